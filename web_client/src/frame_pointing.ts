// What is under the pointer in the pictures that the server draws. The page asks the server which element or which
// surface of a field it is, and for a picture in which this element is highlighted, which it shows while the pointer is
// there.
//
// The server handles the messages of a page one after the other, so a key that is pressed meanwhile waits until the
// answer is complete. The page therefore asks about one point at a time, once per animation frame, and only while the
// picture rests and no command is unanswered. The pictures are requested one at a time, too, but the name of an element
// does not wait for them.

import type { At, Client, PolytopeElement } from "@oval4d/protocol";

import { followHover, type AreaPoint } from "./hover";
import type { PointedDescription, PointedLabel } from "./pointed_label";
import type { Stage } from "./picture/stage";

// Milliseconds without a new picture after which the picture rests: longer than the steps of continuous turning last.
const kRest = 200;
const kNear = 8; // pixels: an answer is not shown if the pointer has moved farther than this before it arrives
// Pixels: until the next answer, the label follows the pointer this far from the point that it names.
const kFollow = 24;

export class FramePointing {
    private pointer: AreaPoint | undefined;
    private named: AreaPoint | undefined; // the point whose element the label names
    private revision: number | undefined; // the revision of the picture at rest; undefined while no picture rests
    private asked = ""; // the pixel of the last request about the present picture, as "x y"; "" if there was none
    private isAsking = false;
    private lit: PolytopeElement | undefined; // the element that the picture that is shown or wanted highlights
    private isLighting = false; // whether a picture has been requested and has not arrived
    private resting: ReturnType<typeof setTimeout> | undefined;

    /** `isIdle` returns whether a revision is the newest one, and no command is unanswered. */
    constructor(
        private readonly drawing: HTMLElement,
        private readonly stage: Stage,
        private readonly client: Client,
        private readonly label: PointedLabel,
        private readonly isIdle: (revision: number) => boolean,
    ) {
        followHover(drawing, (at) => this.moved(at));
    }

    picturePresented(revision: number): void {
        this.reset();
        if (this.stage.mode !== "frames") return;
        this.resting = setTimeout(() => {
            this.revision = revision;
            this.update();
        }, kRest);
    }

    /** Forgets the picture, and hides the label. */
    reset(): void {
        clearTimeout(this.resting);
        this.revision = undefined;
        this.asked = "";
        this.hide();
    }

    /**
     * Asks the server what is under the pointer, unless the answer is known. To be called when the page may have become
     * idle.
     */
    update(): void {
        if (!this.isAsking) void this.ask();
    }

    private moved(at: AreaPoint | undefined): void {
        this.pointer = at;
        if (!at || (this.named && distance(at, this.named) > kFollow)) {
            this.hide();
            this.asked = ""; // so that the page asks again if the pointer returns to this pixel
        } else if (this.named) {
            this.label.place(at);
        }
        this.update();
    }

    /**
     * Asks what is at the pointer, again and again, until the server has answered for the pointer's newest position.
     */
    private async ask(): Promise<void> {
        this.isAsking = true;
        for (let pixel = this.nextPixelToAskAbout(); pixel; pixel = this.nextPixelToAskAbout()) {
            const pointer = this.pointer!;
            const request = this.client.request({ type: "get", what: "at", ...pixel, ...this.stage.size });
            const nextFrame = new Promise((resolve) => requestAnimationFrame(resolve));
            const answer = await request.catch(() => undefined); // after an error, no name is shown
            if (answer) this.answered(answer, pointer);
            await nextFrame;
        }
        this.isAsking = false;
    }

    /**
     * The pixel of the picture to ask about next; undefined if the page has asked about it already, or must not ask
     * now.
     */
    private nextPixelToAskAbout(): AreaPoint | undefined {
        const { pointer, revision } = this;
        if (!pointer || revision === undefined || !this.isIdle(revision)) return undefined;
        const ratio = this.stage.size.height / this.drawing.clientHeight;
        const pixel = { x: Math.round(pointer.x * ratio), y: Math.round(pointer.y * ratio) };
        const asked = `${pixel.x} ${pixel.y}`;
        if (asked === this.asked) return undefined;
        this.asked = asked;
        return pixel;
    }

    /** Shows what is at a point, unless the picture has changed or the pointer has moved on. */
    private answered(answer: At, at: AreaPoint): void {
        const { pointer } = this;
        if (answer.revision !== this.revision || !pointer) return;
        const described = descriptionOf(answer);
        if (distance(pointer, at) > kNear) {
            this.asked = ""; // so that the page asks again if the pointer returns to this pixel
        } else if (described) {
            this.named = at;
            this.label.show(described, pointer);
            if ("element" in described) this.light(described);
            else this.endLight();
        } else {
            this.hide();
        }
    }

    /** Shows a picture in which the element is highlighted, unless the pointer has left the element before. */
    private light(element: PolytopeElement): void {
        if (element.element === this.lit?.element && element.number === this.lit.number) return;
        this.lit = element;
        if (!this.isLighting) void this.requestLitPictures();
    }

    /** Requests pictures, one after the other, until the last one is that of the newest element. */
    private async requestLitPictures(): Promise<void> {
        this.isLighting = true;
        let requested: PolytopeElement | undefined;
        while (this.lit && this.lit !== requested) {
            const wanted = this.lit;
            requested = wanted;
            const highlight = { element: wanted.element, number: wanted.number };
            // After an error, no element is highlighted.
            const frame = await this.client
                .request({ type: "get", what: "frame", highlight, ...this.stage.size })
                .catch(() => undefined);
            if (frame) this.stage.showPointedFrame(frame, () => wanted === this.lit).catch(() => undefined);
        }
        this.isLighting = false;
    }

    private endLight(): void {
        this.lit = undefined;
        this.stage.hidePointedFrame();
    }

    private hide(): void {
        this.endLight();
        if (!this.named) return; // a label that is visible now belongs to pointing.ts, in a picture that the page draws
        this.named = undefined;
        this.label.hide();
    }
}

function distance(a: AreaPoint, b: AreaPoint): number {
    return Math.hypot(a.x - b.x, a.y - b.y);
}

function descriptionOf(answer: At): PointedDescription | undefined {
    const { highlight, name, kind, w, level, cap = false } = answer;
    if (level !== undefined) return { level, cap, sliceW: w, revision: answer.revision, known: answer };
    // A slice that has been zoomed may reach behind a panel of the matrix.
    const isBehindPanel = answer.point !== undefined && answer.in !== "matrix";
    if (!highlight || isBehindPanel) return undefined;
    if (highlight.element === "vertex") return { ...highlight, coordinates: answer.coordinates, sliceW: w };
    return { ...highlight, name, kind, sliceW: w };
}
