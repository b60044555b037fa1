// Converts keyboard events to keystrokes of the key table. The server decides what a keystroke does.
//
// The `key` of a row is a character, a sequence of two characters, or the name of a key, which is longer.

import type { KeyBinding } from "@oval4d/protocol";

const kTextFields = "textarea, select, [contenteditable], input:not([type=radio], [type=checkbox], [type=range])";
const kButtons = "button, a[href]";
const kButtonKeys = /^( |Enter)$/;
const kInputKeys = /^( |Enter|Home|End|(Arrow|Page).*)$/; // of radio buttons and sliders

/** The members of a `key` message. */
export interface KeyStroke {
    key: string;
    shift: boolean;
    ctrl: boolean;
}

/**
 * Whether the key is for the control that has the focus: every key in a text field; Enter and the space bar on a button;
 * these, the arrows, Home and End on a slider or a radio button.
 */
export function isForControl({ key, target }: KeyboardEvent): boolean {
    if (!(target instanceof Element)) return false;
    if (target.matches(kTextFields)) return true;
    return target.matches(kButtons) ? kButtonKeys.test(key) : target.matches("input") && kInputKeys.test(key);
}

/** The action of Ctrl-Z, Ctrl-Shift-Z and Ctrl-Y; on a Mac, of Cmd-Z and so on. */
export function editingAction(event: KeyboardEvent): "undo" | "redo" | undefined {
    if (event.isComposing || event.altKey || event.ctrlKey === event.metaKey) return undefined;
    const letter = typedCharacter(event).toLowerCase();
    if (letter === "z") return event.shiftKey ? "redo" : "undo";
    return letter === "y" && !event.shiftKey ? "redo" : undefined;
}

/** The keystroke of an event; undefined for composition, for other modifiers and for keys that are not in the table. */
export function strokeFromEvent(event: KeyboardEvent, table: readonly KeyBinding[]): KeyStroke | undefined {
    if (event.isComposing || event.key === "Dead" || event.key === "Process" || event.metaKey) return undefined;
    // Some layouts type brackets with AltGr (which Windows reports with Ctrl+Alt) or with the Mac's Option key.
    const composed = event.getModifierState("AltGraph") || (event.altKey && /^[[\]{}]$/.test(event.key));
    if (event.altKey && !composed) return undefined;
    const ctrl = event.ctrlKey && !composed;
    const { shiftKey: shift, key } = event;

    const digit = composed ? undefined : digitOfKey(event);
    if (digit !== undefined) {
        const binding = table.find((row) => row.code !== undefined && row.key === digit);
        // Otherwise Shift with the digit may type another character of the table, such as a parenthesis.
        if (binding && !ctrl && (!shift || binding.shift === "inverse")) return { key: digit, shift, ctrl };
    }
    if (!shift && !ctrl && table.some((row) => isNamed(row) && row.key === key)) return { key, shift, ctrl };
    const typed = typedCharacter(event);
    const known = table.some((row) => {
        if ((row.ctrl ?? false) !== ctrl || isNamed(row)) return false;
        if (row.key.length > 1) return row.key.includes(typed);
        return row.key === typed || (row.shift === "inverse" && row.key === typed.toLowerCase());
    });
    return known ? { key: typed, shift, ctrl } : undefined;
}

/** The keystrokes that a button for this binding sends. */
export function strokesOfBinding(binding: KeyBinding, inverse: boolean): KeyStroke[] {
    const { key, ctrl = false } = binding;
    if (key.length > 1) return [...key].map((character) => ({ key: character, shift: false, ctrl }));
    return [{ key: inverse ? key.toUpperCase() : key, shift: inverse || key !== key.toLowerCase(), ctrl }];
}

/** The digit of the physical key, which Shift does not change on any layout; undefined for keys without a digit. */
function digitOfKey(event: KeyboardEvent): string | undefined {
    const [, row, digit] = /^(Digit|Numpad)([0-9])$/.exec(event.code) ?? [];
    return row === "Numpad" && event.key !== digit ? undefined : digit;
}

/** Whether the row's key is the name of one key in KeyboardEvent.key, such as "ArrowLeft". */
function isNamed({ key }: KeyBinding): boolean {
    return key.length > 2;
}

/** The character that the event types, or the Latin letter of its physical key; "\0" if there is neither. */
function typedCharacter(event: KeyboardEvent): string {
    return /^[ -~]$/.test(event.key) ? event.key : latinLetterOfKey(event);
}

/** The Latin letter of the physical key, for keyboards of another script; "\0" for keys without a letter. */
function latinLetterOfKey(event: KeyboardEvent): string {
    const [, letter] = /^Key([A-Z])$/.exec(event.code) ?? [];
    if (letter === undefined || event.key.length !== 1) return "\0";
    return event.shiftKey ? letter : letter.toLowerCase();
}
