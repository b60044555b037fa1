// Balls, bars and faces as one mesh. Its vertices change with the slices, its indices also with the camera: everything
// is painted from far to near, so that transparency and soft edges are correct without a depth buffer.

import { BufferGeometry } from "three";

import type { SceneDescription, Slices } from "@oval4d/protocol";

import { Elements } from "./elements";
import { GrowingBuffer } from "./growing";
import type { Lens } from "./lens";
import { PaintersOrder } from "./painters_order";
import { kBall, kBar, kFace } from "./shaders";

const kCorners = [-1, -1, 1, -1, -1, 1, 1, 1] as const;

export class Mesh {
    readonly geometry = new BufferGeometry();

    private readonly elements = new Elements();
    private readonly order = new PaintersOrder(this.elements);
    private readonly at = new GrowingBuffer(Float32Array, 3);
    private readonly to = new GrowingBuffer(Float32Array, 3);
    private readonly shape = new GrowingBuffer(Int8Array, 4);
    private readonly color = new GrowingBuffer(Uint8Array, 4, true);
    private readonly index = new GrowingBuffer(Uint32Array, 1);

    /** Takes over the slices of a new picture, with or without their faces. */
    fill(picture: Slices, faces: boolean): void {
        const { elements } = this;
        elements.take(picture);
        this.reserve();
        const { scene } = picture;
        const { shown, colors } = scene;
        // Without balls, bars are joined by round joints.
        const inBall = shown.balls ? Math.sqrt(Math.max(0, scene.ball ** 2 - scene.bar ** 2)) : 0;
        const opacities = [0, scene.faded, 1];
        for (const { slice, vertices, edges } of elements.bodies) {
            const ofVertex = (v: number): number => opacities[slice.seen?.vertices[v - vertices[0]] ?? 2]!;
            const ofEdge = (e: number): number => opacities[slice.seen?.edges[e - edges[0]] ?? 2]!;
            for (let v = vertices[0]; v < vertices[1]; ++v) {
                const color = shown.balls ? colors.ball : colors.bar;
                const own = slice.balls?.opacity[v - vertices[0]] ?? 1;
                for (let k = 0; k < 4; ++k) {
                    this.put(4 * v + k, v, kBall, k, color, own * ofVertex(v));
                    this.to.array[3 * (4 * v + k)] = slice.balls?.scale[v - vertices[0]] ?? 1;
                }
            }
            for (let e = edges[0]; e < edges[1]; ++e) this.putBar(e, inBall, colors.bar, ofEdge(e));
        }
        this.putFaces(scene);
        for (const buffer of [this.at, this.to, this.shape, this.color]) buffer.written();
        this.order.show({ ...shown, faces: shown.faces && faces });
    }

    /** Orders all elements for this camera. */
    arrange(lens: Lens): void {
        const count = this.order.write(lens, this.index.array);
        this.index.used = count;
        this.index.written();
        this.geometry.setDrawRange(0, count);
    }

    private reserve(): void {
        const { vertexCount, edgeCount, cornerCount } = this.elements;
        const { at, to, shape, color, index } = this;
        const items = 4 * vertexCount + 4 * edgeCount + cornerCount;
        let grown = index.reserve(6 * vertexCount + 6 * edgeCount + 3 * cornerCount);
        for (const buffer of [at, to, shape, color]) grown = buffer.reserve(items) || grown;
        if (!grown && this.geometry.index) return;
        this.geometry.dispose();
        for (const [name, { attribute }] of Object.entries({ at, to, shape, color })) {
            this.geometry.setAttribute(name, attribute);
        }
        this.geometry.setIndex(index.attribute);
    }

    private put(item: number, vertex: number, kind: number, corner: number, color: number, opacity: number): void {
        const { array: at } = this.at;
        const { array: shape } = this.shape;
        const { array: rgba } = this.color;
        for (let k = 0; k < 3; ++k) at[3 * item + k] = this.elements.points[3 * vertex + k]!;
        shape[4 * item] = kCorners[2 * corner]!;
        shape[4 * item + 1] = kCorners[2 * corner + 1]!;
        shape[4 * item + 2] = kind;
        rgba[4 * item] = color >> 16;
        rgba[4 * item + 1] = color >> 8;
        rgba[4 * item + 2] = color;
        rgba[4 * item + 3] = 255 * opacity;
    }

    /** Writes a bar, cut off at the surfaces of its balls; a bar that lies within its balls shrinks to a point. */
    private putBar(e: number, inBall: number, color: number, opacity: number): void {
        const { points, edges, vertexCount } = this.elements;
        const a = 3 * edges[2 * e]!;
        const b = 3 * edges[2 * e + 1]!;
        const length = Math.hypot(
            points[b]! - points[a]!,
            points[b + 1]! - points[a + 1]!,
            points[b + 2]! - points[a + 2]!,
        );
        const part = length > 0 ? Math.min(inBall / length, 0.5) : 0.5;
        for (let k = 0; k < 4; ++k) {
            const item = 4 * (vertexCount + e) + k;
            this.put(item, edges[2 * e]!, kBar, k, color, opacity);
            for (let i = 0; i < 3; ++i) {
                const cut = part * (points[b + i]! - points[a + i]!);
                this.at.array[3 * item + i] = points[a + i]! + cut;
                this.to.array[3 * item + i] = points[b + i]! - cut;
            }
        }
    }

    private putFaces({ colors, faded, opacity }: SceneDescription): void {
        const { bodies, corners, cornerBegin, normals, vertexCount, edgeCount } = this.elements;
        for (const { slice, faces } of bodies) {
            const tints = slice.tints ?? slice.of.faces;
            for (let f = faces[0]; f < faces[1]; ++f) {
                const seen = [0, faded * opacity, opacity][slice.seen?.faces[f - faces[0]] ?? 2]!;
                const tint = colors.cells[tints[f - faces[0]]!] ?? colors.bar;
                for (let c = cornerBegin[f]!; c < cornerBegin[f + 1]!; ++c) {
                    const item = 4 * (vertexCount + edgeCount) + c;
                    this.put(item, corners[c]!, kFace, 0, tint, seen);
                    for (let k = 0; k < 3; ++k) this.to.array[3 * item + k] = normals[3 * f + k]!;
                }
            }
        }
    }
}
