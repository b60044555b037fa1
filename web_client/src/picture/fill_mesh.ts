// The mesh of slices whose faces may cross each other. Its triangles fill the faces, and are drawn with a depth buffer.
// Opaque triangles come first, then faded ones. Within each group, slices are ordered from far to near.

import { BufferGeometry } from "three";

import type { Fill, Slices, Vector } from "@oval4d/protocol";

import { GrowingBuffer } from "./growing_buffer";
import { cellColor, type HighlightChange, type HighlightedElements } from "./highlighted_elements";
import { kFace } from "./shaders";
import { ShapeBuffers } from "./shape_buffers";
import type { ViewCamera } from "./view_camera";

/** Values of `Fill.seen`, the visibility of a triangle: faded or fully visible. The value 0 means hidden. */
const kFaded = 1;
const kFull = 2;

/** The part of the mesh that belongs to one slice. */
interface SliceFill {
    fill: Fill;
    position: Vector;
    first: number; // the index in the mesh of the first point of `fill`
}

export class FilledFacesMesh {
    readonly geometry = new BufferGeometry();
    private parts: SliceFill[] = [];
    private readonly shapes = new ShapeBuffers();
    private readonly index = new GrowingBuffer(Uint32Array, 1);

    /**
     * Writes the triangles of a new picture. Returns false if no slice has a `fill`, the triangles to draw instead of
     * faces.
     */
    update(picture: Slices, highlighted: HighlightedElements): boolean {
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
        this.resizeBuffers(points, corners);
        for (const part of this.parts) this.writeFill(part, picture);
        this.shapes.markChanged();
        this.writeColorsToBuffers(picture, highlighted);
        return slices.some((slice) => slice.fill);
    }

    /**
     * Writes the colors of the triangles to the buffers. With `change`, writes only the colors of triangles whose cell
     * is highlighted now or was before.
     */
    writeColorsToBuffers({ scene }: Slices, highlighted: HighlightedElements, change?: HighlightChange): void {
        const { colors, opacity, faded } = scene;
        const [before, after] = change?.cells ?? [];
        for (const { fill, first } of this.parts) {
            for (let t = 0; t < fill.tints.length; ++t) {
                if (change && fill.tints[t] !== before && fill.tints[t] !== after) continue;
                const alpha = opacity * (fill.seen?.[t] === kFaded ? faded : 1);
                // A triangle takes its color from its last point. All triangles with the same last point have the same
                // tint.
                const item = first + fill.triangles[3 * t + 2]!;
                this.shapes.setColor(item, cellColor(fill.tints[t]!, colors, highlighted), alpha);
            }
        }
        this.shapes.color.markChanged();
    }

    /** Orders the triangles for this camera: opaque before faded, slices from far to near. */
    sortForCamera({ eye }: ViewCamera): void {
        const distance = ({ position: [x, y, z] }: SliceFill): number => Math.hypot(x - eye.x, y - eye.y, z - eye.z);
        this.parts.sort((a, b) => distance(b) - distance(a));
        let used = 0;
        for (const visibility of [kFull, kFaded]) {
            for (const { fill, first } of this.parts) {
                for (let i = 0; i < fill.triangles.length; ++i) {
                    if ((fill.seen?.[Math.floor(i / 3)] ?? kFull) !== visibility) continue;
                    this.index.array[used++] = first + fill.triangles[i]!;
                }
            }
        }
        this.index.used = used;
        this.index.markChanged();
        this.geometry.setDrawRange(0, used);
    }

    private resizeBuffers(points: number, corners: number): void {
        const indexGrown = this.index.resize(corners);
        if (!this.shapes.resize(points) && !indexGrown && this.geometry.index) return;
        this.shapes.attachTo(this.geometry);
        this.geometry.setIndex(this.index.attribute);
    }

    private writeFill({ fill, position, first }: SliceFill, { scene }: Slices): void {
        const { points, triangles, tints } = fill;
        const { shapes } = this;
        for (let i = 0; i < points.length; ++i) {
            shapes.at.array[3 * first + i] = position[i % 3]! + scene.scale * points[i]!;
        }
        for (let t = 0; t < tints.length; ++t) {
            const [a, b, c] = [3 * triangles[3 * t]!, 3 * triangles[3 * t + 1]!, 3 * triangles[3 * t + 2]!];
            const [ux, uy, uz] = [points[b]! - points[a]!, points[b + 1]! - points[a + 1]!, points[b + 2]! - points[a + 2]!];
            const [vx, vy, vz] = [points[c]! - points[a]!, points[c + 1]! - points[a + 1]!, points[c + 2]! - points[a + 2]!];
            const [nx, ny, nz] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
            const length = Math.hypot(nx, ny, nz) || 1;
            // The shader takes the normal of a triangle from the triangle's last point, like the color.
            shapes.setVector("to", first + c / 3, nx / length, ny / length, nz / length);
            for (const corner of [a, b, c]) shapes.setShape(first + corner / 3, kFace);
        }
    }
}
