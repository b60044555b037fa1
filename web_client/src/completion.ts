// Completes the command line: commands, settings and their values, and the names that commands take.

import type { KeyBinding } from "@oval4d/protocol";

import type { Catalogue } from "./catalogue";
import { kCommands, kElementKinds, kPlanes, kSettings } from "./commands";
import { fileOptionsOf, kFormats } from "./export_formats";

/** The names that the command line can complete. They depend on the session and on the server. */
export interface CompletableNames {
    polytopes: Catalogue;
    /** The kinds of cells of the polytope that is shown. */
    kinds: string[];
    keys: string[];
}

export interface Completions {
    /** The index in the line where the completed text begins. An option replaces the text from there to the caret. */
    start: number;
    options: string[];
    /** The text to insert after an option if it is the only one: a blank, ":" or "". */
    suffix: string;
}

const kPageSettings = new Map([["latency", ["on", "off"]]]); // settings that only the page knows, each with its values
// The kinds of names that may contain blanks. Such a name extends to the end of the line.
const kOfRestOfLine = ["polytope", "kind"];

/** The completions at the end of the text `line`, which ends at the caret. */
export function completionsOf(line: string, names: CompletableNames): Completions {
    const [, before = "", verb = "", blanks = "", rest = ""] = /^(\s*:?\s*)(\S*)(\s*)(.*)$/s.exec(line) ?? [];
    const command = kCommands.find(({ name }) => name === verb);
    if (blanks === "") {
        const options = filterByPrefix(kCommands.map(({ name }) => name), verb);
        const only = kCommands.find(({ name }) => name === options[0]);
        return completionsUnlessComplete(line, before.length, options, only?.arguments === undefined ? "" : " ");
    }
    const completes = command?.completes ?? "";
    const word = kOfRestOfLine.includes(completes) ? rest : /\S*$/.exec(rest)![0];
    const start = line.length - word.length;
    if (completes === "setting") return settingCompletions(line, start, rest, names);
    if (completes === "format" && word !== rest) return fileOptionCompletions(line, rest, word);
    // Only the first argument of other commands is completed.
    if (word !== rest) return { start, options: [], suffix: "" };
    const options = completionsOfKind(completes, word, names);
    return completionsUnlessComplete(line, start, options, completes === "highlight" ? beforeNumber(options, " ") : "");
}

/** The completions of the last word of `set NAME=VALUE …`. */
function settingCompletions(line: string, start: number, rest: string, names: CompletableNames): Completions {
    // The value of `polytope` may contain blanks if `polytope` is the only setting in the line.
    const [, name = "", value = ""] = /^(polytope)=([^=]*)$/.exec(rest) ?? /(\S*?)=(\S*)$/.exec(rest) ?? [];
    if (name !== "") {
        const options = completionsOfKind(name, value, names);
        const suffix = name === "highlight" ? beforeNumber(options, ":") : "";
        return completionsUnlessComplete(line, line.length - value.length, options, suffix);
    }
    const all = [...kSettings.keys(), ...kPageSettings.keys()].map((one) => `${one}=`);
    return completionsUnlessComplete(line, start, filterByPrefix(all, line.slice(start)));
}

/** The completions of the last word of `export FORMAT NAME=VALUE …`. */
function fileOptionCompletions(line: string, rest: string, word: string): Completions {
    const name = /^\S+/.exec(rest)![0].toLowerCase();
    const format = kFormats.flatMap(({ formats }) => formats).find((one) => one.name === name);
    const options = format ? fileOptionsOf(format) : new Map<string, string[]>();
    const [, option, value = ""] = /^(\w+)=(.*)$/.exec(word) ?? [];
    const found = option === undefined ? [...options.keys()].map((one) => `${one}=`) : (options.get(option) ?? []);
    const typed = option === undefined ? word : value;
    return completionsUnlessComplete(line, line.length - typed.length, filterByPrefix(found, typed));
}

/**
 * The names of the kind `kind`, such as "planes", that begin with `typed`. If there is no such kind of names, the
 * values of the setting `kind` that begin with `typed`.
 */
function completionsOfKind(kind: string, typed: string, { polytopes, kinds, keys }: CompletableNames): string[] {
    if (kind === "polytope") return polytopeNames(polytopes, typed);
    const lists: Record<string, string[]> = {
        planes: kPlanes,
        element: kElementKinds,
        highlight: [...kElementKinds, "none"],
        view: [...(kSettings.get("view") ?? []), "row"], // the view "strip" is also called "row"
        kind: [...new Set(kinds)],
        key: keys,
        format: [...kFormats.flatMap(({ formats }) => formats.map(({ name }) => name)), "latency"],
        command: kCommands.map(({ name }) => name),
    };
    return filterByPrefix(lists[kind] ?? kSettings.get(kind) ?? kPageSettings.get(kind) ?? [], typed);
}

/** The names of polytopes that begin with `typed`; if there are none, those that the search in the catalogue finds. */
function polytopeNames(catalogue: Catalogue, typed: string): string[] {
    const found = filterByPrefix(catalogue.entries.map(({ name }) => name), typed);
    if (found.length > 0) return found;
    return catalogue.find(typed).flatMap(({ entries }) => entries.map(({ name }) => name));
}

function filterByPrefix(list: string[], prefix: string): string[] {
    const wanted = prefix.toLowerCase();
    return list.filter((one) => one.toLowerCase().startsWith(wanted));
}

/**
 * Returns `separator`, the text between a kind of elements and a number, if the first option is such a kind; else "".
 */
function beforeNumber(options: string[], separator: string): string {
    return kElementKinds.includes(options[0] ?? "") ? separator : "";
}

function completionsUnlessComplete(line: string, start: number, options: string[], suffix = ""): Completions {
    const isComplete = options.length === 1 && options[0] + suffix === line.slice(start);
    return { start, options: isComplete ? [] : options, suffix };
}

/** The keys that the command `key` accepts: single keystrokes that the server handles, such as "a" or "ctrl-r". */
export function namesOfServerKeys(table: readonly KeyBinding[]): string[] {
    return table
        .filter(({ key, client }) => key.length === 1 && !client)
        .map(({ key, ctrl }) => (ctrl ? `ctrl-${key}` : key === " " ? "space" : key));
}

/** The longest text with which all options begin. */
export function commonPrefix(options: string[]): string {
    const [first = "", ...others] = options;
    let length = first.length;
    for (const other of others) while (!other.startsWith(first.slice(0, length))) --length;
    return first.slice(0, length);
}
