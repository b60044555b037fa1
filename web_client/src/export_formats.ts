// The formats of exported files: the formats of the protocol, and PNG for the picture itself.

import type { FileOptions } from "@oval4d/protocol";

import table from "../../protocol/export_formats.json";

export type ExportOptionName = "of" | "body" | "size" | "label" | "exact" | "side" | "pixels" | "background";

export interface ExportFormat {
    /** The name in the protocol, which is also the file name extension. */
    name: string;
    label: string;
    /** A line about the contents of the file and the programs that open it. */
    about: string;
    /** The media type of the file, as in the HTTP header Content-Type. */
    type: string;
    /** The options that the dialog offers for this format; "exact" is offered only for fields. */
    choices: ExportOptionName[];
    /** What the file can contain; the first is the default. */
    of: string[];
    /** Replaces `about` and `of` if the object is a field. */
    forFields: { about: string; of: string[] };
    /**
     * The only kind of objects that the format can describe; absent if it can describe all kinds. "polytopes" includes
     * point clouds.
     */
    objects?: "fields" | "polytopes";
}

/** The name of an option of an exported file, such as "fit". protocol/README.md describes the options. */
export type FileOptionName = keyof Omit<FileOptions, "format">;

/**
 * The options of exported files on the command line, each with a list of its values. The list is empty for an option
 * that is a number or a list of numbers. It is also empty for `of`, whose values depend on the format.
 */
export const kFileOptions = {
    of: [],
    body: ["solid", "skeleton"],
    size: [],
    label: ["none", "engraved", "separate"],
    at: [],
    fit: [],
    exact: ["on", "off"],
} satisfies Record<FileOptionName, string[]>;

const kAboutPng = "The picture; scripts can restore its state from the file";
const kPng: ExportFormat = {
    name: "png",
    label: "PNG",
    about: kAboutPng,
    type: "image/png",
    choices: ["pixels", "background"],
    of: [],
    forFields: { about: kAboutPng, of: [] },
};

export const kFormats: { title: string; formats: ExportFormat[] }[] = table.groups.map(({ name: group, title }) => ({
    title,
    formats: [...(group === "figure" ? [kPng] : []), ...table.formats.filter((row) => row.group === group).map(formatFromRow)],
}));

/** A row of protocol/export_formats.json, which describes its members. */
interface ExportFormatRow {
    name: string;
    label: string;
    about: string;
    media_type: string;
    group: string;
    bodies?: string;
    surfaces?: boolean;
    of: string[];
    of_fields?: string[];
    about_fields?: string;
    objects?: string;
}

function formatFromRow(row: ExportFormatRow): ExportFormat {
    const { name, label, about, of, objects } = row;
    return {
        name,
        label,
        about,
        type: row.media_type,
        choices: choicesOf(row),
        of,
        forFields: { about: row.about_fields ?? about, of: row.of_fields ?? of },
        ...(objects && { objects: objects as "fields" | "polytopes" }),
    };
}

function choicesOf(row: ExportFormatRow): ExportOptionName[] {
    const exact = row.surfaces ? ["exact" as const] : [];
    if (row.bodies) return ["of", "body", ...exact, "size", "label"];
    const side = row.group === "figure" ? ["side" as const] : [];
    return [...(row.of.length > 1 ? ["of" as const] : []), ...exact, ...side];
}

/** The options that the command line offers for this format, each with a list of its values. */
export function fileOptionsOf({ choices, of }: ExportFormat): Map<string, string[]> {
    const applies = (name: string): boolean => {
        if (name === "at" || name === "fit") return of.includes("oval");
        return choices.includes((name === "size" && choices.includes("side") ? "side" : name) as ExportOptionName);
    };
    const all = Object.entries<string[]>({ ...kFileOptions, of }).filter(([name]) => applies(name));
    return new Map(all);
}
