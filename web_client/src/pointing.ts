// Names and highlights what is under the pointer, in pictures that the page draws; frame_pointing.ts does so for the
// server's pictures. The name of an element appears beside the pointer. The element is highlighted in all slices, the
// projection, the matrix and the parallel coordinates. The sections of the element itself are highlighted at once.
// Other parts that show it, such as the edges of a cell, follow when the server has named them. For a surface of a
// field, the label shows the level and the values at the point.

import type { PolytopeElement, Slice, State } from "@oval4d/protocol";

import type { ElementMeasurementFetcher } from "./element_measurements";
import type { LevelPointDescription } from "./field_samples";
import { followHover, type AreaPoint } from "./hover";
import { originInFile } from "./origin";
import { pointedElements } from "./picture/highlighted_elements";
import { elementOfHit, type LevelHit } from "./picture/hit_test";
import type { HitTester } from "./picture/hit_tester";
import type { Stage } from "./picture/stage";
import type { ElementDescription, PointerLabel } from "./pointed_label";

/** An element of the polytope, and the slice in which the pointer is on it. */
export interface PointedElement extends PolytopeElement {
    slice?: Slice;
}

/** What a picture shows at a point: an element, or a point of a surface or a contour of a field. */
export type PointedTarget = PointedElement | LevelHit;

export function isElement(target: PointedTarget): target is PointedElement {
    return "element" in target;
}

// A picture rests after this many milliseconds without a new picture. Only then does the page ask the server for values
// at a point, because a key that is pressed meanwhile waits for the answer.
const kRest = 200;

export class PointerHighlighter {
    private at: AreaPoint | undefined;
    private scheduled = false;
    private shown: PointedElement | undefined; // the element that is highlighted
    private isComplete = false; // whether all parts that show the element are highlighted
    private namesLevel = false; // whether the label describes a level of a field
    private restsAt = 0; // the time from which on the picture rests, in milliseconds as in performance.now()
    private resting: ReturnType<typeof setTimeout> | undefined;
    private hitTester: HitTester | undefined; // the hit tester of the picture in which the element was found
    private isTapped = false; // whether the label describes what a finger has tapped

    /**
     * completeHighlight() must be called after each new answer in `measurements`. `mayShowObject(revision)` tells
     * whether the picture with this revision may show the object of the present state.
     */
    constructor(
        private readonly drawing: HTMLElement,
        private readonly stage: Stage,
        private readonly label: PointerLabel,
        private readonly measurements: ElementMeasurementFetcher,
        private readonly state: () => State | undefined,
        private readonly mayShowObject: (revision: number) => boolean,
    ) {
        followHover(drawing, (at) => this.recordPointer(at));
    }

    /** What the picture shows at a point of the drawing, in CSS pixels; undefined if it shows nothing there. */
    targetAt(x: number, y: number, hitTester: HitTester): PointedTarget | undefined {
        const { size, orbit } = this.stage;
        const polytope = this.state()?.polytope;
        const { coordinates, revision, scene } = hitTester.picture;
        if (!this.mayShowObject(revision)) return undefined;
        // A requested picture may be newer than the state, and show another object. Then the numbers of elements
        // usually differ.
        if (!polytope || !mayHaveColorCount(polytope, scene.colors.cells.length)) return undefined;
        if (coordinates.length > 0 && coordinates.length !== 4 * polytope.vertices) return undefined;
        const ratio = size.height / this.drawing.clientHeight;
        const vertex = hitTester.vertexInCoordinatesAt(x * ratio, y * ratio, size);
        if (vertex !== undefined) return { element: "vertex", number: vertex };
        const hit = hitTester.hitAt(x * ratio, y * ratio, orbit, size, ratio);
        if (!hit || "level" in hit) return hit;
        return { ...elementOfHit(hit, polytope), ...(hit.slice && { slice: hit.slice }) };
    }

    /**
     * Shows the name of the element or surface that a finger has tapped. The name stays until the next touch, although
     * the tap moves the focus slice and thereby changes the picture.
     */
    showTappedName(tapped: PointedTarget, hitTester: HitTester, at: AreaPoint): void {
        this.isTapped = true;
        const described = isElement(tapped)
            ? this.descriptionOf(tapped, hitTester)
            : descriptionOfLevel(tapped, hitTester, this.state()!, true);
        this.label.show(described, at);
    }

    /** Finds what is under the pointer in the current picture. Returns whether the picture must be drawn again. */
    update(): boolean {
        const { at } = this;
        const { hitTester } = this.stage;
        const target = at && hitTester && this.targetAt(at.x, at.y, hitTester);
        const isNew = hitTester !== this.hitTester;
        if (isNew) this.restsAt = performance.now() + kRest;
        this.hitTester = hitTester;
        const found = target && isElement(target) ? target : undefined;
        const isRedrawn = this.updateElement(found, isNew);
        const level = target && !isElement(target) ? target : undefined;
        if (level) this.showLevelName(level, at!);
        else if (this.namesLevel && !found) this.label.hide();
        this.namesLevel = level !== undefined;
        return isRedrawn;
    }

    /**
     * Names and highlights the element `found` under the pointer; hides name and highlight if it is undefined. `isNew`
     * tells that there is a new picture. Returns whether the picture must be drawn again.
     */
    private updateElement(found: PointedElement | undefined, isNew: boolean): boolean {
        const { at, hitTester, shown } = this;
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

    /** Highlights all parts that show the element under the pointer, if the server has named them. */
    completeHighlight(): void {
        const { at, hitTester, isComplete, shown } = this;
        if (isComplete || !at || !hitTester || !shown || !this.measurements.measurementsOf(shown)) return;
        if (!this.mayShowObject(hitTester.picture.revision)) return; // the answer may be about a newer object
        this.highlight(shown);
        this.label.show(this.descriptionOf(shown, hitTester), at);
        this.stage.scheduleRedraw();
    }

    private highlight(found: PointedElement): void {
        const highlight = this.measurements.measurementsOf(found)?.highlight;
        this.isComplete = highlight !== undefined;
        this.stage.highlightPointed(pointedElements(found, this.state()!.polytope, highlight));
    }

    /** Names the level under the pointer. When the picture rests, the label also asks for the values at the point. */
    private showLevelName(level: LevelHit, at: AreaPoint): void {
        clearTimeout(this.resting);
        const remaining = this.restsAt - performance.now();
        this.label.show(descriptionOfLevel(level, this.hitTester!, this.state()!, remaining <= 0), at);
        if (remaining > 0) this.resting = setTimeout(() => this.scheduleUpdate(), remaining);
    }

    /** Records the position of the pointer, and updates what is under it. */
    private recordPointer(at: AreaPoint | undefined): void {
        if (this.isTapped) this.label.hide();
        this.isTapped = false;
        if (!at && !this.at) return;
        this.at = at;
        this.scheduleUpdate();
    }

    /** Calls update() at most once per animation frame. */
    private scheduleUpdate(): void {
        if (this.scheduled) return;
        this.scheduled = true;
        requestAnimationFrame(() => {
            this.scheduled = false;
            if (this.update()) this.stage.drawNow();
        });
    }

    /**
     * Describes an element by what the picture shows of it. The length of an edge is known after the server has named
     * its ends.
     */
    private descriptionOf(found: PointedElement, { picture: { coordinates } }: HitTester): ElementDescription {
        const state = this.state()!;
        const { element, number, slice } = found;
        const { kinds = [] } = state.polytope;
        const origin = originInFile(state);
        const placeOf = (v: number): number[] => origin.map((from, axis) => from + coordinates[4 * v + axis]!);
        const hasPlaces = coordinates.length > 0;
        const ends = element === "edge" && hasPlaces ? this.measurements.measurementsOf(found)?.highlight?.own_vertices : undefined;
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

/** Describes a point on a level. `mayAsk` tells whether the label may ask the server for the values at the point. */
function descriptionOfLevel(
    { level, cap, point, slice }: LevelHit,
    { picture: { revision } }: HitTester,
    state: State,
    mayAsk: boolean,
): LevelPointDescription {
    const origin = originInFile(state);
    const inFile = point.map((value, axis) => value + origin[axis]!) as LevelHit["point"];
    return { level, cap, sliceW: slice && origin[3] + slice.w, revision, ...(mayAsk && { point: inFile }) };
}

/**
 * Whether a picture of this polytope can have `count` colors. A polytope has a color for each cell; a surface has one
 * color, or one for each 2-face.
 */
function mayHaveColorCount({ cells, faces }: State["polytope"], count: number): boolean {
    return count === cells || (cells === 0 && (count === 1 || count === faces));
}
