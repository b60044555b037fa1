// The controls for colors: how the faces are colored, and which kinds of cells are shown, faded or hidden.

import type { CellKind, Coloring, Settings, State } from "@oval4d/protocol";

import { element } from "./element";
import { capitalize, formatCount } from "./format";
import type { Section } from "./tools";

const kColorings: Record<Coloring, { label: string; title: string }> = {
    cell: { label: "Cell", title: "Each cell has its own color" },
    kind: { label: "Kind", title: "Each kind of cell has its own color" },
    w: { label: "w", title: "The color shows the w of the cell's center" },
    plain: { label: "Plain", title: "All faces have the same color" },
    light: { label: "Light", title: "Cells are shaded by a light in four dimensions" },
};
const kPresences = ["shown", "faded", "hidden"] as const;
type Presence = (typeof kPresences)[number];

const kMaxListedKinds = 24; // an imported polytope may have as many kinds of cells as cells

export class Colors {
    private readonly modes = element("div", { class: "segments", role: "group", "aria-label": "Color by" });
    private readonly scale = element(
        "p",
        { class: "scale", hidden: true },
        "\u2212w",
        element("span", {
            role: "img",
            "aria-label": "From blue at the lowest w through gray to amber at the highest",
        }),
        "+w",
    );
    private readonly list = element("div", { class: "kinds" });
    private rows: HTMLElement[] = [];
    private listedKinds: string | undefined; // identifies the kinds of cells in the rows
    private state: State | undefined;

    /** `applyChange` is called to change the state. */
    constructor(private readonly applyChange: (change: Settings) => void) {
        for (const [value, { label, title }] of Object.entries(kColorings)) {
            const radio = element("input", { type: "radio", name: "color", value });
            this.modes.append(element("label", { title }, radio, element("span", {}, label)));
        }
        this.modes.addEventListener("change", (event) => {
            this.applyChange({ color: (event.target as HTMLInputElement).value as Coloring });
        });
        this.list.addEventListener("change", () => this.applyPresences());
    }

    get section(): Section {
        return { title: "Colors", after: "look", content: [this.modes, this.scale, this.list] };
    }

    update(state: State): void {
        this.state = state;
        const { kinds = [], name } = state.polytope;
        const listed = JSON.stringify([name, kinds]);
        if (listed !== this.listedKinds) this.listKinds(kinds);
        this.listedKinds = listed;
        checkRadio(this.modes, state.color);
        this.scale.hidden = state.color !== "w";
        this.list.toggleAttribute("data-colored", state.color === "kind");
        this.rows.forEach((row, kind) => {
            const presence = presenceOf(state, kind);
            row.dataset["presence"] = presence;
            checkRadio(row, presence);
        });
    }

    private listKinds(kinds: CellKind[]): void {
        this.rows = kinds.slice(0, kMaxListedKinds).map(kindRow);
        const more = kinds.length - this.rows.length;
        const rest = element("p", {}, `${formatCount(more)} more kinds: use :hide, :fade and :show`);
        this.list.replaceChildren(...this.rows, ...(more > 0 ? [rest] : []));
    }

    /** Applies the chosen presences; kinds of cells that are not listed keep their presence. */
    private applyPresences(): void {
        const { hidden, faded } = this.state!;
        const chosen = (presence: Presence, before: number[]): number[] => [
            ...this.rows.flatMap((row, kind) =>
                row.querySelector("input:checked")?.getAttribute("value") === presence ? [kind] : [],
            ),
            ...before.filter((kind) => kind >= this.rows.length),
        ];
        this.applyChange({ hidden: chosen("hidden", hidden), faded: chosen("faded", faded) });
    }
}

/** A text for screen readers such as "cube hidden, tetrahedron faded", or "all kinds of cells shown". */
export function spokenKinds(state: State): string {
    const { kinds = [] } = state.polytope;
    const named = (list: number[], presence: Presence): string[] =>
        list.map((kind) => `${kinds[kind]?.name ?? `kind ${kind}`} ${presence}`);
    const all = [...named(state.hidden, "hidden"), ...named(state.faded, "faded")];
    return all.length === 0 ? "all kinds of cells shown" : all.join(", ");
}

function presenceOf({ hidden, faded }: State, kind: number): Presence {
    return hidden.includes(kind) ? "hidden" : faded.includes(kind) ? "faded" : "shown";
}

function kindRow({ name, cells, color }: CellKind, kind: number): HTMLElement {
    const swatch = element("i", { "aria-hidden": "true" });
    if (color !== undefined) swatch.style.background = `#${color.toString(16).padStart(6, "0")}`;
    const radios = kPresences.map((presence) => {
        const label = capitalize(presence);
        const attributes = { type: "radio", name: `kind-${kind}`, value: presence, "aria-label": label };
        return element(
            "label",
            { title: label },
            element("input", attributes),
            element("span", { class: presence }),
        );
    });
    return element(
        "div",
        { role: "group", "aria-label": `${name}: ${cells} ${cells === 1 ? "cell" : "cells"}` },
        swatch,
        element("span", {}, name.replace(/(\w{9,})hedron/g, "$1\u00ADhedron")), // a soft hyphen in long names
        element("small", {}, formatCount(cells)),
        element("div", { class: "presence" }, ...radios),
    );
}

function checkRadio(within: HTMLElement, value: string): void {
    const radio = within.querySelector<HTMLInputElement>(`input[value="${value}"]`);
    if (radio) radio.checked = true;
}
