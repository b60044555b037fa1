// Finds the parts of a picture that show an element of the polytope: its pieces in the slices and in the projection,
// and its vertices, if the picture determines them. A source is a number in `of` (see Elements): it identifies the
// element of the polytope from which a part of the picture was cut.
//
// The vertices of an element of a convex polytope follow from the hyperplanes of the cells around it. The slice of a
// cell lies in a plane. Only one hyperplane contains this plane and has the whole polytope on one side: the hyperplane
// of the cell.

import type { Elements, PolytopeElement, Slice, Slices } from "@oval4d/protocol";

import type { Hit } from "./hit_test";
import type { ElementCounts, HighlightedElements } from "./highlighted_elements";
import { doubleAreaVector } from "./polygon";

const kFlat = 1e-5; // circumradii: a vertex up to this distance from a hyperplane counts as lying in it
const kLevel = 1e-4; // circumradii along w: vertices nearer to a slice are not used to find the slope m of a hyperplane

/** The hyperplane a · x + b · y + c · z + m · w = offset, with a unit vector (a, b, c). */
type Hyperplane = readonly [a: number, b: number, c: number, m: number, offset: number];

/** The element of the polytope that was hit. */
export function elementOfHit({ kind, source }: Hit, counts: ElementCounts): PolytopeElement {
    if (kind === "points") {
        if (source < counts.faces) return { element: "face", number: source };
        return elementOfHit({ kind: "vertices", source: source - counts.faces }, counts);
    }
    const [cut, inside, count] = (
        {
            vertices: ["edge", "vertex", counts.edges],
            edges: ["face", "edge", counts.faces],
            faces: ["cell", "face", counts.cells],
        } as const
    )[kind];
    return source < count ? { element: cut, number: source } : { element: inside, number: source - count };
}

export class ElementSources {
    private readonly hyperplanes = new Map<number, Hyperplane | undefined>(); // by cell
    private readonly slicesAndParts: Elements[]; // the slices, and the parts of the projection
    private readonly slices: Slice[];

    constructor(
        private readonly picture: Slices,
        private readonly counts: ElementCounts,
    ) {
        // Includes slices that are not drawn, because these also contain the data that determine elements.
        this.slices = picture.slices.filter((slice) => slice.vertices.length > 0);
        this.slicesAndParts = [...this.slices, ...(picture.projection?.parts ?? [])];
    }

    /** The sources of the parts of the picture that show the element, and the vertices of the element. */
    partsShowing(element: PolytopeElement): HighlightedElements {
        const ownVertices = this.verticesOf(element);
        const { number } = element;
        const { edges: edgeCount, faces: faceCount } = this.counts;
        const vertices = new Set<number>();
        const edges = new Set<number>();
        if (element.element === "vertex") {
            vertices.add(edgeCount + number);
            this.addCutEdgesAt(number, vertices);
        } else if (element.element === "edge") {
            vertices.add(number);
            edges.add(faceCount + number);
        } else {
            if (element.element === "face") this.addFace(number, edges);
            else this.addSlicedElementsOf(number, edges);
            if (element.element === "cell") this.addElementsInSectionsOf(number, edges);
            this.addEdgesBetween(ownVertices, edges);
        }
        return { vertices, edges, ownVertices, ...(element.element === "cell" && { cell: number }) };
    }

    /** The vertices of an element, numbered as in `coordinates`; empty if the picture does not determine them. */
    private verticesOf({ element, number }: PolytopeElement): ReadonlySet<number> {
        const { edges: edgeCount, faces: faceCount, cells: cellCount } = this.counts;
        if (element === "vertex") return new Set([number]);
        const found = new Set<number>();
        for (const { edges, faces, of } of this.slicesAndParts) {
            const addVertex = (v: number): void => {
                if (of.vertices[v]! >= edgeCount) found.add(of.vertices[v]! - edgeCount);
            };
            if (element === "edge") {
                const e = of.edges.indexOf(faceCount + number);
                if (e >= 0) edges.subarray(2 * e, 2 * e + 2).forEach(addVertex);
            } else if (element === "face") {
                const f = of.faces.indexOf(cellCount + number);
                if (f >= 0) faces.corners.subarray(faces.begin[f], faces.begin[f + 1]).forEach(addVertex);
            }
            if (found.size > 0) return found;
        }
        const cells = element === "cell" ? [number] : this.cellsAround(element, number);
        const count = this.picture.coordinates.length / 4;
        for (let v = 0; cells.length > 0 && v < count; ++v) {
            if (cells.every((cell) => this.isVertexOf(v, cell))) found.add(v);
        }
        return found;
    }

    /**
     * The cells around an edge or a 2-face. If a slice cuts the element, they are the cells whose faces in the slice
     * meet at the cut. If no slice cuts a 2-face, the planar sections give its cells. Empty if the picture does not
     * determine the cells.
     */
    private cellsAround(element: "edge" | "face", number: number): number[] {
        for (const { vertices, edges, faces, of } of this.slices) {
            const at = (element === "edge" ? of.vertices : of.edges).indexOf(number);
            if (at < 0) continue;
            const ends = element === "edge" ? [at] : [edges[2 * at]!, edges[2 * at + 1]!];
            const cells: number[] = [];
            const isEnd = new Uint8Array(vertices.length / 3);
            for (const end of ends) isEnd[end] = 1;
            for (let f = 0; f + 1 < faces.begin.length; ++f) {
                let met = 0;
                for (let c = faces.begin[f]!; c < faces.begin[f + 1]!; ++c) met += isEnd[faces.corners[c]!]!;
                if (met === ends.length) cells.push(of.faces[f]!);
            }
            return cells.every((cell) => cell < this.counts.cells) ? cells : [];
        }
        return element === "face" ? this.cellsInSections(number) : [];
    }

    /** The two cells that meet at a 2-face; empty unless a planar section cuts the 2-face. */
    private cellsInSections(face: number): number[] {
        for (const { edges, of } of this.picture.matrix?.sections ?? []) {
            const at = of.points.indexOf(face);
            const cells = at < 0 ? [] : of.edges.filter((_, e) => edges[e]!.includes(at));
            if (cells.length === 2) return cells;
        }
        return [];
    }

    /**
     * Adds those edges that end at a vertex and that slices cut. An edge ends at the vertex if all cells around the
     * edge contain the vertex.
     */
    private addCutEdgesAt(vertex: number, sources: Set<number>): void {
        for (const { vertices, faces, of } of this.slices) {
            const candidates = new Uint8Array(vertices.length / 3);
            for (const wanted of [true, false]) {
                for (let f = 0; f + 1 < faces.begin.length; ++f) {
                    if (this.isVertexOf(vertex, of.faces[f]!) !== wanted) continue;
                    const corners = faces.corners.subarray(faces.begin[f], faces.begin[f + 1]);
                    for (const corner of corners) candidates[corner] = wanted ? 1 : 0;
                }
            }
            candidates.forEach((isAtVertex, v) => {
                if (isAtVertex && of.vertices[v]! < this.counts.edges) sources.add(of.vertices[v]!);
            });
        }
    }

    /** Adds a 2-face, and those of its edges that slices cut. */
    private addFace(face: number, sources: Set<number>): void {
        sources.add(face);
        for (const { edges, of } of this.slices) {
            const e = of.edges.indexOf(face);
            if (e >= 0) edges.subarray(2 * e, 2 * e + 2).forEach((v) => this.addCutEdge(of.vertices[v]!, sources));
        }
    }

    /**
     * Adds the edge from which a vertex of a slice was cut. `source` is the source of the vertex. Does nothing if the
     * vertex is a vertex of the polytope itself.
     */
    private addCutEdge(source: number, sources: Set<number>): void {
        if (source < this.counts.edges) sources.add(this.counts.faces + source);
    }

    /** Adds those 2-faces and edges of a cell that slices cut or contain. */
    private addSlicedElementsOf(cell: number, sources: Set<number>): void {
        for (const { vertices, edges, faces, of } of this.slices) {
            if (!of.faces.includes(cell)) continue;
            const isCorner = new Uint8Array(vertices.length / 3);
            for (let f = 0; f < of.faces.length; ++f) {
                if (of.faces[f] !== cell) continue; // the slice of a star-shaped cell consists of several loops
                for (const corner of faces.corners.subarray(faces.begin[f], faces.begin[f + 1])) isCorner[corner] = 1;
            }
            isCorner.forEach((isIn, v) => isIn && this.addCutEdge(of.vertices[v]!, sources));
            for (let e = 0; e < of.edges.length; ++e) {
                if (isCorner[edges[2 * e]!] && isCorner[edges[2 * e + 1]!]) sources.add(of.edges[e]!);
            }
        }
    }

    /**
     * Adds those 2-faces and edges of a cell that planar sections cut. A planar section cuts the cell in edges, and the
     * points at which these edges end are cut from 2-faces or edges of the cell.
     */
    private addElementsInSectionsOf(cell: number, sources: Set<number>): void {
        for (const { edges, of } of this.picture.matrix?.sections ?? []) {
            for (const end of edges.filter((_, e) => of.edges[e] === cell).flat()) {
                const source = of.points[end]!;
                if (source < this.counts.faces + this.counts.edges) sources.add(source);
            }
        }
    }

    /** Adds those edges in slices and in the projection whose two vertices are in `own`. */
    private addEdgesBetween(own: ReadonlySet<number>, sources: Set<number>): void {
        const { edges: edgeCount, faces: faceCount } = this.counts;
        for (const { edges, of } of this.slicesAndParts) {
            const isOwn = (v: number): boolean => own.has(of.vertices[v]! - edgeCount);
            of.edges.forEach((source, e) => {
                if (source >= faceCount && isOwn(edges[2 * e]!) && isOwn(edges[2 * e + 1]!)) sources.add(source);
            });
        }
    }

    private isVertexOf(vertex: number, cell: number): boolean {
        const plane = this.hyperplaneOf(cell);
        if (!plane) return false;
        return Math.abs(heightAbove(plane, this.picture.coordinates, vertex)) <= kFlat * this.circumradius;
    }

    private get circumradius(): number {
        return this.picture.scene.circumradius;
    }

    /** The hyperplane of a cell that a slice cuts; undefined if the picture does not determine the hyperplane. */
    private hyperplaneOf(cell: number): Hyperplane | undefined {
        if (!this.hyperplanes.has(cell)) this.hyperplanes.set(cell, this.findHyperplane(cell));
        return this.hyperplanes.get(cell);
    }

    private findHyperplane(cell: number): Hyperplane | undefined {
        const { coordinates, scene } = this.picture;
        const isConvex = scene.opacity < 1; // see `opacity` in protocol/README.md
        if (!isConvex || cell >= this.counts.cells) return undefined;
        let [largest, extent]: [readonly [Slice, number] | undefined, number] = [undefined, 0];
        for (const slice of this.slices) {
            const f = slice.of.faces.indexOf(cell);
            const area = f < 0 ? 0 : Math.hypot(...doubleAreaVectorOf(slice, f));
            if (area > extent) [largest, extent] = [[slice, f], area];
        }
        if (!largest) return undefined;
        const [slice, f] = largest;
        const [a, b, c] = doubleAreaVectorOf(slice, f).map((value) => value / extent) as [number, number, number];
        const p = 3 * slice.faces.corners[slice.faces.begin[f]!]!;
        const [x, y, z] = slice.vertices.subarray(p, p + 3);
        const offset = a * x! + b * y! + c * z!;
        // All vertices satisfy a · x + b · y + c · z + m · (w − slice.w) ≤ offset. So each vertex with w > slice.w
        // gives an upper bound of m. The least of these bounds is m itself, because equality holds for the vertices of
        // this cell.
        let m = Infinity;
        for (let v = 0; v < coordinates.length; v += 4) {
            const level = coordinates[v + 3]! - slice.w;
            if (level <= kLevel * this.circumradius) continue;
            const height = a * coordinates[v]! + b * coordinates[v + 1]! + c * coordinates[v + 2]! - offset;
            m = Math.min(m, -height / level);
        }
        return m < Infinity ? [a, b, c, m, offset + m * slice.w] : undefined;
    }
}

function heightAbove([a, b, c, m, offset]: Hyperplane, points: Float32Array, v: number): number {
    const [x, y, z, w] = [points[4 * v]!, points[4 * v + 1]!, points[4 * v + 2]!, points[4 * v + 3]!];
    return a * x + b * y + c * z + m * w - offset;
}

/** The outward normal of a face of a slice; its length is twice the area. */
function doubleAreaVectorOf({ vertices, faces: { begin, corners } }: Slice, f: number): [number, number, number] {
    return doubleAreaVector(vertices, corners, [begin[f]!, begin[f + 1]!]);
}
