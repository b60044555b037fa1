// The label beside the pointer, which names an element of the polytope.

import type { PolytopeElement, State } from "@oval4d/protocol";

import { byId } from "./element";
import { capitalize, formatCoordinate, formatLength } from "./format";
import type { Point } from "./hover";

/** An element, and what is known of its shape and its place. */
export interface ElementDescription extends PolytopeElement {
    /** Of a cell: the name of its kind. */
    kind?: string | undefined;
    /** Of a vertex: x, y, z, w. */
    coordinates?: readonly number[] | undefined;
    /** Of an edge: its length. */
    length?: number | undefined;
    /** The least and the greatest w of its vertices. */
    range?: readonly [number, number] | undefined;
    /** The w of the slice in which the pointer is on the element; undefined if the pointer is on no slice. */
    sliceW?: number | undefined;
}

const kGap = 14; // pixels between the pointer and the label
const kMargin = 4; // pixels between the label and the edges of the drawing

export class PointedLabel {
    private readonly label = byId("pointed");

    constructor(
        private readonly drawing: HTMLElement,
        private readonly state: () => State | undefined,
    ) {}

    /** Shows the label of an element beside the pointer. */
    show(element: ElementDescription, pointer: Point): void {
        this.label.hidden = false;
        this.label.textContent = describe(element, this.state()?.slices.spacing ?? 1);
        this.place(pointer);
    }

    hide(): void {
        this.label.hidden = true;
    }

    /** Places the label beside the pointer, within the drawing. */
    place({ x, y }: Point): void {
        const { offsetWidth: width, offsetHeight: height } = this.label;
        const { clientWidth, clientHeight } = this.drawing;
        const left = Math.max(kMargin, Math.min(x + kGap, clientWidth - width - kMargin));
        const isBelow = y + kGap + height + kMargin <= clientHeight;
        const top = isBelow ? y + kGap : Math.max(kMargin, y - kGap - height);
        this.label.style.transform = `translate(${Math.round(left)}px, ${Math.round(top)}px)`;
    }
}

/** `spacing`: the distance between slices, to which coordinates are rounded. */
function describe(described: ElementDescription, spacing: number): string {
    const { element, number, kind, coordinates, length, range, sliceW } = described;
    const format = (coordinate: number): string => formatCoordinate(coordinate, spacing);
    const parts = [`${capitalize(element)} ${number}`];
    if (coordinates) parts[0] += ` (${coordinates.map(format).join(", ")})`;
    if (kind !== undefined) parts.push(kind);
    if (length !== undefined) parts.push(`length ${formatLength(length)}`);
    if (range) {
        const [least, most] = range.map(format);
        parts.push(least === most ? `w ${least}` : `w ${least} … ${most}`);
    }
    if (sliceW !== undefined) parts.push(`slice w ${format(sliceW)}`);
    return parts.join(" · ");
}
