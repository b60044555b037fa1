// 4-D fields: their formulas and settings in messages, commands, addresses and texts for screen readers.

import type { Box, Quantity, Settings, State } from "@oval4d/protocol";

import { textOfFog } from "./fog";
import { focusW, formatCoordinate, formatFieldValue } from "./format";
import { referenceFrameQuery } from "./reference_frame";

/** A field given by a formula: the formula, its domain, and the formula whose values color the surfaces. */
export interface FormulaWithBox {
    formula: string;
    box: Box;
    /** The formula whose values color the surfaces, if there is one. */
    values?: string;
}

/** How a field is shown, and its frame of reference (`pace`, `follow` and `boost`; see reference_frame.ts). */
export type FieldDisplaySettings = Pick<Settings, "levels" | "inside" | "caps" | "fog" | "pace" | "follow" | "boost">;

/** The name under which the page and the command `formula` load a formula. */
export const kFormulaName = "formula";

/** The domain of a formula if none is given. */
export const kUsualBox: Box = [
    [-2, 2],
    [-2, 2],
    [-2, 2],
    [-2, 2],
];

export const kMaxLevels = 4;

// Coordinates that differ by at most this fraction of the box's width along their axis count as the same.
const kSamePlace = 1e-9;

/** Whether the object of this state is a field. */
export function isField({ levels }: State): boolean {
    return levels !== undefined;
}

/** The `load` message of a formula, without the member `type`. */
export interface FormulaLoadMessage {
    name: string;
    format: "formula";
    data: string;
    box: Box;
    values?: string;
}

export function formulaLoadOf({ formula, box, values }: FormulaWithBox): FormulaLoadMessage {
    return { name: kFormulaName, format: "formula", data: formula, box, ...(values && { values }) };
}

/** A text such as "temperature, K" from the known name and unit of a quantity; "" if both are unknown. */
export function labelOfQuantity({ name, unit }: Quantity = {}): string {
    return [name, unit].filter(Boolean).join(", ");
}

/**
 * The quantity that the colors show: that of the second function or, without one, that of the field. Empty if unknown.
 */
export function quantityOfColors({ field }: State): Quantity {
    const { values, quantity } = field ?? {};
    const isOfSecond = values?.formula !== undefined || values?.variable !== undefined;
    return (isOfSecond ? values?.quantity : quantity) ?? {};
}

/**
 * The w of the focus slice. In parentheses follows the coordinate that all points of the slice share in the box of the
 * field: "0.25 (130 s)", or "0.25 (x 0.5 m)" if the slice is perpendicular to the axis x of the box. There are no
 * parentheses if this coordinate is w itself, without a unit, or if the slice is perpendicular to no axis of the box.
 */
export function focusWithCoordinate(state: State): string {
    const { section, field } = state;
    const { axis = "w", value = section.w, unit = "" } = section.coordinate ?? {};
    const [least, most] = field?.box[["x", "y", "z", "w"].indexOf(axis)] ?? [0, 1];
    const isW = axis === "w" && unit === "" && Math.abs(value - section.w) <= kSamePlace * (most - least);
    if (isW) return focusW(state);
    const place = [axis === "w" ? "" : axis, formatCoordinate(value, (most - least) / 100), unit];
    return `${focusW(state)} (${place.filter(Boolean).join(" ")})`;
}

/** The field that a line such as "formula x^2 < 1 colored by y" shows; undefined for other commands. */
export function fieldInCommandLine(line: string): FormulaWithBox | undefined {
    const [, formula, values] = /^\s*:?\s*formula\s+(.*?\S)(?:\s+colored by\s+(.*?\S))?\s*$/s.exec(line) ?? [];
    return formula === undefined ? undefined : { formula, box: kUsualBox, ...(values && { values }) };
}

/** A text for screen readers such as "levels 0, 0.5 K, inside below, fog from −1 to 2 K"; "" if there is no field. */
export function spokenLevels({ levels, inside = "below", fog = [], field }: State): string {
    if (!levels) return "";
    const named = levels.length === 1 ? "level" : "levels";
    const ends = [fog[0], fog.at(-1)].map((point) => formatFieldValue(point?.value ?? 0));
    const unit = field?.quantity?.unit ? ` ${field.quantity.unit}` : "";
    const fogText = fog.length > 0 ? `, fog from ${ends.join(" to ")}${unit}` : "";
    return `${named} ${levels.map(formatFieldValue).join(", ")}${unit}, inside ${inside}${fogText}`;
}

/**
 * Reads numbers separated by blanks, commas or semicolons; the minus sign U+2212 counts as "-". A word that is not a
 * number gives NaN.
 */
export function parseNumbers(text: string): number[] {
    const words = text.replaceAll("\u2212", "-").split(/[\s,;]+/);
    return words.filter((word) => word !== "").map(Number);
}

/**
 * The box with the given ranges of x, y, z and w. `numbers` has the two ends for each axis. Undefined unless these are
 * eight finite numbers.
 */
export function boxOf(numbers: number[]): Box | undefined {
    if (numbers.length !== 8 || !numbers.every(Number.isFinite)) return undefined;
    return [0, 2, 4, 6].map((i) => [numbers[i]!, numbers[i + 1]!]) as Box;
}

/** The query of an address that opens this field with this look. Has no question mark. */
export function fieldQuery({ formula, box, values }: FormulaWithBox, look: FieldDisplaySettings): string {
    const { levels, inside, caps, fog } = look;
    const parameters = {
        formula,
        ...(values && { values }),
        ...(String(box) !== String(kUsualBox) && { box: String(box) }),
        ...(levels && String(levels) !== "0" && { levels: String(levels) }),
        ...(inside && inside !== "below" && { inside }),
        ...(caps && caps !== "plain" && { caps }),
        ...(fog && fog.length > 0 && { fog: textOfFog(fog) }),
        ...referenceFrameQuery(look),
    };
    // In addresses, some characters of formulas, such as "^", need no encoding. They stay as they are, so that the
    // formula is readable.
    const encoded = (text: string): string =>
        encodeURIComponent(text).replace(/%(5E|3D|2C|3B|2F|3A)/g, (code) => decodeURIComponent(code));
    return Object.entries(parameters)
        .map(([name, value]) => `${name}=${encoded(value)}`)
        .join("&");
}
