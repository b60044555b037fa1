// The label beside the pointer. It names an element of the polytope, or a level of a field with the values at a point.

import type { Measured, PolytopeElement, State } from "@oval4d/protocol";

import { byId } from "./element";
import type { ElementMeasurementFetcher } from "./element_measurements";
import type { FieldSample, FieldSampleFetcher, LevelPointDescription } from "./field_samples";
import { capitalize, formatCoordinate, formatFieldValue, formatLength, formatW } from "./format";
import type { AreaPoint } from "./hover";
import { spokenReferenceFrame } from "./reference_frame";

/** An element of the polytope, with what is known of its shape and place. Unknown members are absent. */
export interface ElementDescription extends PolytopeElement {
    /** For a cell or a 2-face: the name of its shape, if the page knows it without asking the server. */
    name?: string | undefined;
    /**
     * For a cell: the index of its kind in `polytope.kinds` of the state, if the page knows it without asking the
     * server.
     */
    kind?: number | undefined;
    /**
     * For a vertex: its coordinates x, y, z, w after the rotation. Without them, the label of a vertex of a field's box
     * shows the coordinates in the box, which the server sends.
     */
    coordinates?: readonly number[] | undefined;
    /** For an edge: the distance between its ends in 4-D space, in units of the object, if it is known. */
    length?: number | undefined;
    /** The w of the slice in which the pointer is on the element; undefined if the pointer is not on a slice. */
    sliceW?: number | undefined;
}

const kAxes = ["x", "y", "z", "w"] as const;
const kGap = 14; // pixels between the pointer and the label
const kMargin = 4; // the least distance, in pixels, of the label from the edges of the drawing

/** What the label describes. */
export type PointedDescription = ElementDescription | LevelPointDescription;

export class PointerLabel {
    private readonly label = byId("pointed");
    private shown: PointedDescription | undefined;
    private pointer: AreaPoint = { x: 0, y: 0 };

    /** `update` must be called after each new answer in `measurements` or `samples`. */
    constructor(
        private readonly drawing: HTMLElement,
        private readonly state: () => State | undefined,
        private readonly measurements: ElementMeasurementFetcher,
        private readonly samples: FieldSampleFetcher,
    ) {}

    /**
     * Shows the label of an element, or of a point of a field, beside the pointer. Completes the label when the server
     * has answered.
     */
    show(described: PointedDescription, pointer: AreaPoint): void {
        this.shown = described;
        this.pointer = pointer;
        this.label.hidden = false;
        this.update();
        this.measurements.askAbout(isLevelDescription(described) ? undefined : described);
        this.samples.askAbout(isLevelDescription(described) ? described : undefined);
    }

    hide(): void {
        this.shown = undefined;
        this.label.hidden = true;
        this.measurements.askAbout(undefined);
        this.samples.askAbout(undefined);
    }

    /** Writes the label again, with everything that is known now. */
    update(): void {
        const { shown } = this;
        if (!shown) return;
        this.label.textContent = isLevelDescription(shown)
            ? describeLevel(shown, this.samples.knownAt(shown), this.state())
            : describeElement(shown, this.measurements.measurementsOf(shown) ?? {}, this.state());
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

/** The coordinates of a point in the box of a field, each with its unit if it has one: "0.5 m, 0, −2 s". */
function formatPlaceInBox(place: readonly number[], state: State | undefined): string {
    const { units, box } = state?.field ?? {};
    const format = (coordinate: number, axis: number): string => {
        const [least, most] = box?.[axis] ?? [0, 1];
        const unit = units?.[kAxes[axis]!];
        // Rounds as if neighboring slices were a tenth of the box's width apart.
        return formatCoordinate(coordinate, (most - least) / 10) + (unit === undefined ? "" : ` ${unit}`);
    };
    return place.map(format).join(", ");
}

function isLevelDescription(described: PointedDescription): described is LevelPointDescription {
    return "level" in described;
}

function describeLevel(
    { level, cap, sliceW }: LevelPointDescription,
    { place, value, second_value: second }: FieldSample,
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
    // Rounded like the label of the slice.
    if (sliceW !== undefined) parts.push(`slice w ${formatW(sliceW, slices?.spacing ?? 1)}`);
    return parts.join(" · ");
}

/** Describes an element. Omits its sizes for a moving observer, because the server measures the object at rest. */
function describeElement(described: ElementDescription, measured: Partial<Measured>, state: State | undefined): string {
    const { element, number, coordinates, sliceW } = described;
    const spacing = state?.slices.spacing ?? 1; // determines how coordinates are rounded
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
    const unit = measured.unit === undefined ? "" : ` ${measured.unit}`; // known only for a field whose box has units
    for (const [name, size] of Object.entries(sizes)) {
        if (size !== undefined) parts.push(`${name} ${formatLength(size)}${unit}`);
    }
    if (measured.range && !coordinates && !placeInBox) {
        const [least, most] = measured.range.map(format);
        parts.push(least === most ? `w ${least}` : `w ${least} … ${most}`);
    }
    if (sliceW !== undefined) parts.push(`slice w ${formatW(sliceW, spacing)}`); // rounded like the label of the slice
    return parts.join(" · ");
}
