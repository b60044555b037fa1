// Shows the main values of the state, and announces changes of the state to screen readers.

import type { State } from "@oval4d/protocol";

import { spokenKinds } from "./colors";
import { byId, element } from "./element";
import { formatDegrees, focusW, formatLength, formatRotation } from "./format";
import { makeToolbar } from "./toolbar";

interface Reading {
    name: string;
    symbol: string;
    /** Describes the value; the beginning of the button's tooltip. */
    meaning: string;
    /** The beginning of the command that changes the value. */
    command: string;
    value(state: State): string;
    spoken(state: State): string;
}

const kReadings: Reading[] = [
    reading("alpha", "α", "Angle of the rotation keys", "set alpha=", ({ alpha }) => formatDegrees(alpha)),
    reading("beta", "β", "Angle in the second plane", "set beta=", ({ beta }) => formatDegrees(beta)),
    reading("w", "w", "Position of the focus slice", "set focus=", focusW),
    reading("spacing", "δ", "Distance between slices", "set spacing=", ({ slices }) => formatLength(slices.spacing)),
    reading("slices", "Slices", "Number of slices", "set slices=", ({ slices }) => String(slices.count)),
    {
        ...reading("last", "Last rotation", "Planes and angles of the last rotation", "rotate ", ({ last }) =>
            last ? formatRotation(last) : "none",
        ),
        spoken: ({ last }) => (last ? `turned ${formatRotation(last)}` : ""),
    },
];

const kSpeechDelay = 700; // milliseconds without a change before the state is announced

export class Readings {
    private readonly root = byId("readings");
    private readonly announcer = byId("spoken");
    private readonly values = new Map<string, HTMLElement>();
    private state: State | undefined;
    private announced: string[] | undefined;
    private timer: ReturnType<typeof setTimeout> | undefined;

    /** `edit` is called to open the command line with the beginning of a command. */
    constructor(edit: (command: string) => void) {
        for (const { name, symbol, meaning, command } of kReadings) {
            const value = element("span", { "data-reading": name }, "\u2013");
            const label = element("span", { class: symbol.length === 1 ? "symbol" : "word" }, symbol);
            const title = `${meaning}. Change with :${command}…`;
            const button = element("button", { type: "button", title }, label, " ", value);
            button.addEventListener("click", () => edit(command));
            this.root.append(button);
            this.values.set(name, value);
        }
        makeToolbar(this.root, "Current values");
    }

    update(state: State): void {
        for (const { name, value } of kReadings) {
            const text = value(state);
            const output = this.values.get(name)!;
            if (output.textContent !== text) output.textContent = text;
        }
        this.state = state;
        if (state.turning && this.timer !== undefined) return; // otherwise each step would delay the announcement
        clearTimeout(this.timer);
        this.timer = setTimeout(() => this.announce(), kSpeechDelay);
    }

    /** Announces the changes since the last announcement; the first time, only the polytope's name. */
    private announce(): void {
        this.timer = undefined;
        const state = this.state!;
        const { shown } = state;
        const onOff = (part: string, isShown: boolean): string => `${part} ${isShown ? "on" : "off"}`;
        const now = [
            state.polytope.name,
            ...kReadings.map((one) => one.spoken(state)),
            state.view === "oval" ? "oval view" : "single view",
            state.turning ? "turning" : "at rest",
            state.color === "plain" ? "plain colors" : `colored by ${state.color}`,
            spokenKinds(state),
            ...Object.entries(shown).map(([part, isShown]) => onOff(part, isShown as boolean)),
        ];
        const before = this.announced ?? now.map((text, i) => (i === 0 ? "" : text));
        this.announced = now;
        const changed = now.filter((text, i) => text !== "" && text !== before[i]);
        if (changed.length > 0) this.announcer.textContent = changed.join(", ");
    }
}

function reading(
    name: string,
    symbol: string,
    meaning: string,
    command: string,
    value: (state: State) => string,
): Reading {
    return { name, symbol, meaning, command, value, spoken: (state) => `${symbol} ${value(state)}` };
}
