// The key table: how its keys are pressed, and what they do.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

import { assertMatrix, isNear, turned } from "./rotation.mjs";

const read = (file) => JSON.parse(readFileSync(new URL(`../../../protocol/${file}`, import.meta.url), "utf8"));

/** The key table. The server uses the same file. */
export const { keys: table } = read("keymap.json");

/** Whether a key has a button in the tools panel. The controls of playing are beside the slider of w instead. */
export const hasTool = ({ group }) => group !== "play";

const parts = Object.keys(read("schema/parts.schema.json").properties);
const settings = read("schema/settings.schema.json").properties;
const views = settings.view.enum;
const elements = settings.highlight.properties.element.enum;
/**
 * The views that actions of the same name show: all but the oval and the single view, whose action is called "view".
 */
export const toggledViews = views.filter((view) => view !== "oval" && view !== "single");

const backgrounds = settings.background.enum;

const close = (a, b) => Math.abs(a - b) < 1e-9;

const toggles = (part) => (before, after) => assert.equal(after.shown[part], !before.shown[part]);
const adds = (angle, sign) => (before, after) => assert.ok(close(after[angle], before[angle] + sign * before.step));

const moves = (before, after) => assert.ok(after.moving || !isNear(after.orientation, before.orientation));

const movesPoint = (axis, sign) => (before, after) =>
    after.point.forEach((coordinate, i) => {
        const by = i === axis ? sign * before.slices.spacing : 0;
        assert.ok(close(coordinate, before.point[i] + by), `${before.point} to ${after.point}`);
    });

const highlights = (element) => (before, after) => {
    assert.equal(before.highlight, null);
    assert.equal(after.highlight.element, element);
};

/** Checks of the state after an action, for actions that effectOf() cannot derive from the tables. */
const effects = {
    rotate: (before, after, { planes }) => {
        assertMatrix(after.orientation, turned(before.orientation, planes, [before.alpha, before.beta]));
    },
    alpha_up: adds("alpha", 1),
    alpha_down: adds("alpha", -1),
    beta_up: adds("beta", 1),
    beta_down: adds("beta", -1),
    focus_right: (before, after) => assert.equal(after.slices.focus, before.slices.focus + 1),
    focus_left: (before, after) => assert.equal(after.slices.focus, before.slices.focus - 1),
    focus_zero: (_, after) => assert.equal(after.slices.focus, 0),
    focus_first: (before, after) => assert.ok(after.slices.focus < 0 && after.slices.focus < before.slices.focus),
    focus_last: (before, after) => assert.ok(after.slices.focus > 0 && after.slices.focus > before.slices.focus),
    background: (before, after) => {
        const next = (backgrounds.indexOf(before.background) + 1) % backgrounds.length;
        assert.equal(after.background, backgrounds[next]);
    },
    undo: (before, after) => assert.notDeepEqual(after.orientation, before.orientation),
    redo: (before, after) => assert.notDeepEqual(after.orientation, before.orientation),
    repeat: (before, after) => {
        assertMatrix(after.orientation, turned(before.orientation, before.last.planes, before.last.angles));
    },
    toward_vertex: moves,
    toward_edge: moves,
    toward_face: moves,
    toward_cell: moves,
    ...Object.fromEntries(elements.flatMap((element) => [
        [`highlight_next_${element}`, highlights(element)],
        [`highlight_previous_${element}`, highlights(element)],
    ])),
    vertex_next: (before, after) => assert.ok(after.section.w > before.section.w && after.section.vertices !== ""),
    vertex_previous: (before, after) => assert.ok(after.section.w < before.section.w && after.section.vertices !== ""),
    ...Object.fromEntries(["x", "y", "z"].flatMap((name, axis) => [
        [`point_${name}_up`, movesPoint(axis, 1)],
        [`point_${name}_down`, movesPoint(axis, -1)],
    ])),
    play: (before, after) => assert.equal(after.playing, !before.playing),
    turn: (before, after) => assert.equal(after.turning, !before.turning),
    spacing_smaller: (before, after) => assert.ok(close(after.slices.spacing, before.slices.spacing / 1.1)),
    spacing_larger: (before, after) => assert.ok(close(after.slices.spacing, before.slices.spacing * 1.1)),
    slices_fewer: (before, after) => assert.equal(after.slices.count, before.slices.count - 2),
    slices_more: (before, after) => assert.equal(after.slices.count, before.slices.count + 2),
    polytope_next: (_, after) => assert.notEqual(after.polytope.name, "24-cell"),
    polytope_previous: (_, after) => assert.notEqual(after.polytope.name, "24-cell"),
    view: (_, after) => assert.equal(after.view, "single"),
    projection: (_, after) => assert.equal(after.projection, "perspective"),
};

/** The value of the setting with this name, which is a member of the state or of an object in the state. */
function settingIn(state, name) {
    return [state, ...Object.values(state)].find((object) => object?.[name] !== undefined)?.[name];
}

/**
 * Returns a function that compares the states before and after an action. An action with the name of a part or view
 * switches it. For keys that increase or decrease something, the action is named after the setting, as in alpha_up.
 */
export function effectOf({ action, name, increases, decreases }) {
    if (effects[action]) return effects[action];
    if (parts.includes(action)) return toggles(action);
    if (views.includes(action)) return (_, after) => assert.equal(after.view, action);
    assert.ok(increases ?? decreases, `this file must say what the action ${action} of the key ${name} does`);
    return (before, after) => {
        const [from, to] = [before, after].map((state) => settingIn(state, action.slice(0, action.lastIndexOf("_"))));
        assert.ok(increases ? to > from : to < from, `${action}: from ${from} to ${to}`);
    };
}

/** The key presses of a binding, in Playwright's notation, on an American keyboard. */
export function strokes({ key, code, ctrl }, inverse = false) {
    const typed = (character) => (/[A-Z()]/.test(character) ? `Shift+${character}` : character);
    if (key.length > 1) return [...key].map(typed);
    const name = code ?? typed(key);
    if (ctrl) return [`Control+${key}`];
    return [inverse ? (code ? `Shift+${code}` : `Shift+${key.toUpperCase()}`) : name];
}

const kShown = {
    ...{ faces: true, bars: true, balls: true, coordinates: true, labels: true },
    ...{ cells: true, back: true, sections: false },
};

/**
 * Puts the session into the same state before each key: rotated, with the focus not at w = 0, and with steps to undo or
 * redo.
 */
export async function prepare(script, { action }) {
    await script.request({ type: "set", polytope: "24-cell", view: "oval", projection: "off", turning: false, playing: false });
    await script.request({ type: "reset" });
    await script.request({ type: "set", shown: kShown, highlight: null });
    await script.request({ type: "set", alpha: 0.3, beta: 0.2, slices: { count: 21, spacing: 0.2, focus: 2 } });
    await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.25, 0.5] });
    if (action === "redo") await script.request({ type: "undo" });
    return script.state();
}
