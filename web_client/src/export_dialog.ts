// The dialog for exporting a slice, the oval, the polytope or a picture to a file.

import type { Client, FileOptions, State, Viewport } from "@oval4d/protocol";

import { Dialog } from "./dialog";
import { download, fileName } from "./download";
import { byId, element } from "./element";
import { type Format, kFormats } from "./export_formats";
import { focusW, length, sentence } from "./format";
import { recall, remember } from "./memory";

const kChosen = "oval4d.export";
const kAll = kFormats.flatMap(({ formats }) => formats);

export class ExportDialog {
    private readonly dialog = new Dialog("export");
    private readonly form = byId<HTMLFormElement>("export-form");
    private readonly about = byId("export-about");
    private readonly error = byId("export-error");
    private readonly submit = byId<HTMLButtonElement>("export-submit");
    private state: State | undefined;
    private request = 0; // number of the current request: answers to abandoned ones are dropped

    /** `size` returns the size of the picture on the page. */
    constructor(
        private readonly client: Client,
        private readonly size: () => Viewport,
    ) {
        byId("export-formats").append(...kFormats.map((group) => choices(group.title, group.formats)));
        this.recall();
        this.form.addEventListener("input", (event) => this.changed(event.target as HTMLInputElement));
        this.form.addEventListener("submit", (event) => {
            event.preventDefault();
            void this.make();
        });
        byId("export").addEventListener("close", () => this.endRequest());
    }

    open(state: State): void {
        this.state = state;
        byId("export-of").textContent = state.polytope.name;
        byId("export-focus").textContent = `w = ${length(focusW(state))}`;
        byId("export-oval").textContent = `${state.slices.count} slices`;
        const { limits = {} } = this.client.welcome ?? {};
        const { width, height } = this.size();
        for (const [name, own] of Object.entries({ width, height })) {
            const field = this.field(name);
            field.min = String(limits["min_side"] ?? 1);
            field.max = String(limits[`max_${name}`] ?? 8192);
            field.value ||= String(own);
        }
        this.preset();
        this.show();
        this.dialog.open(this.form.querySelector<HTMLElement>("[name=format]:checked")!);
    }

    private field(name: string): HTMLInputElement {
        return this.form.elements.namedItem(name) as HTMLInputElement;
    }

    private get format(): Format {
        return kAll.find(({ name }) => name === this.chosen("format")) ?? kAll[0]!;
    }

    private chosen(name: string): string {
        return (this.form.elements.namedItem(name) as RadioNodeList | HTMLInputElement).value;
    }

    private changed({ name, value }: HTMLInputElement): void {
        if (name === "preset") {
            const { width, height } = this.size();
            const [w = String(width), h = String(height)] = value === "" ? [] : value.split("x");
            this.field("width").value = w;
            this.field("height").value = h;
        } else if (name === "width" || name === "height") {
            this.preset();
        }
        this.endRequest();
        this.show();
        remember(kChosen, { ...recall<object>(kChosen), ...this.fields() });
    }

    /** Selects the preset that equals the current size, if any. */
    private preset(): void {
        const { width, height } = this.size();
        const at = `${this.field("width").value}x${this.field("height").value}`;
        for (const one of this.form.querySelectorAll<HTMLInputElement>("[name=preset]")) {
            one.checked = at === (one.value || `${width}x${height}`);
        }
    }

    /** Restores the previous choices. */
    private recall(): void {
        for (const [name, value] of Object.entries(recall<Record<string, string>>(kChosen) ?? {})) {
            const field = this.form.elements.namedItem(name) as RadioNodeList | HTMLInputElement | null;
            if (field) field.value = value;
        }
    }

    /** Shows only the options that the format offers. */
    private show(): void {
        const { format } = this;
        this.about.textContent = format.about;
        for (const set of this.form.querySelectorAll<HTMLFieldSetElement>("[data-choice]")) {
            const used = (format.choices as string[]).includes(set.dataset["choice"]!);
            set.hidden = set.disabled = !used;
        }
        this.submit.textContent = `Download ${format.label}`;
    }

    private async make(): Promise<void> {
        const turn = ++this.request;
        const { format } = this;
        this.error.textContent = "";
        this.submit.disabled = true;
        this.submit.textContent = "Creating the file…";
        try {
            const bytes = await this.bytes(format);
            if (turn !== this.request) return;
            download(bytes, this.name(format), format.type);
            this.dialog.close();
        } catch (error) {
            if (turn !== this.request) return;
            this.endRequest();
            this.error.textContent = sentence((error as Error).message);
        }
    }

    /** Requests the file. Fields that the format does not use are disabled, and therefore omitted. */
    private bytes({ name }: Format): Promise<Uint8Array> {
        const fields = this.fields();
        if (name === "png") {
            const [width, height] = [Number(fields["width"]), Number(fields["height"])];
            return this.client.request({ type: "get", what: "frame", width, height });
        }
        const { size, ...rest } = fields;
        const options = size === undefined ? rest : { ...rest, size: Number(size) };
        return this.client.request({ type: "get", what: "file", ...(options as unknown as FileOptions) });
    }

    private fields(): Record<string, string> {
        return Object.fromEntries(new FormData(this.form)) as Record<string, string>;
    }

    private name({ name, choices }: Format): string {
        const state = this.state!;
        const parts = [state.polytope.name];
        if (choices.includes("of")) {
            parts.push(this.chosen("of") === "oval" ? "oval" : `w ${length(focusW(state)).replace("\u2212", "-")}`);
        }
        if (choices.includes("body") && this.chosen("body") === "frame") parts.push("frame");
        return fileName(parts, name);
    }

    /** Abandons a request in progress, and clears the error. */
    private endRequest(): void {
        ++this.request;
        this.error.textContent = "";
        this.submit.disabled = false;
        this.submit.textContent = `Download ${this.format.label}`;
    }
}

function choices(title: string, formats: Format[]): HTMLElement {
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
