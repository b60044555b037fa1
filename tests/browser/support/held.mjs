// Messages of the page that a test holds back.

/**
 * Runs in the page before its scripts: holds those messages to the server back for which `window.isHeld` returns true,
 * until the test calls `window.release()`.
 */
export function holdSent() {
    const { send } = WebSocket.prototype;
    const held = [];
    WebSocket.prototype.send = function (text) {
        if (window.isHeld?.(JSON.parse(text))) held.push(() => send.call(this, text));
        else send.call(this, text);
    };
    window.release = () => {
        window.isHeld = undefined;
        held.splice(0).forEach((sendNow) => sendNow());
    };
}
