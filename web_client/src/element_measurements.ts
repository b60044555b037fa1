// What the server answers about the element under the pointer: its size, what pictures highlight of it, and its range
// of w.

import type { Measured, PolytopeElement, State } from "@oval4d/protocol";

export class ElementMeasurements {
    private wanted: PolytopeElement | undefined;
    private asked = ""; // the question that was asked last (see questionAbout)
    private newest: { about: string; answer: Measured | undefined } = { about: "", answer: undefined };
    private isAsking = false;

    /** `measure` asks the server about an element. `answered` is called after each answer. */
    constructor(
        private readonly state: () => State | undefined,
        private readonly measure: (element: PolytopeElement) => Promise<Measured>,
        private readonly answered: () => void,
    ) {}

    /**
     * The newest answer about an element; undefined if there is none, or if the server has refused to answer. While the
     * object moves, the range of w in the answer may be that of an earlier picture.
     */
    of(element: PolytopeElement): Measured | undefined {
        return this.newest.about === this.identityOf(element) ? this.newest.answer : undefined;
    }

    /**
     * Asks about this element, if the answer may have changed since the last question. One question is asked at a time,
     * so the element may be replaced by another one before it is asked about.
     */
    want(element: PolytopeElement | undefined): void {
        this.wanted = element;
        if (!this.isAsking) void this.askAboutWanted();
    }

    /** Asks until the answer about the element that is wanted then is known. */
    private async askAboutWanted(): Promise<void> {
        this.isAsking = true;
        while (this.wanted && this.questionAbout(this.wanted) !== this.asked) {
            const { wanted } = this;
            const about = this.identityOf(wanted);
            this.asked = this.questionAbout(wanted);
            const answer = await this.measure(wanted).catch(() => undefined);
            this.newest = { about, answer };
            this.answered();
        }
        this.isAsking = false;
    }

    /** A text that differs for different elements, also of different objects. */
    private identityOf({ element, number }: PolytopeElement): string {
        return JSON.stringify([element, number, this.state()?.object_serial]);
    }

    /** A text that also differs if the state has changed, because the range of w then may be another one. */
    private questionAbout(element: PolytopeElement): string {
        return `${this.identityOf(element)} ${this.state()?.revision}`;
    }
}
