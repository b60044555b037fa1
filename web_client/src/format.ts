// Formatting of numbers and messages for display.

import type { State } from "@oval4d/protocol";

const kMinus = "\u2212";
const kMaxPlanes = 3; // the most planes that the text of a rotation lists
const kMaxPlainDecimals = 9; // with more decimals, small numbers are written with an exponent
const kMostDigits = 17; // this many significant digits identify every number in double precision

/** Formats a number with at most `decimals` decimals, without trailing zeros. */
export function formatDecimal(value: number, decimals: number): string {
    const text = Math.abs(value)
        .toFixed(decimals)
        .replace(/(\.\d*?)0+$/, "$1")
        .replace(/\.$/, "");
    return value < 0 && Number(text) !== 0 ? kMinus + text : text;
}

/** Formats an integer. From 10,000 on, thin spaces separate groups of three digits: 14 400. */
export function formatCount(value: number): string {
    return String(value).replace(/\B(?=(\d{3})+$)/g, value < 10_000 ? "" : "\u2009");
}

export function formatDegrees(radians: number): string {
    return `${formatDecimal((radians * 180) / Math.PI, 2)}°`;
}

/** Formats a length with three significant digits, or with all digits of its integer part if these are more. */
export function formatLength(value: number): string {
    return formatRounded(value, value === 0 ? 0 : Math.max(0, 2 - exponentOf(value)));
}

/**
 * Formats a coordinate with at most three decimals. Uses more decimals if neighboring slices, whose w differ by
 * `spacing`, would otherwise look the same.
 */
export function formatCoordinate(value: number, spacing: number): string {
    return formatRounded(value, Math.max(3, 1 - exponentOf(spacing)));
}

/**
 * Formats a value of a field with at most three decimals, or with three significant digits if its absolute value is
 * below 0.01.
 */
export function formatFieldValue(value: number): string {
    const size = Math.abs(value);
    return formatRounded(value, size === 0 || size >= 0.01 ? 3 : 2 - exponentOf(size));
}

/**
 * Formats a number with at most `decimals` decimals, without trailing zeros. If `decimals` is above kMaxPlainDecimals,
 * writes numbers whose absolute value is below 1e-4 with an exponent.
 */
function formatRounded(value: number, decimals: number): string {
    if (decimals <= kMaxPlainDecimals) return formatDecimal(value, decimals);
    const size = Math.abs(value);
    if (size < 0.5 * 10 ** -decimals) return "0";
    const text = withExponentIfSmall(size, decimals)
        .replace(/(\.\d*?)0+(e|$)/, "$1$2")
        .replace(/\.(e|$)/, "$1");
    return value < 0 ? kMinus + text : text;
}

/**
 * Rounds `value` to the last decimal place of `size`, written with `digits` significant digits. The size 0.5 with 3
 * digits is 0.500, which ends with the thousandths: 1234.56789 becomes 1234.568. A value below `size` is rounded to
 * `digits` significant digits. `size` is, for example, the difference between two values that must stay
 * distinguishable.
 */
export function roundedToDigitsOfSize(size: number, value: number, digits: number): number {
    const more = exponentOf(value) - exponentOf(size) || 0; // 0 if `size` is not finite
    return Number(value.toPrecision(Math.min(kMostDigits, digits + Math.max(0, more))));
}

/** The decimal exponent of a number: the largest integer n with 10 ** n ≤ |value|; 0 if the value is 0. */
function exponentOf(value: number): number {
    return Number(value.toExponential(kMostDigits - 1).split("e")[1]);
}

/**
 * Formats the positive number `size` with `decimals` decimals, where `decimals` is above kMaxPlainDecimals. Writes
 * numbers below 1e-4 with an exponent, like server/scene/slice_label.cpp.
 */
function withExponentIfSmall(size: number, decimals: number): string {
    const exponent = exponentOf(size);
    const atMost = (most: number, wanted: number): number => Math.max(0, Math.min(most, wanted));
    if (size >= 1e-4) return size.toFixed(atMost(decimals, kMostDigits - 1 - exponent));
    return size.toExponential(atMost(kMostDigits - 1, exponent + decimals));
}

/** Formats the w of the focus slice. */
export function focusW({ section, slices }: State): string {
    return formatW(section.w, slices.spacing);
}

/** Formats the w of a slice, rounded like the label of the slice in the picture (see server/scene/slice_label.cpp). */
export function formatW(w: number, spacing: number): string {
    const decimals = Math.min(300, Math.max(2, Math.ceil(-Math.log10(spacing)) + 1));
    if (decimals > kMaxPlainDecimals) {
        const size = Math.abs(w);
        if (size < 0.5 * 10 ** -decimals) return "0";
        return (w < 0 ? kMinus : "") + withExponentIfSmall(size, decimals);
    }
    const text = new Intl.NumberFormat("en-US", {
        minimumFractionDigits: decimals,
        maximumFractionDigits: decimals,
        roundingMode: "halfEven",
        useGrouping: false,
    }).format(Math.abs(w));
    if (Number(text) === 0) return "0";
    return w < 0 ? kMinus + text : text;
}

/**
 * Formats a rotation, such as "xw 22.5°, yz 81.42°". A gesture may turn in all six planes; only the three planes with
 * the largest angles are listed.
 */
export function formatRotation(last: NonNullable<State["last"]>): string {
    const turns = last.planes.map((plane, i) => ({ plane, angle: last.angles[i] ?? 0 }));
    const largest = [...turns].sort((a, b) => Math.abs(b.angle) - Math.abs(a.angle)).slice(0, kMaxPlanes);
    const listed = turns.filter((turn) => largest.includes(turn));
    const text = listed.map(({ plane, angle }) => `${plane} ${formatDegrees(angle)}`).join(", ");
    return listed.length < turns.length ? `${text}, …` : text;
}

/** Capitalizes the first letter. */
export function capitalize(text: string): string {
    return text.charAt(0).toUpperCase() + text.slice(1);
}

/** Turns a message into a sentence: with a capital letter, and a period unless it ends with other punctuation. */
export function toSentence(message: string): string {
    return /[.?!:…]$/.test(message) ? capitalize(message) : `${capitalize(message)}.`;
}

export function formatTime(date: Date): string {
    return date.toLocaleTimeString([], { hour: "2-digit", minute: "2-digit", second: "2-digit" });
}
