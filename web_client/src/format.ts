// Numbers as people read them.

import type { State } from "@oval4d/protocol";

const kMinus = "\u2212";

export function decimal(value: number, decimals: number): string {
    const text = Math.abs(value)
        .toFixed(decimals)
        .replace(/(\.\d*?)0+$/, "$1")
        .replace(/\.$/, "");
    return value < 0 && Number(text) !== 0 ? kMinus + text : text;
}

/** 14,400 with a thin space: 14 400. */
export function count(value: number): string {
    return String(value).replace(/\B(?=(\d{3})+$)/g, value < 10_000 ? "" : "\u2009");
}

export function degrees(radians: number): string {
    return `${decimal((radians * 180) / Math.PI, 2)}°`;
}

/** Three significant digits, but no fewer decimals than tell small values apart. */
export function length(value: number): string {
    const digits = value === 0 ? 0 : Math.max(0, 2 - Math.floor(Math.log10(Math.abs(value))));
    return decimal(value, Math.min(8, digits));
}

export function focusW({ slices }: State): number {
    return slices.focus * slices.spacing;
}

/** "xw 22.5°, yz 81.42°". */
export function rotation(last: NonNullable<State["last"]>): string {
    return last.planes.map((plane, i) => `${plane} ${degrees(last.angles[i] ?? 0)}`).join(", ");
}

export function time(date: Date): string {
    return date.toLocaleTimeString([], { hour: "2-digit", minute: "2-digit", second: "2-digit" });
}
