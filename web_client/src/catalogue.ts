// Searches the catalogue of polytopes by name, alias, short name or symbol.

import type { CatalogueEntry } from "@oval4d/protocol";

/** A family of polytopes, with those of its members that a search has found. */
export interface PolytopeFamily {
    name: string;
    entries: CatalogueEntry[];
}

/** How well a name matches the text that the user searches for. Smaller numbers are better matches. */
const kMatch = { exact: 0, prefix: 1, wordPrefix: 2, substring: 3 };

const kMostCompared = 64; // the search for similar names compares only this many letters at the start of a name
const kLettersPerMistake = 3; // one mistake is allowed for every three letters typed, as in the server's suggestions

interface SearchableCatalogueEntry {
    entry: CatalogueEntry;
    family: string;
    /** The name, the aliases and the symbols of the entry, as normalizeForSearch() returns them. */
    names: string[];
    /**
     * The normalized names and family; then the names without blanks, so that a search for "120cell" finds "120 cell".
     */
    searchText: string;
}

export class Catalogue {
    private readonly indexed: SearchableCatalogueEntry[];
    private readonly families: string[]; // the names of the families, in the order of the catalogue

    constructor(readonly entries: readonly CatalogueEntry[]) {
        this.indexed = entries.map((entry) => {
            const { name, aliases, schlaefli, diagram = "", family = "" } = entry;
            const names = [name, ...aliases, schlaefli, diagram].map(normalizeForSearch).filter((name) => name !== "");
            const withoutBlanks = names.map((name) => name.replaceAll(" ", ""));
            return { entry, family, names, searchText: [...names, normalizeForSearch(family), ...withoutBlanks].join("\n") };
        });
        this.families = [...new Set(this.indexed.map(({ family }) => family))];
    }

    /**
     * The entries whose names, symbols and family together contain every word of `query`, grouped by family. The best
     * matches come first.
     */
    find(query: string): PolytopeFamily[] {
        const words = query.split(/\s+/).map(normalizeForSearch);
        const found = this.indexed.filter(({ searchText }) => words.every((word) => hasSearchWord(searchText, word)));
        return this.groupByFamily(found, normalizeForSearch(query));
    }

    /**
     * The entries whose names differ from `query` by the fewest spelling mistakes, grouped by family. Finds only names
     * that contain the same numbers as `query`, and have at most one mistake for every three letters of `query`.
     */
    findSimilar(query: string): PolytopeFamily[] {
        return this.groupByFamily(this.similarEntries(normalizeForSearch(query)), normalizeForSearch(query));
    }

    private groupByFamily(items: SearchableCatalogueEntry[], wanted: string): PolytopeFamily[] {
        const found = items.map((item) => ({ ...item, match: matchQuality(item.names, wanted) }));
        const families = this.families
            .map((name) => ({ name, found: found.filter(({ family }) => family === name).sort(compareMatch) }))
            .filter((family) => family.found.length > 0);
        families.sort((a, b) => compareMatch(a.found[0]!, b.found[0]!));
        return families.map((family) => ({ name: family.name, entries: family.found.map(({ entry }) => entry) }));
    }

    private similarEntries(wanted: string): SearchableCatalogueEntry[] {
        const text = wanted.replaceAll(" ", "").slice(0, kMostCompared);
        let least = Math.floor(text.length / kLettersPerMistake);
        let similar: SearchableCatalogueEntry[] = [];
        if (least === 0) return similar;
        for (const item of this.indexed) {
            for (const name of item.names) {
                if (numberSequenceOf(name) !== numberSequenceOf(wanted)) continue;
                const distance = editDistance(text, name.replaceAll(" ", "").slice(0, kMostCompared), least);
                if (distance > least) continue;
                if (distance < least) similar = [];
                least = distance;
                if (similar.at(-1) !== item) similar.push(item);
            }
        }
        return similar;
    }

    /** The entry with this name, alias or symbol, regardless of case and hyphens. */
    findByName(text: string): CatalogueEntry | undefined {
        const wanted = normalizeForSearch(text);
        return this.indexed.find(({ names }) => names.includes(wanted))?.entry;
    }
}

/** Whether `word` occurs in `text`; a number must not begin inside another number: "20" does not occur in "120". */
function hasSearchWord(text: string, word: string): boolean {
    for (let at = text.indexOf(word); at >= 0; at = text.indexOf(word, at + 1)) {
        if (!/^\d/.test(word) || !/\d/.test(text[at - 1] ?? "")) return true;
    }
    return false;
}

function numberSequenceOf(text: string): string {
    return (text.match(/\d+/g) ?? []).join(" ");
}

/** The edit distance (Levenshtein) of two texts; any number above `most` if the distance is above `most`. */
function editDistance(a: string, b: string, most: number): number {
    if (Math.abs(a.length - b.length) > most) return most + 1;
    const row = Array.from({ length: b.length + 1 }, (_, j) => j);
    for (let i = 0; i < a.length; i++) {
        let diagonal = row[0]!;
        row[0] = i + 1;
        for (let j = 0; j < b.length; j++) {
            const replaced = diagonal + (a[i] === b[j] ? 0 : 1);
            diagonal = row[j + 1]!;
            row[j + 1] = Math.min(replaced, row[j]! + 1, row[j + 1]! + 1);
        }
    }
    return row[b.length]!;
}

function matchQuality(names: string[], wanted: string): number {
    if (wanted === "" || names.includes(wanted)) return kMatch.exact;
    if (names.some((name) => name.startsWith(wanted))) return kMatch.prefix;
    return names.some((name) => ` ${name}`.includes(` ${wanted}`)) ? kMatch.wordPrefix : kMatch.substring;
}

function compareMatch(a: { match: number }, b: { match: number }): number {
    return a.match - b.match;
}

/** Lower-cases the text, strips diacritics, and replaces all but letters, numbers, '/' and '*' by single blanks. */
function normalizeForSearch(text: string): string {
    return text
        .normalize("NFKD")
        .replace(/\p{M}/gu, "")
        .toLowerCase()
        .replace(/[^\p{L}\p{N}/*]+/gu, " ")
        .trim();
}
