// The server's answers about the element under the pointer: its size, the parts that pictures highlight, and its range
// of w.

import type { Measured, PolytopeElement, State } from "@oval4d/protocol";

export class ElementMeasurementFetcher {
    private wanted: PolytopeElement | undefined;
    private asked = ""; // the text of the last question; see questionAbout()
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
    measurementsOf(element: PolytopeElement): Measured | undefined {
        return this.newest.about === this.identityOf(element) ? this.newest.answer : undefined;
    }

    /**
     * Asks the server about this element, if the answer may have changed since the last question. The server is asked
     * one question at a time. If another element is wanted before a question is sent, only the newer one is asked
     * about. If `element` is undefined, no further question is sent.
     */
    askAbout(element: PolytopeElement | undefined): void {
        this.wanted = element;
        if (!this.isAsking) void this.requestMeasurementOfWanted();
    }

    /** Asks about the wanted element, again and again, until the answer about the newest wanted element is known. */
    private async requestMeasurementOfWanted(): Promise<void> {
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

    /** A text that identifies an element of the present object. Elements of different objects have different texts. */
    private identityOf({ element, number }: PolytopeElement): string {
        return JSON.stringify([element, number, this.state()?.object_serial]);
    }

    /**
     * A text that identifies a question. The text changes with each new state, because the element's range of w may
     * change.
     */
    private questionAbout(element: PolytopeElement): string {
        return `${this.identityOf(element)} ${this.state()?.revision}`;
    }
}
