// The element under the pointer in the page's own picture: its name is shown beside the pointer, and it is highlighted
// in all slices, the projection, the matrix and the parallel coordinates. What was cut from the element itself is
// highlighted at once; what else shows it, such as the edges of a cell, when the server has answered which parts these
// are. For the server's pictures, see frame_pointing.ts.

import type { PolytopeElement, Slice, State } from "@oval4d/protocol";

import type { ElementMeasurements } from "./element_measurements";
import { followHover, type Point } from "./hover";
import { originInFile } from "./origin";
import { pointedElements } from "./picture/highlighted_elements";
import { elementOfHit } from "./picture/hit_test";
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
    private isComplete = false; // whether everything that shows the element is highlighted
    private hitTester: HitTester | undefined; // the hit tester of the picture in which the element was found
    private isTapped = false; // whether the label names what a finger has tapped

    /**
     * `complete` must be called when there is a new answer in `measurements`. `mayShowObject` returns whether the
     * picture of a revision may show the object of the state.
     */
    constructor(
        private readonly drawing: HTMLElement,
        private readonly stage: Stage,
        private readonly label: PointedLabel,
        private readonly measurements: ElementMeasurements,
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
        if (!polytope || !hasColorsOf(polytope, scene.colors.cells.length)) return undefined;
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
        this.isTapped = true;
        this.label.show(this.descriptionOf(tapped, hitTester), at);
    }

    /** Finds the element under the pointer in the current picture. Returns whether the picture must be drawn again. */
    update(): boolean {
        const { at } = this;
        const { hitTester } = this.stage;
        const found = at && hitTester && this.elementAt(at.x, at.y, hitTester);
        const { shown } = this;
        const isNew = hitTester !== this.hitTester;
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
            if (!isSame) this.highlight(found);
            this.label.show(this.descriptionOf(found, hitTester!), at!);
        }
        return !isSame;
    }

    /** Highlights everything that shows the element under the pointer, if the server has answered what this is. */
    complete(): void {
        const { at, hitTester, isComplete, shown } = this;
        if (isComplete || !at || !hitTester || !shown || !this.measurements.of(shown)) return;
        if (!this.mayShowObject(hitTester.picture.revision)) return; // the answer is about a newer object
        this.highlight(shown);
        this.label.show(this.descriptionOf(shown, hitTester), at);
        this.stage.scheduleRedraw();
    }

    private highlight(found: PointedElement): void {
        const highlight = this.measurements.of(found)?.highlight;
        this.isComplete = highlight !== undefined;
        this.stage.highlightPointed(pointedElements(found, this.state()!.polytope, highlight));
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

    /** What a picture tells about an element. The length of an edge is known when the server has named its ends. */
    private descriptionOf(found: PointedElement, { picture: { coordinates } }: HitTester): ElementDescription {
        const state = this.state()!;
        const { element, number, slice } = found;
        const { kinds = [] } = state.polytope;
        const origin = originInFile(state);
        const placeOf = (v: number): number[] => origin.map((from, axis) => from + coordinates[4 * v + axis]!);
        const hasPlaces = coordinates.length > 0;
        const ends = element === "edge" && hasPlaces ? this.measurements.of(found)?.highlight?.own_vertices : undefined;
        const [a, b] = ends?.map(placeOf) ?? [];
        return {
            element,
            number,
            sliceW: slice && origin[3] + slice.w,
            coordinates: element === "vertex" && hasPlaces && !state.field ? placeOf(number) : undefined,
            name: element === "cell" && kinds.length === 1 ? kinds[0]!.name : undefined,
            length: a && b && Math.hypot(...a.map((value, i) => value - b[i]!)),
        };
    }
}

/** Whether a picture of this polytope may have this many colors of cells or, of a surface, of 2-faces. */
function hasColorsOf({ cells, faces }: State["polytope"], count: number): boolean {
    return count === cells || (cells === 0 && (count === 1 || count === faces));
}
