// Keyboard events → strokes that the key table knows. What a stroke does, the server decides.

import type { KeyBinding } from "@oval4d/protocol";

/** A `key` message's content. */
export interface Stroke {
    key: string;
    shift: boolean;
    ctrl: boolean;
}

/** The stroke that an event stands for, or nothing where it is not ours: composition, other modifiers, unknown keys. */
export function strokeOf(event: KeyboardEvent, table: readonly KeyBinding[]): Stroke | undefined {
    if (event.isComposing || event.key === "Dead" || event.key === "Process" || event.metaKey) return undefined;
    // Some layouts type brackets with AltGr (Windows reports Ctrl+Alt with it) or with the Mac's Option key.
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
    const ours = table.some((one) => {
        if ((one.ctrl ?? false) !== ctrl) return false;
        if (one.key.length > 1) return one.key.startsWith(typed);
        return one.key === typed || (one.shift === "inverse" && one.key === typed.toLowerCase());
    });
    return ours ? { key: typed, shift, ctrl } : undefined;
}

/** The strokes that a button for this binding stands for. */
export function strokesOf(binding: KeyBinding, inverse: boolean): Stroke[] {
    const { key, ctrl = false } = binding;
    if (key.length > 1) return [...key].map((one) => ({ key: one, shift: false, ctrl }));
    return [{ key: inverse ? key.toUpperCase() : key, shift: inverse || key !== key.toLowerCase(), ctrl }];
}

/** A digit is recognised by the physical key, so that Shift gives its inverse on every layout. */
function digitOf(event: KeyboardEvent): string | undefined {
    const [, row, digit] = /^(Digit|Numpad)([0-9])$/.exec(event.code) ?? [];
    return row === "Numpad" && event.key !== digit ? undefined : digit;
}

/** On a keyboard of another script, the Latin letter of the physical key. */
function latinOf(event: KeyboardEvent): string {
    const [, letter] = /^Key([A-Z])$/.exec(event.code) ?? [];
    if (letter === undefined || event.key.length !== 1) return "\0";
    return event.shiftKey ? letter : letter.toLowerCase();
}
