// A short message over the picture. It disappears after some seconds or at the next action; a lasting message stays
// until the user closes it.

import { byId, element } from "./element";
import { toSentence } from "./format";

const kDuration = 8000; // the time for which each message is shown, in milliseconds

export class Notice {
    private readonly root = byId("notice");
    private timer: ReturnType<typeof setTimeout> | undefined;
    private isLasting = false; // whether the message stays until it is closed or replaced

    /**
     * Shows a message. If `text` is given, also shows it in a field from which the user can copy it. Message and text
     * then stay until the next action.
     */
    show(message: string, text?: string): void {
        this.write([message]);
        if (text === undefined) return;
        clearTimeout(this.timer);
        const rows = String(text.trimEnd().split("\n").length);
        const field = element("textarea", { readonly: true, rows, "aria-label": "Text to copy" }, text);
        this.root.append(field);
        field.select();
    }

    /** Shows several messages, each on a line of its own. */
    showAll(messages: string[]): void {
        if (messages.length > 0) this.write(messages);
    }

    /** Shows several messages, each on a line of its own, with a button that closes them. They stay until then. */
    showLasting(messages: string[]): void {
        if (messages.length === 0) return;
        this.write(messages);
        clearTimeout(this.timer);
        this.isLasting = true;
        const close = element("button", { type: "button", "aria-label": "Close the message", title: "Close" }, "×");
        close.addEventListener("mousedown", (event) => event.preventDefault()); // the focus does not move to the button
        close.addEventListener("click", () => {
            const hadFocus = document.activeElement === close;
            this.close();
            if (hadFocus) byId("drawing").focus();
        });
        this.root.append(close);
    }

    /** Hides the message, except a lasting one. The page must call this function at each action of the user. */
    hide(): void {
        if (!this.isLasting) this.close();
    }

    /** Hides the message, even a lasting one. */
    close(): void {
        clearTimeout(this.timer);
        this.isLasting = false;
        this.root.replaceChildren();
    }

    private write(messages: string[]): void {
        clearTimeout(this.timer);
        this.isLasting = false;
        this.root.replaceChildren(messages.map(toSentence).join("\n"));
        this.timer = setTimeout(() => this.hide(), messages.length * kDuration);
    }
}
