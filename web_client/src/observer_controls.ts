// The controls for the frame of reference in which an object is shown: the pace of time, a velocity to follow, and the
// velocity of a Lorentz boost.

import type { Settings, State, Vector } from "@oval4d/protocol";

import { byId, element } from "./element";
import { parseNumbers } from "./fields";
import { formatDecimal, toSentence } from "./format";
import { NewestValueSender } from "./newest_only";
import { OldStateDetector } from "./old_state_detector";
import type { VelocitySetting } from "./reference_frame";

const kTypingDelay = 150; // milliseconds without further typing before a change is sent
const kPaceDigits = 2; // significant digits of the paces on the slider
const kAxes = ["x", "y", "z"] as const;
const kVelocitySettings: Record<VelocitySetting, string> = {
    follow: "What moves with this velocity stands still",
    boost: "Lorentz boost to an observer with this velocity; that of light is 1",
};

export class ReferenceFrameControls {
    private readonly pace = byId<HTMLInputElement>("observer-pace");
    private readonly paceValue = byId("observer-pace-value");
    private readonly error = byId("observer-error");
    private readonly components: Record<VelocitySetting, HTMLInputElement[]> = { follow: [], boost: [] };
    private readonly paces = new NewestValueSender<number>((pace) => this.applyPace(pace));
    private readonly velocities: Record<VelocitySetting, NewestValueSender<Vector>> = {
        follow: new NewestValueSender(async (follow) => void (await this.apply({ follow }, "follow"))),
        boost: new NewestValueSender(async (boost) => void (await this.apply({ boost }, "boost"))),
    };
    private continues = false; // whether the next pace joins the undo step of the last pace
    private readonly lastPace = new OldStateDetector();
    private statePace = 1; // the pace in the newest state
    private readonly errors = { pace: "", follow: "", boost: "" };

    /** `set` changes settings. If the server refuses, it must reject with an Error, whose message is shown. */
    constructor(private readonly set: (change: Settings & { continues?: boolean }) => Promise<{ revision: number }>) {
        for (const begin of ["pointerdown", "keydown"]) {
            this.pace.addEventListener(begin, () => (this.continues = false));
        }
        this.pace.addEventListener("input", () => {
            this.showError("pace", "");
            this.showPace(this.chosenPace);
            this.paces.submit(this.chosenPace, 0);
        });
        for (const name of ["follow", "boost"] as const) {
            this.components[name] = kAxes.map((axis) => this.componentInput(name, axis));
            const title = element("span", { title: kVelocitySettings[name] }, name === "follow" ? "Follow" : "Boost");
            byId("observer-velocities").append(element("div", {}, title, ...this.components[name]));
        }
    }

    /** Prepares for the states of a new connection. */
    prepareForNewConnection(): void {
        this.lastPace.prepareForNewConnection();
    }

    /**
     * Shows the frame of reference of a state. Does not change a text field in which the user types, nor a pace that
     * the server has not yet answered.
     */
    update(state: State): void {
        this.statePace = state.pace;
        const isOld = this.lastPace.recordAndCheckIfOld(state);
        if (!isOld && !this.paces.isBusy) this.showPace(state.pace);
        for (const name of ["follow", "boost"] as const) {
            this.components[name].forEach((input, i) => {
                if (document.activeElement === input || parseNumbers(input.value)[0] === state[name][i]) return;
                input.value = String(state[name][i]);
                this.showError(name, "");
            });
        }
    }

    /** The pace at the position of the slider's thumb, rounded to kPaceDigits significant digits. */
    private get chosenPace(): number {
        return Number((10 ** Number(this.pace.value)).toPrecision(kPaceDigits));
    }

    private showPace(pace: number): void {
        // The thumb stays where it is if its position already rounds to this pace. Otherwise the thumb could move back
        // to the rounded pace after each press of an arrow key, and never reach the next pace.
        if (this.chosenPace !== pace) this.pace.value = String(Math.log10(pace));
        const text = formatDecimal(pace, 3);
        this.paceValue.textContent = text;
        this.pace.setAttribute("aria-valuetext", text);
    }

    private changed(name: VelocitySetting): void {
        const velocity = this.components[name].flatMap(({ value }) => parseNumbers(value));
        const isValid = velocity.length === kAxes.length && velocity.every(Number.isFinite);
        this.showError(name, isValid ? "" : "Type a number for each of x, y and z, such as 0.3.");
        if (isValid) this.velocities[name].submit(velocity as Vector, kTypingDelay);
    }

    private async applyPace(pace: number): Promise<void> {
        const { continues } = this;
        this.continues = true;
        const revision = await this.apply({ pace, continues }, "pace");
        if (revision === undefined) this.showPace(this.statePace);
        else this.lastPace.noteRevision(revision);
    }

    /** Applies settings. Resolves to the revision after the change; to undefined if the server refuses it. */
    private async apply(
        change: Settings & { continues?: boolean },
        name: "pace" | VelocitySetting,
    ): Promise<number | undefined> {
        try {
            const { revision } = await this.set(change);
            this.showError(name, "");
            return revision;
        } catch (error) {
            this.showError(name, toSentence((error as Error).message));
            return undefined;
        }
    }

    private showError(name: "pace" | VelocitySetting, error: string): void {
        this.errors[name] = error;
        this.error.textContent = Object.values(this.errors).filter((one) => one !== "").join(" ");
        const inputs = name === "pace" ? [] : this.components[name];
        for (const input of inputs) input.setAttribute("aria-invalid", String(error !== ""));
    }

    private componentInput(name: VelocitySetting, axis: string): HTMLInputElement {
        const input = element("input", {
            ...{ type: "text", inputmode: "text", autocomplete: "off", spellcheck: "false", value: "0" },
            ...{ "aria-label": `${name} ${axis}`, "aria-describedby": "observer-error", "data-velocity": `${name} ${axis}` },
        });
        input.addEventListener("input", () => this.changed(name));
        return input;
    }
}
