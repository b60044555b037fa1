// Sliders for the named constants of a formula, such as a in "x^2 - a; a=0.7". Moving a slider rewrites the formula.

import { element } from "./element";
import { constantsOf, sliderRangeFor, textOfSliderValue, constantValues, withConstant } from "./formula";

const kDigits = 4; // significant digits of the values beside the sliders

/** The slider of a constant, and the text that shows the constant's value. `step` is the slider's step. */
interface ConstantSliderRow {
    slider: HTMLInputElement;
    value: HTMLOutputElement;
    step: number;
}

export class ConstantSliders {
    private readonly rows = new Map<string, ConstantSliderRow>(); // the sliders, by the names of their constants
    // The number that each text stands for. The keys are texts that users have typed as values of constants, such as
    // "pi/2".
    private readonly values = new Map<string, number>();
    private formula = "";

    /** `changed` is called with the new text of the formula. */
    constructor(
        private readonly root: HTMLElement,
        private readonly changed: (formula: string) => void,
    ) {}

    /**
     * Learns the values of constants that are typed as texts, such as "pi/2". `typed` is the formula as the user typed
     * it; `written` is the same formula as the server writes it, with numbers.
     */
    learn(typed: string, written: string): void {
        for (const [text, value] of constantValues(typed, written)) this.values.set(text, value);
        this.update(this.formula);
    }

    /** Shows the constants of a formula. A slider keeps its range as long as the range contains the value. */
    update(formula: string): void {
        this.formula = formula;
        const constants = constantsOf(formula, this.values);
        const names = constants.map(({ name }) => name);
        if (names.join() !== [...this.rows.keys()].join()) {
            const kept = new Map(this.rows);
            this.rows.clear();
            for (const name of names) this.rows.set(name, kept.get(name) ?? this.makeRow(name));
            this.root.replaceChildren(...[...this.rows.values()].map(({ slider }) => slider.closest("label")!));
        }
        this.root.hidden = names.length === 0;
        for (const { name, value } of constants) this.show(this.rows.get(name)!, value);
    }

    private show(row: ConstantSliderRow, value: number): void {
        const { slider } = row;
        if (slider.min === "" || value < Number(slider.min) || value > Number(slider.max)) {
            const { min, max, step } = sliderRangeFor(value);
            Object.assign(slider, { min: String(min), max: String(max), step: String(step) });
            row.step = step;
        }
        row.value.textContent = String(Number(value.toPrecision(kDigits)));
        slider.value = String(value);
    }

    private makeRow(name: string): ConstantSliderRow {
        const slider = element("input", { type: "range", "data-constant": name, "aria-label": name });
        const value = element("output");
        element("label", {}, element("i", { "aria-hidden": "true" }, name), slider, value);
        const row = { slider, value, step: 1 };
        slider.addEventListener("input", () => {
            this.changed(withConstant(this.formula, name, textOfSliderValue(Number(slider.value), row.step)));
        });
        return row;
    }
}
