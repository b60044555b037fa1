// Converts keyboard events to keystrokes of the key table. The server decides what a keystroke does.

import type { KeyBinding } from "@oval4d/protocol";

/** The members of a `key` message. */
export interface Stroke {
    key: string;
    shift: boolean;
    ctrl: boolean;
}

/** The keystroke of an event; undefined for composition, for other modifiers and for keys that are not in the table. */
export function strokeFromEvent(event: KeyboardEvent, table: readonly KeyBinding[]): Stroke | undefined {
    if (event.isComposing || event.key === "Dead" || event.key === "Process" || event.metaKey) return undefined;
    // Some layouts type brackets with AltGr (which Windows reports with Ctrl+Alt) or with the Mac's Option key.
    const composed = event.getModifierState("AltGraph") || (event.altKey && /^[[\]{}]$/.test(event.key));
    if (event.altKey && !composed) return undefined;
    const ctrl = event.ctrlKey && !composed;
    const { shiftKey: shift, key } = event;

    const digit = composed ? undefined : digitOfKey(event);
    if (digit !== undefined) {
        const binding = table.find((row) => row.code !== undefined && row.key === digit);
        const known = binding && !ctrl && (!shift || binding.shift === "inverse");
        return known ? { key: digit, shift, ctrl } : undefined;
    }
    const typed = /^[ -~]$/.test(key) ? key : latinLetterOfKey(event);
    const known = table.some((row) => {
        if ((row.ctrl ?? false) !== ctrl) return false;
        if (row.key.length > 1) return row.key.startsWith(typed);
        return row.key === typed || (row.shift === "inverse" && row.key === typed.toLowerCase());
    });
    return known ? { key: typed, shift, ctrl } : undefined;
}

/** The keystrokes that a button for this binding sends. */
export function strokesOfBinding(binding: KeyBinding, inverse: boolean): Stroke[] {
    const { key, ctrl = false } = binding;
    if (key.length > 1) return [...key].map((character) => ({ key: character, shift: false, ctrl }));
    return [{ key: inverse ? key.toUpperCase() : key, shift: inverse || key !== key.toLowerCase(), ctrl }];
}

/** The digit of the physical key, which Shift does not change on any layout; undefined for keys without a digit. */
function digitOfKey(event: KeyboardEvent): string | undefined {
    const [, row, digit] = /^(Digit|Numpad)([0-9])$/.exec(event.code) ?? [];
    return row === "Numpad" && event.key !== digit ? undefined : digit;
}

/** The Latin letter of the physical key, for keyboards of another script; "\0" for keys without a letter. */
function latinLetterOfKey(event: KeyboardEvent): string {
    const [, letter] = /^Key([A-Z])$/.exec(event.code) ?? [];
    if (letter === undefined || event.key.length !== 1) return "\0";
    return event.shiftKey ? letter : letter.toLowerCase();
}
