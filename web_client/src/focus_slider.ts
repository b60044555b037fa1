// The slider below the picture: moves the focus slice from the lowest w of the object to the highest, and plays this
// motion. Its marks are the critical values of w: where vertices lie, or the body of a field changes its topology.

import type { Client, Slices, State } from "@oval4d/protocol";

import { type CriticalValue, CriticalValues } from "./critical_values";
import { byId } from "./element";
import { FocusMover } from "./focus_mover";
import { formatW } from "./format";

export interface SliderEvents {
    /** Presses a key of the key table. */
    pressKey(key: string, held: boolean): void;
    failed(error: Error): void;
}

const kSnapDistance = 4; // pixels: a drag this near to a mark snaps to the mark
const kKeySteps = 200; // steps of the arrow keys from one end to the other
const kMaxMarks = 60; // if there are more critical values, their density is shown instead of marks
const kDensityBins = 80;
const kSweepTime = 8; // seconds from one end to the other at the speed 1
// Seconds: a longer time between two animation frames, when the page is busy, counts as this time.
const kMaxInterval = 0.1;

export class FocusSlider {
    private readonly input = byId<HTMLInputElement>("focus-w");
    private readonly marks = document.querySelector<SVGPathElement>("#focus-marks path")!;
    private readonly section = byId("focus-section");
    private readonly playButton = byId<HTMLButtonElement>("focus-play");
    private readonly speed = byId<HTMLSelectElement>("focus-speed");
    private readonly criticalValues: CriticalValues;
    private readonly mover: FocusMover;
    private state: State | undefined;
    private isDragged = false;
    private mayNotSnap = false; // whether Alt or Shift is held
    private playedAt: number | undefined; // the time of the last step in milliseconds; undefined while not playing
    private direction = 1;

    constructor(
        client: Client,
        private readonly events: SliderEvents,
    ) {
        this.criticalValues = new CriticalValues(client, () => this.showRange());
        this.mover = new FocusMover(client, (error) => {
            if (error) {
                this.stop();
                events.failed(error);
            }
            this.show();
        });
        this.listen();
    }

    update(state: State): void {
        this.state = state;
        if (this.mover.recordAndCheckIfMovedElsewhere(state)) this.stop();
        this.criticalValues.update(state);
        const { name, vertices } = state.section;
        this.section.textContent = name || (vertices && `vertices: ${vertices}`);
        this.show();
    }

    /** Takes the critical values from the picture of the newest state. */
    updateFromPicture(slices: Slices): void {
        this.criticalValues.adoptFromPicture(slices);
    }

    /** Prepares for the states of a new connection. */
    prepareForNewConnection(): void {
        this.mover.prepareForNewConnection();
        this.stop();
    }

    /** Stops playing. */
    stop(): void {
        if (this.playedAt === undefined) return;
        this.playedAt = undefined;
        this.mover.cancelUnsentMove();
        this.showPlaying();
    }

    private listen(): void {
        const { input } = this;
        input.addEventListener("pointerdown", (event) => {
            this.isDragged = true;
            this.mover.begin();
            this.noteModifiers(event);
            this.stop();
        });
        for (const end of ["pointerup", "pointercancel"]) {
            // Firefox reports the last value of a drag after pointerup.
            window.addEventListener(end, () => setTimeout(() => (this.isDragged = false)));
        }
        window.addEventListener("pointermove", (event) => this.noteModifiers(event));
        input.addEventListener("input", () => this.slid());
        input.addEventListener("keydown", (event) => this.keydown(event));
        this.playButton.addEventListener("click", () => (this.playedAt === undefined ? this.play() : this.stop()));
        // The drawing keeps the focus: if the button got it, the space bar would press the button again.
        this.playButton.addEventListener("mousedown", (event) => event.preventDefault());
        document.addEventListener("visibilitychange", () => document.hidden && this.stop());
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

    /** Moves the focus after a drag of the slider, or a step by assistive technology. */
    private slid(): void {
        this.stop();
        this.moveTo(this.snapped(this.input.valueAsNumber));
    }

    /**
     * In a drag without Alt and Shift, the w of a mark that is at most kSnapDistance away, if there is one; otherwise
     * `w`.
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
        this.stop();
        this.mover.begin();
        move();
    }

    private pressKey(key: string, held: boolean): void {
        this.mover.cancelUnsentMove();
        this.events.pressKey(key, held);
    }

    private play(): void {
        this.playedAt = performance.now();
        this.mover.begin();
        this.showPlaying();
        requestAnimationFrame((now) => this.playOn(now));
    }

    private playOn(now: number): void {
        if (this.playedAt === undefined) return;
        const seconds = Math.min(kMaxInterval, Math.max(0, now - this.playedAt) / 1000);
        this.playedAt = now;
        const [least, most] = this.range;
        const w = this.mover.w + (this.direction * seconds * Number(this.speed.value) * (most - least)) / kSweepTime;
        if (w >= most) this.direction = -1;
        else if (w <= least) this.direction = 1;
        this.moveTo(w);
        requestAnimationFrame((next) => this.playOn(next));
    }

    private showPlaying(): void {
        const isPlaying = this.playedAt !== undefined;
        this.playButton.setAttribute("aria-pressed", String(isPlaying));
        this.playButton.querySelector("span")!.textContent = isPlaying ? "Pause" : "Play";
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
        const outline = all.length > kMaxMarks ? densityOutline : marksOutline;
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

/** A vertical line for each critical value, in a square of side 1. `at` converts w to a position from 0 to 1. */
function marksOutline(values: CriticalValue[], at: (w: number) => number): string {
    return values.map(({ w }) => `M${at(w)} 0V1`).join("");
}

/**
 * The outline of a bar chart, in a square of side 1, of how many vertices, or changes of a field's topology, lie near
 * each w.
 */
function densityOutline(values: CriticalValue[], at: (w: number) => number): string {
    const bins = new Array<number>(kDensityBins).fill(0);
    const binOf = (w: number): number => Math.min(kDensityBins - 1, Math.floor(at(w) * kDensityBins));
    for (const { w, vertices } of values) bins[binOf(w)]! += vertices ?? 1;
    const most = Math.max(...bins);
    const steps = bins.map((count, i) => `V${1 - count / most}H${(i + 1) / kDensityBins}`);
    return `M0 1${steps.join("")}V1Z`;
}
