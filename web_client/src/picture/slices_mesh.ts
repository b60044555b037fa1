// The balls, bars and faces of all slices as one mesh. A new picture changes the vertices. A new picture or a new
// camera changes the indices, which order all elements from far to near. Transparency and soft edges are then correct
// without a depth buffer.

import { BufferGeometry } from "three";

import type { Slices } from "@oval4d/protocol";

import { SliceElements } from "./elements";
import { GrowingBuffer } from "./growing_buffer";
import { cellColor, type HighlightChange, type HighlightedElements, isFlagged } from "./highlighted_elements";
import { PaintersOrder } from "./painters_order";
import { kBall, kBar, kFace } from "./shaders";
import { ShapeBuffers } from "./shape_buffers";
import type { ViewCamera } from "./view_camera";

export class SlicesMesh {
    readonly geometry = new BufferGeometry();

    private readonly elements = new SliceElements();
    private readonly order = new PaintersOrder(this.elements);
    private readonly shapes = new ShapeBuffers();
    private readonly index = new GrowingBuffer(Uint32Array, 1);

    /**
     * Writes the elements of a new picture. If `faces` is false, the mesh omits the faces, because the picture shows a
     * field or because FilledFacesMesh (fill_mesh.ts) draws the faces.
     */
    update(picture: Slices, faces: boolean, highlighted: HighlightedElements): void {
        const { elements } = this;
        elements.update(picture);
        this.resizeBuffers();
        const { scene } = picture;
        const { shown } = scene;
        // Without shown balls, balls as thick as the bars join the bars at their ends.
        const inBall = shown.balls ? Math.sqrt(Math.max(0, scene.ball ** 2 - scene.bar ** 2)) : 0;
        for (const { slice, vertices, edges } of elements.sliceRanges) {
            for (let v = vertices[0]; v < vertices[1]; ++v) {
                for (let k = 0; k < 4; ++k) {
                    this.writeVertex(4 * v + k, v, kBall, k);
                    this.shapes.to.array[3 * (4 * v + k)] = slice.balls?.scale[v - vertices[0]] ?? 1;
                }
            }
            for (let e = edges[0]; e < edges[1]; ++e) this.writeBar(e, inBall);
        }
        this.writeFaces();
        this.shapes.markChanged();
        this.writeColorsToBuffers(picture, highlighted);
        const hasPoints = picture.slices.some((slice) => slice.balls); // the points of a cloud are always drawn
        this.order.update({ ...shown, faces: shown.faces && faces, balls: shown.balls || hasPoints });
    }

    /**
     * Writes the colors of the elements: all colors or, if `change` is given, only those of elements whose highlight
     * has changed. The picture must be the last one that was passed to update().
     */
    writeColorsToBuffers({ scene }: Slices, highlighted: HighlightedElements, change?: HighlightChange): void {
        const { sliceRanges, cornerBegin, vertexCount, edgeCount } = this.elements;
        const { shown, colors, faded, opacity } = scene;
        const opacities = [0, faded, 1];
        const { shapes } = this;
        const [before, after] = change?.cells ?? [];
        const ballColor = shown.balls ? colors.ball : colors.bar;
        for (const { slice, vertices, edges, faces } of sliceRanges) {
            const { of, seen, balls, tints = of.faces } = slice;
            for (let i = 0; i < vertices[1] - vertices[0]; ++i) {
                if (change && !isFlagged(change.vertices, of.vertices[i]!)) continue;
                const color = highlighted.vertices.has(of.vertices[i]!) ? colors.highlight : ballColor;
                const alpha = (balls?.opacity[i] ?? 1) * opacities[seen?.vertices[i] ?? 2]!;
                for (let k = 0; k < 4; ++k) shapes.setColor(4 * (vertices[0] + i) + k, color, alpha);
            }
            for (let i = 0; i < edges[1] - edges[0]; ++i) {
                if (change && !isFlagged(change.edges, of.edges[i]!)) continue;
                const color = highlighted.edges.has(of.edges[i]!) ? colors.highlight : colors.bar;
                const alpha = opacities[seen?.edges[i] ?? 2]!;
                for (let k = 0; k < 4; ++k) shapes.setColor(4 * (vertexCount + edges[0] + i) + k, color, alpha);
            }
            for (let i = 0; i < faces[1] - faces[0]; ++i) {
                if (change && tints[i] !== before && tints[i] !== after) continue;
                const color = cellColor(tints[i]!, colors, highlighted);
                const alpha = opacity * opacities[seen?.faces[i] ?? 2]!;
                const [begin, end] = [cornerBegin[faces[0] + i]!, cornerBegin[faces[0] + i + 1]!];
                for (let c = begin; c < end; ++c) shapes.setColor(4 * (vertexCount + edgeCount) + c, color, alpha);
            }
        }
        shapes.color.markChanged();
    }

    /** Orders all elements for this camera, from far to near. */
    sortForCamera(viewCamera: ViewCamera): void {
        this.index.used = this.order.writeIndices(viewCamera, this.index.array);
        this.index.markChanged();
        this.geometry.setDrawRange(0, this.index.used);
    }

    private resizeBuffers(): void {
        const { vertexCount, edgeCount, cornerCount } = this.elements;
        const indexGrown = this.index.resize(6 * vertexCount + 6 * edgeCount + 3 * cornerCount);
        const grown = this.shapes.resize(4 * vertexCount + 4 * edgeCount + cornerCount);
        if (!grown && !indexGrown && this.geometry.index) return;
        this.shapes.attachTo(this.geometry);
        this.geometry.setIndex(this.index.attribute);
    }

    private writeVertex(item: number, vertex: number, kind: number, corner: number): void {
        const { points } = this.elements;
        this.shapes.setVector("at", item, points[3 * vertex]!, points[3 * vertex + 1]!, points[3 * vertex + 2]!);
        this.shapes.setShape(item, kind, corner);
    }

    /**
     * Writes a bar. Shortens it at each end by `inBall`, the length that the ball there hides. A bar not longer than 2
     * · inBall becomes a point.
     */
    private writeBar(e: number, inBall: number): void {
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
            this.writeVertex(item, edges[2 * e]!, kBar, k);
            for (let i = 0; i < 3; ++i) {
                const cut = part * (points[b + i]! - points[a + i]!);
                this.shapes.at.array[3 * item + i] = points[a + i]! + cut;
                this.shapes.to.array[3 * item + i] = points[b + i]! - cut;
            }
        }
    }

    private writeFaces(): void {
        const { faceCount, corners, cornerBegin, normals, vertexCount, edgeCount } = this.elements;
        for (let f = 0; f < faceCount; ++f) {
            for (let c = cornerBegin[f]!; c < cornerBegin[f + 1]!; ++c) {
                const item = 4 * (vertexCount + edgeCount) + c;
                this.writeVertex(item, corners[c]!, kFace, 0);
                for (let k = 0; k < 3; ++k) this.shapes.to.array[3 * item + k] = normals[3 * f + k]!;
            }
        }
    }
}
