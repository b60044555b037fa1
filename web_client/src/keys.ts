// Converts keyboard events to keystrokes of the key table. The server decides what a keystroke does.
//
// In a row of the key table, `key` is one character, a sequence of two characters, or the name of a key. Names of keys
// have more than two characters.

import type { KeyBinding } from "@oval4d/protocol";

const kTextFields = "textarea, select, [contenteditable], input:not([type=radio], [type=checkbox], [type=range])";
const kButtons = "button, a[href]";
const kButtonKeys = /^( |Enter)$/;
const kInputKeys = /^( |Enter|Home|End|(Arrow|Page).*)$/; // sliders, radio buttons and checkboxes use these keys
const kNumber = /^[\d.]/; // how every entry of a list of numbers begins; such a list uses the keys of these characters

/** The members of a `key` message. */
export interface KeyStroke {
    key: string;
    shift: boolean;
    ctrl: boolean;
}

/**
 * Whether the control that has the focus uses the key:
 * - A text field or a list of names uses every key.
 * - A button uses Enter and the space bar.
 * - A slider, a radio button, a checkbox or a list of numbers uses Enter, the space bar, the arrow keys, Home, End,
 *   Page Up and Page Down.
 * - A list of numbers also uses digits and the decimal point.
 */
export function isUsedByFocusedControl({ key, target }: KeyboardEvent): boolean {
    if (!(target instanceof Element)) return false;
    if (target instanceof HTMLSelectElement && isListOfNumbers(target)) {
        return kInputKeys.test(key) || kNumber.test(key);
    }
    if (target.matches(kTextFields)) return true;
    return target.matches(kButtons) ? kButtonKeys.test(key) : target.matches("input") && kInputKeys.test(key);
}

function isListOfNumbers({ options }: HTMLSelectElement): boolean {
    return options.length > 0 && [...options].every(({ text }) => kNumber.test(text));
}

/** The action of Ctrl-Z (undo), Ctrl-Shift-Z or Ctrl-Y (redo); on a Mac, with Cmd. Undefined for other keys. */
export function undoOrRedoOf(event: KeyboardEvent): "undo" | "redo" | undefined {
    if (event.isComposing || event.altKey || event.ctrlKey === event.metaKey) return undefined;
    const letter = typedCharacter(event).toLowerCase();
    if (letter === "z") return event.shiftKey ? "redo" : "undo";
    return letter === "y" && !event.shiftKey ? "redo" : undefined;
}

/**
 * Converts a keyboard event to a keystroke of the key table. Undefined for keys that are not in the table, while an
 * input method composes a text, and while a modifier other than Shift and Ctrl is held. The first rule that applies
 * gives the keystroke's key:
 * - A key that types a character of the table counts as this character. On a French keyboard, digit keys type "(" and
 *   "-".
 * - A key of a non-Latin script counts as the character in the same place on an American keyboard.
 * - A digit key counts as its digit, whatever character it types.
 */
export function strokeFromEvent(event: KeyboardEvent, table: readonly KeyBinding[]): KeyStroke | undefined {
    if (event.isComposing || event.key === "Dead" || event.key === "Process" || event.metaKey) return undefined;
    // Some layouts type brackets with AltGr, which Windows reports as Ctrl+Alt, or with the Mac's Option key.
    const composed = event.getModifierState("AltGraph") || (event.altKey && /^[[\]{}]$/.test(event.key));
    if (event.altKey && !composed) return undefined;
    const ctrl = event.ctrlKey && !composed;
    const { shiftKey: shift, key } = event;

    if (!shift && !ctrl && table.some((row) => isKeyGivenByName(row) && row.key === key)) return { key, shift, ctrl };
    const digit = composed ? undefined : digitOfKey(event);
    const typed = typedCharacter(event);
    const isKnown = table.some((row) => {
        if ((row.ctrl ?? false) !== ctrl || isKeyGivenByName(row)) return false;
        if (row.key.length > 1) return row.key.includes(typed);
        return row.key === typed || (row.shift === "inverse" && row.key === typed.toLowerCase());
    });
    if (isKnown && typed !== digit) return { key: typed, shift, ctrl };
    const binding = table.find((row) => row.code !== undefined && row.key === digit);
    if (!binding || ctrl) return undefined;
    if (binding.shift === "inverse") return { key: binding.key, shift, ctrl };
    // On some keyboards, Shift is needed to type digits. For a typed digit, Shift therefore does not count as held.
    return !shift || typed === digit ? { key: binding.key, shift: false, ctrl } : undefined;
}

/** The keystrokes that a button for this binding sends; `inverse` adds Shift, which inverts a rotation. */
export function strokesOfBinding(binding: KeyBinding, inverse: boolean): KeyStroke[] {
    const { key, ctrl = false } = binding;
    if (key.length > 1) return [...key].map((character) => ({ key: character, shift: false, ctrl }));
    return [{ key: inverse ? key.toUpperCase() : key, shift: inverse || key !== key.toLowerCase(), ctrl }];
}

/** The digit on the physical key, independent of the layout and of Shift; undefined for keys without a digit. */
function digitOfKey(event: KeyboardEvent): string | undefined {
    const [, row, digit] = /^(Digit|Numpad)([0-9])$/.exec(event.code) ?? [];
    return row === "Numpad" && event.key !== digit ? undefined : digit;
}

/**
 * Whether a binding names its key by a name such as "ArrowLeft", as in KeyboardEvent.key. Other bindings consist of one
 * or two characters.
 */
function isKeyGivenByName({ key }: KeyBinding): boolean {
    return key.length > 2;
}

/**
 * The character that the event types. If it is not ASCII, the character of the same key on an American keyboard; "\0"
 * if there is none. Letters are capitals only if Shift is held: Caps Lock has no effect.
 */
function typedCharacter(event: KeyboardEvent): string {
    const character = /^[ -~]$/.test(event.key) ? event.key : characterOnUsKeyboard(event);
    return event.shiftKey ? character.toUpperCase() : character.toLowerCase();
}

/**
 * The two characters that a punctuation key types on an American keyboard, without Shift and with Shift. The property
 * is the name of the key in KeyboardEvent.code. Keyboards of other scripts have letters on these keys.
 */
const kPunctuation: Record<string, string> = {
    BracketLeft: "[{",
    BracketRight: "]}",
    Semicolon: ";:",
    Quote: "'\"",
    Comma: ",<",
    Period: ".>",
    Slash: "/?",
    Backslash: "\\|",
    Minus: "-_",
    Equal: "=+",
    Backquote: "`~",
};

/**
 * The character that this key types on an American keyboard: for a letter key, the capital letter; for a punctuation
 * key that types a letter of a non-Latin script, the character in kPunctuation. "\0" for all other keys.
 */
function characterOnUsKeyboard({ code, key, shiftKey }: KeyboardEvent): string {
    if ([...key].length !== 1) return "\0"; // `key` is a name, not a character
    const [, letter] = /^Key([A-Z])$/.exec(code) ?? [];
    if (letter !== undefined) return letter;
    const isOfOtherScript = /[\p{L}\p{M}]/u.test(key) && !/\p{Script=Latin}/u.test(key);
    return (isOfOtherScript && kPunctuation[code]?.[Number(shiftKey)]) || "\0";
}
