// The first visit of a user: the page shows a view that fills the oval, and a line of text that offers a tour.

import type { State } from "@oval4d/protocol";

import { byId } from "./element";

const kVisitedKey = "oval4d.visited"; // key in localStorage

/**
 * Commands for the view of a first visit. The last rotation is small, so that the keys that repeat it (Space and .)
 * turn the polytope only a little.
 */
export const kFirstVisitView = ["polytope 24-cell", "rotate xw,yz pi/8 pi/sqrt(3)-pi/8", "rotate xy,zw"];

/** Whether this browser opens the page for the first time. False if the browser forbids storage. */
export function isFirstVisit(): boolean {
    try {
        return localStorage.getItem(kVisitedKey) === null;
    } catch {
        return false;
    }
}

/** The name of the field that a button in the welcome line shows. */
const kFirstField = "tiger";

export interface WelcomeLineActions {
    startTour(): void;
    /** Shows the object of the catalogue with this name. */
    showObject(name: string): void;
    /** Called after the line has disappeared, if the focus was in it. */
    closed(): void;
}

/**
 * The welcome line over the picture. It advises the user to turn the object and to move the focus, and disappears when
 * the user has done both.
 */
export class WelcomeLine {
    private readonly root = byId("welcome");
    private since = 0; // the revision from which on the view of the first visit is complete
    private first: State | undefined;
    private hasTurned = false;
    private hasMoved = false;

    constructor(
        drawing: HTMLElement,
        private readonly actions: WelcomeLineActions,
    ) {
        // A user who drags, taps or zooms no longer needs the line. Hiding it gives its room to the picture.
        for (const gesture of ["pointerup", "wheel"]) drawing.addEventListener(gesture, () => this.hide());
        this.root.addEventListener("mousedown", (event) => event.preventDefault()); // the drawing keeps the focus
        byId("welcome-tour").addEventListener("click", () => {
            this.hide();
            actions.startTour();
        });
        byId("welcome-field").addEventListener("click", () => actions.showObject(kFirstField));
        byId("welcome-close").addEventListener("click", () => this.hide());
    }

    /** Shows the line, and remembers that this browser has seen it. */
    showAndRememberVisit(): void {
        this.root.hidden = false;
        try {
            localStorage.setItem(kVisitedKey, "1");
        } catch {
            // The storage is full or forbidden: the next visit counts as the first again.
        }
    }

    /** Records that the view of the first visit is complete from this revision on. */
    firstVisitViewComplete(revision: number): void {
        this.since = revision;
        this.first = undefined;
    }

    update(state: State): void {
        if (this.root.hidden || state.revision < this.since) return;
        const first = (this.first ??= state);
        const differ = (a: unknown, b: unknown): boolean => JSON.stringify(a) !== JSON.stringify(b);
        this.hasTurned ||= differ(state.orientation, first.orientation);
        this.hasMoved ||= differ([state.slices.focus, state.slices.offset, state.point], [
            first.slices.focus,
            first.slices.offset,
            first.point,
        ]);
        if (this.hasTurned && this.hasMoved) this.hide();
    }

    hide(): void {
        const hadFocus = this.root.contains(document.activeElement);
        this.root.hidden = true;
        if (hadFocus) this.actions.closed();
    }
}
