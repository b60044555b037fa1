// Formatting of numbers and messages for display.

import type { State } from "@oval4d/protocol";

const kMinus = "\u2212";
const kMaxPlanes = 3; // the most planes that the text of a rotation lists

/** A number with at most `decimals` decimals, without trailing zeros. */
export function formatDecimal(value: number, decimals: number): string {
    const text = Math.abs(value)
        .toFixed(decimals)
        .replace(/(\.\d*?)0+$/, "$1")
        .replace(/\.$/, "");
    return value < 0 && Number(text) !== 0 ? kMinus + text : text;
}

/** An integer; from 10,000 on, thin spaces separate groups of three digits: 14 400. */
export function formatCount(value: number): string {
    return String(value).replace(/\B(?=(\d{3})+$)/g, value < 10_000 ? "" : "\u2009");
}

export function formatDegrees(radians: number): string {
    return `${formatDecimal((radians * 180) / Math.PI, 2)}°`;
}

/** A length with three significant digits, more if its integer part has more, and at most eight decimals. */
export function formatLength(value: number): string {
    const digits = value === 0 ? 0 : Math.max(0, 2 - Math.floor(Math.log10(Math.abs(value))));
    return formatDecimal(value, Math.min(8, digits));
}

/** A coordinate of a vertex, with three decimals at most. */
export function formatCoordinate(value: number): string {
    return formatDecimal(value, 3);
}

/** The w of the focus slice. */
export function focusW({ section, slices }: State): string {
    return formatW(section.w, slices.spacing);
}

/** The w of a slice, rounded like its label in the picture (labelNumber() in server/scene/slice_label.cpp). */
export function formatW(w: number, spacing: number): string {
    const decimals = Math.min(9, Math.max(2, Math.ceil(-Math.log10(spacing)) + 1));
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
 * A rotation such as "xw 22.5°, yz 81.42°". The rotation of a gesture may turn in all six planes: only the planes with
 * the three largest angles are listed.
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
