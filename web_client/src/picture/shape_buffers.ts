// The vertex buffers of balls, bars and faces, in the format of the shaders in shaders.ts.

import type { BufferGeometry } from "three";

import { GrowingBuffer } from "./growing_buffer";

/** The x and y of the four corners of a quad. A ball or a bar is drawn on such a quad. */
const kCorners = [-1, -1, 1, -1, -1, 1, 1, 1] as const;

/** The two triangles of a quad, as numbers of its corners. */
export const kQuadTriangles = [0, 1, 2, 2, 1, 3] as const;

/** The value in the fourth component of `shape` for bars as thick as the uniform barRadius. */
export const kFullThickness = 100;

export class ShapeBuffers {
    readonly at = new GrowingBuffer(Float32Array, 3);
    readonly to = new GrowingBuffer(Float32Array, 3);
    readonly shape = new GrowingBuffer(Int8Array, 4);
    readonly color = new GrowingBuffer(Uint8Array, 4, true);

    /**
     * Makes room for this many vertices. Returns true if a buffer was reallocated; the caller must then call
     * attachTo().
     */
    resize(vertices: number): boolean {
        let grown = false;
        for (const buffer of [this.at, this.to, this.shape, this.color]) grown = buffer.resize(vertices) || grown;
        return grown;
    }

    attachTo(geometry: BufferGeometry): void {
        geometry.dispose();
        const { at, to, shape, color } = this;
        for (const [name, { attribute }] of Object.entries({ at, to, shape, color })) {
            geometry.setAttribute(name, attribute);
        }
    }

    /** Marks all buffers as changed. The next rendering then uploads them to the graphics card. */
    markChanged(): void {
        for (const buffer of [this.at, this.to, this.shape, this.color]) buffer.markChanged();
    }

    /** Sets the attribute `at` or `to` of a vertex. shaders.ts describes what they mean for balls, bars and faces. */
    setVector(buffer: "at" | "to", vertex: number, x: number, y: number, z: number): void {
        const { array } = this[buffer];
        array[3 * vertex] = x;
        array[3 * vertex + 1] = y;
        array[3 * vertex + 2] = z;
    }

    /**
     * Sets the kind of patch to which a vertex belongs. `corner` is the corner of the patch's quad, 0 to 3; 0 for a
     * face. `thickness` is the radius of a bar, relative to the uniform barRadius.
     */
    setShape(vertex: number, kind: number, corner = 0, thickness = 1): void {
        const { array } = this.shape;
        array[4 * vertex] = kCorners[2 * corner]!;
        array[4 * vertex + 1] = kCorners[2 * corner + 1]!;
        array[4 * vertex + 2] = kind;
        array[4 * vertex + 3] = Math.round(kFullThickness * thickness);
    }

    /** Sets the color (0xRRGGBB) and the opacity (0 to 1) of a vertex. */
    setColor(vertex: number, color: number, opacity: number): void {
        const { array } = this.color;
        array[4 * vertex] = color >> 16;
        array[4 * vertex + 1] = color >> 8;
        array[4 * vertex + 2] = color;
        array[4 * vertex + 3] = 255 * opacity;
    }
}
