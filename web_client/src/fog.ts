// The transfer function of fog: it maps each value of a field to the opacity and the color of the fog.

import type { FogControlPoint, Inside, Scheme, Slices } from "@oval4d/protocol";

import table from "../../protocol/colors.json";
import { roundedToDigitsOfSize } from "./format";

export const kMinFogControlPoints = 2;
export const kMaxFogControlPoints = 8;
// The significant digits to which the values and opacities of control points are rounded. The digits of a value count
// from the first digit of a difference between values (see roundedToDigitsOfSize()).
const kDigits = 4;

/** How often the values of a field occur. */
export interface ValueDistribution {
    range: [number, number];
    /**
     * A tone for each of several equally spaced values from range[0] to range[1]. A tone is the cube root of how often
     * the value occurs, divided by the largest such cube root.
     */
    tones: number[];
}

/**
 * The distribution of the field's values, from the histogram of a picture; undefined if the picture has no histogram.
 */
export function valueDistributionOf({ histogram, density, scene }: Slices): ValueDistribution | undefined {
    if (!histogram) return undefined;
    const { columns } = scene.coordinates;
    const rows = density.length / columns;
    // `density` is an image whose rows belong to values of the field, row 0 to the greatest. Its columns belong to
    // parts of the field. A tone is proportional to the cube root of how often the value occurs in the part.
    const counts = Array.from({ length: rows }, (_, row) => {
        let sum = 0; // a loop, for speed: this runs for each picture
        for (const tone of density.subarray((rows - 1 - row) * columns, (rows - row) * columns)) sum += tone ** 3;
        return sum;
    });
    const most = Math.max(...counts, 1);
    return { range: histogram.range, tones: counts.map((count) => Math.cbrt(count / most)) };
}

// Tones that differ by less than this look the same. Rounding errors of a turning object stay below this difference.
const kVisible = 0.02;

/** Whether two distributions look the same. */
export function distributionsLookAlike(one: ValueDistribution, other: ValueDistribution): boolean {
    if (String(one.range) !== String(other.range)) return false;
    return one.tones.every((tone, i) => Math.abs(tone - (other.tones[i] ?? NaN)) < kVisible);
}

/**
 * Default fog for a body inside a level: dense at the value farthest inside, thinner at the level, transparent outside.
 * `least` and `greatest` are the ends of the field's range.
 */
export function defaultFog([least, greatest]: [number, number], level: number, inside: Inside): FogControlPoint[] {
    const [deep, far] = inside === "below" ? [least, greatest] : [greatest, least];
    const edge = level > least && level < greatest ? level : (least + greatest) / 2;
    const points = [
        { value: deep, opacity: 0.95 },
        { value: edge, opacity: 0.5 },
        { value: edge + (far - edge) / 4, opacity: 0 },
    ];
    // The smaller one of the two differences between the values of neighboring points.
    const size = Math.min(Math.abs(edge - deep), Math.abs(far - edge) / 4);
    const rounded = points.map(({ value, opacity }) => ({ value: roundedToDigitsOfSize(size, value, kDigits), opacity }));
    return inside === "below" ? rounded : rounded.reverse();
}

/**
 * Writes a transfer function as a text for the command line and addresses, such as "0:0.5,1:0"; "off" without points.
 */
export function textOfFog(points: FogControlPoint[]): string {
    const textOf = ({ value, opacity, color }: FogControlPoint): string =>
        [value, opacity, ...(color === undefined ? [] : [hexDigitsOf(color)])].join(":");
    return points.length === 0 ? "off" : points.map(textOf).join(",");
}

/** A color as six hexadecimal digits. */
export function hexDigitsOf(color: number): string {
    return color.toString(16).padStart(6, "0");
}

/**
 * The color of control point i in a picture of this scheme: the point's own color. Without one, the color of the
 * point's value on a color scale from the first point to the last.
 */
export function colorOf(points: FogControlPoint[], i: number, scheme: Scheme): number {
    const { value, color } = points[i]!;
    if (color !== undefined) return color;
    const [first, last] = [points[0]!.value, points.at(-1)!.value];
    const place = (2 * (value - first)) / (last - first);
    const [least, middle, most] = table.schemes[scheme].scale.map((one) => parseInt(one.slice(1), 16)) as FogColors;
    const [from, to] = place < 1 ? [least, middle] : [middle, most];
    const part = place < 1 ? place : place - 1;
    return [16, 8, 0].reduce((sum, shift) => {
        const [a, b] = [(from >> shift) & 255, (to >> shift) & 255];
        return sum | (Math.round(a + part * (b - a)) << shift);
    }, 0);
}

/** The colors of the fog's color scale at its lower end, in its middle and at its upper end. */
type FogColors = [least: number, middle: number, most: number];

/** Whether the server accepts these points: increasing finite values, and opacities from 0 to 1. */
export function isValidTransferFunction(points: FogControlPoint[]): boolean {
    return points.every(
        ({ value, opacity }, i) =>
            Number.isFinite(value) && opacity >= 0 && opacity <= 1 && (i === 0 || value > points[i - 1]!.value),
    );
}

/**
 * The control points after point i has moved to `value` and `opacity`. The move stops shortly before the neighbors of
 * point i, and at `ends`, the least and the greatest allowed value.
 */
export function withMovedPoint(points: FogControlPoint[], i: number, value: number, opacity: number, ends: [number, number]): FogControlPoint[] {
    const gap = (ends[1] - ends[0]) / 1000;
    const least = i > 0 ? points[i - 1]!.value + gap : ends[0];
    const most = i < points.length - 1 ? points[i + 1]!.value - gap : ends[1];
    const within = (number: number, from: number, to: number): number => Math.max(from, Math.min(to, number));
    const moved = {
        ...points[i]!,
        value: roundedToDigitsOfSize(ends[1] - ends[0], within(value, least, most), kDigits),
        opacity: roundedToDigitsOfSize(1, within(opacity, 0, 1), kDigits),
    };
    const result = points.map((point, k) => (k === i ? moved : point));
    return isValidTransferFunction(result) ? result : points;
}

/** Adds a point in the middle of the two neighbors with the largest difference of values. */
export function withNewPoint(points: FogControlPoint[]): FogControlPoint[] {
    const lengths = points.slice(1).map(({ value }, i) => value - points[i]!.value);
    const at = lengths.indexOf(Math.max(...lengths));
    const [from, to] = [points[at]!, points[at + 1]!];
    const middle = {
        value: roundedToDigitsOfSize(to.value - from.value, (from.value + to.value) / 2, kDigits),
        opacity: roundedToDigitsOfSize(1, (from.opacity + to.opacity) / 2, kDigits),
    };
    return [...points.slice(0, at + 1), middle, ...points.slice(at + 1)];
}
