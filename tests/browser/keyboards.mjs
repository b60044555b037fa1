// The page's keys work on keyboards of many languages. support/make_keyboards.py has made the table of what their keys
// type.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "./support/suite.mjs";

import { strokeFromEvent } from "./node_modules/.oval4d/keys.mjs";

const read = (path) => JSON.parse(readFileSync(new URL(path, import.meta.url), "utf8"));
const keyboards = read("./support/keyboards.json");
const { keys: table } = read("../../protocol/keymap.json");

const kSingle = new Set(table.filter(({ key, ctrl }) => key.length === 1 && !ctrl).map(({ key }) => key));
const kLetters = new Set([...table.filter(({ key, ctrl }) => key.length <= 2 && !ctrl).map(({ key }) => key).join("")]);
for (const { key, shift } of table) if (shift === "inverse" && key.length === 1) kLetters.add(key.toUpperCase());
const isLatin = (character) => /^[a-z]$/i.test(character);

/**
 * The keystroke that the page derives from a key press. `characters` are what the key types without and with Shift;
 * `code` is its place.
 */
function stroke(characters, code, shift, capsLock = false) {
    let key = characters[Number(shift)] || "Dead";
    if (capsLock && isLatin(key)) key = shift ? key.toLowerCase() : key.toUpperCase();
    const modifiers = { shiftKey: shift, ctrlKey: false, altKey: false, metaKey: false, getModifierState: () => false };
    return strokeFromEvent({ key, code, isComposing: false, ...modifiers }, table);
}

/** Calls `check` for each key of each keyboard, without Shift and with Shift. */
function forEachKey(check) {
    for (const [layout, keys] of Object.entries(keyboards)) {
        for (const [code, characters] of Object.entries(keys)) {
            for (const shift of [false, true]) {
                const typed = characters[Number(shift)];
                check({ layout, code, shift, typed, characters, name: `${layout}: ${shift ? "Shift+" : ""}${code} “${typed}”` });
            }
        }
    }
}

test("keyboards: a character of the table acts, whichever key types it", async () => {
    const found = new Set();
    forEachKey(({ code, shift, typed, characters, name }) => {
        if (!kLetters.has(typed) && !kSingle.has(typed)) return;
        assert.equal(stroke(characters, code, shift)?.key, typed, name);
        found.add(typed);
    });
    for (const key of kSingle) if (key !== " ") assert.ok(found.has(key), key);
});

test("keyboards: other characters on digit keys count as the digit, and with Shift as its inverse", async () => {
    forEachKey(({ code, shift, typed, characters, name }) => {
        const [, digit] = /^Digit([2-7])$/.exec(code) ?? [];
        if (digit === undefined || (kSingle.has(typed) && typed !== digit)) return;
        assert.deepEqual(stroke(characters, code, shift), { key: digit, shift, ctrl: false }, name);
    });
});

test("keyboards: Caps Lock changes nothing", async () => {
    forEachKey(({ code, shift, characters, name }) => {
        assert.deepEqual(stroke(characters, code, shift, true), stroke(characters, code, shift), name);
    });
});

test("keyboards: letters of other scripts act as the American keys in their places", async () => {
    const { us } = keyboards;
    let count = 0;
    forEachKey(({ code, shift, typed, characters, name }) => {
        const american = us[code][Number(shift)];
        if (!/\p{L}/u.test(typed) || /\p{Script=Latin}/u.test(typed)) return;
        const expected = kLetters.has(american) || kSingle.has(american) ? american : undefined;
        assert.equal(stroke(characters, code, shift)?.key, expected, name);
        count += 1;
    });
    assert.ok(count > 300, `${count} letters`);
    for (const [key, expected] of [["х", "["], ["ъ", "]"], ["ю", "."]]) {
        const [code, characters] = Object.entries(keyboards.ru).find(([, [plain]]) => plain === key);
        assert.equal(stroke(characters, code, false).key, expected);
    }
});

test("keyboards: signs of Latin keyboards that the table does not have do nothing", async () => {
    for (const [layout, code] of [["de", "Semicolon"], ["de", "BracketLeft"], ["fr", "Digit1"], ["us", "Comma"], ["us", "Quote"]]) {
        assert.equal(stroke(keyboards[layout][code], code, false), undefined, `${layout}: ${code}`);
    }
});
