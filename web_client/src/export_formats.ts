// The formats in which a session can be exported: those of the protocol, and the picture itself.

import table from "../../protocol/export_formats.json";

export type Choice = "of" | "figure" | "body" | "size" | "label" | "pixels";

export interface Format {
    /** The name in the protocol, and the file name extension. */
    name: string;
    label: string;
    /** A line about the contents of the file and the programs that open it. */
    about: string;
    /** The media type. */
    type: string;
    /** The options that the format offers. */
    choices: Choice[];
}

const kPng: Format = {
    name: "png",
    label: "PNG",
    about: "The picture; scripts can restore its state from the file",
    type: "image/png",
    choices: ["pixels"],
};

export const kFormats: { title: string; formats: Format[] }[] = table.groups.map(({ name: group, title }) => ({
    title,
    formats: [...(group === "figure" ? [kPng] : []), ...table.formats.filter((row) => row.group === group).map(format)],
}));

interface Row {
    name: string;
    label: string;
    about: string;
    media_type: string;
    group: string;
    bodies?: string;
}

function format(row: Row): Format {
    const { name, label, about } = row;
    const choices: Choice[] = row.bodies ? ["of", "body", "size", "label"] : row.group === "figure" ? ["figure"] : [];
    return { name, label, about, type: row.media_type, choices };
}
