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
    /** The only objects that the format describes, if it does not describe all. */
    objects?: "fields" | "polytopes";
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
    of?: boolean;
    objects?: string;
}

function format(row: Row): Format {
    const { name, label, about, objects } = row;
    return {
        name,
        label,
        about,
        type: row.media_type,
        choices: choicesOf(row),
        ...(objects && { objects: objects as "fields" | "polytopes" }),
    };
}

function choicesOf(row: Row): Choice[] {
    if (row.bodies) return ["of", "body", "size", "label"];
    if (row.of) return ["of"];
    return row.group === "figure" ? ["figure"] : [];
}
