// A modal dialog. Escape, the Close button or a click outside closes the dialog. The browser then returns the focus to
// the element that had it before. If the dialog was opened with the mouse, this element is the drawing.

import { byId } from "./element";

export class Dialog {
    private readonly root: HTMLDialogElement;

    constructor(id: string) {
        this.root = byId<HTMLDialogElement>(id);
        this.root.addEventListener("pointerdown", (event) => {
            if (event.target === this.root) this.root.close(); // a click beside the dialog
        });
        for (const button of this.root.querySelectorAll("[data-close]")) {
            button.addEventListener("click", () => this.root.close());
        }
    }

    get isOpen(): boolean {
        return this.root.open;
    }

    /** Opens the dialog and focuses the element `first`. */
    open(first: HTMLElement): void {
        if (!this.root.open) this.root.showModal();
        first.focus();
    }

    close(): void {
        this.root.close();
    }
}
