// Converts keyboard events to keystrokes of the key table. The server decides what a keystroke does.

import type { KeyBinding } from "@oval4d/protocol";

/** The members of a `key` message. */
export interface Stroke {
    key: string;
    shift: boolean;
    ctrl: boolean;
}

/** The keystroke of an event; undefined for composition, for other modifiers and for keys that are not in the table. */
export function strokeOf(event: KeyboardEvent, table: readonly KeyBinding[]): Stroke | undefined {
    if (event.isComposing || event.key === "Dead" || event.key === "Process" || event.metaKey) return undefined;
    // Some layouts type brackets with AltGr (which Windows reports with Ctrl+Alt) or with the Mac's Option key.
    const composed = event.getModifierState("AltGraph") || (event.altKey && /^[[\]{}]$/.test(event.key));
    if (event.altKey && !composed) return undefined;
    const ctrl = event.ctrlKey && !composed;
    const { shiftKey: shift, key } = event;

    const digit = composed ? undefined : digitOf(event);
    if (digit !== undefined) {
        const binding = table.find((one) => one.code !== undefined && one.key === digit);
        const known = binding && !ctrl && (!shift || binding.shift === "inverse");
        return known ? { key: digit, shift, ctrl } : undefined;
    }
    const typed = /^[ -~]$/.test(key) ? key : latinOf(event);
    const known = table.some((one) => {
        if ((one.ctrl ?? false) !== ctrl) return false;
        if (one.key.length > 1) return one.key.startsWith(typed);
        return one.key === typed || (one.shift === "inverse" && one.key === typed.toLowerCase());
    });
    return known ? { key: typed, shift, ctrl } : undefined;
}

/** The keystrokes that a button for this binding sends. */
export function strokesOf(binding: KeyBinding, inverse: boolean): Stroke[] {
    const { key, ctrl = false } = binding;
    if (key.length > 1) return [...key].map((one) => ({ key: one, shift: false, ctrl }));
    return [{ key: inverse ? key.toUpperCase() : key, shift: inverse || key !== key.toLowerCase(), ctrl }];
}

/** The digit on the physical key, so that Shift applies the inverse on every layout; undefined for other keys. */
function digitOf(event: KeyboardEvent): string | undefined {
    const [, row, digit] = /^(Digit|Numpad)([0-9])$/.exec(event.code) ?? [];
    return row === "Numpad" && event.key !== digit ? undefined : digit;
}

/** The Latin letter on the physical key, for keyboards of another script; "\0" for other keys. */
function latinOf(event: KeyboardEvent): string {
    const [, letter] = /^Key([A-Z])$/.exec(event.code) ?? [];
    if (letter === undefined || event.key.length !== 1) return "\0";
    return event.shiftKey ? letter : letter.toLowerCase();
}
