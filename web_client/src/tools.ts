// A button for every action: those of the key table, and the page's own.

import type { KeyBinding, Keymap, Plane, State } from "@oval4d/protocol";

import { byId, element, planeName } from "./element";

export interface ToolEvents {
    /** `held`: the button is being held down, and this is not its first time. */
    press(binding: KeyBinding, inverse: boolean, held: boolean): void;
}

/** A page's own section, shown among those of the table; under a title that the table has too, they are one. */
export interface Section {
    title: string;
    /** The group of the table that it follows; else it stands at the end. */
    after?: string;
    content: Node[];
}

// Sections stand together on a small screen's tabs. Groups that are not named here come last.
const kTabs = [
    { title: "Turn", groups: ["turn", "history"] },
    { title: "Slices", groups: ["angle", "focus", "slices"] },
    { title: "Show", groups: ["polytope", "look", "Colours"] },
];
const kOther = "More";

const kRepeating =
    /^(rotate|repeat|undo|redo|(alpha|beta|focus|spacing|slices|polytope)_(up|down|left|right|smaller|larger|fewer|more|next|previous))$/;
const kHoldDelay = 400; // milliseconds
const kHoldInterval = 60;

/** Which actions are switches, and how they stand. */
const kSwitches: Record<string, (state: State) => boolean> = {
    turn: (state) => state.turning,
    view: (state) => state.view === "single",
    coordinates: (state) => state.shown.coordinates,
    faces: (state) => state.shown.faces,
    bars: (state) => state.shown.bars,
    balls: (state) => state.shown.balls,
};
/** Where the table's word would say too little on a button. */
const kLabels: Record<string, string> = { view: "single", command_line: "command" };
const kFocusOrder = ["focus_first", "focus_left", "focus_zero", "focus_right", "focus_last"];

/** Pairs that make one stepper: less, more, of what. */
const kPairs = [
    ["alpha_down", "alpha_up", "α"],
    ["beta_down", "beta_up", "β"],
    ["spacing_smaller", "spacing_larger", "δ"],
    ["slices_fewer", "slices_more", "slices"],
] as const;

const kColumns: Plane[] = ["xy", "xz", "xw"]; // of the pad; their perpendiculars zw, yw, yz stand below

export class Tools {
    private readonly root = byId("tools");
    private readonly switches = new Map<string, HTMLElement>();

    constructor(private readonly events: ToolEvents) {
        // The drawing keeps the focus, and with it the keys, when the mouse presses a button.
        this.root.addEventListener("mousedown", (event) => event.preventDefault());
    }

    show(keymap: Keymap, own: Section[]): void {
        this.switches.clear();
        const rotations = keymap.keys.filter((key) => key.action === "rotate");
        const sections = keymap.groups
            .map(({ name, title }) => ({ name, title, keys: keymap.keys.filter((key) => key.group === name) }))
            .filter(({ keys }) => keys.some((key) => key.action !== "rotate"))
            .map(({ name, title, keys }) => ({ name, title, content: this.controls(keys) }));
        const groups: { name: string; title: string; content: Node[] }[] = [
            { name: "turn", title: "Turn", content: rotations.map((key) => this.rotation(key)) },
            ...sections,
        ];
        for (const { title, content, after } of own) {
            const same = groups.find((group) => group.title === title);
            const at = groups.findIndex(({ name }) => name === after) + 1 || groups.length;
            if (same) same.content.push(...content);
            else groups.splice(at, 0, { name: title, title, content: [...content] });
        }
        const tabOf = (name: string): string => kTabs.find((tab) => tab.groups.includes(name))?.title ?? kOther;
        this.root.replaceChildren(
            this.tabs([...kTabs.map((tab) => tab.title), kOther]),
            ...groups.map(({ name, title, content }) => {
                const attributes = { "data-tab": tabOf(name), "data-group": name };
                return element("section", attributes, element("h2", {}, title), element("div", {}, ...content));
            }),
        );
    }

    update(state: State): void {
        for (const [action, button] of this.switches) {
            button.setAttribute("aria-pressed", String(kSwitches[action]!(state)));
        }
    }

    private tabs(titles: string[]): HTMLElement {
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
        return element("div", { class: "tabs", role: "group", "aria-label": "Tools to show" }, ...buttons);
    }

    private button(binding: KeyBinding): HTMLElement {
        const label = element("span", {}, kLabels[binding.action] ?? binding.label);
        const button = element("button", { type: "button", ...this.names(binding, binding.text, binding.name) });
        button.append(label, element("kbd", { "aria-hidden": "true" }, binding.name));
        if (binding.action in kSwitches) {
            this.switches.set(binding.action, button);
            button.setAttribute("aria-pressed", "false");
        }
        this.onPress(button, binding, false);
        return button;
    }

    /** Steppers for the pairs, buttons for the rest. */
    private controls(keys: KeyBinding[]): HTMLElement[] {
        const find = (action: string): KeyBinding | undefined => keys.find((key) => key.action === action);
        const steppers = kPairs.flatMap(([lessName, moreName, of]) => {
            const [less, more] = [find(lessName), find(moreName)];
            if (!less || !more) return [];
            const name = element("span", { class: of.length === 1 ? "symbol" : "" }, of);
            return [this.stepper(less, false, [name], `${less.name} ${more.name}`, more)];
        });
        const paired: string[] = kPairs.flatMap(([less, more]) => [less, more]);
        const rest = keys.filter((key) => !paired.includes(key.action)).sort(byFocus);
        return [...steppers, ...rest.map((key) => this.button(key))];
    }

    /** − xy +: a rotation and its inverse. */
    private rotation(binding: KeyBinding): HTMLElement {
        const planes = binding.planes ?? [];
        const made = this.stepper(binding, true, planes.map(planeName), binding.name, binding);
        made.style.gridColumn = String(1 + columnOf(planes[0]!));
        made.style.gridRow = planes.length > 1 ? "3" : kColumns.includes(planes[0]!) ? "1" : "2";
        return made;
    }

    private stepper(less: KeyBinding, inverse: boolean, name: Node[], keys: string, more: KeyBinding): HTMLElement {
        const step = (sign: string, binding: KeyBinding, inverted: boolean): HTMLElement => {
            const text = inverted ? `${binding.text}, the inverse` : binding.text;
            const key = inverted ? `Shift+${binding.name}` : binding.name;
            const button = element("button", { type: "button", ...this.names(binding, text, key) }, sign);
            this.onPress(button, binding, inverted);
            return button;
        };
        const label = element("span", { "aria-hidden": "true" }, ...name, element("kbd", {}, keys));
        return element("div", { class: "stepper" }, step("\u2212", less, inverse), label, step("+", more, false));
    }

    private names({ action }: KeyBinding, text: string, key: string): Record<string, string> {
        return {
            "aria-label": `${text} (key ${key})`,
            title: `${text}  (${key})`,
            "data-action": action,
            "data-key": key,
        };
    }

    /** Presses at a click, and again and again while held down. */
    private onPress(button: HTMLElement, binding: KeyBinding, inverse: boolean): void {
        let timer: ReturnType<typeof setTimeout> | undefined;
        let repeated = false;
        const again = (): void => {
            repeated = true;
            this.events.press(binding, inverse, true);
            timer = setTimeout(again, kHoldInterval);
        };
        const stop = (): void => clearTimeout(timer);
        if (kRepeating.test(binding.action)) {
            button.addEventListener("pointerdown", (event) => {
                repeated = false;
                if (event.button === 0) timer = setTimeout(again, kHoldDelay);
            });
            for (const end of ["pointerup", "pointercancel", "pointerleave", "blur"])
                button.addEventListener(end, stop);
            button.addEventListener("contextmenu", (event) => event.preventDefault()); // of a long touch
        }
        button.addEventListener("click", () => {
            stop();
            if (!repeated) this.events.press(binding, inverse, false);
            repeated = false;
        });
    }
}

function columnOf(plane: Plane): number {
    const column = kColumns.indexOf(plane);
    return column >= 0 ? column : kColumns.findIndex((one) => ![...one].some((axis) => plane.includes(axis)));
}

function byFocus(a: KeyBinding, b: KeyBinding): number {
    return kFocusOrder.indexOf(a.action) - kFocusOrder.indexOf(b.action);
}
