// The tools panel: a button for every action of the key table, and sections that other parts of the page add, such as
// the section Colors.

import type { KeyBinding, Keymap, Parts, Plane, Projection, State } from "@oval4d/protocol";

import parts from "../../protocol/schema/parts.schema.json";
import settings from "../../protocol/schema/settings.schema.json";
import { byId, element, planeName } from "./element";
import { makeToolbar } from "./toolbar";

export interface ToolEvents {
    /**
     * Presses the key of a button. `inverse` asks for the inverse rotation. `held` is true for repetitions while the
     * button is held down.
     */
    press(binding: KeyBinding, inverse: boolean, held: boolean): void;
}

/**
 * A section of the tools panel that another part of the page adds. If a group of keys has the same title, the content
 * joins this group.
 */
export interface ToolSection {
    title: string;
    /**
     * The name of the group after which the section is placed, if no group has the section's title. If absent, the
     * section comes last.
     */
    after?: string;
    content: Node[];
}

// On small screens, tabs show the sections in groups. Groups that are not listed here are in the last tab.
const kTabs = [
    { title: "Turn", groups: ["turn", "toward", "history", "Tilt"] },
    { title: "Slices", groups: ["angle", "focus", "slices"] },
    { title: "Show", groups: ["polytope", "look", "whole", "point", "highlight", "camera", "Colors"] },
];
const kOtherTab = "More";
// The groups of keys without buttons in this panel. The controls for playing are beside the slider of w, below the
// picture.
const kGroupsElsewhere = ["play"];

const kHoldDelay = 400; // milliseconds until a held button repeats
const kHoldInterval = 60; // milliseconds between repetitions

/**
 * For each action that switches something, a function that tells whether it is on. An action that switches a view or a
 * part of the picture has the name of the view or part, such as "matrix" or "faces".
 */
const kToggles: Record<string, (state: State) => boolean> = {
    turn: (state) => state.turning,
    view: (state) => state.view === "single",
    projection: (state) => state.projection !== "off",
    ...Object.fromEntries(settings.properties.view.enum.map((view) => [view, (state: State) => state.view === view])),
    ...Object.fromEntries(
        Object.keys(parts.properties).map((part) => [part, (state: State) => state.shown[part as keyof Parts]]),
    ),
};
/** The label of the button that switches between projections; it names the shown projection. */
const kProjectionLabels: Record<Projection, string> = {
    off: "Project",
    perspective: "Perspective",
    orthogonal: "Orthogonal",
};
/** Labels of buttons that replace unclear labels of the key table. */
const kLabels: Record<string, string> = {
    view: "One slice",
    command_line: "Command",
    focus_zero: "0",
    vertex_previous: "(",
    vertex_next: ")",
};
const kFocusOrder =
    "focus_first vertex_previous focus_left focus_zero focus_right vertex_next focus_last".split(" ");

// The planes in the first row of steppers; below each is its perpendicular plane.
const kRotationColumns: Plane[] = ["xy", "xz", "xw"];

export class ToolsPanel {
    private readonly root = byId("tools");
    private readonly toggleButtons = new Map<string, HTMLButtonElement>();
    // The buttons that are disabled while the picture has no projection.
    private projectionButtons: HTMLButtonElement[] = [];

    constructor(private readonly events: ToolEvents) {
        // A click on a button leaves the focus on the drawing. Otherwise the space bar would press the button again.
        this.root.addEventListener("mousedown", (event) => event.preventDefault());
    }

    show(keymap: Keymap, pageSections: ToolSection[]): void {
        this.toggleButtons.clear();
        this.projectionButtons = [];
        const rotations = keymap.keys.filter((key) => key.action === "rotate").sort(compareGridPlaces);
        const sections = keymap.groups
            .filter(({ name }) => !kGroupsElsewhere.includes(name))
            .map(({ name, title }) => ({ name, title, keys: keymap.keys.filter((key) => key.group === name) }))
            .filter(({ keys }) => keys.some((key) => key.action !== "rotate"))
            .map(({ name, title, keys }) => ({ name, title, content: this.controls(keys) }));
        const groups: { name: string; title: string; content: Node[] }[] = [
            { name: "turn", title: "Turn", content: rotations.map((key) => this.rotationStepper(key)) },
            ...sections,
        ];
        for (const { title, content, after } of pageSections) {
            const same = groups.find((group) => group.title === title);
            const at = groups.findIndex(({ name }) => name === after) + 1 || groups.length;
            if (same) same.content.push(...content);
            else groups.splice(at, 0, { name: title, title, content: [...content] });
        }
        const tabOf = (name: string): string => kTabs.find((tab) => tab.groups.includes(name))?.title ?? kOtherTab;
        this.root.replaceChildren(
            this.tabBar([...kTabs.map((tab) => tab.title), kOtherTab]),
            ...groups.map(({ name, title, content }) => {
                const attributes = { "data-tab": tabOf(name), "data-group": name };
                const controls = element("div", {}, ...content);
                if (controls.querySelector("button")) makeToolbar(controls, title);
                return element("section", attributes, element("h2", {}, title), controls);
            }),
        );
    }

    update(state: State): void {
        for (const [action, button] of this.toggleButtons) {
            button.setAttribute("aria-pressed", String(kToggles[action]!(state)));
            if (action === "projection") button.firstChild!.textContent = kProjectionLabels[state.projection];
        }
        for (const button of this.projectionButtons) button.disabled = state.projection === "off";
    }

    private tabBar(titles: string[]): HTMLElement {
        const buttons = titles.map((title) => {
            const button = element("button", { type: "button" }, title);
            button.addEventListener("click", () => choose(title));
            return button;
        });
        const choose = (title: string): void => {
            this.root.dataset["tab"] = title;
            for (const button of buttons) button.setAttribute("aria-pressed", String(button.textContent === title));
        };
        choose(titles.includes(this.root.dataset["tab"] ?? "") ? this.root.dataset["tab"]! : titles[0]!);
        const bar = element("div", { class: "tabs" }, ...buttons);
        makeToolbar(bar, "Groups of tools");
        return bar;
    }

    private actionButton(binding: KeyBinding): HTMLElement {
        const label = kLabels[binding.action] ?? binding.label;
        const attributes = this.buttonAttributes(binding, binding.text, binding.name);
        const button = element("button", { type: "button", ...attributes });
        // A label in words is the accessible name, so that speech control finds the button. The title describes the
        // button.
        if (/\p{L}/u.test(label)) button.removeAttribute("aria-label");
        button.append(element("span", {}, label), element("kbd", { "aria-hidden": "true" }, binding.name));
        if (binding.action in kToggles) {
            this.toggleButtons.set(binding.action, button);
            button.setAttribute("aria-pressed", "false");
        }
        if (binding.needs === "projection") this.projectionButtons.push(button);
        this.bindPresses(button, binding, false);
        return button;
    }

    /**
     * Makes the controls for a group of keys: a stepper for each setting that two keys decrease and increase, and a
     * button for every other key.
     */
    private controls(keys: KeyBinding[]): HTMLElement[] {
        const paired = new Set<KeyBinding>();
        const steppers = keys.flatMap((less) => {
            const of = less.decreases;
            const more = keys.find((key) => key.increases === of);
            if (of === undefined || !more) return [];
            paired.add(less).add(more);
            const name = element("span", { class: of.length === 1 ? "symbol" : "" }, of);
            return [this.stepper(less, false, [name], `${less.name} ${more.name}`, more)];
        });
        const rest = keys.filter((key) => !paired.has(key)).sort(compareFocusSliceKeys);
        return [...steppers, ...rest.map((key) => this.actionButton(key))];
    }

    /** Makes a stepper for a rotation and its inverse. It looks like this: − xy +. */
    private rotationStepper(binding: KeyBinding): HTMLElement {
        const planes = binding.planes ?? [];
        const made = this.stepper(binding, true, planes.map(planeName), binding.name, binding);
        const { row, column } = gridPlaceOf(planes);
        made.style.gridColumn = String(column);
        made.style.gridRow = String(row);
        return made;
    }

    private stepper(less: KeyBinding, inverse: boolean, name: Node[], keys: string, more: KeyBinding): HTMLElement {
        const step = (sign: string, binding: KeyBinding, inverted: boolean): HTMLElement => {
            const text = inverted ? `Inverse: ${uncapitalized(binding.text)}` : binding.text;
            const key = inverted ? `Shift+${binding.name}` : binding.name;
            const button = element("button", { type: "button", ...this.buttonAttributes(binding, text, key) }, sign);
            this.bindPresses(button, binding, inverted);
            return button;
        };
        const label = element("span", { "aria-hidden": "true" }, ...name, element("kbd", {}, keys));
        return element("div", { class: "stepper" }, step("\u2212", less, inverse), label, step("+", more, false));
    }

    private buttonAttributes({ action }: KeyBinding, text: string, key: string): Record<string, string> {
        return {
            "aria-label": `${text} (key ${key})`,
            title: `${text}  (${key})`,
            "data-action": action,
            "data-key": key,
        };
    }

    /**
     * Makes a button press the key of `binding` at each click. If the key's action may repeat, the button also presses
     * repeatedly while it is held down.
     */
    private bindPresses(button: HTMLElement, binding: KeyBinding, inverse: boolean): void {
        let timer: ReturnType<typeof setTimeout> | undefined;
        let repeated = false;
        const repeat = (): void => {
            repeated = true;
            this.events.press(binding, inverse, true);
            timer = setTimeout(repeat, kHoldInterval);
        };
        const stop = (): void => clearTimeout(timer);
        if (binding.repeats) {
            button.addEventListener("pointerdown", (event) => {
                repeated = false;
                if (event.button === 0) timer = setTimeout(repeat, kHoldDelay);
            });
            for (const end of ["pointerup", "pointercancel", "pointerleave", "blur"])
                button.addEventListener(end, stop);
            button.addEventListener("contextmenu", (event) => event.preventDefault()); // no menu after a long touch
        }
        button.addEventListener("click", ({ detail }) => {
            stop();
            // The click at the end of a repetition does not press again. A click by the keyboard (detail 0) always
            // presses. `repeated` may still be set then, because no click follows if the pointer leaves the held
            // button.
            if (!repeated || detail === 0) this.events.press(binding, inverse, false);
            repeated = false;
        });
    }
}

function uncapitalized(text: string): string {
    return text.charAt(0).toLowerCase() + text.slice(1);
}

/**
 * The index in kRotationColumns of a plane. A plane that is not in kRotationColumns has the index of its perpendicular
 * plane.
 */
function rotationColumnIndex(plane: Plane): number {
    const column = kRotationColumns.indexOf(plane);
    return column >= 0 ? column : kRotationColumns.findIndex((other) => ![...other].some((axis) => plane.includes(axis)));
}

/** The row and column of a rotation in the grid of rotation steppers, counted from 1. */
function gridPlaceOf(planes: readonly Plane[]): { row: number; column: number } {
    const row = planes.length > 1 ? 3 : kRotationColumns.includes(planes[0]!) ? 1 : 2;
    return { row, column: 1 + rotationColumnIndex(planes[0]!) };
}

/** Orders rotations by their places in the grid, so that Tab and the arrow keys follow the visible order. */
function compareGridPlaces(a: KeyBinding, b: KeyBinding): number {
    const [one, other] = [gridPlaceOf(a.planes ?? []), gridPlaceOf(b.planes ?? [])];
    return one.row - other.row || one.column - other.column;
}

function compareFocusSliceKeys(a: KeyBinding, b: KeyBinding): number {
    return kFocusOrder.indexOf(a.action) - kFocusOrder.indexOf(b.action);
}
