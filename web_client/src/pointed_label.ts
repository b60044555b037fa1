// The label beside the pointer, which names an element of the polytope.

import type { Measured, PolytopeElement, State } from "@oval4d/protocol";

import { byId } from "./element";
import { capitalize, formatCoordinate, formatLength } from "./format";
import type { Point } from "./hover";
import { spokenReferenceFrame } from "./reference_frame";

/** An element, and what is known of its shape and its place. */
export interface ElementDescription extends PolytopeElement {
    /** Of a cell: the name of its kind, if it is known without asking the server. */
    kind?: string | undefined;
    /** Of a vertex: x, y, z, w. */
    coordinates?: readonly number[] | undefined;
    /** Of an edge: its length, if it is known without asking the server. */
    length?: number | undefined;
    /** The least and the greatest w of the element's vertices. */
    range?: readonly [number, number] | undefined;
    /** The w of the slice in which the pointer is on the element; undefined if the pointer is on no slice. */
    sliceW?: number | undefined;
}

const kGap = 14; // pixels between the pointer and the label
const kMargin = 4; // pixels between the label and the edges of the drawing

/** What the server has answered about the element that `of` identifies; nothing if it has refused to answer. */
type Measurement = { of: string } & Partial<Pick<Measured, "kind" | "length" | "area" | "volume" | "unit">>;

export class PointedLabel {
    private readonly label = byId("pointed");
    private shown: ElementDescription | undefined;
    private pointer: Point = { x: 0, y: 0 };
    private measurement: Measurement = { of: "" };
    private isMeasuring = false;

    /** `measure` asks the server for the size of an element. */
    constructor(
        private readonly drawing: HTMLElement,
        private readonly state: () => State | undefined,
        private readonly measure: (element: PolytopeElement) => Promise<Measured>,
    ) {}

    /** Shows the label of an element beside the pointer. The label gets the element's size when the server answers. */
    show(element: ElementDescription, pointer: Point): void {
        this.shown = element;
        this.pointer = pointer;
        this.label.hidden = false;
        this.write();
        if (!this.isMeasuring) void this.measureShown();
    }

    hide(): void {
        this.shown = undefined;
        this.label.hidden = true;
    }

    /** Asks for one size at a time, until the size of the element that is shown then is known. */
    private async measureShown(): Promise<void> {
        this.isMeasuring = true;
        for (let key = this.unmeasured(); key !== undefined; key = this.unmeasured()) {
            const { element, number } = this.shown!;
            const answer = await this.measure({ element, number }).catch(() => undefined);
            this.measurement = { ...answer, of: key };
            if (this.shown) this.write();
        }
        this.isMeasuring = false;
    }

    /** Identifies the element that is shown; undefined if there is nothing to ask about it. */
    private unmeasured(): string | undefined {
        const key = this.identity();
        const isKnown = this.shown?.element === "vertex" || this.shown?.length !== undefined;
        return isKnown || key === this.measurement.of ? undefined : key;
    }

    /** A text that differs for different elements, also of different objects; undefined if none is shown. */
    private identity(): string | undefined {
        const state = this.state();
        if (!this.shown || !state) return undefined;
        const { element, number } = this.shown;
        return JSON.stringify([element, number, state.object_serial]);
    }

    private write(): void {
        const { measurement } = this;
        const known = measurement.of === this.identity() ? measurement : { of: "" };
        this.label.textContent = describe(this.shown!, known, this.state());
        this.place(this.pointer);
    }

    /** Places the label beside the pointer, within the drawing. */
    place({ x, y }: Point): void {
        this.pointer = { x, y };
        const { offsetWidth: width, offsetHeight: height } = this.label;
        const { clientWidth, clientHeight } = this.drawing;
        const left = Math.max(kMargin, Math.min(x + kGap, clientWidth - width - kMargin));
        const isBelow = y + kGap + height + kMargin <= clientHeight;
        const top = isBelow ? y + kGap : Math.max(kMargin, y - kGap - height);
        this.label.style.transform = `translate(${Math.round(left)}px, ${Math.round(top)}px)`;
    }
}

/** The sizes that the server measures are those of the object at rest, so they are omitted for a moving observer. */
function describe(described: ElementDescription, measured: Measurement, state: State | undefined): string {
    const { element, number, coordinates, range, sliceW } = described;
    const spacing = state?.slices.spacing ?? 1; // to which coordinates are rounded
    const format = (coordinate: number): string => formatCoordinate(coordinate, spacing);
    const parts = [`${capitalize(element)} ${number}`];
    if (coordinates) parts[0] += ` (${coordinates.map(format).join(", ")})`;
    const kind = described.kind ?? state?.polytope.kinds?.[measured.kind ?? -1]?.name;
    if (kind !== undefined) parts.push(kind);
    const { length, area, volume }: Partial<Measurement> = state && spokenReferenceFrame(state) === "" ? measured : {};
    const sizes = { length: described.length ?? length, area, volume };
    const unit = measured.unit === undefined ? "" : ` ${measured.unit}`; // of a field's box, whose sizes are all measured
    for (const [name, size] of Object.entries(sizes)) {
        if (size !== undefined) parts.push(`${name} ${formatLength(size)}${unit}`);
    }
    if (range) {
        const [least, most] = range.map(format);
        parts.push(least === most ? `w ${least}` : `w ${least} … ${most}`);
    }
    if (sliceW !== undefined) parts.push(`slice w ${format(sliceW)}`);
    return parts.join(" · ");
}
