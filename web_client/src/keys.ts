// Converts keyboard events to keystrokes of the key table. The server decides what a keystroke does.
//
// In a row of the key table, `key` is one character, a sequence of two characters, or the name of a key, which has more
// characters.

import type { KeyBinding } from "@oval4d/protocol";

const kTextFields = "textarea, select, [contenteditable], input:not([type=radio], [type=checkbox], [type=range])";
const kButtons = "button, a[href]";
const kButtonKeys = /^( |Enter)$/;
const kInputKeys = /^( |Enter|Home|End|(Arrow|Page).*)$/; // the keys that sliders, radio buttons and checkboxes use
const kNumber = /^[\d.]/; // how the name of a number begins in a list; the list uses the keys of these characters

/** The members of a `key` message. */
export interface KeyStroke {
    key: string;
    shift: boolean;
    ctrl: boolean;
}

/**
 * Whether the control that has the focus uses the key: every key in a text field or a list of names; Enter and the
 * space bar on a button; Enter, the space bar, the arrow keys, Home, End, Page Up and Page Down on a slider, a radio
 * button, a checkbox or a list of numbers; and on the latter also digits and the decimal point.
 */
export function isForControl({ key, target }: KeyboardEvent): boolean {
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

/** The action of Ctrl-Z, Ctrl-Shift-Z and Ctrl-Y or, on a Mac, of Cmd-Z and so on; undefined for other keys. */
export function editingAction(event: KeyboardEvent): "undo" | "redo" | undefined {
    if (event.isComposing || event.altKey || event.ctrlKey === event.metaKey) return undefined;
    const letter = typedCharacter(event).toLowerCase();
    if (letter === "z") return event.shiftKey ? "redo" : "undo";
    return letter === "y" && !event.shiftKey ? "redo" : undefined;
}

/**
 * The keystroke of an event; undefined while a text is composed, if a modifier other than Shift and Ctrl is held, and
 * for keys that are not in the table. The first of these rules that applies gives the keystroke's key:
 * - A key that types a character of the table counts as this character. On a French keyboard, digit keys type "(" and
 *   "-".
 * - A key of another script counts as the character that an American keyboard has in its place.
 * - A digit key counts as its digit, whatever it types.
 */
export function strokeFromEvent(event: KeyboardEvent, table: readonly KeyBinding[]): KeyStroke | undefined {
    if (event.isComposing || event.key === "Dead" || event.key === "Process" || event.metaKey) return undefined;
    // Some layouts type brackets with AltGr (which Windows reports with Ctrl+Alt) or with the Mac's Option key.
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

/** The digit on the physical key, whatever the layout and Shift make it type; undefined for keys without a digit. */
function digitOfKey(event: KeyboardEvent): string | undefined {
    const [, row, digit] = /^(Digit|Numpad)([0-9])$/.exec(event.code) ?? [];
    return row === "Numpad" && event.key !== digit ? undefined : digit;
}

/**
 * Whether a binding identifies its key by a name of KeyboardEvent.key, such as "ArrowLeft", not by one or two
 * characters.
 */
function isKeyGivenByName({ key }: KeyBinding): boolean {
    return key.length > 2;
}

/**
 * The character that the event types. If it is not ASCII, the character of this key on an American keyboard; "\0" if
 * the key has none. A letter is a capital if Shift is held; Caps Lock has no effect.
 */
function typedCharacter(event: KeyboardEvent): string {
    const character = /^[ -~]$/.test(event.key) ? event.key : characterOfPlace(event);
    return event.shiftKey ? character.toUpperCase() : character.toLowerCase();
}

/**
 * The two characters that a punctuation key types on an American keyboard: without Shift, and with Shift. The name of
 * the key is as in KeyboardEvent.code. Keyboards of other scripts have letters on these keys.
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

/** The character of this key on an American keyboard, for keyboards of another script; "\0" if there is none. */
function characterOfPlace({ code, key, shiftKey }: KeyboardEvent): string {
    if ([...key].length !== 1) return "\0"; // the name of a key
    const [, letter] = /^Key([A-Z])$/.exec(code) ?? [];
    if (letter !== undefined) return letter;
    const isOfOtherScript = /[\p{L}\p{M}]/u.test(key) && !/\p{Script=Latin}/u.test(key);
    return (isOfOtherScript && kPunctuation[code]?.[Number(shiftKey)]) || "\0";
}
