// The controls for colors: how the faces are colored, and which kinds of cells are shown, faded or hidden.

import type { Background, CellKind, Coloring, Settings, State } from "@oval4d/protocol";

import { element } from "./element";
import { isField, labelOfQuantity, quantityOfColors } from "./fields";
import { capitalize, formatCount, roundedToDigitsOfSize } from "./format";
import { cssColor } from "./picture/pen";
import type { ToolSection } from "./tools";

interface LabelAndTooltip {
    label: string;
    title: string;
}

/**
 * The labels of the colorings, for polytopes and for fields. A coloring without a label for a kind of object has no
 * effect on such objects: they look as with `plain`.
 */
const kColorings: Record<Coloring, { polytope?: LabelAndTooltip; field?: LabelAndTooltip }> = {
    cell: {
        polytope: { label: "Cell", title: "Each cell has its own color" },
        field: { label: "Level", title: "Each level has its own color" },
    },
    kind: { polytope: { label: "Kind", title: "Each kind of cell has its own color" } },
    w: {
        polytope: { label: "w", title: "The color shows the w of the cell's center" },
        field: { label: "w", title: "The color shows the w of the slice" },
    },
    plain: {
        polytope: { label: "Plain", title: "All faces have the same color" },
        field: { label: "Plain", title: "All surfaces have the same color" },
    },
    light: { polytope: { label: "Light", title: "Cells are shaded by a light in four dimensions" } },
    growth: { field: { label: "Growth", title: "How fast the surface moves outward as w grows" } },
    value: { field: { label: "Value", title: "The value of the second function, or of the field itself" } },
};
interface ColorScaleLegend {
    least: string;
    most: string;
    text: string;
    /** What the colors show, such as "temperature, K"; "" or absent if it is not known. */
    label?: string;
    /** CSS colors from the least value to the greatest; by default, from blue through gray to amber. */
    colors?: string[];
}

/** The legends of the colorings whose color scale is the same for all objects. */
const kScales: Partial<Record<Coloring, ColorScaleLegend>> = {
    w: { least: "\u2212w", most: "+w", text: "From blue at the lowest w through gray to amber at the highest" },
    growth: {
        least: "shrinks",
        most: "grows",
        text: "From blue where the body shrinks through gray to amber where it grows",
    },
};
const kBackgrounds: Record<Background, { label: string; title: string }> = {
    auto: { label: "Auto", title: "The background of each viewer's page, dark or light" },
    dark: { label: "Dark", title: "Dark for all viewers" },
    light: { label: "Light", title: "Light for all viewers" },
    white: { label: "White", title: "White, as paper" },
    transparent: { label: "Clear", title: "None in PNG files, for slides; white on this page" },
};
const kVisibilities = ["shown", "faded", "hidden"] as const;
type CellKindVisibility = (typeof kVisibilities)[number];

// The ends of a color scale are rounded to the decimal place at which their difference has this significant digit.
const kScaleDigits = 3;
const kMaxListedKinds = 24; // the most kinds of cells in the list; an imported polytope may have as many kinds as cells

export class ColorControls {
    private readonly colorings = element("div", { class: "segments", role: "group", "aria-label": "Color by" });
    private readonly options = new Map<Coloring, HTMLElement>();
    private readonly scale = element("p", { class: "scale", hidden: true });
    private readonly backgrounds = element("div", { class: "segments", role: "group", "aria-label": "Background" });
    private readonly list = element("div", { class: "kinds" });
    private rows: HTMLElement[] = [];
    private listedKinds: string | undefined; // a text that identifies the kinds of cells that are listed
    private state: State | undefined;

    /** `applyChange` is called with the settings that the user has changed. */
    constructor(private readonly applyChange: (change: Settings) => void) {
        for (const value of Object.keys(kColorings) as Coloring[]) {
            const radio = element("input", { type: "radio", name: "color", value });
            const option = element("label", {}, radio, element("span"));
            this.options.set(value, option);
            this.colorings.append(option);
        }
        this.colorings.addEventListener("change", (event) => {
            this.applyChange({ color: (event.target as HTMLInputElement).value as Coloring });
        });
        this.list.addEventListener("change", () => this.applyChosenVisibilities());
        for (const [value, { label, title }] of Object.entries(kBackgrounds)) {
            const radio = element("input", { type: "radio", name: "background", value });
            this.backgrounds.append(element("label", { title }, radio, element("span", {}, label)));
        }
        this.backgrounds.addEventListener("change", (event) => {
            this.applyChange({ background: (event.target as HTMLInputElement).value as Background });
        });
    }

    get sections(): ToolSection[] {
        return [
            { title: "Colors", after: "whole", content: [this.colorings, this.scale, this.list] },
            { title: "Background", content: [this.backgrounds] },
        ];
    }

    update(state: State): void {
        this.state = state;
        const { name } = state.polytope;
        const kinds = cellKindsOf(state);
        const listed = JSON.stringify([name, kinds]);
        if (listed !== this.listedKinds) this.listKinds(kinds);
        this.listedKinds = listed;
        this.showColoring(state);
        checkRadio(this.backgrounds, state.background);
        this.list.toggleAttribute("data-colored", state.color === "kind");
        this.rows.forEach((row, kind) => {
            const visibility = visibilityOf(state, kind);
            row.dataset["visibility"] = visibility;
            checkRadio(row, visibility);
        });
    }

    /**
     * Offers the colorings that have an effect on the object. Selects the coloring that the picture shows, and shows
     * its color scale.
     */
    private showColoring(state: State): void {
        const object = isField(state) ? "field" : "polytope";
        for (const [value, option] of this.options) {
            const text = kColorings[value][object];
            option.hidden = text === undefined;
            option.title = text?.title ?? "";
            option.querySelector("span")!.textContent = text?.label ?? "";
        }
        const seen = coloringSeen(state);
        checkRadio(this.colorings, seen);
        const scale = colorScaleLegend(state, seen);
        this.scale.hidden = scale === undefined;
        const shown = JSON.stringify(scale);
        if (!scale || this.scale.dataset["of"] === shown) return;
        this.scale.dataset["of"] = shown;
        const bar = element("span", { role: "img", "aria-label": scale.text });
        if (scale.colors) bar.style.background = `linear-gradient(90deg, ${scale.colors.join(", ")})`;
        // Screen readers read `scale.text`, which contains the label.
        const label = scale.label ? [element("small", { "aria-hidden": "true" }, scale.label)] : [];
        this.scale.replaceChildren(scale.least, bar, scale.most, ...label);
    }

    private listKinds(kinds: CellKind[]): void {
        this.rows = kinds.slice(0, kMaxListedKinds).map(cellKindRow);
        const more = kinds.length - this.rows.length;
        const rest = element("p", {}, `${formatCount(more)} more kinds: use :hide, :fade and :show`);
        this.list.replaceChildren(...this.rows, ...(more > 0 ? [rest] : []));
    }

    /**
     * Applies the visibilities that the user has chosen in the list. Kinds of cells that the list is too short to show
     * keep their visibilities.
     */
    private applyChosenVisibilities(): void {
        const { hidden, faded } = this.state!;
        const chosen = (visibility: CellKindVisibility, before: number[]): number[] => [
            ...this.rows.flatMap((row, kind) =>
                row.querySelector("input:checked")?.getAttribute("value") === visibility ? [kind] : [],
            ),
            ...before.filter((kind) => kind >= this.rows.length),
        ];
        this.applyChange({ hidden: chosen("hidden", hidden), faded: chosen("faded", faded) });
    }
}

/**
 * The coloring that the picture shows: the chosen coloring, or `plain` if the chosen one has no effect on the object.
 */
function coloringSeen(state: State): Coloring {
    return kColorings[state.color][isField(state) ? "field" : "polytope"] ? state.color : "plain";
}

/**
 * The legend of the picture's color scale; undefined if the picture has no color scale. The legend belongs to `seen`,
 * the coloring of the picture. If `seen` has no scale but the caps of a field are colored by value, the legend belongs
 * to the caps: the flat parts that close a body at the boundary of the field's box.
 */
function colorScaleLegend(state: State, seen: Coloring): ColorScaleLegend | undefined {
    const { caps, field } = state;
    const values = field?.values;
    if (!values || (seen !== "value" && (caps !== "value" || kScales[seen]))) return kScales[seen];
    const size = values.range[1] - values.range[0];
    const textOf = (value: number): string => withTypographicMinus(String(roundedToDigitsOfSize(size, value, kScaleDigits)));
    const [least, most] = values.range.map(textOf) as [string, string];
    const { name, unit = "" } = quantityOfColors(state);
    const of = name ?? values.formula ?? values.variable ?? "the values of the field";
    const label = labelOfQuantity({ ...(name !== undefined && { name }), unit });
    const text = `The colors of ${of}, from ${least} to ${[most, unit].filter(Boolean).join(" ")}`;
    return { least, most, text, label, colors: values.colors.map(cssColor) };
}

/** A text for screen readers such as "colored by kind". */
export function spokenColoring(state: State): string {
    const seen = coloringSeen(state);
    const name = seen === "cell" && isField(state) ? "level" : seen;
    return seen === "plain" ? "plain colors" : `colored by ${name}`;
}

/** The kinds of cells that can be shown, faded or hidden; none for a field, because its only cell is its box. */
function cellKindsOf(state: State): CellKind[] {
    return isField(state) ? [] : (state.polytope.kinds ?? []);
}

/** A text for screen readers such as "cube hidden, tetrahedron faded", or "all kinds of cells shown". */
export function spokenKinds(state: State): string {
    const kinds = cellKindsOf(state);
    const named = (list: number[], visibility: CellKindVisibility): string[] =>
        list.map((kind) => `${kinds[kind]?.name ?? `kind ${kind}`} ${visibility}`);
    const all = [...named(state.hidden, "hidden"), ...named(state.faded, "faded")];
    return all.length === 0 ? "all kinds of cells shown" : all.join(", ");
}

function visibilityOf({ hidden, faded }: State, kind: number): CellKindVisibility {
    return hidden.includes(kind) ? "hidden" : faded.includes(kind) ? "faded" : "shown";
}

function cellKindRow({ name, cells, color }: CellKind, kind: number): HTMLElement {
    const swatch = element("i", { "aria-hidden": "true" });
    if (color !== undefined) swatch.style.background = cssColor(color);
    const radios = kVisibilities.map((visibility) => {
        const label = capitalize(visibility);
        const attributes = { type: "radio", name: `kind-${kind}`, value: visibility, "aria-label": label };
        return element(
            "label",
            { title: label },
            element("input", attributes),
            element("span", { class: visibility }),
        );
    });
    return element(
        "div",
        { role: "group", "aria-label": `${name}: ${cells} ${cells === 1 ? "cell" : "cells"}` },
        swatch,
        element("span", {}, name.replace(/(\w{9,})hedron/g, "$1\u00ADhedron")), // a soft hyphen in long names
        element("small", {}, formatCount(cells)),
        element("div", { class: "visibility" }, ...radios),
    );
}

function withTypographicMinus(text: string): string {
    return text.replace("-", "\u2212");
}

function checkRadio(within: HTMLElement, value: string): void {
    const radio = within.querySelector<HTMLInputElement>(`input[value="${value}"]`);
    if (radio) radio.checked = true;
}
