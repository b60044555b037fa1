// The panel for the formula of a field, with its constants, levels and domain. The picture follows every change. Only
// one change at a time is sent to the server; of the changes made meanwhile, only the newest is sent next.

import type { Box, Caps, Inside, RequestError, Settings, Slices, State } from "@oval4d/protocol";

import { byId, element } from "./element";
import { kExamples } from "./field_examples";
import { isField, kFormulaName, kMaxLevels, kUsualBox, labelOfQuantity, parseNumbers, fieldQuery, type FormulaWithBox } from "./fields";
import { FogEditor } from "./fog_editor";
import { toSentence } from "./format";
import { comparisonOperatorIn } from "./formula";
import { FormulaInput } from "./formula_input";
import { ConstantSliders } from "./constant_sliders";
import { NewestValueSender } from "./newest_only";
import { ReferenceFrameControls } from "./observer_controls";
import { loadFromStorage, saveToStorage } from "./storage";

export interface FieldPanelEvents {
    /**
     * Loads a formula, then changes settings; resolves to the revision after both commands. `continues` tells whether
     * both belong to the undo step of the previous command. Rejects with an Error if the server refuses the formula.
     */
    loadFormula(field: FormulaWithBox, settings: Settings, continues: boolean): Promise<number>;
    /** Changes settings; rejects with an Error whose message is shown. */
    changeSettings(settings: Settings & { continues?: boolean }): Promise<{ revision: number }>;
    /** Gives the user `address`, a link that opens the field of the panel. */
    shareAddress(address: string): void;
    /** Called when the panel has been closed. */
    closed(): void;
}

const kTypingDelay = 150; // milliseconds without further typing before a change is sent
const kSeries = 1500; // milliseconds: a change that follows the last one within this time is undone together with it
const kMaxTyped = 100; // the panel remembers what the user typed for at most this many formulas, for undo
const kStorageKey = "oval4d.formula";
const kAxes = ["x", "y", "z", "w"] as const;
const kOfValues = /^values: /; // how an error message about the coloring formula begins

export class FieldPanel {
    private readonly root = byId("field");
    private readonly formula = this.makeFormulaInput("");
    private readonly values = this.makeFormulaInput("-values");
    private readonly levels = byId<HTMLInputElement>("field-levels");
    private readonly levelsError = byId("field-levels-error");
    private readonly boxError = byId("field-box-error");
    private readonly example = byId<HTMLSelectElement>("field-example");
    private readonly ends: HTMLInputElement[]; // the text fields of the box: from and to, for each of x, y, z and w
    private readonly sliders = new ConstantSliders(byId("field-constants"), (text) => {
        this.formula.value = text;
        this.scheduleLoad(0);
    });
    private readonly loads = new NewestValueSender<FormulaWithBox>((field) => this.loadFormula(field));
    private readonly levelSettings = new NewestValueSender<number[]>((levels) => this.applySettings({ levels }));
    private readonly capSettings = new NewestValueSender<Caps>((caps) => this.applySettings({ caps }));
    private readonly insideSettings = new NewestValueSender<Inside>((inside) => this.applySettings({ inside }));
    private readonly fog = new FogEditor((settings) => this.events.changeSettings(settings));
    private readonly observer = new ReferenceFrameControls((settings) => this.events.changeSettings(settings));
    private loaded: FormulaWithBox | undefined; // the formula that this page loaded last
    // The settings that loadFormula() sent last, and the revision in the server's answer. Undefined after a state of
    // this or a later revision has arrived.
    private sent: { settings: Settings; revision: number } | undefined;
    private state: State | undefined;
    // The last formula that this page loaded: its revision, the time of loading as in performance.now(), and whether
    // recordServerText() has seen a state with this formula.
    private lastLoad: { revision: number; time: number; isRecorded: boolean } | undefined;
    private shownText = ""; // formulaKeyOf() of the newest state: a text that identifies its formula
    // formulaKeyOf() of the last state whose formula this page loaded itself, or adopted in showForeignFormula().
    private ownText = "";
    // What the user typed, by the formulaKeyOf() of the first state with the loaded formula.
    private readonly typedFields = new Map<string, FormulaWithBox>();

    constructor(private readonly events: FieldPanelEvents) {
        this.ends = kAxes.flatMap((axis) => ["from", "to"].map((end) => rangeEndInput(axis, end)));
        byId("field-ranges").append(...kAxes.map((axis, i) => rangeRow(axis, this.ends[2 * i]!, this.ends[2 * i + 1]!)));
        this.example.append(...kExamples.map(({ title }, i) => element("option", { value: String(i) }, title)));
        this.loaded = loadFromStorage<FormulaWithBox>(kStorageKey);
        this.write(this.loaded ?? { formula: kExamples[0]!.formula, box: kUsualBox });
        for (const end of this.ends) end.addEventListener("input", () => this.scheduleLoad(kTypingDelay));
        this.example.addEventListener("change", () => this.startFromExample(Number(this.example.value)));
        this.levels.addEventListener("input", () => this.changeLevels());
        byId("field-inside").addEventListener("change", (event) => {
            this.insideSettings.submit((event.target as HTMLInputElement).value as Inside, 0);
        });
        byId("field-caps").addEventListener("change", (event) => {
            this.capSettings.submit((event.target as HTMLInputElement).value as Caps, 0);
        });
        byId("field-link").addEventListener("click", () => this.events.shareAddress(this.address()));
        byId("field-close").addEventListener("click", () => this.close());
        byId("field-form").addEventListener("submit", (event) => event.preventDefault());
    }

    private makeFormulaInput(of: string): FormulaInput {
        const ids = { input: of === "" ? "field-formula" : `field${of}`, error: `field${of}-error`, excerpt: `field${of}-excerpt` };
        return new FormulaInput(
            ids,
            () => this.scheduleLoad(kTypingDelay),
            () => this.scheduleLoad(0),
        );
    }

    get isOpen(): boolean {
        return !this.root.hidden;
    }

    /**
     * Opens the panel. If the session does not show a field, loads the formula in the panel's text field into the
     * session.
     */
    open(): void {
        this.setOpen(true);
        // On a touch screen, a text field with the focus would open the keyboard over the panel.
        (matchMedia("(pointer: coarse)").matches ? byId("field-close") : this.formula.input).focus();
        if (this.state && !isField(this.state)) this.scheduleLoad(0);
    }

    close(): void {
        this.setOpen(false);
        this.events.closed();
    }

    /**
     * Shows a formula that another part of the page has loaded, and stores it as if the user had typed it in the panel.
     * `revision` is the revision in the server's answer.
     */
    adoptLoaded(field: FormulaWithBox, revision: number): void {
        this.write(field);
        saveToStorage(kStorageKey, field);
        this.recordLoad(field, revision);
        this.showError(undefined);
    }

    private recordLoad(field: FormulaWithBox, revision: number): void {
        this.loaded = field;
        this.lastLoad = { revision, time: performance.now(), isRecorded: false };
        this.recordServerText();
    }

    prepareForNewConnection(): void {
        this.fog.prepareForNewConnection();
        this.observer.prepareForNewConnection();
    }

    update(state: State): void {
        this.state = state;
        if (this.sent && state.revision >= this.sent.revision) this.sent = undefined;
        this.showForeignFormula(state);
        const { levels = [], inside = "below", caps = "plain" } = state;
        for (const control of this.root.querySelectorAll<HTMLInputElement>("[data-of=field]")) {
            control.disabled = !isField(state);
        }
        if (document.activeElement !== this.levels) this.showLevels(levels);
        const quantity = labelOfQuantity(state.field?.quantity);
        for (const part of this.root.querySelectorAll("[data-quantity]")) part.textContent = quantity && ` (${quantity})`;
        this.observer.update(state);
        this.fog.update(state);
        for (const [name, value] of Object.entries({ inside, caps })) {
            this.root.querySelector<HTMLInputElement>(`[name=${name}][value=${value}]`)!.checked = true;
        }
    }

    updateFromPicture(picture: Slices): void {
        this.fog.updateFromPicture(picture);
    }

    /**
     * Records how the server writes the formula that this page loaded last. The server omits superfluous blanks and
     * parentheses, and writes constants as numbers. The text comes from the first state with this formula.
     */
    private recordServerText(): void {
        const { lastLoad, state, loaded } = this;
        if (!lastLoad || lastLoad.isRecorded || !loaded || !state || state.revision < lastLoad.revision) return;
        lastLoad.isRecorded = true;
        this.sliders.learn(loaded.formula, state.field?.formula ?? "");
        this.ownText = formulaKeyOf(state);
        if (this.typedFields.size >= kMaxTyped) this.typedFields.clear();
        this.typedFields.set(this.ownText, loaded);
    }

    /**
     * Shows the formula of a state, if it is not the formula that this page loaded last: for example, after an undo.
     */
    private showForeignFormula(state: State): void {
        this.recordServerText();
        const text = formulaKeyOf(state);
        const isNew = text !== this.shownText;
        this.shownText = text;
        const { formula, box, values } = state.field ?? {};
        const isOwn = text === this.ownText || this.lastLoad?.isRecorded === false;
        if (!isNew || formula === undefined || !box || this.loads.isBusy || isOwn) return;
        this.ownText = text;
        this.loaded = this.typedFields.get(text) ?? { formula, box, ...(values?.formula && { values: values.formula }) };
        this.write(this.loaded);
        this.showError(undefined);
    }

    private setOpen(open: boolean): void {
        this.root.hidden = !open;
        document.body.toggleAttribute("data-field-open", open); // the panel takes the place of the tools
    }

    /** Shows a formula, its box and the formula of its colors in the text fields. */
    private write({ formula, box, values = "" }: FormulaWithBox): void {
        this.formula.value = formula;
        this.values.value = values;
        this.ends.forEach((end, i) => (end.value = String(box[Math.floor(i / 2)]![i % 2])));
        this.sliders.update(formula);
        this.readBox(); // clears an error about the previous box
    }

    private startFromExample(example: number): void {
        this.write(kExamples[example]!);
        this.loaded = undefined; // so that loadFormula() sends no levels or slices of the old field
        this.example.selectedIndex = 0;
        this.scheduleLoad(0);
    }

    /**
     * Loads the typed formula after `delay` milliseconds without another change; does nothing if the typed box is not
     * valid.
     */
    private scheduleLoad(delay: number): void {
        this.sliders.update(this.formula.value);
        const box = this.readBox();
        if (!box) return;
        const field = this.typedField(box);
        saveToStorage(kStorageKey, field);
        this.loads.submit(field, delay);
    }

    /** The formulas in the text fields, together with the given box. */
    private typedField(box: Box): FormulaWithBox {
        const values = this.values.value.trim();
        return { formula: this.formula.value, box, ...(values !== "" && { values }) };
    }

    /** The box in the text fields. If a range is not valid, shows an error, and returns undefined. */
    private readBox(): Box | undefined {
        const wrong = kAxes.filter((_, i) => {
            const pair = [this.ends[2 * i]!, this.ends[2 * i + 1]!];
            const [from = NaN, to = NaN] = pair.map(({ value }) => parseNumber(value));
            const isValid = from < to && to - from < Infinity;
            for (const end of pair) end.setAttribute("aria-invalid", String(!isValid));
            return !isValid;
        });
        this.boxError.textContent = wrong.length > 0 ? `${wrong.join(", ")}: from a smaller to a larger number.` : "";
        if (wrong.length > 0) return undefined;
        return kAxes.map((_, i) => [parseNumber(this.ends[2 * i]!.value), parseNumber(this.ends[2 * i + 1]!.value)]) as Box;
    }

    private async loadFormula(field: FormulaWithBox): Promise<void> {
        this.root.setAttribute("aria-busy", "true");
        try {
            const settings = this.keptSettings(field);
            const revision = await this.events.loadFormula(field, settings, this.continuesSeries(field));
            this.sent = { settings, revision };
            this.recordLoad(field, revision);
            this.showError(undefined);
        } catch (error) {
            if ((error as RequestError).code !== "not_connected") this.showError((error as Error).message);
        }
        this.root.setAttribute("aria-busy", "false");
    }

    /**
     * Whether loading this field continues the previous undo step. Quick changes of the same formula, such as a drag of
     * a slider, are undone together.
     */
    private continuesSeries({ formula }: FormulaWithBox): boolean {
        const { loaded, lastLoad, state } = this;
        // A state newer than the last load shows that another command came after the load.
        if (!loaded || !lastLoad || !state || state.revision > lastLoad.revision) return false;
        return performance.now() - lastLoad.time < kSeries && comparisonOperatorIn(loaded.formula) === comparisonOperatorIn(formula);
    }

    /**
     * The settings that stay when the user edits the formula. They are sent with it, because the server treats an
     * edited formula as a new object and would choose new settings. Empty if the present object is not a formula that
     * this panel has loaded or shown.
     */
    private keptSettings({ formula, box }: FormulaWithBox): Settings {
        const { loaded, state } = this;
        if (!loaded || !state || !isField(state) || state.polytope.name !== kFormulaName) return {};
        const { levels, inside, fog, slices, point } = { ...state, ...this.sent?.settings };
        const keepsLevels = levels && inside && comparisonOperatorIn(loaded.formula) === comparisonOperatorIn(formula);
        return {
            ...(keepsLevels && { levels, inside, ...(fog && { fog }) }),
            ...(String(loaded.box) === String(box) && { slices: focusAndOffsetOf(slices), point }),
        };
    }

    /**
     * Shows an error of the server beside the formula that it concerns: the formula of the field, or the formula that
     * colors the surfaces. Clears the error beside the other formula. If `message` is undefined, clears both errors.
     */
    private showError(message: string | undefined): void {
        const isOfValues = message !== undefined && kOfValues.test(message);
        this.formula.showError(isOfValues ? undefined : message);
        this.values.showError(isOfValues ? message.replace(kOfValues, "") : undefined);
    }

    private changeLevels(): void {
        const levels = parseNumbers(this.levels.value);
        const isValid = levels.length > 0 && levels.length <= kMaxLevels && levels.every(Number.isFinite);
        this.showLevelsError(isValid ? "" : `Type 1 to ${kMaxLevels} numbers, such as 0, 0.5.`);
        if (isValid) this.levelSettings.submit(levels, kTypingDelay);
    }

    private async applySettings(settings: Settings): Promise<void> {
        try {
            await this.events.changeSettings(settings);
            this.showLevelsError("");
        } catch (error) {
            this.showLevelsError(toSentence((error as Error).message));
        }
    }

    /** Shows the levels of the state. If they differ from the typed levels, clears an error about the typed ones. */
    private showLevels(levels: number[]): void {
        const text = levels.join(", ");
        if (this.levels.value === text) return;
        this.levels.value = text;
        this.showLevelsError("");
    }

    private showLevelsError(error: string): void {
        this.levelsError.textContent = error;
        this.levels.setAttribute("aria-invalid", String(error !== ""));
    }

    /** An address that opens the field of the panel. */
    private address(): string {
        const address = new URL(location.href);
        address.hash = "";
        address.search = "";
        const box = this.readBox() ?? kUsualBox;
        return `${address.href}?${fieldQuery(this.typedField(box), this.state ?? {})}`;
    }
}

/** A text that identifies the formula, box and coloring formula of a state; "" if the state has no formula. */
function formulaKeyOf({ field }: State): string {
    return field?.formula === undefined ? "" : `${field.formula} ${String(field.box)} ${field.values?.formula ?? ""}`;
}

/**
 * The settings that determine the position of the slices along w, which stays when a formula is edited. The distance
 * between slices is omitted, because the server chooses a new one for each object.
 */
function focusAndOffsetOf({ focus = 0, offset = 0 }: NonNullable<Settings["slices"]>): NonNullable<Settings["slices"]> {
    return { focus, offset };
}

/** The number that a text consists of; NaN for other texts. */
function parseNumber(text: string): number {
    const numbers = parseNumbers(text);
    return numbers.length === 1 ? numbers[0]! : NaN;
}

function rangeEndInput(axis: string, end: string): HTMLInputElement {
    return element("input", {
        ...{ type: "text", inputmode: "text", autocomplete: "off", spellcheck: "false" },
        ...{ "aria-label": `${axis} ${end}`, "aria-describedby": "field-box-error", "data-end": `${axis} ${end}` },
    });
}

function rangeRow(axis: string, from: HTMLInputElement, to: HTMLInputElement): HTMLElement {
    const name = element("b", { class: `plane axis-${axis}`, "aria-hidden": "true" }, axis);
    return element("div", {}, name, from, element("span", { "aria-hidden": "true" }, "to"), to);
}
