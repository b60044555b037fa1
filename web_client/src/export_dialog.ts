// The dialog that exports a slice, the oval, the polytope or a picture to a file.

import type { Client, FileOptions, State, Viewport } from "@oval4d/protocol";

import { Dialog } from "./dialog";
import { download, fileName } from "./download";
import { byId, element } from "./element";
import { type Format, kFormats } from "./export_formats";
import { focusW, toSentence } from "./format";
import { readStored, writeStored } from "./storage";

const kChoicesKey = "oval4d.export";
const kAllFormats = kFormats.flatMap(({ formats }) => formats);

export class ExportDialog {
    private readonly dialog = new Dialog("export");
    private readonly form = byId<HTMLFormElement>("export-form");
    private readonly description = byId("export-about");
    private readonly error = byId("export-error");
    private readonly submit = byId<HTMLButtonElement>("export-submit");
    private state: State | undefined;
    private requestNumber = 0; // number of the current request; answers to earlier requests are ignored

    /** `size` returns the size of the picture on the page. */
    constructor(
        private readonly client: Client,
        private readonly size: () => Viewport,
    ) {
        byId("export-formats").append(...kFormats.map((group) => formatButtons(group.title, group.formats)));
        this.restoreChoices();
        this.form.addEventListener("input", (event) => this.choiceChanged(event.target as HTMLInputElement));
        this.form.addEventListener("submit", (event) => {
            event.preventDefault();
            void this.downloadFile();
        });
        byId("export").addEventListener("close", () => this.abandonRequest());
    }

    open(state: State): void {
        this.prepare(state);
        this.dialog.open(this.form.querySelector<HTMLElement>("[name=format]:checked")!);
    }

    /** Saves a file in the format of this name with the choices in the dialog, without opening it. */
    async save(name: string, state: State): Promise<void> {
        const format = kAllFormats.find((one) => one.name === name.toLowerCase());
        if (!format) {
            const names = [...kAllFormats.map((one) => one.name), "latency"].join(", ");
            throw new Error(`no format is called “${name}”; the formats are ${names}`);
        }
        this.field("format").value = format.name;
        this.prepare(state);
        if (this.format !== format) throw new Error(`${format.label} files contain only ${format.objects}`);
        const wrong = this.form.querySelector<HTMLInputElement>("input:enabled:invalid");
        if (wrong) throw new Error(`the ${wrong.name} in the export dialog is not valid: ${wrong.validationMessage}`);
        download(await this.requestFile(format), this.fileNameFor(format), format.type);
    }

    private prepare(state: State): void {
        this.state = state;
        byId("export-of").textContent = state.polytope.name;
        byId("export-focus").textContent = `w = ${focusW(state)}`;
        byId("export-oval").textContent = `${state.slices.count} slices`;
        const { limits = {} } = this.client.welcome ?? {};
        const { width, height } = this.size();
        for (const [name, pageSize] of Object.entries({ width, height })) {
            const field = this.field(name);
            field.min = String(limits["min_side"] ?? 1);
            field.max = String(limits[`max_${name}`] ?? 8192);
            field.value ||= String(pageSize);
        }
        this.selectPreset();
        this.showFormats();
        this.showOptions();
    }

    /** Hides the formats that do not describe the object. Selects the first one if the selected format is among them. */
    private showFormats(): void {
        const kind = this.state?.field ? "fields" : "polytopes";
        for (const { name, objects } of kAllFormats) {
            const radio = this.form.querySelector<HTMLInputElement>(`[name=format][value="${name}"]`)!;
            radio.disabled = radio.parentElement!.hidden = objects !== undefined && objects !== kind;
            if (radio.disabled && radio.checked) this.field("format").value = kAllFormats[0]!.name;
        }
    }

    private field(name: string): HTMLInputElement {
        return this.form.elements.namedItem(name) as HTMLInputElement;
    }

    private get format(): Format {
        return kAllFormats.find(({ name }) => name === this.chosenValue("format")) ?? kAllFormats[0]!;
    }

    private chosenValue(name: string): string {
        return (this.form.elements.namedItem(name) as RadioNodeList | HTMLInputElement).value;
    }

    private choiceChanged({ name, value }: HTMLInputElement): void {
        if (name === "preset") {
            const { width, height } = this.size();
            const [w = String(width), h = String(height)] = value === "" ? [] : value.split("x");
            this.field("width").value = w;
            this.field("height").value = h;
        } else if (name === "width" || name === "height") {
            this.selectPreset();
        }
        this.abandonRequest();
        this.showOptions();
        writeStored(kChoicesKey, { ...readStored<object>(kChoicesKey), ...this.formValues() });
    }

    /** Selects the preset that equals the current size, if any. */
    private selectPreset(): void {
        const { width, height } = this.size();
        const size = `${this.field("width").value}x${this.field("height").value}`;
        for (const radio of this.form.querySelectorAll<HTMLInputElement>("[name=preset]")) {
            radio.checked = size === (radio.value || `${width}x${height}`);
        }
    }

    /** Restores the previous choices. */
    private restoreChoices(): void {
        for (const [name, value] of Object.entries(readStored<Record<string, string>>(kChoicesKey) ?? {})) {
            const field = this.form.elements.namedItem(name) as RadioNodeList | HTMLInputElement | null;
            if (field) field.value = value;
        }
    }

    /** Shows the options that the chosen format offers, and hides the others. */
    private showOptions(): void {
        const { format } = this;
        this.description.textContent = format.about;
        for (const set of this.form.querySelectorAll<HTMLFieldSetElement>("[data-choice]")) {
            const used = (format.choices as string[]).includes(set.dataset["choice"]!);
            set.hidden = set.disabled = !used;
        }
        this.showContents(format);
        this.submit.textContent = `Download ${format.label}`;
    }

    /** Offers what files of the format can contain, and chooses the default if they cannot contain what is chosen. */
    private showContents({ of }: Format): void {
        if (of.length > 0 && !of.includes(this.chosenValue("of"))) this.field("of").value = of[0]!;
        for (const radio of this.form.querySelectorAll<HTMLInputElement>("[name=of]")) {
            radio.disabled = radio.parentElement!.hidden = !of.includes(radio.value);
        }
    }

    private async downloadFile(): Promise<void> {
        const number = ++this.requestNumber;
        const { format } = this;
        this.error.textContent = "";
        this.submit.disabled = true;
        this.submit.textContent = "Creating the file…";
        try {
            const bytes = await this.requestFile(format);
            if (number !== this.requestNumber) return;
            download(bytes, this.fileNameFor(format), format.type);
            this.dialog.close();
        } catch (error) {
            if (number !== this.requestNumber) return;
            this.abandonRequest();
            this.error.textContent = toSentence((error as Error).message);
        }
    }

    /** Requests the file. Fields that the format does not use are disabled, and therefore omitted. */
    private requestFile({ name }: Format): Promise<Uint8Array> {
        const fields = this.formValues();
        if (name === "png") {
            const [width, height] = [Number(fields["width"]), Number(fields["height"])];
            return this.client.request({ type: "get", what: "frame", width, height });
        }
        const { size, ...rest } = fields;
        const options = { ...rest, ...(size !== undefined && { size: Number(size) }) };
        return this.client.request({ type: "get", what: "file", ...(options as unknown as FileOptions) });
    }

    private formValues(): Record<string, string> {
        return Object.fromEntries(new FormData(this.form)) as Record<string, string>;
    }

    private fileNameFor({ name, choices }: Format): string {
        const state = this.state!;
        const parts = [state.polytope.name];
        if (choices.includes("of")) {
            const of = this.chosenValue("of");
            parts.push(of === "focus" ? `w ${focusW(state).replace("\u2212", "-")}` : of);
        }
        if (choices.includes("body") && this.chosenValue("body") === "skeleton") parts.push("skeleton");
        return fileName(parts, name);
    }

    /** Abandons a request in progress, and clears the error. */
    private abandonRequest(): void {
        ++this.requestNumber;
        this.error.textContent = "";
        this.submit.disabled = false;
        this.submit.textContent = `Download ${this.format.label}`;
    }
}

function formatButtons(title: string, formats: Format[]): HTMLElement {
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
