// The painter's order of a mesh, which is exact for convex slices that do not overlap: slices from far to near; within
// a slice the back faces, the balls and bars on them, the front faces, and the other balls and bars. Vertices are
// ordered from far to near, each followed by the bars to nearer vertices; a bar therefore covers its farther ball and
// is covered by its nearer ball.

import type { Parts } from "@oval4d/protocol";

import { type Body, Buckets, type Elements, roomFor } from "./elements";
import type { Lens } from "./lens";
import { sortByKey } from "./sort";

type SolidParts = Pick<Parts, "faces" | "bars" | "balls">;

const kQuad = [0, 1, 2, 2, 1, 3] as const;

export class PaintersOrder {
    private shown: SolidParts = { faces: true, bars: true, balls: true };
    private vertexToward = new Uint8Array(0);
    private edgeToward = new Uint8Array(0);
    private faceToward = new Uint8Array(0);
    private depth = new Float32Array(0); // of each vertex
    private order = new Uint32Array(0); // each slice's vertices from far to near
    private scratch = new Uint32Array(0); // for sorting
    private rank = new Uint32Array(0); // the position of each vertex in `order`
    private readonly bodies: Body[] = []; // from far to near
    private readonly bars = new Buckets(); // edges by the rank of the farther vertex
    private out = new Uint32Array(0);
    private used = 0;

    constructor(private readonly elements: Elements) {}

    /** Sets which parts are painted, and makes room for new elements. */
    show(parts: SolidParts): void {
        this.shown = parts;
        const { vertexCount, edgeCount, faceCount } = this.elements;
        this.vertexToward = roomFor(this.vertexToward, vertexCount);
        this.edgeToward = roomFor(this.edgeToward, edgeCount);
        this.faceToward = roomFor(this.faceToward, faceCount);
        this.depth = roomFor(this.depth, vertexCount);
        this.order = roomFor(this.order, vertexCount);
        this.scratch = roomFor(this.scratch, vertexCount);
        this.rank = roomFor(this.rank, vertexCount);
    }

    /** Writes the mesh's indices into `out`; returns their number. */
    write(lens: Lens, out: Uint32Array<ArrayBuffer>): number {
        this.out = out;
        this.used = 0;
        this.sortBodies(lens);
        for (const body of this.bodies) {
            this.classify(body, lens);
            this.sortByDepth(body, lens);
            for (const toward of [0, 1]) {
                if (this.shown.faces) this.paintFaces(body, toward);
                this.paintFrame(body, toward);
            }
        }
        return this.used;
    }

    private sortBodies({ eye }: Lens): void {
        this.bodies.length = 0;
        for (const body of this.elements.bodies) {
            const [x, y, z] = body.position;
            body.distance = Math.hypot(x - eye.x, y - eye.y, z - eye.z);
            this.bodies.push(body);
        }
        this.bodies.sort((a, b) => b.distance - a.distance);
    }

    /** Determines which faces are front faces; a vertex or edge is in front if any of its faces is. */
    private classify({ vertices, edges, faces }: Body, { eye }: Lens): void {
        const { points, corners, cornerBegin, cornerEdges, normals } = this.elements;
        this.vertexToward.fill(0, ...vertices);
        this.edgeToward.fill(0, ...edges);
        for (let f = faces[0]; f < faces[1]; ++f) {
            const p = 3 * corners[cornerBegin[f]!]!;
            const facing =
                normals[3 * f]! * (eye.x - points[p]!) +
                normals[3 * f + 1]! * (eye.y - points[p + 1]!) +
                normals[3 * f + 2]! * (eye.z - points[p + 2]!);
            this.faceToward[f] = facing > 0 ? 1 : 0;
            if (facing <= 0) continue;
            for (let c = cornerBegin[f]!; c < cornerBegin[f + 1]!; ++c) {
                this.vertexToward[corners[c]!] = 1;
                this.edgeToward[cornerEdges[c]!] = 1;
            }
        }
    }

    private sortByDepth({ vertices, edges: range }: Body, { view: { elements: view } }: Lens): void {
        const { depth, order, rank } = this;
        const { points, edges } = this.elements;
        for (let v = vertices[0]; v < vertices[1]; ++v) {
            depth[v] = view[2]! * points[3 * v]! + view[6]! * points[3 * v + 1]! + view[10]! * points[3 * v + 2]!;
            order[v] = v;
        }
        sortByKey(order, vertices, depth, this.scratch);
        for (let i = vertices[0]; i < vertices[1]; ++i) rank[order[i]!] = i;
        this.bars.sort(vertices, range, (e) => Math.min(rank[edges[2 * e]!]!, rank[edges[2 * e + 1]!]!));
    }

    private paintFaces({ faces }: Body, toward: number): void {
        const { cornerBegin, vertexCount, edgeCount } = this.elements;
        for (let f = faces[0]; f < faces[1]; ++f) {
            if (this.faceToward[f] !== toward) continue;
            const first = 4 * (vertexCount + edgeCount) + cornerBegin[f]!;
            for (let k = 2; k < cornerBegin[f + 1]! - cornerBegin[f]!; ++k) {
                this.out[this.used++] = first;
                this.out[this.used++] = first + k - 1;
                this.out[this.used++] = first + k;
            }
        }
    }

    private paintFrame({ vertices }: Body, toward: number): void {
        const { begin, items } = this.bars;
        const { balls, bars } = this.shown;
        for (let i = vertices[0]; i < vertices[1]; ++i) {
            const v = this.order[i]!;
            if ((balls || bars) && this.vertexToward[v] === toward) this.paintQuad(v);
            if (!bars) continue;
            for (let k = begin[i]!; k < begin[i + 1]!; ++k) {
                if (this.edgeToward[items[k]!] === toward) this.paintQuad(this.elements.vertexCount + items[k]!);
            }
        }
    }

    private paintQuad(number: number): void {
        for (const corner of kQuad) this.out[this.used++] = 4 * number + corner;
    }
}
