// The first visit of a browser: a view that fills the oval, and a line that explains it and offers the tour.

import { byId } from "./element";

const kVisitedKey = "oval4d.visited"; // in localStorage

/** Commands for the view of a first visit. The last rotation is one that may be repeated: it turns a little. */
export const kFirstView = ["polytope 24-cell", "rotate xw,yz pi/8 pi/sqrt(3)-pi/8", "rotate xy,zw"];

/** Whether this browser opens the page for the first time. False if the browser forbids storage. */
export function isFirstVisit(): boolean {
    try {
        return localStorage.getItem(kVisitedKey) === null;
    } catch {
        return false;
    }
}

export class Welcome {
    private readonly root = byId("welcome");

    constructor(
        startTour: () => void,
        private readonly closed: () => void,
    ) {
        this.root.addEventListener("mousedown", (event) => event.preventDefault()); // the drawing keeps the focus
        byId("welcome-tour").addEventListener("click", () => {
            this.hide();
            startTour();
        });
        byId("welcome-close").addEventListener("click", () => this.hide());
    }

    /** Shows the line, and remembers that this browser has seen it. */
    show(): void {
        this.root.hidden = false;
        try {
            localStorage.setItem(kVisitedKey, "1");
        } catch {
            // The storage is full: the next visit counts as the first again.
        }
    }

    hide(): void {
        const hadFocus = this.root.contains(document.activeElement);
        this.root.hidden = true;
        if (hadFocus) this.closed();
    }
}
