// Shows the main values of the state in fields that change them, and announces changes of the state to screen readers.

import type { State } from "@oval4d/protocol";

import { angleExpression, editableAngle, withoutBlanksAroundOperators, withoutBlanksBeforeUnits } from "./angles";
import { spokenColoring, spokenKinds } from "./color_controls";
import { byId } from "./element";
import { focusWithCoordinate, spokenLevels } from "./fields";
import { formatCoordinate, formatDegrees, focusW, formatLength, formatRotation } from "./format";
import { HeaderValue } from "./header_value";
import { spokenReferenceFrame } from "./reference_frame";
import { makeToolbar } from "./toolbar";

/** A value in the header of the page: what it shows of the state, and the command that changes it. */
interface HeaderValueDescription {
    name: string;
    symbol: string;
    /** A short description of the value, for its tooltip. */
    meaning: string;
    /** A description of what the user can type. */
    hint: string;
    value(state: State): string;
    /** What a screen reader says about the value; "" for nothing. */
    spoken(state: State): string;
    /** The text with which the field opens, such as an angle that is not rounded; by default, the shown value. */
    editable?(state: State): string;
    /** The command that applies what the user has typed; throws an Error if the text cannot be understood. */
    command(text: string, state: State): string;
}

const kAngleHint = "In degrees, or for example pi/8";

const kHeaderValues: HeaderValueDescription[] = [
    {
        ...nameAndValue("alpha", "α", "Angle of the rotation keys", ({ alpha }) => formatDegrees(alpha)),
        hint: kAngleHint,
        editable: ({ alpha }) => editableAngle(alpha),
        command: (text) => `set alpha=${angleExpression(text)}`,
    },
    {
        ...nameAndValue("beta", "β", "Angle in the second plane", ({ beta }) => formatDegrees(beta)),
        hint: kAngleHint,
        editable: ({ beta }) => editableAngle(beta),
        command: (text) => `set beta=${angleExpression(text)}`,
    },
    {
        ...nameAndValue("w", "w", "Position of the focus slice; in parentheses, in the box of a field", focusWithCoordinate),
        hint: "Any w: all hyperplanes move with the focus slice",
        editable: focusW,
        command: (text) => `set w=${withoutBlanksAroundOperators(text)}`,
    },
    {
        ...nameAndValue("spacing", "δ", "Distance between slices", ({ slices }) => formatLength(slices.spacing)),
        hint: "A length, for example 0.1 or 1/8",
        command: (text) => `set spacing=${withoutBlanksAroundOperators(text)}`,
    },
    {
        ...nameAndValue("slices", "Slices", "Number of slices", ({ slices }) => String(slices.count)),
        hint: "An odd number",
        command: (text) => `set slices=${withoutBlanksAroundOperators(text)}`,
    },
    {
        ...nameAndValue("last", "Last rotation", "Planes and angles of the last rotation", ({ last }) =>
            last ? formatRotation(last) : "none",
        ),
        hint: "Turn by other angles: xw 10° or xw 10°, yz 5°",
        spoken: ({ last }) => (last ? `turned ${formatRotation(last)}` : ""),
        editable: ({ last }) =>
            last?.planes.map((plane, i) => `${plane} ${editableAngle(last.angles[i]!)}`).join(", ") ?? "",
        command: rotateCommand,
    },
];

const kSpeechDelay = 700; // milliseconds without a change before the state is announced

export class HeaderValues {
    private readonly root = byId("state-fields");
    private readonly announcer = byId("spoken");
    private readonly byName = new Map<string, HeaderValue>();
    private state: State | undefined;
    private announced: string[] | undefined; // what screenReaderTextsOf() returned at the last announcement
    private timer: ReturnType<typeof setTimeout> | undefined;

    /** `run` executes a command; it rejects with an Error whose message is shown at the field. */
    constructor(run: (command: string) => Promise<unknown>) {
        for (const { name, symbol, meaning, hint, value, editable = value, command } of kHeaderValues) {
            const headerValue = new HeaderValue(name, symbol, meaning, hint, {
                editableText: () => (this.state ? editable(this.state) : ""),
                apply: async (text) => this.state && run(command(text, this.state)),
            });
            this.byName.set(name, headerValue);
            this.root.append(headerValue.root);
        }
        makeToolbar(this.root, "Current values");
    }

    update(state: State): void {
        for (const { name, value } of kHeaderValues) this.byName.get(name)!.show(value(state));
        this.state = state;
        this.announced ??= ["", ...screenReaderTextsOf(state).slice(1)];
        // While the polytope turns or the focus plays, new states must not postpone the announcement forever.
        if ((state.turning || state.playing) && this.timer !== undefined) return;
        clearTimeout(this.timer);
        this.timer = setTimeout(() => this.announce(), kSpeechDelay);
    }

    /** Announces what has changed since the last announcement. The first announcement also names the polytope. */
    private announce(): void {
        this.timer = undefined;
        const before = this.announced!;
        this.announced = screenReaderTextsOf(this.state!);
        const changed = this.announced.filter((text, i) => text !== "" && text !== before[i]);
        if (changed.length > 0) this.announcer.textContent = changed.join(", ");
    }
}

/**
 * What a screen reader can say about a state: first the polytope's name, then a text for each value or setting. A text
 * is "" if there is nothing to say.
 */
function screenReaderTextsOf(state: State): string[] {
    const onOff = (part: string, isShown: boolean): string => `${part} ${isShown ? "on" : "off"}`;
    return [
        state.polytope.name,
        // While the focus plays, w and the section change all the time: they are announced when it stops.
        ...kHeaderValues.map((one) => (state.playing && one.name === "w" ? "" : one.spoken(state))),
        state.section.name && !state.playing ? `section: ${state.section.name}` : "",
        `${state.view} view`,
        state.view === "matrix" && !state.playing ? `focus point ${spokenPoint(state)}` : "",
        state.turning ? "turning" : "at rest",
        state.playing ? "playing" : "not playing",
        spokenColoring(state),
        spokenKinds(state),
        `${state.background === "auto" ? "automatic" : state.background} background`,
        spokenLevels(state),
        spokenReferenceFrame(state) || "observer at rest",
        state.highlight ? `${state.highlight.element} ${state.highlight.number} highlighted` : "no highlight",
        ...Object.entries(state.shown).map(([part, isShown]) => onOff(part, isShown as boolean)),
    ];
}

function spokenPoint({ point, slices }: State): string {
    return point.map((coordinate) => formatCoordinate(coordinate, slices.spacing)).join(", ");
}

function nameAndValue(name: string, symbol: string, meaning: string, value: (state: State) => string) {
    return { name, symbol, meaning, value, spoken: (state: State) => `${symbol} ${value(state)}` };
}

/** The command for a rotation such as "xw 10°, yz 0.2 rad" or "xw,yz 10 5". */
function rotateCommand(text: string): string {
    // A blank before a minus sign separates two angles, so it is not removed.
    const joined = withoutBlanksBeforeUnits(text).replace(/\s*([*/^])\s*/g, "$1");
    const words = joined.split(/[\s,;]+/).filter((word) => word !== "");
    const isPlane = (word: string, i: number): boolean => i === 0 || /^[xyzw]{2}$/.test(word);
    const angles = words.filter((word, i) => !isPlane(word, i)).map(angleExpression);
    return `rotate ${words.filter(isPlane).join(",")} ${angles.join(" ")}`;
}
