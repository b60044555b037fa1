// Messages of the page that a test holds back.

/**
 * Runs in the page before its scripts. Holds back the messages to the server for which `window.isHeld` returns true.
 * `window.release()` sends them.
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
