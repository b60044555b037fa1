// The painter's algorithm for the mesh of slices_mesh.ts: sorts shapes so that later ones cover earlier ones. Slices
// are painted from far to near. Of each slice, the back faces come first, then the balls and bars on the back, then the
// front faces, then all other balls and bars. Balls are painted from far to near. After each ball, its bars to nearer
// balls follow, so a bar covers its farther ball, and its nearer ball covers the bar. This order is exact for convex
// slices that do not overlap.

import type { Parts } from "@oval4d/protocol";

import { EdgesByVertex, ensureCapacity, type SliceElements, type SliceElementRanges } from "./elements";
import { kQuadTriangles } from "./shape_buffers";
import { sortByKey } from "./sort";
import type { ViewCamera } from "./view_camera";

type ShownSolidParts = Pick<Parts, "faces" | "bars" | "balls">;

export class PaintersOrder {
    private shown: ShownSolidParts = { faces: true, bars: true, balls: true };
    private vertexInFront = new Uint8Array(0);
    private edgeInFront = new Uint8Array(0);
    private faceInFront = new Uint8Array(0);
    private nearness = new Float32Array(0); // one number for each vertex; larger is nearer to the viewer
    private order = new Uint32Array(0); // the vertices of each slice, from far to near
    private scratch = new Uint32Array(0); // working memory of sortByKey()
    private rank = new Uint32Array(0); // the index of each vertex in `order`
    private readonly sliceRanges: SliceElementRanges[] = []; // the slices from far to near
    // The edges of a slice, grouped by the index in `order` of each edge's farther vertex.
    private readonly edgesByRank = new EdgesByVertex();
    private out = new Uint32Array(0);
    private used = 0;

    constructor(private readonly elements: SliceElements) {}

    /** Sets which parts are painted, and makes room for the elements of a new picture. */
    update(parts: ShownSolidParts): void {
        this.shown = parts;
        const { vertexCount, edgeCount, faceCount } = this.elements;
        this.vertexInFront = ensureCapacity(this.vertexInFront, vertexCount);
        this.edgeInFront = ensureCapacity(this.edgeInFront, edgeCount);
        this.faceInFront = ensureCapacity(this.faceInFront, faceCount);
        this.nearness = ensureCapacity(this.nearness, vertexCount);
        this.order = ensureCapacity(this.order, vertexCount);
        this.scratch = ensureCapacity(this.scratch, vertexCount);
        this.rank = ensureCapacity(this.rank, vertexCount);
    }

    /** Writes the indices of the mesh in painting order to `out`, and returns their number. */
    writeIndices(viewCamera: ViewCamera, out: Uint32Array<ArrayBuffer>): number {
        this.out = out;
        this.used = 0;
        this.sortSlices(viewCamera);
        for (const ranges of this.sliceRanges) {
            this.findFrontElements(ranges, viewCamera);
            this.sortVerticesAndEdgesByDepth(ranges, viewCamera);
            for (const front of [0, 1]) {
                if (this.shown.faces) this.writeFaceIndices(ranges, front);
                this.writeBallAndBarIndices(ranges, front);
            }
        }
        return this.used;
    }

    private sortSlices({ eye }: ViewCamera): void {
        this.sliceRanges.length = 0;
        for (const ranges of this.elements.sliceRanges) {
            const [x, y, z] = ranges.position;
            ranges.distance = Math.hypot(x - eye.x, y - eye.y, z - eye.z);
            this.sliceRanges.push(ranges);
        }
        this.sliceRanges.sort((a, b) => b.distance - a.distance);
    }

    /** Finds the faces of a slice that are turned toward the viewer. A vertex or an edge of such a face is in front. */
    private findFrontElements({ vertices, edges, faces }: SliceElementRanges, { eye }: ViewCamera): void {
        const { points, corners, cornerBegin, cornerEdges, normals } = this.elements;
        this.vertexInFront.fill(0, ...vertices);
        this.edgeInFront.fill(0, ...edges);
        for (let f = faces[0]; f < faces[1]; ++f) {
            const p = 3 * corners[cornerBegin[f]!]!;
            const facing =
                normals[3 * f]! * (eye.x - points[p]!) +
                normals[3 * f + 1]! * (eye.y - points[p + 1]!) +
                normals[3 * f + 2]! * (eye.z - points[p + 2]!);
            this.faceInFront[f] = facing > 0 ? 1 : 0;
            if (facing <= 0) continue;
            for (let c = cornerBegin[f]!; c < cornerBegin[f + 1]!; ++c) {
                this.vertexInFront[corners[c]!] = 1;
                this.edgeInFront[cornerEdges[c]!] = 1;
            }
        }
    }

    private sortVerticesAndEdgesByDepth({ vertices, edges: range }: SliceElementRanges, { view: { elements: view } }: ViewCamera): void {
        const { nearness, order, rank } = this;
        const { points, edges } = this.elements;
        for (let v = vertices[0]; v < vertices[1]; ++v) {
            nearness[v] = view[2]! * points[3 * v]! + view[6]! * points[3 * v + 1]! + view[10]! * points[3 * v + 2]!;
            order[v] = v;
        }
        sortByKey(order, vertices, nearness, this.scratch);
        for (let i = vertices[0]; i < vertices[1]; ++i) rank[order[i]!] = i;
        this.edgesByRank.groupEdges(vertices, range, (e) => Math.min(rank[edges[2 * e]!]!, rank[edges[2 * e + 1]!]!));
    }

    private writeFaceIndices({ faces }: SliceElementRanges, front: number): void {
        const { cornerBegin, vertexCount, edgeCount } = this.elements;
        for (let f = faces[0]; f < faces[1]; ++f) {
            if (this.faceInFront[f] !== front) continue;
            const first = 4 * (vertexCount + edgeCount) + cornerBegin[f]!;
            for (let k = 2; k < cornerBegin[f + 1]! - cornerBegin[f]!; ++k) {
                this.out[this.used++] = first;
                this.out[this.used++] = first + k - 1;
                this.out[this.used++] = first + k;
            }
        }
    }

    private writeBallAndBarIndices({ vertices }: SliceElementRanges, front: number): void {
        const { begin, items } = this.edgesByRank;
        const { balls, bars } = this.shown;
        for (let i = vertices[0]; i < vertices[1]; ++i) {
            const v = this.order[i]!;
            if ((balls || bars) && this.vertexInFront[v] === front) this.writeQuadIndices(v);
            if (!bars) continue;
            for (let k = begin[i]!; k < begin[i + 1]!; ++k) {
                if (this.edgeInFront[items[k]!] === front) this.writeQuadIndices(this.elements.vertexCount + items[k]!);
            }
        }
    }

    private writeQuadIndices(number: number): void {
        for (const corner of kQuadTriangles) this.out[this.used++] = 4 * number + corner;
    }
}
