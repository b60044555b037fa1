// A short message over the picture, which disappears after a few seconds or at the next action.

import { byId, element } from "./element";
import { toSentence } from "./format";

const kDuration = 8000; // milliseconds per message

export class Notice {
    private readonly root = byId("notice");
    private timer: ReturnType<typeof setTimeout> | undefined;

    /**
     * Shows a message. If `text` is given, also shows this text in a field from which the user can copy it; both then
     * stay until the next action.
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

    hide(): void {
        clearTimeout(this.timer);
        this.root.replaceChildren();
    }

    private write(messages: string[]): void {
        clearTimeout(this.timer);
        this.root.replaceChildren(messages.map(toSentence).join("\n"));
        this.timer = setTimeout(() => this.hide(), messages.length * kDuration);
    }
}
