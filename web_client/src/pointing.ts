// The element under the pointer in the page's own picture: its name is shown beside the pointer, and it is highlighted
// in all slices, the projection and the parallel coordinates. For the server's pictures, see frame_pointing.ts.

import type { PolytopeElement, Slice, State } from "@oval4d/protocol";

import { followHover, type Point } from "./hover";
import { originInFile } from "./origin";
import { elementOfHit, ElementSources } from "./picture/element_sources";
import type { HitTester } from "./picture/hit_tester";
import type { Stage } from "./picture/stage";
import type { ElementDescription, PointedLabel } from "./pointed_label";

/** An element of the polytope, and the slice in which it was pointed at. */
export interface PointedElement extends PolytopeElement {
    slice?: Slice;
}

export class Pointing {
    private at: Point | undefined;
    private scheduled = false;
    private shown: PointedElement | undefined;
    private sources: ElementSources | undefined;
    private hitTester: HitTester | undefined; // the hit tester of the picture to which `sources` belongs
    private isTapped = false; // whether the label names what a finger has tapped

    /** `mayShowObject` returns whether the picture of a revision may show the object of the state. */
    constructor(
        private readonly drawing: HTMLElement,
        private readonly stage: Stage,
        private readonly label: PointedLabel,
        private readonly state: () => State | undefined,
        private readonly mayShowObject: (revision: number) => boolean,
    ) {
        followHover(drawing, (at) => this.moveTo(at));
    }

    /** The element at a point of the drawing, in pixels; undefined if there is none. */
    elementAt(x: number, y: number, hitTester: HitTester): PointedElement | undefined {
        const { size, orbit } = this.stage;
        const polytope = this.state()?.polytope;
        const { coordinates, revision, scene } = hitTester.picture;
        if (!this.mayShowObject(revision)) return undefined;
        // A picture that the page has requested may be newer than the state, and of another object. Their numbers of
        // elements then usually differ.
        if (polytope?.cells !== scene.colors.cells.length) return undefined;
        if (coordinates.length > 0 && coordinates.length !== 4 * polytope.vertices) return undefined;
        const ratio = size.height / this.drawing.clientHeight;
        const vertex = hitTester.vertexInCoordinatesAt(x * ratio, y * ratio, size);
        if (vertex !== undefined) return { element: "vertex", number: vertex };
        const hit = hitTester.hitAt(x * ratio, y * ratio, orbit, size, ratio);
        return hit && { ...elementOfHit(hit, polytope), ...(hit.slice && { slice: hit.slice }) };
    }

    /**
     * Shows the name of the element that a finger has tapped. The name stays until the next touch, even if the picture
     * changes, because the tap itself moves the focus slice.
     */
    showName(tapped: PointedElement, hitTester: HitTester, at: Point): void {
        const state = this.state()!;
        const { ownVertices } = new ElementSources(hitTester.picture, state.polytope).partsShowing(tapped);
        this.isTapped = true;
        this.label.show(descriptionOf(tapped, [...ownVertices], hitTester, state), at);
    }

    /** Finds the element under the pointer in the current picture. Returns whether the picture must be drawn again. */
    update(): boolean {
        const { at } = this;
        const { hitTester } = this.stage;
        const found = at && hitTester && this.elementAt(at.x, at.y, hitTester);
        const { shown } = this;
        const isNew = hitTester !== this.hitTester;
        if (isNew) this.sources = undefined;
        this.hitTester = hitTester;
        if (!found && !shown) return false;
        const isSame = !isNew && found?.element === shown?.element && found?.number === shown?.number;
        if (isSame && found?.slice === shown?.slice) {
            this.label.place(at!);
            return false;
        }
        this.shown = found;
        if (!found) {
            this.stage.highlightPointed(undefined);
            this.label.hide();
        } else {
            const state = this.state()!;
            this.sources ??= new ElementSources(hitTester!.picture, state.polytope);
            const lit = this.sources.partsShowing(found);
            if (!isSame) this.stage.highlightPointed(lit);
            this.label.show(descriptionOf(found, [...lit.ownVertices], hitTester!, state), at!);
        }
        return !isSame;
    }

    /** Records where the pointer is, and calls update() at most once per animation frame. */
    private moveTo(at: Point | undefined): void {
        if (this.isTapped) this.label.hide();
        this.isTapped = false;
        if (!at && !this.at) return;
        this.at = at;
        if (this.scheduled) return;
        this.scheduled = true;
        requestAnimationFrame(() => {
            this.scheduled = false;
            if (this.update()) this.stage.drawNow();
        });
    }
}

function descriptionOf(
    { element, number, slice }: PointedElement,
    own: number[],
    { picture: { coordinates } }: HitTester,
    state: State,
): ElementDescription {
    const { kinds = [] } = state.polytope;
    const origin = originInFile(state);
    const placeOf = (v: number): number[] => origin.map((from, axis) => from + coordinates[4 * v + axis]!);
    const points = coordinates.length > 0 ? own.map(placeOf) : [];
    const common = { element, number, sliceW: slice && origin[3] + slice.w };
    if (element === "vertex") return { ...common, coordinates: points[0] };
    const w = points.map((point) => point[3]!);
    const [a, b] = points.length === 2 ? points : [];
    return {
        ...common,
        kind: element === "cell" && kinds.length === 1 ? kinds[0]!.name : undefined,
        length: element === "edge" && a && b ? Math.hypot(...a.map((value, i) => value - b[i]!)) : undefined,
        range: w.length > 0 ? [Math.min(...w), Math.max(...w)] : undefined,
    };
}
