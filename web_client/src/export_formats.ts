// What a session can be exported as.

export type Choice = "of" | "body" | "size" | "label" | "pixels";

export interface Format {
    /** As the file's extension, too. */
    name: string;
    label: string;
    /** What the file holds and who opens it, in a line. */
    about: string;
    type: string;
    /** What there is to choose. */
    choices: Choice[];
}

const kBodies: Choice[] = ["of", "body", "size", "label"];

export const kFormats: { title: string; formats: Format[] }[] = [
    {
        title: "To print",
        formats: [
            format(
                "3mf",
                "3MF",
                "For 3-D printing: closed bodies in millimetres, each with its name",
                kBodies,
                "model/3mf",
            ),
            format("stl", "STL", "For 3-D printing: closed bodies in millimetres, all as one", kBodies, "model/stl"),
        ],
    },
    {
        title: "To model",
        formats: [
            format(
                "glb",
                "GLB",
                "glTF for viewers, the web and Blender, with the cells’ colours",
                kBodies,
                "model/gltf-binary",
            ),
            format("ply", "PLY", "Triangles with the cells’ colours, for MeshLab and others", kBodies, "model/ply"),
            format("obj", "OBJ", "Read by nearly all that models, a group for each cell", kBodies, "model/obj"),
        ],
    },
    {
        title: "As data",
        formats: [
            format(
                "off",
                "4OFF",
                "The whole polytope as turned, for other 4-D programs and to be imported again",
                [],
                "text/plain",
            ),
            format(
                "csv",
                "CSV",
                "w, elements, volume, area and centroid of each slice, and the critical w",
                [],
                "text/csv",
            ),
        ],
    },
    {
        title: "As a figure",
        formats: [
            format("png", "PNG", "The picture; it holds the state and can be opened again", ["pixels"], "image/png"),
            format("svg", "SVG", "The parallel coordinates, as lines that stay sharp at any size", [], "image/svg+xml"),
        ],
    },
];

function format(name: string, label: string, about: string, choices: Choice[], type: string): Format {
    return { name, label, about, choices, type };
}
