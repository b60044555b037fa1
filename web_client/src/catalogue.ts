// The catalogue, searched by name, alias, short name or symbol as one types.

import type { CatalogueEntry } from "@oval4d/protocol";

export interface Family {
    name: string;
    entries: CatalogueEntry[];
}

/** How well an entry fits: the smaller the better. */
const kFits = { exactly: 0, begins: 1, beginsWord: 2, contains: 3 };

interface Indexed {
    entry: CatalogueEntry;
    family: string;
    /** Name, aliases and symbols, plain. */
    names: string[];
    /** All of them and the family, plain; then without blanks: "120 cell" is found by "120cell", "3 3 5" by "335". */
    all: string;
}

export class Catalogue {
    private readonly indexed: Indexed[];
    private readonly families: string[]; // in the catalogue's order

    constructor(readonly entries: readonly CatalogueEntry[]) {
        this.indexed = entries.map((entry) => {
            const { name, aliases, schlaefli, diagram = "", family = "" } = entry;
            const names = [name, ...aliases, schlaefli, diagram].map(plain).filter((one) => one !== "");
            const runs = names.map((one) => one.replaceAll(" ", ""));
            return { entry, family, names, all: [...names, plain(family), ...runs].join("\n") };
        });
        this.families = [...new Set(this.indexed.map(({ family }) => family))];
    }

    /** The entries in which every word of `query` is found, by family; what fits best comes first. */
    find(query: string): Family[] {
        const wanted = plain(query);
        const words = query.split(/\s+/).map(plain);
        const found = this.indexed
            .filter(({ all }) => words.every((word) => contains(all, word)))
            .map((one) => ({ ...one, fit: fit(one.names, wanted) }));
        const families = this.families
            .map((name) => ({ name, found: found.filter(({ family }) => family === name).sort(byFit) }))
            .filter((family) => family.found.length > 0);
        families.sort((a, b) => byFit(a.found[0]!, b.found[0]!));
        return families.map(({ name, found: those }) => ({ name, entries: those.map(({ entry }) => entry) }));
    }

    /** The entry that is called so, whatever the case and the hyphens. */
    named(text: string): CatalogueEntry | undefined {
        const wanted = plain(text);
        return this.indexed.find(({ names }) => names.includes(wanted))?.entry;
    }
}

/** Whether `word` is a part of `text`; a number counts only as a whole one: "20" is not in "120". */
function contains(text: string, word: string): boolean {
    for (let at = text.indexOf(word); at >= 0; at = text.indexOf(word, at + 1)) {
        if (!/^\d/.test(word) || !/\d/.test(text[at - 1] ?? "")) return true;
    }
    return false;
}

function fit(names: string[], wanted: string): number {
    if (wanted === "" || names.includes(wanted)) return kFits.exactly;
    if (names.some((name) => name.startsWith(wanted))) return kFits.begins;
    return names.some((name) => ` ${name}`.includes(` ${wanted}`)) ? kFits.beginsWord : kFits.contains;
}

function byFit(a: { fit: number }, b: { fit: number }): number {
    return a.fit - b.fit;
}

/** Letters without case and marks, numbers and fractions; all else is a blank. */
function plain(text: string): string {
    return text
        .normalize("NFKD")
        .replace(/\p{M}/gu, "")
        .toLowerCase()
        .replace(/[^\p{L}\p{N}/*]+/gu, " ")
        .trim();
}
