// The display of the state, which is also announced to screen readers when it changes.

import type { State } from "@oval4d/protocol";

import { spokenKinds } from "./colors";
import { byId, element } from "./element";
import { degrees, focusW, length, rotation } from "./format";

interface Reading {
    name: string;
    symbol: string;
    /** The beginning of the command that changes the value. */
    command: string;
    value(state: State): string;
    spoken(state: State): string;
}

const kReadings: Reading[] = [
    reading("alpha", "α", "set alpha=", (state) => degrees(state.alpha)),
    reading("beta", "β", "set beta=", (state) => degrees(state.beta)),
    reading("w", "w", "set focus=", (state) => length(focusW(state))),
    reading("spacing", "δ", "set spacing=", (state) => length(state.slices.spacing)),
    reading("slices", "Slices", "set slices=", (state) => String(state.slices.count)),
    {
        ...reading("last", "Last rotation", "rotate ", (state) => (state.last ? rotation(state.last) : "none")),
        spoken: ({ last }) => (last ? `turned ${rotation(last)}` : ""),
    },
];

const kSpeechDelay = 700; // milliseconds without a change before the state is announced

export class Readings {
    private readonly root = byId("readings");
    private readonly live = byId("spoken");
    private readonly values = new Map<string, HTMLElement>();
    private state: State | undefined;
    private spoken: string[] | undefined;
    private timer: ReturnType<typeof setTimeout> | undefined;

    /** `edit` is called to open the command line with the beginning of a command. */
    constructor(edit: (command: string) => void) {
        for (const { name, symbol, command } of kReadings) {
            const value = element("output", { "data-reading": name }, "\u2013");
            const label = element("span", { class: symbol.length === 1 ? "symbol" : "word" }, symbol);
            const button = element("button", { type: "button", title: `Change with :${command}…` }, label, " ", value);
            button.addEventListener("click", () => edit(command));
            this.root.append(button);
            this.values.set(name, value);
        }
    }

    update(state: State): void {
        for (const { name, value } of kReadings) {
            const text = value(state);
            const output = this.values.get(name)!;
            if (output.textContent !== text) output.textContent = text;
        }
        this.state = state;
        if (state.turning && this.timer !== undefined) return; // each step would delay the announcement
        clearTimeout(this.timer);
        this.timer = setTimeout(() => this.speak(), kSpeechDelay);
    }

    /** Announces the changes since the last announcement; the first time, only the polytope's name. */
    private speak(): void {
        this.timer = undefined;
        const state = this.state!;
        const { shown } = state;
        const on = (what: string, is: boolean): string => `${what} ${is ? "on" : "off"}`;
        const now = [
            state.polytope.name,
            ...kReadings.map((one) => one.spoken(state)),
            state.view === "oval" ? "oval view" : "single view",
            state.turning ? "turning" : "at rest",
            `colors by ${state.color}`,
            spokenKinds(state),
            ...Object.entries(shown).map(([what, is]) => on(what, is as boolean)),
        ];
        const before = this.spoken ?? now.map((text, i) => (i === 0 ? "" : text));
        this.spoken = now;
        const changed = now.filter((text, i) => text !== "" && text !== before[i]);
        if (changed.length > 0) this.live.textContent = changed.join(", ");
    }
}

function reading(name: string, symbol: string, command: string, value: (state: State) => string): Reading {
    return { name, symbol, command, value, spoken: (state) => `${symbol} ${value(state)}` };
}
