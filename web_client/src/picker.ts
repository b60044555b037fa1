// The dialog for choosing a polytope. It searches the catalogue, or builds a polytope from a symbol that is not listed.

import type { CatalogueEntry } from "@oval4d/protocol";

import { Catalogue } from "./catalogue";
import { Dialog } from "./dialog";
import { byId, element } from "./element";
import { formatCount, toSentence } from "./format";

const kDataFamily = "data"; // the family of catalogue entries for arrays in the server's data folder
const kFieldFamilies = ["fields", kDataFamily];
const kCounted = ["vertices", "edges", "2-faces", "cells"]; // the headings of the columns with counts
const kPage = 8; // number of options by which Page Up and Page Down move
const kSteps: Record<string, number> = { ArrowDown: 1, ArrowUp: -1, PageDown: kPage, PageUp: -kPage };

export class PolytopePicker {
    /** The catalogue that the server listed last; empty before the first list. */
    catalogue = new Catalogue([]);
    private readonly dialog = new Dialog("picker");
    private readonly input = byId<HTMLInputElement>("picker-search");
    private readonly list = byId("picker-list");
    private readonly error = byId("picker-error");
    private readonly resultCount = byId("picker-found");
    private readonly options = new Map<CatalogueEntry, HTMLElement>();
    private readonly typedOption = element("div", { role: "option", id: "picker-typed", class: "typed" });
    private current = "";
    private active: HTMLElement | undefined;
    private failure = ""; // why the server could not send the catalogue; "" if it could
    private choiceNumber = 0; // number of the latest choice; results of earlier choices are ignored

    /**
     * `choose` shows the object with the name `name`. If `isData` is true, the object is an array in the server's data
     * folder. Otherwise, it is in the catalogue, or the server builds it from the name. If `choose` rejects, the open
     * dialog shows the message of the Error; if the dialog has been closed, `failedLater` gets the Error.
     */
    constructor(
        private readonly choose: (name: string, isData: boolean) => Promise<unknown>,
        private readonly failedLater: (error: Error) => void,
    ) {
        this.input.addEventListener("input", () => this.searchAnew());
        this.input.addEventListener("keydown", (event) => this.keydown(event));
        byId("picker-form").addEventListener("submit", (event) => {
            event.preventDefault();
            if (this.active) void this.confirm(this.active);
        });
        this.list.addEventListener("pointerdown", (event) => event.pointerType === "mouse" && event.preventDefault());
        this.list.addEventListener("click", (event) => {
            const option = event.target instanceof Element && event.target.closest<HTMLElement>("[role=option]");
            if (option) void this.confirm(option);
        });
    }

    /** Opens the dialog. `current` is the name of the object that the picture shows. */
    open(current: string): void {
        this.current = current;
        this.failure = "";
        this.input.value = "";
        this.dialog.open(this.input);
        this.searchAnew();
    }

    get isOpen(): boolean {
        return this.dialog.isOpen;
    }

    /** Replaces the entries of the catalogue, if they have changed. */
    setEntries(entries: CatalogueEntry[]): void {
        if (this.failure !== "") this.showError("");
        this.failure = "";
        if (JSON.stringify(entries) === JSON.stringify(this.catalogue.entries)) return;
        this.catalogue = new Catalogue(entries);
        this.options.clear();
        entries.forEach((entry, i) => this.options.set(entry, optionElement(entry, `picker-option-${i}`)));
        if (this.isOpen) this.search();
    }

    /** Shows why the catalogue is not available. Entries that are already listed stay in the list. */
    showFailure(reason: string): void {
        this.failure = reason;
        this.showError(reason);
    }

    /**
     * Searches for the new text in the search field. If an earlier choice is still being loaded, the dialog no longer
     * closes when the choice has been loaded.
     */
    private searchAnew(): void {
        ++this.choiceNumber;
        this.search();
    }

    private search(): void {
        this.showError(this.failure);
        const text = this.input.value.trim();
        const found = this.catalogue.find(text);
        const families = found.length > 0 ? found : this.catalogue.findSimilar(text);
        const groups = families.map(({ name, entries }, i) => {
            const title = element("h3", { id: `picker-family-${i}`, role: "presentation" }, name);
            if (!kFieldFamilies.includes(name)) title.append(elementCountColumns(kCounted));
            const options = entries.map((entry) => this.options.get(entry)!);
            const attributes = { role: "group", "aria-labelledby": title.id };
            return element("div", attributes, title, ...options);
        });
        const isName = text === "" || this.catalogue.findByName(text) !== undefined;
        this.typedOption.replaceChildren(element("b", {}, "Build "), element("q", {}, text));
        this.typedOption.dataset["name"] = text;
        // The typed text comes before entries with similar names, because it may be a name that only the server knows.
        const typed = isName ? [] : [this.typedOption];
        this.list.replaceChildren(...(found.length > 0 ? [...groups, ...typed] : [...typed, ...groups]));
        const shown = this.listedOptions.length - typed.length;
        const number = shown === 0 ? "No" : formatCount(shown);
        const similar = found.length === 0 && shown > 0 ? " with a similar name" : "";
        const results = (shown === 1 ? "1 object" : `${number} objects`) + similar;
        this.resultCount.textContent = this.options.size > 0 ? results : "";
        for (const one of this.options.values()) {
            one.toggleAttribute("data-current", one.dataset["name"] === this.current);
        }
        const first = text === "" ? this.listedOptions.find((one) => one.dataset["name"] === this.current) : undefined;
        this.activate(first ?? this.listedOptions[0], first ? "center" : "nearest");
        if (!first) this.list.scrollTop = 0;
    }

    private get listedOptions(): HTMLElement[] {
        return [...this.list.querySelectorAll<HTMLElement>("[role=option]")];
    }

    private keydown(event: KeyboardEvent): void {
        const step = kSteps[event.key];
        if (step === undefined || event.isComposing) return;
        event.preventDefault();
        const { listedOptions } = this;
        const at = this.active ? listedOptions.indexOf(this.active) : -1;
        const last = listedOptions.length - 1;
        const onward =
            Math.abs(step) > 1 ? Math.min(last, Math.max(0, at + step)) : (at + step + last + 1) % (last + 1);
        this.activate(listedOptions[onward], "nearest");
    }

    private activate(next: HTMLElement | undefined, block: ScrollLogicalPosition): void {
        this.active?.setAttribute("aria-selected", "false");
        this.active = next;
        next?.setAttribute("aria-selected", "true");
        if (next) this.input.setAttribute("aria-activedescendant", next.id);
        else this.input.removeAttribute("aria-activedescendant");
        const heading = next?.previousElementSibling;
        if (block === "nearest" && heading?.tagName === "H3") heading.scrollIntoView({ block });
        next?.scrollIntoView({ block });
    }

    private async confirm(chosen: HTMLElement): Promise<void> {
        const number = ++this.choiceNumber;
        this.activate(chosen, "nearest");
        this.showError("");
        this.list.setAttribute("aria-busy", "true");
        try {
            await this.choose(chosen.dataset["name"]!, chosen.dataset["family"] === kDataFamily);
            if (number === this.choiceNumber) this.dialog.close();
        } catch (error) {
            if (!this.isOpen) this.failedLater(error as Error);
            else if (number === this.choiceNumber) this.showError((error as Error).message);
        } finally {
            if (number === this.choiceNumber) this.list.removeAttribute("aria-busy");
        }
    }

    private showError(error: string): void {
        this.error.textContent = error === "" ? "" : toSentence(error);
        this.input.setAttribute("aria-invalid", String(error !== ""));
        this.list.removeAttribute("aria-busy");
    }
}

function optionElement(entry: CatalogueEntry, id: string): HTMLElement {
    const { name, aliases, schlaefli, diagram = "", vertices, edges, faces, cells } = entry;
    const symbol = schlaefli || diagram;
    const also = aliases.filter((alias) => alias !== symbol && alias !== diagram).join(", ");
    const drawn = symbol === diagram || diagram === "" ? [] : [element("code", {}, diagram), also === "" ? "" : ", "];
    const counts = [vertices, edges, faces, cells];
    const attributes = { role: "option", id, "data-name": name, "data-family": entry.family ?? "", "aria-selected": "false" };
    return element(
        "div",
        attributes,
        element("b", {}, name),
        element("span", { class: "symbol-of" }, symbol),
        element("small", {}, ...drawn, also),
        kFieldFamilies.includes(entry.family ?? "")
            ? element("small", { class: "counts" }, "field")
            : elementCountColumns(counts.map(formatCount)),
    );
}

/** Makes four columns of text: the counts of elements of an entry, or the headings of these columns. */
function elementCountColumns(texts: string[]): HTMLElement {
    return element("small", { class: "counts columns" }, ...texts.map((text) => element("span", {}, text)));
}
