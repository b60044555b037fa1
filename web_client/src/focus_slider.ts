// The slider below the picture. It moves the focus slice from the lowest w of the object to the highest. Its marks are
// the critical values of w: where vertices lie, or where the body of a field changes its topology. The button Play
// beside the slider makes the server move the focus to and fro.

import type { Client, Command, Slices, State } from "@oval4d/protocol";

import { type CriticalValue, CriticalValueTracker } from "./critical_values";
import { byId, element } from "./element";
import { FocusSliceMover } from "./focus_mover";
import { formatW } from "./format";

export interface FocusSliderEvents {
    /** Presses a key of the key table. */
    pressKey(key: string, held: boolean): void;
    /** Sends a command; shows the error if the server refuses it. */
    send(command: Command): void;
    failed(error: Error): void;
}

const kSnapDistance = 4; // pixels: a drag this near to a mark snaps to the mark
const kKeySteps = 200; // the number of presses of an arrow key that move the focus from one end to the other
const kMaxMarks = 60; // if there are more critical values, their density is shown instead of marks
const kDensityBins = 80;

export class FocusSlider {
    private readonly input = byId<HTMLInputElement>("focus-w");
    private readonly marks = document.querySelector<SVGPathElement>("#focus-marks path")!;
    private readonly section = byId("focus-section");
    private readonly playButton = byId<HTMLButtonElement>("focus-play");
    private readonly speed = byId<HTMLSelectElement>("focus-speed");
    // An entry for the speed of the session, listed only while no other entry has this speed.
    private readonly otherSpeed = element("option", {});
    private readonly criticalValues: CriticalValueTracker;
    private readonly mover: FocusSliceMover;
    private state: State | undefined;
    private isDragged = false;
    private mayNotSnap = false; // whether Alt or Shift is held

    constructor(
        client: Client,
        private readonly events: FocusSliderEvents,
    ) {
        this.criticalValues = new CriticalValueTracker(client, () => this.showRange());
        this.mover = new FocusSliceMover(client, (error) => {
            if (error) events.failed(error);
            this.show();
        });
        this.listen();
    }

    update(state: State): void {
        this.state = state;
        this.mover.update(state);
        this.criticalValues.update(state);
        const { name, vertices } = state.section;
        this.section.textContent = name || (vertices && `vertices: ${vertices}`);
        this.showPlaying(state);
        this.show();
    }

    /** Takes the critical values from a picture, which must be that of the newest state. */
    updateFromPicture(slices: Slices): void {
        this.criticalValues.adoptFromPicture(slices);
    }

    /** Prepares for the states of a new connection. */
    prepareForNewConnection(): void {
        this.mover.prepareForNewConnection();
    }

    /** Stops the playing of the focus, for all who see the session. */
    stop(): void {
        if (this.state?.playing) this.events.send({ type: "set", playing: false });
    }

    private listen(): void {
        const { input } = this;
        input.addEventListener("pointerdown", (event) => {
            this.isDragged = true;
            this.mover.beginGesture();
            this.noteModifiers(event);
            this.stop();
        });
        for (const end of ["pointerup", "pointercancel"]) {
            // Firefox reports the last value of a drag only after the event pointerup, so the drag ends one task later.
            window.addEventListener(end, () => setTimeout(() => (this.isDragged = false)));
        }
        window.addEventListener("pointermove", (event) => this.noteModifiers(event));
        input.addEventListener("input", () => this.slid());
        input.addEventListener("keydown", (event) => this.keydown(event));
        this.playButton.addEventListener("click", () => {
            this.events.send({ type: "set", playing: !this.state?.playing });
        });
        this.speed.addEventListener("change", () => {
            this.events.send({ type: "set", speed: Number(this.speed.value) });
        });
        // The button Play leaves the focus on the drawing. With the focus, the button would react to the space bar.
        this.playButton.addEventListener("mousedown", (event) => event.preventDefault());
    }

    private noteModifiers({ altKey, shiftKey }: PointerEvent): void {
        this.mayNotSnap = altKey || shiftKey;
    }

    /** The lowest and the highest w of the object. */
    private get range(): [number, number] {
        return this.criticalValues.range;
    }

    private moveTo(w: number): void {
        const [least, most] = this.range;
        this.mover.moveTo(Math.min(most, Math.max(least, w)));
        this.show();
    }

    /**
     * Moves the focus to the slider's value, after a drag or a step by assistive technology. The server then ends
     * playing.
     */
    private slid(): void {
        this.moveTo(this.snapped(this.input.valueAsNumber));
    }

    /**
     * Returns the w of the mark that is nearest to `w`, if the user drags without Alt and Shift and the mark is at most
     * kSnapDistance pixels away. Otherwise returns `w`; also while no marks are shown, or their w are not exact.
     */
    private snapped(w: number): number {
        const { all, isExact } = this.criticalValues;
        if (!this.isDragged || this.mayNotSnap || !isExact || all.length === 0 || all.length > kMaxMarks) return w;
        const [least, most] = this.range;
        const distance = (value: CriticalValue): number => Math.abs(value.w - w);
        const nearest = all.reduce((best, value) => (distance(value) < distance(best) ? value : best));
        const perPixel = (most - least) / Math.max(1, this.marks.getBoundingClientRect().width);
        return distance(nearest) <= kSnapDistance * perPixel ? nearest.w : w;
    }

    private keydown(event: KeyboardEvent): void {
        if (event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
        const [least, most] = this.range;
        const step = (most - least) / kKeySteps;
        const moves: Record<string, () => void> = {
            ArrowRight: () => this.moveTo(this.mover.w + step),
            ArrowUp: () => this.moveTo(this.mover.w + step),
            ArrowLeft: () => this.moveTo(this.mover.w - step),
            ArrowDown: () => this.moveTo(this.mover.w - step),
            Home: () => this.moveTo(least),
            End: () => this.moveTo(most),
            PageUp: () => this.pressKey(")", event.repeat),
            PageDown: () => this.pressKey("(", event.repeat),
        };
        const move = moves[event.key];
        if (!move) return;
        event.preventDefault();
        this.mover.beginGesture();
        move();
    }

    private pressKey(key: string, held: boolean): void {
        this.mover.cancelUnsentMove();
        this.events.pressKey(key, held);
    }

    private showPlaying({ playing, speed }: State): void {
        this.playButton.setAttribute("aria-pressed", String(playing));
        this.playButton.querySelector("span")!.textContent = playing ? "Pause" : "Play";
        const isListed = [...this.speed.options].some((one) => one !== this.otherSpeed && Number(one.value) === speed);
        if (isListed) {
            this.otherSpeed.remove();
        } else {
            this.otherSpeed.value = String(speed);
            this.otherSpeed.textContent = `${Number(speed.toFixed(2))}×`;
            this.speed.append(this.otherSpeed);
        }
        this.speed.value = String(speed);
    }

    private showRange(): void {
        const { all, isCurrent } = this.criticalValues;
        const [least, most] = this.range;
        const isEmpty = !(most > least);
        this.input.disabled = this.playButton.disabled = isEmpty;
        this.input.min = String(least);
        this.input.max = String(most);
        const at = (w: number): number => (w - least) / (most - least);
        this.marks.toggleAttribute("data-density", all.length > kMaxMarks);
        const outline = all.length > kMaxMarks ? densityOutline : criticalMarksPath;
        this.marks.setAttribute("d", isEmpty || !isCurrent ? "" : outline(all, at));
        this.show();
    }

    private show(): void {
        if (!this.state) return;
        const { section, slices } = this.state;
        const { w } = this.mover;
        this.input.value = String(w);
        const text = formatW(w, slices.spacing);
        const hasName = section.name !== "" && text === formatW(section.w, slices.spacing);
        this.input.setAttribute("aria-valuetext", `w = ${text}${hasName ? `, ${section.name}` : ""}`);
    }
}

/**
 * An SVG path with a vertical line for each critical value, in a square of side 1. `at` maps w to a position from 0 to
 * 1.
 */
function criticalMarksPath(values: CriticalValue[], at: (w: number) => number): string {
    return values.map(({ w }) => `M${at(w)} 0V1`).join("");
}

/**
 * An SVG path of a bar chart, in a square of side 1. A bar shows how many vertices, or changes of a field's topology,
 * lie near a w. `at` maps w to a position from 0 to 1.
 */
function densityOutline(values: CriticalValue[], at: (w: number) => number): string {
    const bins = new Array<number>(kDensityBins).fill(0);
    const binOf = (w: number): number => Math.min(kDensityBins - 1, Math.floor(at(w) * kDensityBins));
    for (const { w, vertices } of values) bins[binOf(w)]! += vertices ?? 1;
    const most = Math.max(...bins);
    const steps = bins.map((count, i) => `V${1 - count / most}H${(i + 1) / kDensityBins}`);
    return `M0 1${steps.join("")}V1Z`;
}
