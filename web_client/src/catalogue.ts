// Search of the catalogue by name, alias, short name or symbol.

import type { CatalogueEntry } from "@oval4d/protocol";

export interface Family {
    name: string;
    entries: CatalogueEntry[];
}

/** The quality of a match; smaller is better. */
const kMatch = { exact: 0, prefix: 1, wordPrefix: 2, substring: 3 };

interface Indexed {
    entry: CatalogueEntry;
    family: string;
    /** Name, aliases and symbols, normalized. */
    names: string[];
    /** The names and the family, normalized; then the names without blanks, so that "120cell" finds "120 cell". */
    all: string;
}

export class Catalogue {
    private readonly indexed: Indexed[];
    private readonly families: string[]; // in the order of the catalogue

    constructor(readonly entries: readonly CatalogueEntry[]) {
        this.indexed = entries.map((entry) => {
            const { name, aliases, schlaefli, diagram = "", family = "" } = entry;
            const names = [name, ...aliases, schlaefli, diagram].map(normalized).filter((one) => one !== "");
            const runs = names.map((one) => one.replaceAll(" ", ""));
            return { entry, family, names, all: [...names, normalized(family), ...runs].join("\n") };
        });
        this.families = [...new Set(this.indexed.map(({ family }) => family))];
    }

    /** The entries that contain every word of `query`, by family; the best matches come first. */
    find(query: string): Family[] {
        const wanted = normalized(query);
        const words = query.split(/\s+/).map(normalized);
        const found = this.indexed
            .filter(({ all }) => words.every((word) => contains(all, word)))
            .map((one) => ({ ...one, match: matchOf(one.names, wanted) }));
        const families = this.families
            .map((name) => ({ name, found: found.filter(({ family }) => family === name).sort(byMatch) }))
            .filter((family) => family.found.length > 0);
        families.sort((a, b) => byMatch(a.found[0]!, b.found[0]!));
        return families.map(({ name, found: those }) => ({ name, entries: those.map(({ entry }) => entry) }));
    }

    /** The entry with this name, alias or symbol, regardless of case and hyphens. */
    named(text: string): CatalogueEntry | undefined {
        const wanted = normalized(text);
        return this.indexed.find(({ names }) => names.includes(wanted))?.entry;
    }
}

/** Whether `word` occurs in `text`; a number must not begin inside another number: "20" does not occur in "120". */
function contains(text: string, word: string): boolean {
    for (let at = text.indexOf(word); at >= 0; at = text.indexOf(word, at + 1)) {
        if (!/^\d/.test(word) || !/\d/.test(text[at - 1] ?? "")) return true;
    }
    return false;
}

function matchOf(names: string[], wanted: string): number {
    if (wanted === "" || names.includes(wanted)) return kMatch.exact;
    if (names.some((name) => name.startsWith(wanted))) return kMatch.prefix;
    return names.some((name) => ` ${name}`.includes(` ${wanted}`)) ? kMatch.wordPrefix : kMatch.substring;
}

function byMatch(a: { match: number }, b: { match: number }): number {
    return a.match - b.match;
}

/** Lower-cases the text, strips diacritics, and replaces all but letters, numbers, '/' and '*' by single blanks. */
function normalized(text: string): string {
    return text
        .normalize("NFKD")
        .replace(/\p{M}/gu, "")
        .toLowerCase()
        .replace(/[^\p{L}\p{N}/*]+/gu, " ")
        .trim();
}
