// The dialog that exports a slice, the oval, the polytope or a picture to a file.

import type { Background, Client, ExportedFile, FileOptions, State, Viewport } from "@oval4d/protocol";

import { Dialog } from "./dialog";
import { download, fileName } from "./download";
import { byId, element } from "./element";
import { type ExportFormat, type FileOptionName, kFormats } from "./export_formats";
import { focusW, toSentence } from "./format";
import { loadFromStorage, saveToStorage } from "./storage";

const kChoicesKey = "oval4d.export";
const kAllFormats = kFormats.flatMap(({ formats }) => formats);

/** The chosen options of a file, without its format. protocol/README.md describes them for the message `get`. */
type ExportOptionValue = string | number | boolean;
type ExportChoices = Record<string, ExportOptionValue>;
const kOptionReaders: Record<FileOptionName, (value: string) => ExportOptionValue> = {
    of: String,
    body: String,
    size: Number,
    label: String,
    at: String,
    fit: Number,
    exact: parseOnOff,
};
const kOptions: Record<string, (value: string) => ExportOptionValue> = kOptionReaders;

type ExportedFileWithState = [file: ExportedFile, state: State];

export class ExportDialog {
    private readonly dialog = new Dialog("export");
    private readonly form = byId<HTMLFormElement>("export-form");
    private readonly description = byId("export-about");
    private readonly error = byId("export-error");
    private readonly submit = byId<HTMLButtonElement>("export-submit");
    private state: State | undefined;
    // The body that the user chose, "solid" or "skeleton", kept while the dialog forces "skeleton" for an element
    // without volume.
    private bodyToRestore: string | undefined;
    // Whether open() has set choices in order to export an element. These choices end when the dialog closes.
    private isForElement = false;
    private requestNumber = 0; // number of the current request; answers to earlier requests are ignored

    /** `size` returns the size of the picture on the page; `warn` shows the warnings about a saved file. */
    constructor(
        private readonly client: Client,
        private readonly size: () => Viewport,
        private readonly warn: (warnings: string[]) => void,
    ) {
        byId("export-formats").append(...kFormats.map((group) => formatButtons(group.title, group.formats)));
        this.restoreChoices();
        this.form.addEventListener("input", (event) => this.choiceChanged(event.target as HTMLInputElement));
        this.form.addEventListener("submit", (event) => {
            event.preventDefault();
            void this.downloadFile();
        });
        byId("export").addEventListener("close", () => this.dialog.isOpen || this.closed());
    }

    /** Opens the dialog. If `of` is given, it is chosen as the contents of the file until the dialog closes. */
    open(state: State, of?: string): void {
        this.closed(); // the event `close` of the last closing may not have arrived yet
        this.isForElement = of !== undefined;
        if (of !== undefined) {
            const format = this.format.of.includes(of) ? this.format : kAllFormats.find((one) => one.of.includes(of));
            this.formField("format").value = format!.name;
            this.formField("of").value = of;
        }
        this.fillForm(state);
        this.dialog.open(this.form.querySelector<HTMLElement>("[name=format]:checked")!);
    }

    /**
     * Saves the file that a text describes: the name of a format and options that replace choices in the dialog, as in
     * "stl fit=5". Does not open the dialog. Rejects with an Error if the text is not valid or the server refuses it.
     */
    async save(description: string, state: State): Promise<void> {
        const [name = "", ...words] = description.trim().split(/\s+/);
        const given = parseOptions(words);
        const format = kAllFormats.find((one) => one.name === name.toLowerCase());
        if (!format) {
            const names = [...kAllFormats.map((one) => one.name), "latency"].join(", ");
            throw new Error(`no format is called “${name}”; the formats are ${names}`);
        }
        const { options, file } = this.restoringForm(() => {
            this.formField("format").value = format.name;
            this.fillForm(state);
            if (this.format !== format) throw new Error(`${format.label} files contain only ${format.objects}`);
            const wrong = this.form.querySelector<HTMLInputElement>("input:enabled:invalid");
            if (wrong) throw new Error(`the ${wrong.name} in the export dialog is not valid: ${wrong.validationMessage}`);
            if (format.name === "png" && words.length > 0) {
                throw new Error("the size of a PNG is chosen in the export dialog");
            }
            const changed = withChangedOptions(this.options, given);
            return { options: changed, file: this.requestFile(format, changed) };
        });
        this.saveFile(await file, format, options);
    }

    /** Calls `use`, which may change the choices in the form; then restores the earlier choices. */
    private restoringForm<T>(use: () => T): T {
        const { bodyToRestore } = this;
        const inputs = [...this.form.querySelectorAll("input")].map((input) => {
            const { value, checked } = input;
            return { input, chosen: { value, checked } };
        });
        try {
            return use();
        } finally {
            for (const { input, chosen } of inputs) Object.assign(input, chosen);
            this.bodyToRestore = bodyToRestore;
            if (this.dialog.isOpen) this.showOptions();
        }
    }

    private fillForm(state: State): void {
        this.state = state;
        byId("export-of").textContent = state.polytope.name;
        this.showSliceValues();
        byId("export-highlight").textContent = elementNameOf(state.highlight);
        byId("export-coordinates").textContent = state.field ? "Histogram" : "Parallel coordinates";
        const limits = this.client.welcome?.limits;
        const pageSize = this.size();
        const isAsDisplayed = this.form.querySelector('[name=preset][value=""]:checked') !== null;
        for (const name of ["width", "height"] as const) {
            const field = this.formField(name);
            field.min = String(limits?.min_side ?? 1);
            field.max = String(limits?.[`max_${name}` as const] ?? 8192);
            if (isAsDisplayed || field.value === "") field.value = String(pageSize[name]);
        }
        this.selectPreset();
        this.offerFormats();
        this.showOptions();
    }

    /**
     * Updates the slice values shown while the dialog is open. The server exports the slices of its newest state, which
     * may differ from those shown at first: when the dialog opened, a move of the focus may have been on its way.
     */
    updateSlices({ section, slices }: State): void {
        if (!this.dialog.isOpen || !this.state) return;
        this.state = { ...this.state, section, slices };
        this.showSliceValues();
    }

    private showSliceValues(): void {
        byId("export-focus").textContent = `w = ${focusW(this.state!)}`;
        byId("export-oval").textContent = `${this.state!.slices.count} slices`;
    }

    /**
     * Hides the formats that cannot describe the object. If a hidden format is selected, selects the first format of
     * the list instead.
     */
    private offerFormats(): void {
        const kind = this.state?.field ? "fields" : "polytopes";
        for (const { name, objects } of kAllFormats) {
            const radio = this.form.querySelector<HTMLInputElement>(`[name=format][value="${name}"]`)!;
            radio.disabled = radio.parentElement!.hidden = objects !== undefined && objects !== kind;
            if (radio.disabled && radio.checked) this.formField("format").value = kAllFormats[0]!.name;
        }
    }

    private formField(name: string): HTMLInputElement {
        return this.form.elements.namedItem(name) as HTMLInputElement;
    }

    private get format(): ExportFormat {
        return kAllFormats.find(({ name }) => name === this.chosenValue("format")) ?? kAllFormats[0]!;
    }

    private chosenValue(name: string): string {
        return (this.form.elements.namedItem(name) as RadioNodeList | HTMLInputElement).value;
    }

    private choiceChanged({ name, value }: HTMLInputElement): void {
        if (name === "preset") {
            const { width, height } = this.size();
            const [w = String(width), h = String(height)] = value === "" ? [] : value.split("x");
            this.formField("width").value = w;
            this.formField("height").value = h;
        } else if (name === "width" || name === "height") {
            this.selectPreset();
        }
        this.abandonRequest();
        this.showOptions();
        this.storeChoices();
    }

    /** Selects the preset with the width and height in the form, if there is one. */
    private selectPreset(): void {
        const { width, height } = this.size();
        const size = `${this.formField("width").value}x${this.formField("height").value}`;
        for (const radio of this.form.querySelectorAll<HTMLInputElement>("[name=preset]")) {
            radio.checked = size === (radio.value || `${width}x${height}`);
        }
    }

    /**
     * Stores the choices for reloads of the page in this tab, except those that were made for the export of an element.
     */
    private storeChoices(): void {
        const choices = this.formValues();
        if (this.isForElement) for (const name of ["format", "of", "body"]) delete choices[name];
        else if (this.bodyToRestore !== undefined) choices["body"] = this.bodyToRestore;
        const stored = { ...loadFromStorage<Record<string, string>>(kChoicesKey), ...choices };
        if ("width" in choices && !("preset" in choices)) delete stored["preset"]; // no preset has this size
        saveToStorage(kChoicesKey, stored);
    }

    private closed(): void {
        this.abandonRequest();
        if (!this.isForElement) return;
        this.isForElement = false;
        this.form.reset();
        this.bodyToRestore = undefined;
        this.restoreChoices();
    }

    /** Restores the choices that storeChoices() has stored in this tab, if any. */
    private restoreChoices(): void {
        for (const [name, value] of Object.entries(loadFromStorage<Record<string, string>>(kChoicesKey) ?? {})) {
            const field = this.form.elements.namedItem(name) as RadioNodeList | HTMLInputElement | null;
            if (field) field.value = value;
        }
    }

    /** Shows the options that the chosen format offers, and hides the others. */
    private showOptions(): void {
        const { format } = this;
        this.description.textContent = this.state?.field ? format.forFields.about : format.about;
        for (const set of this.form.querySelectorAll<HTMLFieldSetElement>("[data-choice]")) {
            const used = (format.choices as string[]).includes(set.dataset["choice"]!);
            set.hidden = set.disabled = !used;
        }
        this.offerContents(format);
        this.offerSliceChoices(format);
        this.offerBodies();
        this.offerExact(format);
        this.submit.textContent = `Download ${format.label}`;
    }

    /**
     * Offers the contents that files of the format can have. If the chosen contents are not among them, chooses the
     * default of the format.
     */
    private offerContents(format: ExportFormat): void {
        const all = this.state?.field ? format.forFields.of : format.of;
        const of = all.filter((one) => one !== "highlight" || this.state?.highlight);
        if (of.length > 0 && !of.includes(this.chosenValue("of"))) this.formField("of").value = of[0]!;
        for (const radio of this.form.querySelectorAll<HTMLInputElement>("[name=of]")) {
            radio.disabled = radio.parentElement!.hidden = !of.includes(radio.value);
        }
    }

    /**
     * Offers a choice of slices only if the whole oval is exported. Shows the text field of the choice: `fit` for a
     * number of slices, `at` for values of w.
     */
    private offerSliceChoices({ choices }: ExportFormat): void {
        const set = this.form.querySelector<HTMLFieldSetElement>("[data-choice=slices]")!;
        set.hidden = set.disabled = !choices.includes("of") || this.chosenValue("of") !== "oval";
        for (const name of ["fit", "at"]) {
            const field = this.formField(name);
            field.disabled = field.parentElement!.hidden = this.chosenValue("slices") !== name;
        }
    }

    /**
     * Hides the choice "solid" for a face, an edge or a vertex, which has no volume, and selects the skeleton instead.
     */
    private offerBodies(): void {
        const isFlat = this.chosenValue("of") === "highlight" && this.state?.highlight?.element !== "cell";
        const body = this.formField("body");
        if (isFlat) {
            this.bodyToRestore ??= body.value;
            body.value = "skeleton";
        } else if (this.bodyToRestore !== undefined) {
            body.value = this.bodyToRestore;
            this.bodyToRestore = undefined;
        }
        const solid = this.form.querySelector<HTMLInputElement>('[name=body][value="solid"]')!;
        solid.disabled = solid.parentElement!.hidden = isFlat;
    }

    /** Offers the option `exact` only if the file will contain surfaces of a field. */
    private offerExact({ choices }: ExportFormat): void {
        const set = this.form.querySelector<HTMLFieldSetElement>("[data-choice=exact]")!;
        const hasSurfaces =
            choices.includes("exact") &&
            this.state?.field !== undefined &&
            ["focus", "oval"].includes(this.chosenValue("of")) &&
            !(choices.includes("body") && this.chosenValue("body") === "skeleton");
        set.hidden = set.disabled = !hasSurfaces;
    }

    private async downloadFile(): Promise<void> {
        const number = ++this.requestNumber;
        const { format, options } = this;
        this.error.textContent = "";
        this.submit.disabled = true;
        this.submit.textContent = "Creating the file…";
        try {
            const file = await this.requestFile(format, options);
            if (number !== this.requestNumber) return;
            this.saveFile(file, format, options);
            this.dialog.close();
        } catch (error) {
            if (number !== this.requestNumber) return;
            this.abandonRequest();
            this.error.textContent = toSentence((error as Error).message);
        }
    }

    /** The chosen options, without those that the format does not use: their fields are disabled. */
    private get options(): ExportChoices {
        const { side, ...values } = this.formValues(); // `side` is the size of a drawing
        const all = side === undefined ? values : { ...values, size: side };
        const chosen = Object.entries(all).filter(([name]) => name in kOptions);
        return Object.fromEntries(chosen.map(([name, value]) => [name, kOptions[name]!(value)]));
    }

    /**
     * Requests the state and a file. The state is the one that the file shows, because the server executes the two
     * requests one after the other.
     */
    private async requestFile({ name: format }: ExportFormat, options: ExportChoices): Promise<ExportedFileWithState> {
        const state = this.client.request({ type: "get", what: "state" });
        if (format !== "png") {
            const chosen = options as unknown as Partial<FileOptions>;
            const file = this.client.request({ type: "get", what: "file", ...chosen, format });
            return Promise.all([file, state]);
        }
        const { width, height, background } = this.formValues();
        const request = {
            width: Number(width),
            height: Number(height),
            ...(background && { background: background as Background }),
        };
        const [bytes, shown] = await Promise.all([this.client.request({ type: "get", what: "frame", ...request }), state]);
        return [{ bytes, warnings: [] }, shown];
    }

    private saveFile([{ bytes, warnings }, state]: ExportedFileWithState, format: ExportFormat, options: ExportChoices): void {
        download(bytes, fileNameFor(state, format, options), format.type);
        this.warn(warnings);
    }

    private formValues(): Record<string, string> {
        return Object.fromEntries(new FormData(this.form)) as Record<string, string>;
    }

    /** Makes the page ignore the answer to a request in progress, and clears the error. */
    private abandonRequest(): void {
        ++this.requestNumber;
        this.error.textContent = "";
        this.submit.disabled = false;
        this.submit.textContent = `Download ${this.format.label}`;
    }
}

function fileNameFor(
    state: State,
    { name, choices }: ExportFormat,
    { of, fit, at, body, exact }: ExportChoices,
): string {
    const parts = [state.polytope.name];
    if (fit !== undefined) parts.push(`${fit} slices`);
    else if (at !== undefined) parts.push("slices");
    else if (of === "highlight") parts.push(elementNameOf(state.highlight));
    else if (of === "focus") parts.push(`w ${focusW(state).replace("\u2212", "-")}`);
    else if (of === "coordinates" && state.field) parts.push("histogram");
    else if (of !== undefined && choices.includes("of")) parts.push(String(of));
    if (body === "skeleton") parts.push("skeleton");
    if (exact === true) parts.push("exact");
    return fileName(parts, name);
}

/** The name of an element, such as "cell 17". */
function elementNameOf(element: State["highlight"]): string {
    return element ? `${element.element} ${element.number}` : "";
}

/** Parses the value of an option that is on or off; throws an Error for another value. */
function parseOnOff(text: string): boolean {
    if (["on", "true", "yes", "1"].includes(text)) return true;
    if (["off", "false", "no", "0"].includes(text)) return false;
    throw new Error(`exact must be on or off, not “${text}”`);
}

/** Parses options from words such as "fit=5"; throws an Error if a word is not an option. */
function parseOptions(words: string[]): ExportChoices {
    const options: ExportChoices = {};
    for (const word of words) {
        const [, name = "", text = ""] = /^(\w+)=(.+)$/.exec(word) ?? [];
        if (!Object.hasOwn(kOptions, name)) {
            const all = Object.keys(kOptions).join(", ");
            throw new Error(`“${word}” is not an option, such as fit=5; the options are ${all}`);
        }
        const value = kOptions[name]!(text);
        if (Number.isNaN(value)) throw new Error(`${name} must be a number, not “${text}”`);
        options[name] = value;
    }
    return options;
}

/**
 * The chosen options after applying `changes`. The options `of`, `at` and `fit` choose slices together: if `changes`
 * contains one of the three, the chosen values of all three are discarded.
 */
function withChangedOptions({ of, at, fit, ...others }: ExportChoices, changes: ExportChoices): ExportChoices {
    const changesSlices = ["of", "at", "fit"].some((name) => name in changes);
    const kept = { ...(of !== undefined && { of }), ...(at !== undefined && { at }), ...(fit !== undefined && { fit }) };
    return { ...others, ...(changesSlices ? {} : kept), ...changes };
}

function formatButtons(title: string, formats: ExportFormat[]): HTMLElement {
    const radios = formats.map(({ name, label }) => {
        const radio = element("input", { type: "radio", name: "format", value: name, checked: name === "3mf" });
        return element("label", {}, radio, element("span", {}, label));
    });
    return element(
        "div",
        { class: "segments", role: "group", "aria-label": title },
        element("h3", { "aria-hidden": "true" }, title),
        ...radios,
    );
}
