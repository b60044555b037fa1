// A short message over the picture, until the next action or a while later.

import { byId, element } from "./element";

const kShownFor = 8000; // milliseconds

export class Notice {
    private readonly root = byId("notice");
    private timer: ReturnType<typeof setTimeout> | undefined;

    /** With `text` to be copied by hand, it stays. */
    show(message: string, text?: string): void {
        clearTimeout(this.timer);
        this.root.replaceChildren(message);
        if (text === undefined) {
            this.timer = setTimeout(() => this.hide(), kShownFor);
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
