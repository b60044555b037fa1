// The vertices, edges and faces of all drawn slices, in world coordinates. They are in flat arrays, which each new
// picture overwrites.

import type { SceneDescription, Slice, Slices, Vector } from "@oval4d/protocol";

/** A half-open range of indices in the arrays of SliceElements: `begin` is included, `end` is not. */
export type IndexRange = [begin: number, end: number];

/** A slice, and the ranges of its vertices, edges and faces in the arrays. */
export interface SliceElementRanges {
    slice: Slice;
    position: Vector;
    vertices: IndexRange;
    edges: IndexRange;
    faces: IndexRange;
    distance: number; // the distance from `position` to the eye when the slices were last sorted
}

/** The flat arrays of the vertices, edges and faces of all drawn slices. */
export class SliceElements {
    sliceRanges: SliceElementRanges[] = [];
    vertexCount = 0;
    edgeCount = 0;
    faceCount = 0;
    cornerCount = 0;
    points = new Float32Array(0); // x, y, z of each vertex
    edges = new Uint32Array(0); // the indices of two vertices for each edge
    cornerBegin = new Uint32Array(1); // face f has corners[cornerBegin[f]] … corners[cornerBegin[f + 1] − 1]
    corners = new Uint32Array(0);
    // For each corner, the index of the edge from this corner to the next corner of its face.
    cornerEdges = new Uint32Array(0);
    normals = new Float32Array(0); // x, y, z of each face's outward normal
    // The edges of the slice that is being written, grouped by the smaller vertex index of each edge.
    readonly edgesByVertex = new EdgesByVertex();
    private readonly spare: SliceElementRanges[] = []; // unused objects, kept for pictures with more slices

    /** Replaces the elements by the elements of a new picture. */
    update({ slices, scene }: Slices): void {
        this.vertexCount = this.edgeCount = this.faceCount = this.cornerCount = 0;
        while (this.sliceRanges.length > 0) this.spare.push(this.sliceRanges.pop()!);
        for (const slice of slices) {
            if (slice.drawn && slice.vertices.length > 0) this.sliceRanges.push(this.addSlice(slice));
        }
        this.points = ensureCapacity(this.points, 3 * this.vertexCount);
        this.edges = ensureCapacity(this.edges, 2 * this.edgeCount);
        this.cornerBegin = ensureCapacity(this.cornerBegin, this.faceCount + 1);
        this.corners = ensureCapacity(this.corners, this.cornerCount);
        this.cornerEdges = ensureCapacity(this.cornerEdges, this.cornerCount);
        this.normals = ensureCapacity(this.normals, 3 * this.faceCount);
        for (const ranges of this.sliceRanges) this.writeSlice(ranges, scene);
    }

    private addSlice(slice: Slice): SliceElementRanges {
        const { vertexCount, edgeCount, faceCount } = this;
        this.vertexCount += slice.vertices.length / 3;
        this.edgeCount += slice.edges.length / 2;
        this.faceCount += slice.faces.begin.length - 1;
        this.cornerCount += slice.faces.corners.length;
        const ranges = this.spare.pop() ?? emptyRanges(slice);
        ranges.slice = slice;
        ranges.position = slice.position;
        setRange(ranges.vertices, vertexCount, this.vertexCount);
        setRange(ranges.edges, edgeCount, this.edgeCount);
        setRange(ranges.faces, faceCount, this.faceCount);
        return ranges;
    }

    private writeSlice({ slice, position, vertices, edges, faces }: SliceElementRanges, scene: SceneDescription): void {
        const begin = slice.faces.begin;
        const firstCorner = this.cornerBegin[faces[0]]!;
        for (let i = 0; i < slice.vertices.length; ++i) {
            this.points[3 * vertices[0] + i] = position[i % 3]! + scene.scale * slice.vertices[i]!;
        }
        for (let i = 0; i < slice.edges.length; ++i) this.edges[2 * edges[0] + i] = vertices[0] + slice.edges[i]!;
        for (let i = 0; i < begin.length; ++i) this.cornerBegin[faces[0] + i] = firstCorner + begin[i]!;
        for (let i = 0; i < slice.faces.corners.length; ++i) {
            this.corners[firstCorner + i] = vertices[0] + slice.faces.corners[i]!;
        }
        this.edgesByVertex.groupEdges(vertices, edges, (e) => Math.min(this.edges[2 * e]!, this.edges[2 * e + 1]!));
        for (let f = faces[0]; f < faces[1]; ++f) {
            this.computeNormal(f);
            this.findCornerEdges(f);
        }
    }

    /** The vertex at the corner after corner c of face f. The last corner is followed by the first. */
    private nextCorner(f: number, c: number): number {
        return this.corners[c + 1 < this.cornerBegin[f + 1]! ? c + 1 : this.cornerBegin[f]!]!;
    }

    private findCornerEdges(f: number): void {
        for (let c = this.cornerBegin[f]!; c < this.cornerBegin[f + 1]!; ++c) {
            const a = this.corners[c]!;
            const b = this.nextCorner(f, c);
            const { begin, items } = this.edgesByVertex;
            const lower = Math.min(a, b);
            for (let k = begin[lower]!; k < begin[lower + 1]!; ++k) {
                const e = items[k]!;
                if (this.edges[2 * e]! + this.edges[2 * e + 1]! === a + b) this.cornerEdges[c] = e;
            }
        }
    }

    private computeNormal(f: number): void {
        const { points, corners, normals } = this;
        let [x, y, z] = [0, 0, 0];
        for (let c = this.cornerBegin[f]!; c < this.cornerBegin[f + 1]!; ++c) {
            const p = 3 * corners[c]!;
            const q = 3 * this.nextCorner(f, c);
            x += (points[p + 1]! - points[q + 1]!) * (points[p + 2]! + points[q + 2]!);
            y += (points[p + 2]! - points[q + 2]!) * (points[p]! + points[q]!);
            z += (points[p]! - points[q]!) * (points[p + 1]! + points[q + 1]!);
        }
        const length = Math.hypot(x, y, z) || 1;
        normals[3 * f] = x / length;
        normals[3 * f + 1] = y / length;
        normals[3 * f + 2] = z / length;
    }
}

function emptyRanges(slice: Slice): SliceElementRanges {
    return { slice, position: slice.position, vertices: [0, 0], edges: [0, 0], faces: [0, 0], distance: 0 };
}

function setRange(range: IndexRange, begin: number, end: number): void {
    range[0] = begin;
    range[1] = end;
}

/**
 * Groups the edges of a slice by one of their vertices, with a counting sort. `vertexOf` returns this vertex for an
 * edge. The edges of vertex v are items[begin[v]] … items[begin[v + 1] − 1].
 */
export class EdgesByVertex {
    begin = new Uint32Array(0);
    items = new Uint32Array(0);

    groupEdges(vertices: IndexRange, edges: IndexRange, vertexOf: (edge: number) => number): void {
        this.begin = ensureCapacity(this.begin, vertices[1] + 1);
        this.items = ensureCapacity(this.items, edges[1] - edges[0]);
        const { begin, items } = this;
        begin.fill(0, vertices[0], vertices[1] + 1);
        for (let e = edges[0]; e < edges[1]; ++e) ++begin[vertexOf(e)]!;
        for (let v = vertices[0] + 1; v <= vertices[1]; ++v) begin[v]! += begin[v - 1]!;
        // begin[v] is now the end of the range for vertex v. The next loop fills each range from its end, and thereby
        // moves begin[v] to the beginning.
        for (let e = edges[1]; e-- > edges[0]; ) items[--begin[vertexOf(e)]!] = e;
    }
}

/**
 * Returns the array if it has at least `length` elements. Otherwise returns a larger array that begins with the same
 * contents.
 */
export function ensureCapacity<T extends Float32Array | Uint32Array | Uint8Array>(array: T, length: number): T {
    if (array.length >= length) return array;
    const larger = new (array.constructor as new (length: number) => T)(2 ** Math.ceil(Math.log2(length)));
    larger.set(array);
    return larger;
}
