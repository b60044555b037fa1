// Formatting of numbers and messages for display.

import type { State } from "@oval4d/protocol";

const kMinus = "\u2212";

/** A number with at most `decimals` decimals, without trailing zeros. */
export function decimal(value: number, decimals: number): string {
    const text = Math.abs(value)
        .toFixed(decimals)
        .replace(/(\.\d*?)0+$/, "$1")
        .replace(/\.$/, "");
    return value < 0 && Number(text) !== 0 ? kMinus + text : text;
}

/** An integer; from 10,000 on, digits are grouped by thin spaces: 14 400. */
export function count(value: number): string {
    return String(value).replace(/\B(?=(\d{3})+$)/g, value < 10_000 ? "" : "\u2009");
}

export function degrees(radians: number): string {
    return `${decimal((radians * 180) / Math.PI, 2)}°`;
}

/** A length with three significant digits, or the whole integer part if that is longer, and at most eight decimals. */
export function length(value: number): string {
    const digits = value === 0 ? 0 : Math.max(0, 2 - Math.floor(Math.log10(Math.abs(value))));
    return decimal(value, Math.min(8, digits));
}

/** The w of the focus slice. */
export function focusW({ slices }: State): number {
    return slices.focus * slices.spacing;
}

/** A rotation such as "xw 22.5°, yz 81.42°". */
export function rotation(last: NonNullable<State["last"]>): string {
    return last.planes.map((plane, i) => `${plane} ${degrees(last.angles[i] ?? 0)}`).join(", ");
}

/** Capitalizes the first letter. */
export function capitalized(text: string): string {
    return text.charAt(0).toUpperCase() + text.slice(1);
}

/** Turns a message into a sentence: with a capital letter, and a period unless it ends with other punctuation. */
export function sentence(message: string): string {
    return /[.?!:…]$/.test(message) ? capitalized(message) : `${capitalized(message)}.`;
}

export function time(date: Date): string {
    return date.toLocaleTimeString([], { hour: "2-digit", minute: "2-digit", second: "2-digit" });
}
