// Names what is under the pointer in pictures that the server draws. The page asks the server which element, or which
// surface of a field, is at a pixel. It then requests a picture in which this element is highlighted, and shows this
// picture while the pointer stays on the element.
//
// A key pressed meanwhile waits for these answers, because the server handles a page's messages one after the other.
// The page therefore asks about one point at a time, once per animation frame. It asks only while the picture rests and
// every command is answered. It also requests one picture at a time, but shows the name of an element before its
// picture arrives.

import type { At, Client, PolytopeElement } from "@oval4d/protocol";

import { followHover, type AreaPoint } from "./hover";
import type { PointedDescription, PointerLabel } from "./pointed_label";
import type { Stage } from "./picture/stage";

// A picture rests after this many milliseconds without a new picture. This is longer than a step of continuous turning.
const kRest = 200;
const kNear = 8; // pixels: an answer is ignored if the pointer has moved farther than this since the question
// Pixels: the label follows the pointer up to this distance from the named point, until the next answer arrives.
const kFollow = 24;

export class FramePointerHighlighter {
    private pointer: AreaPoint | undefined;
    private named: AreaPoint | undefined; // the point of the drawing about which the label tells
    private revision: number | undefined; // the revision of the picture at rest; undefined while no picture rests
    private asked = ""; // the pixel of the last request about this picture, as "x y"; "" if there was none
    private isAsking = false;
    private lit: PolytopeElement | undefined; // the highlighted element of the picture that is shown or requested
    private isLighting = false; // whether a picture has been requested and has not arrived
    private resting: ReturnType<typeof setTimeout> | undefined;

    /** `isIdle(revision)` tells whether this revision is the newest one and all commands are answered. */
    constructor(
        private readonly drawing: HTMLElement,
        private readonly stage: Stage,
        private readonly client: Client,
        private readonly label: PointerLabel,
        private readonly isIdle: (revision: number) => boolean,
    ) {
        followHover(drawing, (at) => this.handlePointerMove(at));
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
        this.hideName();
    }

    /**
     * Asks the server what is under the pointer, unless the answer is known. Must be called when the page may have
     * become idle.
     */
    update(): void {
        if (!this.isAsking) void this.requestPickAtPointer();
    }

    private handlePointerMove(at: AreaPoint | undefined): void {
        this.pointer = at;
        if (!at || (this.named && distance(at, this.named) > kFollow)) {
            this.hideName();
            this.asked = ""; // so that the page asks again if the pointer returns to this pixel
        } else if (this.named) {
            this.label.place(at);
        }
        this.update();
    }

    /** Asks what is under the pointer, repeatedly, until the server has answered for the pointer's newest position. */
    private async requestPickAtPointer(): Promise<void> {
        this.isAsking = true;
        for (let pixel = this.nextPixelToAskAbout(); pixel; pixel = this.nextPixelToAskAbout()) {
            const pointer = this.pointer!;
            const request = this.client.request({ type: "get", what: "at", ...pixel, ...this.stage.size });
            const nextFrame = new Promise((resolve) => requestAnimationFrame(resolve));
            const answer = await request.catch(() => undefined); // after an error, no name is shown
            if (answer) this.showAnswer(answer, pointer);
            await nextFrame;
        }
        this.isAsking = false;
    }

    /**
     * The pixel of the picture to ask about next. Undefined if the page has already asked about this pixel, or must not
     * ask now.
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

    /** Shows the server's answer about a point, unless the picture has changed or the pointer has moved away. */
    private showAnswer(answer: At, at: AreaPoint): void {
        const { pointer } = this;
        if (answer.revision !== this.revision || !pointer) return;
        const described = descriptionOf(answer);
        if (distance(pointer, at) > kNear) {
            this.asked = ""; // so that the page asks again if the pointer returns to this pixel
        } else if (described) {
            this.named = at;
            this.label.show(described, pointer);
            if ("element" in described) this.highlightElement(described);
            else this.hideHighlight();
        } else {
            this.hideName();
        }
    }

    /**
     * Requests and shows a picture in which the element is highlighted, unless the pointer leaves the element before
     * the picture arrives.
     */
    private highlightElement(element: PolytopeElement): void {
        if (element.element === this.lit?.element && element.number === this.lit.number) return;
        this.lit = element;
        if (!this.isLighting) void this.requestHighlightedPictures();
    }

    /** Requests one picture after another, until the last one highlights the newest element. */
    private async requestHighlightedPictures(): Promise<void> {
        this.isLighting = true;
        let requested: PolytopeElement | undefined;
        while (this.lit && this.lit !== requested) {
            const wanted = this.lit;
            requested = wanted;
            const highlight = { element: wanted.element, number: wanted.number };
            // If the server refuses, no element is highlighted.
            const frame = await this.client
                .request({ type: "get", what: "frame", highlight, ...this.stage.size })
                .catch(() => undefined);
            if (frame) this.stage.showPointedFrame(frame, () => wanted === this.lit).catch(() => undefined);
        }
        this.isLighting = false;
    }

    private hideHighlight(): void {
        this.lit = undefined;
        this.stage.hidePointedFrame();
    }

    private hideName(): void {
        this.hideHighlight();
        if (!this.named) return; // otherwise the label may belong to pointing.ts
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
    // A zoomed slice may reach behind a panel of the matrix, where it is not visible.
    const isBehindPanel = answer.point !== undefined && answer.in !== "matrix";
    if (!highlight || isBehindPanel) return undefined;
    if (highlight.element === "vertex") return { ...highlight, coordinates: answer.coordinates, sliceW: w };
    return { ...highlight, name, kind, sliceW: w };
}
