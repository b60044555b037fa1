// A short message over the picture, shown until the next action or for a few seconds.

import { byId, element } from "./element";
import { sentence } from "./format";

const kDuration = 8000; // milliseconds

export class Notice {
    private readonly root = byId("notice");
    private timer: ReturnType<typeof setTimeout> | undefined;

    /** Shows a message. With a `text` for the user to copy, it stays until the next action. */
    show(message: string, text?: string): void {
        clearTimeout(this.timer);
        this.root.replaceChildren(sentence(message));
        if (text === undefined) {
            this.timer = setTimeout(() => this.hide(), kDuration);
            return;
        }
        const field = element("input", { type: "text", readonly: true, value: text, "aria-label": "Link" });
        this.root.append(field);
        field.select();
    }

    hide(): void {
        clearTimeout(this.timer);
        this.root.replaceChildren();
    }
}
