// The element under the pointer: it is named beside the pointer, and lit in all slices, the projection and the parallel
// coordinates.

import type { PolytopeElement, Slice, State } from "@oval4d/protocol";

import { byId } from "./element";
import { capitalize, formatCoordinate, formatLength } from "./format";
import { elementOfHit, ElementSources } from "./picture/element_sources";
import type { SliceLayout } from "./picture/slice_layout";
import type { Stage } from "./picture/stage";

const kGap = 14; // pixels between the pointer and the label
const kMargin = 4; // pixels between the label and the edges of the drawing

/** An element of the polytope, and the slice in which it was pointed at. */
export interface Pointed extends PolytopeElement {
    slice?: Slice;
}

export class Pointing {
    private readonly label = byId("pointed");
    private at: { x: number; y: number } | undefined; // in pixels from the upper left corner of the drawing
    private scheduled = false;
    private shown: Pointed | undefined;
    private sources: ElementSources | undefined;
    private layout: SliceLayout | undefined; // of the picture that `sources` belongs to

    constructor(
        private readonly drawing: HTMLElement,
        private readonly stage: Stage,
        private readonly state: () => State | undefined,
    ) {
        drawing.addEventListener("pointermove", (event) => this.moved(event));
        drawing.addEventListener("pointerup", (event) => this.moved(event));
        drawing.addEventListener("pointerdown", () => this.moveTo(undefined));
        drawing.addEventListener("pointerleave", () => this.moveTo(undefined));
    }

    /** The element at a point of the drawing, in pixels. */
    elementAt(x: number, y: number, layout: SliceLayout): Pointed | undefined {
        const { size, orbit } = this.stage;
        const polytope = this.state()?.polytope;
        // A state may be newer than the picture.
        if (polytope?.cells !== layout.picture.scene.colors.cells.length) return undefined;
        const ratio = size.height / this.drawing.clientHeight;
        const column = layout.columnAt(x * ratio, y * ratio, size);
        if (column !== undefined) return { element: "vertex", number: column };
        const hit = layout.hitAt(x * ratio, y * ratio, orbit, size, ratio);
        return hit && { ...elementOfHit(hit, polytope), ...(hit.slice && { slice: hit.slice }) };
    }

    /** Finds the element under the pointer in the current picture. Returns whether the picture must be drawn again. */
    update(): boolean {
        const { at } = this;
        const { layout } = this.stage;
        const found = at && layout && this.elementAt(at.x, at.y, layout);
        const { shown } = this;
        const isNew = layout !== this.layout;
        if (isNew) this.sources = undefined;
        this.layout = layout;
        if (!found && !shown) return false;
        const isSame = !isNew && found?.element === shown?.element && found?.number === shown?.number;
        if (isSame && found?.slice === shown?.slice) {
            this.place();
            return false;
        }
        this.shown = found;
        this.label.hidden = !found;
        if (!found) this.stage.light(undefined);
        else {
            const state = this.state()!;
            this.sources ??= new ElementSources(layout!.picture, state.polytope);
            const lit = this.sources.showing(found);
            if (!isSame) this.stage.light(lit);
            this.label.textContent = describe(found, [...lit.ownVertices], layout!, state);
            this.place();
        }
        return !isSame;
    }

    private moved({ pointerType, buttons, clientX, clientY }: PointerEvent): void {
        const { left, top } = this.drawing.getBoundingClientRect();
        this.moveTo(pointerType === "touch" || buttons !== 0 ? undefined : { x: clientX - left, y: clientY - top });
    }

    /** Updates once in each animation frame. */
    private moveTo(at: { x: number; y: number } | undefined): void {
        if (!at && !this.at) return;
        this.at = at;
        if (this.scheduled) return;
        this.scheduled = true;
        requestAnimationFrame(() => {
            this.scheduled = false;
            if (this.update()) this.stage.drawNow();
        });
    }

    /** Places the label beside the pointer, within the drawing. */
    private place(): void {
        const { x, y } = this.at!;
        const { offsetWidth: width, offsetHeight: height } = this.label;
        const { clientWidth, clientHeight } = this.drawing;
        const left = Math.max(kMargin, Math.min(x + kGap, clientWidth - width - kMargin));
        const isBelow = y + kGap + height + kMargin <= clientHeight;
        const top = isBelow ? y + kGap : Math.max(kMargin, y - kGap - height);
        this.label.style.transform = `translate(${Math.round(left)}px, ${Math.round(top)}px)`;
    }
}

/** The element's name, and what is known of its shape and its place. */
function describe(
    { element, number, slice }: Pointed,
    own: number[],
    { picture: { coordinates } }: SliceLayout,
    { polytope: { kinds = [] } }: State,
): string {
    const parts = [`${capitalize(element)} ${number}`];
    const points = coordinates.length > 0 ? own.map((v) => [...coordinates.subarray(4 * v, 4 * v + 4)]) : [];
    if (element === "cell" && kinds.length === 1) parts.push(kinds[0]!.name);
    if (element === "vertex" && points[0]) parts[0] += ` (${points[0].map(formatCoordinate).join(", ")})`;
    else if (points.length > 0) {
        if (element === "edge" && points.length === 2) {
            const [a, b] = points as [number[], number[]];
            parts.push(`length ${formatLength(Math.hypot(...a.map((value, i) => value - b[i]!)))}`);
        }
        const w = points.map((point) => point[3]!);
        const [least, most] = [Math.min(...w), Math.max(...w)].map(formatCoordinate);
        parts.push(least === most ? `w ${least}` : `w ${least} … ${most}`);
    }
    if (slice) parts.push(`slice w ${formatCoordinate(slice.w)}`);
    return parts.join(" · ");
}
