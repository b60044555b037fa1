// A modal dialog: closes with Escape, its button or a click beside it. The browser then gives the focus back to where
// it was; the mouse leaves it on the drawing all the while.

import { byId } from "./element";

export class Dialog {
    private readonly root: HTMLDialogElement;

    constructor(id: string) {
        this.root = byId<HTMLDialogElement>(id);
        this.root.addEventListener("pointerdown", (event) => {
            if (event.target === this.root) this.root.close(); // beside what it shows
        });
        for (const button of this.root.querySelectorAll("[data-close]")) {
            button.addEventListener("click", () => this.root.close());
        }
    }

    get isOpen(): boolean {
        return this.root.open;
    }

    open(first: HTMLElement): void {
        if (!this.root.open) this.root.showModal();
        first.focus();
    }

    close(): void {
        this.root.close();
    }
}
