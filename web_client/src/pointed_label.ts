// The label beside the pointer, which names an element of the polytope, or a level of a field with the values at a
// point.

import type { Measured, PolytopeElement, State } from "@oval4d/protocol";

import { byId } from "./element";
import type { ElementMeasurements } from "./element_measurements";
import type { FieldPoint, FieldSamples, LevelDescription } from "./field_samples";
import { capitalize, formatCoordinate, formatFieldValue, formatLength, formatW } from "./format";
import type { AreaPoint } from "./hover";
import { spokenReferenceFrame } from "./reference_frame";

/** An element, and what is known of its shape and its place. */
export interface ElementDescription extends PolytopeElement {
    /** Of a cell or 2-face: the name of its shape, if it is known without asking the server. */
    name?: string | undefined;
    /** Of a cell: the index of its kind in `polytope.kinds` of the state, if it is known without asking the server. */
    kind?: number | undefined;
    /**
     * Of a vertex: x, y, z, w, after the rotation. Without these, the label of a vertex of a field's box has its
     * coordinates in the box, which the server tells.
     */
    coordinates?: readonly number[] | undefined;
    /** Of an edge: the distance between its ends in 4-D space, in the units of the object, if it is known. */
    length?: number | undefined;
    /** The w of the slice in which the pointer is on the element; undefined if the pointer is on no slice. */
    sliceW?: number | undefined;
}

const kAxes = ["x", "y", "z", "w"] as const;
const kGap = 14; // pixels between the pointer and the label
const kMargin = 4; // pixels between the label and the edges of the drawing

/** What the label describes. */
export type PointedDescription = ElementDescription | LevelDescription;

export class PointedLabel {
    private readonly label = byId("pointed");
    private shown: PointedDescription | undefined;
    private pointer: AreaPoint = { x: 0, y: 0 };

    /** `update` must be called when there is a new answer in `measurements` or `samples`. */
    constructor(
        private readonly drawing: HTMLElement,
        private readonly state: () => State | undefined,
        private readonly measurements: ElementMeasurements,
        private readonly samples: FieldSamples,
    ) {}

    /**
     * Shows the label of an element, or of a point of a field, beside the pointer. The label is complete when the server
     * has answered.
     */
    show(described: PointedDescription, pointer: AreaPoint): void {
        this.shown = described;
        this.pointer = pointer;
        this.label.hidden = false;
        this.update();
        this.measurements.want(isLevel(described) ? undefined : described);
        this.samples.want(isLevel(described) ? described : undefined);
    }

    hide(): void {
        this.shown = undefined;
        this.label.hidden = true;
        this.measurements.want(undefined);
        this.samples.want(undefined);
    }

    /** Writes what is known of what is shown. */
    update(): void {
        const { shown } = this;
        if (!shown) return;
        this.label.textContent = isLevel(shown)
            ? describeLevel(shown, this.samples.of(shown), this.state())
            : describe(shown, this.measurements.of(shown) ?? {}, this.state());
        this.place(this.pointer);
    }

    /** Places the label beside the pointer, within the drawing. */
    place({ x, y }: AreaPoint): void {
        this.pointer = { x, y };
        const { offsetWidth: width, offsetHeight: height } = this.label;
        const { clientWidth, clientHeight } = this.drawing;
        const left = Math.max(kMargin, Math.min(x + kGap, clientWidth - width - kMargin));
        const isBelow = y + kGap + height + kMargin <= clientHeight;
        const top = isBelow ? y + kGap : Math.max(kMargin, y - kGap - height);
        this.label.style.transform = `translate(${Math.round(left)}px, ${Math.round(top)}px)`;
    }
}

/** The coordinates of a point in the box of a field, each with its unit if it is known: "0.5 m, 0, −2 s". */
function formatPlaceInBox(place: readonly number[], state: State | undefined): string {
    const { units, box } = state?.field ?? {};
    const format = (coordinate: number, axis: number): string => {
        const [least, most] = box?.[axis] ?? [0, 1];
        const unit = units?.[kAxes[axis]!];
        // As if slices were a tenth of the box apart.
        return formatCoordinate(coordinate, (most - least) / 10) + (unit === undefined ? "" : ` ${unit}`);
    };
    return place.map(format).join(", ");
}

function isLevel(described: PointedDescription): described is LevelDescription {
    return "level" in described;
}

function describeLevel(
    { level, cap, sliceW }: LevelDescription,
    { place, value, second_value: second }: FieldPoint,
    state: State | undefined,
): string {
    const { levels = [], field, slices } = state ?? {};
    const { quantity = {}, values } = field ?? {};
    const withUnit = (number: number, unit = ""): string => `${formatFieldValue(number)}${unit && ` ${unit}`}`;
    const parts = [cap ? "Inside level" : "Level"];
    if (levels[level] !== undefined) parts[0] += ` ${withUnit(levels[level], quantity.unit)}`;
    if (place) parts[0] += ` (${formatPlaceInBox(place, state)})`;
    if (cap && value !== undefined) parts.push(`${quantity.name || "value"} ${withUnit(value, quantity.unit)}`);
    if (second !== undefined) {
        const name = values?.quantity?.name || values?.variable || "second value";
        parts.push(`${name} ${withUnit(second, values?.quantity?.unit)}`);
    }
    if (sliceW !== undefined) parts.push(`slice w ${formatW(sliceW, slices?.spacing ?? 1)}`); // as below the slice
    return parts.join(" · ");
}

/** The sizes that the server measures are those of the object at rest, so they are omitted for a moving observer. */
function describe(described: ElementDescription, measured: Partial<Measured>, state: State | undefined): string {
    const { element, number, coordinates, sliceW } = described;
    const spacing = state?.slices.spacing ?? 1; // to which coordinates are rounded
    const format = (coordinate: number): string => formatCoordinate(coordinate, spacing);
    const parts = [`${capitalize(element)} ${number}`];
    const placeInBox = element === "vertex" && state?.field ? measured.center : undefined;
    if (coordinates) parts[0] += ` (${coordinates.map(format).join(", ")})`;
    else if (placeInBox) parts[0] += ` (${formatPlaceInBox(placeInBox, state)})`;
    const kinds = state?.polytope.kinds ?? [];
    const kind = described.kind ?? measured.kind;
    const shape = described.name ?? measured.name ?? kinds[kind ?? -1]?.name;
    const kindText = kind !== undefined && kinds.length > 1 ? `, kind ${kind + 1} of ${kinds.length}` : "";
    if (shape !== undefined) parts.push(shape + kindText);
    const { length, area, volume }: Partial<Measured> = state && spokenReferenceFrame(state) === "" ? measured : {};
    const sizes = { length: described.length ?? length, area, volume };
    const unit = measured.unit === undefined ? "" : ` ${measured.unit}`; // of a field's box, whose sizes are all measured
    for (const [name, size] of Object.entries(sizes)) {
        if (size !== undefined) parts.push(`${name} ${formatLength(size)}${unit}`);
    }
    if (measured.range && !coordinates && !placeInBox) {
        const [least, most] = measured.range.map(format);
        parts.push(least === most ? `w ${least}` : `w ${least} … ${most}`);
    }
    if (sliceW !== undefined) parts.push(`slice w ${formatW(sliceW, spacing)}`); // as below the slice
    return parts.join(" · ");
}
