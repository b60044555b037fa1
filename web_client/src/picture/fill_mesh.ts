// The triangles that are drawn instead of the faces of slices that need not be convex, with a depth buffer: first all
// fully visible ones, then the faded ones, with the slices ordered from far to near.

import { BufferGeometry } from "three";

import type { Fill, Slices, Vector } from "@oval4d/protocol";

import { GrowingBuffer } from "./growing";
import type { Lens } from "./lens";
import { kFace } from "./shaders";

/** Values of a fill's `seen`. */
const kFaded = 1;
const kFull = 2;

/** One slice's part of the mesh. */
interface Part {
    fill: Fill;
    position: Vector;
    first: number; // index of its first point
}

export class FillMesh {
    readonly geometry = new BufferGeometry();
    private parts: Part[] = [];
    private readonly at = new GrowingBuffer(Float32Array, 3);
    private readonly to = new GrowingBuffer(Float32Array, 3);
    private readonly shape = new GrowingBuffer(Int8Array, 4);
    private readonly color = new GrowingBuffer(Uint8Array, 4, true);
    private readonly index = new GrowingBuffer(Uint32Array, 1);

    /** Takes over the slices of a new picture; returns false if none of them has a fill. */
    fill(picture: Slices): boolean {
        const { slices, scene } = picture;
        let points = 0;
        let corners = 0;
        this.parts = [];
        for (const { fill, drawn, position } of slices) {
            if (!fill || !drawn || !scene.shown.faces) continue;
            this.parts.push({ fill, position, first: points });
            points += fill.points.length / 3;
            corners += fill.triangles.length;
        }
        this.reserve(points, corners);
        for (const part of this.parts) this.place(part, picture);
        for (const buffer of [this.at, this.to, this.shape, this.color]) buffer.written();
        return slices.some((slice) => slice.fill);
    }

    /** Orders the slices for this camera. */
    arrange({ eye }: Lens): void {
        const distance = ({ position: [x, y, z] }: Part): number => Math.hypot(x - eye.x, y - eye.y, z - eye.z);
        this.parts.sort((a, b) => distance(b) - distance(a));
        let used = 0;
        for (const presence of [kFull, kFaded]) {
            for (const { fill, first } of this.parts) {
                for (let i = 0; i < fill.triangles.length; ++i) {
                    if ((fill.seen?.[Math.floor(i / 3)] ?? kFull) !== presence) continue;
                    this.index.array[used++] = first + fill.triangles[i]!;
                }
            }
        }
        this.index.used = used;
        this.index.written();
        this.geometry.setDrawRange(0, used);
    }

    private reserve(points: number, corners: number): void {
        const { at, to, shape, color, index } = this;
        let grown = index.reserve(corners);
        for (const buffer of [at, to, shape, color]) grown = buffer.reserve(points) || grown;
        if (!grown && this.geometry.index) return;
        this.geometry.dispose();
        for (const [name, { attribute }] of Object.entries({ at, to, shape, color })) {
            this.geometry.setAttribute(name, attribute);
        }
        this.geometry.setIndex(index.attribute);
    }

    private place({ fill, position, first }: Part, { scene }: Slices): void {
        const { points, triangles, tints, seen } = fill;
        const { colors, opacity, faded } = scene;
        const { array: normals } = this.to;
        const { array: rgba } = this.color;
        for (let i = 0; i < points.length; ++i) {
            this.at.array[3 * first + i] = position[i % 3]! + scene.scale * points[i]!;
        }
        for (let t = 0; t < tints.length; ++t) {
            const [a, b, c] = [3 * triangles[3 * t]!, 3 * triangles[3 * t + 1]!, 3 * triangles[3 * t + 2]!];
            const [ux, uy, uz] = [points[b]! - points[a]!, points[b + 1]! - points[a + 1]!, points[b + 2]! - points[a + 2]!];
            const [vx, vy, vz] = [points[c]! - points[a]!, points[c + 1]! - points[a + 1]!, points[c + 2]! - points[a + 2]!];
            const [nx, ny, nz] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
            const length = Math.hypot(nx, ny, nz) || 1;
            const tint = colors.cells[tints[t]!] ?? colors.bar;
            const alpha = 255 * opacity * (seen?.[t] === kFaded ? faded : 1);
            // A triangle takes its values from its last point, which is never the last point of another tint.
            const item = first + c / 3;
            normals[3 * item] = nx / length;
            normals[3 * item + 1] = ny / length;
            normals[3 * item + 2] = nz / length;
            this.shape.array[4 * item + 2] = kFace;
            rgba[4 * item] = tint >> 16;
            rgba[4 * item + 1] = tint >> 8;
            rgba[4 * item + 2] = tint;
            rgba[4 * item + 3] = alpha;
            this.shape.array[4 * (first + a / 3) + 2] = kFace;
            this.shape.array[4 * (first + b / 3) + 2] = kFace;
        }
    }
}
