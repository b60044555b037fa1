// Which elements are drawn in the highlight color. They are the kept element and the element under the pointer. The
// kept element, which the user has clicked, is the `highlight` of the state.

import type { Highlight, PolytopeElement, SceneDescription, Slices, State } from "@oval4d/protocol";

/** The numbers of edges, faces and cells that the polytope has. */
export type ElementCounts = Pick<State["polytope"], "edges" | "faces" | "cells">;

/** The vertices, edges and faces of a picture that are drawn in the highlight color. */
export interface HighlightedElements {
    /**
     * Numbers in the arrays `of.vertices` and `of.edges` of slices and of the projection. The number of a slice vertex
     * or edge identifies the element of the polytope from which it was cut.
     */
    vertices: ReadonlySet<number>;
    edges: ReadonlySet<number>;
    /** Vertices of the polytope, numbered as in `coordinates`. */
    ownVertices: ReadonlySet<number>;
    /** The cell under the pointer, whose faces are highlighted. The server colors the faces of the kept cell. */
    cell?: number;
}

/**
 * The parts of a picture that show the element under the pointer. `highlight` is the server's answer about the element.
 * Without it, the parts are only those that are sections of the element itself.
 */
export function pointedElements(
    pointed: PolytopeElement,
    counts: ElementCounts,
    highlight: Highlight = highlightWithoutAnswer(pointed, counts),
): HighlightedElements {
    return {
        vertices: new Set(highlight.vertices),
        edges: new Set(highlight.edges),
        ownVertices: new Set(highlight.own_vertices),
        ...(pointed.element === "cell" && { cell: pointed.number }),
    };
}

/**
 * The parts of a picture that are sections of an element itself. The sections of a cell are faces, which `cell`
 * highlights.
 */
function highlightWithoutAnswer({ element, number }: PolytopeElement, { edges, faces }: ElementCounts): Highlight {
    const own: Record<PolytopeElement["element"], Partial<Highlight>> = {
        vertex: { vertices: [edges + number], own_vertices: [number] },
        edge: { vertices: [number], edges: [faces + number] },
        face: { edges: [number] },
        cell: {},
    };
    return { vertices: [], edges: [], own_vertices: [], ...own[element] };
}

/** The parts of a picture that show the kept element and the element under the pointer. */
export function highlightedAndPointedElements(
    { highlight }: Slices,
    pointed: HighlightedElements | undefined,
): HighlightedElements {
    return {
        vertices: new Set([...(highlight?.vertices ?? []), ...(pointed?.vertices ?? [])]),
        edges: new Set([...(highlight?.edges ?? []), ...(pointed?.edges ?? [])]),
        ownVertices: new Set([...(highlight?.own_vertices ?? []), ...(pointed?.ownVertices ?? [])]),
        ...(pointed?.cell !== undefined && { cell: pointed.cell }),
    };
}

/** The difference between two highlights of the same picture. */
export interface HighlightChange {
    /**
     * Flags for numbers in `of.vertices` and `of.edges`; a flag is set if only one of the highlights has the number.
     * See isFlagged().
     */
    vertices: Uint8Array;
    edges: Uint8Array;
    /** The numbers of the cells whose faces must be colored again. */
    cells: readonly (number | undefined)[];
}

/** Whether the flag of n is set; not set for numbers beyond the end. Flags in an array are faster than a set. */
export function isFlagged(flags: Uint8Array, n: number): boolean {
    return n < flags.length && flags[n] === 1;
}

export function highlightChangeBetween(before: HighlightedElements, after: HighlightedElements): HighlightChange {
    return {
        vertices: flagsOfDifference(before.vertices, after.vertices),
        edges: flagsOfDifference(before.edges, after.edges),
        cells: before.cell === after.cell ? [] : [before.cell, after.cell],
    };
}

/** Flags for numbers; a flag is set if exactly one of the two sets has the number. */
function flagsOfDifference(before: ReadonlySet<number>, after: ReadonlySet<number>): Uint8Array {
    const differing = [...before].filter((n) => !after.has(n)).concat([...after].filter((n) => !before.has(n)));
    const flags = new Uint8Array(differing.reduce((most, n) => Math.max(most, n + 1), 0));
    for (const n of differing) flags[n] = 1;
    return flags;
}

/**
 * The color of a cell's faces: the highlight color if the cell is under the pointer, otherwise the cell's own color.
 */
export function cellColor(cell: number, colors: SceneDescription["colors"], highlighted: HighlightedElements): number {
    return cell === highlighted.cell ? colors.highlight : (colors.cells[cell] ?? colors.bar);
}

/**
 * Whether a point of a planar section shows a highlighted element. `source` is the number of the point in `of.points`.
 */
export function isPointHighlighted(source: number, { vertices, edges }: HighlightedElements, counts: ElementCounts): boolean {
    return source < counts.faces + counts.edges ? edges.has(source) : vertices.has(source - counts.faces);
}
