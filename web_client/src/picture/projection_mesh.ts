// The projection of the whole object as two meshes, both tested against the depth buffer. The solid mesh has the opaque
// balls and bars of the object; they hide what is behind them. The translucent mesh has the faces, the sections and the
// faded elements; they are blended from far to near.

import { BufferGeometry } from "three";

import type { Elements, Fill, ObjectProjection, SceneDescription, Slices } from "@oval4d/protocol";

import { ensureCapacity } from "./elements";
import { GrowingBuffer } from "./growing_buffer";
import { cellColor, type HighlightChange, type HighlightedElements, isFlagged } from "./highlighted_elements";
import { doubleAreaVector } from "./polygon";
import { kBall, kBar, kFace } from "./shaders";
import { kQuadTriangles, ShapeBuffers } from "./shape_buffers";
import { sortByKey } from "./sort";
import type { ViewCamera } from "./view_camera";

/**
 * The point that determines the depth of a translucent shape: the middle of a polygon, the center of a ball, or the
 * farther or nearer end of a bar.
 */
const kMiddle = 0;
const kCenter = 1;
const kFarEnd = 2;
const kNearEnd = 3;

type ProjectionPart = ObjectProjection["parts"][number];

/** The convex polygons that show the faces of one part of the projection. */
interface ProjectionPartPolygons {
    /** The coordinates x, y, z of each point. */
    points: Float32Array;
    /** The corners of the polygons, in the format of Elements.faces, with indices into `points`. */
    faces: Elements["faces"];
    /** For each polygon: the cell that determines its color (`tints`), and its visibility (`seen`). */
    tints: Uint32Array;
    seen: Uint32Array | undefined;
}

export class ProjectionMesh {
    readonly solid = new BufferGeometry();
    readonly translucent = new BufferGeometry();
    /** The radius of the thickest bar of all parts, in world units. */
    barRadius = 0;
    /** The center of the projection, in world space. */
    position: readonly [number, number, number] = [0, 0, 0];

    private readonly shapes = new ShapeBuffers();
    private readonly solidIndex = new GrowingBuffer(Uint32Array, 1);
    private readonly translucentIndex = new GrowingBuffer(Uint32Array, 1);
    private used = 0; // number of vertices in `shapes`
    private polygons: ProjectionPartPolygons[] = []; // the polygons of each part of the projection
    // Arrays with one entry for each translucent shape: its first vertex, its number of vertices, and the point that
    // determines its depth (kMiddle, kCenter, kFarEnd or kNearEnd).
    private first = new Uint32Array(0);
    private size = new Uint32Array(0);
    private depthKind = new Uint8Array(0);
    private nearness = new Float32Array(0);
    private order = new Uint32Array(0);
    private scratch = new Uint32Array(0);
    private count = 0;

    /** Writes the projection of a new picture into the meshes; returns whether the picture has a projection. */
    update(picture: Slices, highlighted: HighlightedElements): boolean {
        const { projection, scene } = picture;
        if (!projection) return false;
        const { parts, position } = projection;
        this.position = position;
        this.barRadius = Math.max(...parts.map((part) => part.bar));
        this.polygons = parts.map(polygonsOf);
        this.resizeBuffers(parts, this.polygons);
        this.used = this.count = 0;
        let solids = 0;
        parts.forEach((part, i) => {
            const opacities = opacitiesOf(part, scene);
            const addQuad = (opacity: number, depthKind: number): void => {
                if (i > 0 || opacity < 1) this.addTranslucentShape(4, depthKind);
                else for (const corner of kQuadTriangles) this.solidIndex.array[solids++] = this.used - 4 + corner;
            };
            const place = (points: Float32Array, p: number): [number, number, number] => [
                position[0] + projection.scale * points[3 * p]!,
                position[1] + projection.scale * points[3 * p + 1]!,
                position[2] + projection.scale * points[3 * p + 2]!,
            ];
            const point = (v: number): [number, number, number] => place(part.vertices, v);
            for (let v = 0; part.ball > 0 && v < part.vertices.length / 3; ++v) {
                const opacity = opacities.ofVertex(v);
                if (opacity === 0) continue;
                for (let corner = 0; corner < 4; ++corner, ++this.used) {
                    this.shapes.setVector("at", this.used, ...point(v));
                    this.shapes.setVector("to", this.used, part.ball * (part.balls?.scale[v] ?? 1), 0, 0);
                    this.shapes.setShape(this.used, kBall, corner);
                }
                addQuad(opacity, kCenter);
            }
            for (let e = 0; part.bar > 0 && e < part.edges.length / 2; ++e) {
                const opacity = opacities.ofEdge(e);
                if (opacity === 0) continue;
                for (let corner = 0; corner < 4; ++corner, ++this.used) {
                    this.shapes.setVector("at", this.used, ...point(part.edges[2 * e]!));
                    this.shapes.setVector("to", this.used, ...point(part.edges[2 * e + 1]!));
                    this.shapes.setShape(this.used, kBar, corner, part.bar / this.barRadius);
                }
                // The bars of a section must be drawn over the faces beside them, so the nearer end determines their
                // depth.
                addQuad(opacity, i > 0 ? kNearEnd : kFarEnd);
            }
            if (part.opacity > 0) this.addPolygons(this.polygons[i]!, place, opacities);
        });
        this.solidIndex.used = solids;
        this.solidIndex.markChanged();
        this.solid.setDrawRange(0, solids);
        this.shapes.markChanged();
        this.writeColorsToBuffers(picture, highlighted);
        return true;
    }

    /**
     * Writes the colors of the shapes, in the order in which update() adds them. With `change`, writes only the colors
     * of elements whose highlight has changed.
     */
    writeColorsToBuffers(picture: Slices, highlighted: HighlightedElements, change?: HighlightChange): void {
        const { projection, scene } = picture;
        if (!projection) return;
        const { colors } = scene;
        const [before, after] = change?.cells ?? [];
        let used = 0;
        const paint = (vertices: number, color: number, opacity: number): void => {
            for (let v = used; v < used + vertices; ++v) this.shapes.setColor(v, color, opacity);
        };
        projection.parts.forEach((part, i) => {
            const { of, vertices, edges } = part;
            const opacities = opacitiesOf(part, scene);
            for (let v = 0; part.ball > 0 && v < vertices.length / 3; ++v) {
                const opacity = opacities.ofVertex(v);
                if (opacity === 0) continue;
                const source = of.vertices[v]!;
                const color = highlighted.vertices.has(source) ? colors.highlight : part.ball_color;
                if (!change || isFlagged(change.vertices, source)) paint(4, color, opacity);
                used += 4;
            }
            for (let e = 0; part.bar > 0 && e < edges.length / 2; ++e) {
                const opacity = opacities.ofEdge(e);
                if (opacity === 0) continue;
                const source = of.edges[e]!;
                const color = highlighted.edges.has(source) ? colors.highlight : part.bar_color;
                if (!change || isFlagged(change.edges, source)) paint(4, color, opacity);
                used += 4;
            }
            const { faces, tints, seen } = this.polygons[i]!;
            for (let f = 0; part.opacity > 0 && f + 1 < faces.begin.length; ++f) {
                const opacity = opacities.ofPolygon(seen, f);
                if (opacity === 0) continue;
                const [cell, corners] = [tints[f]!, faces.begin[f + 1]! - faces.begin[f]!];
                const isChanged = !change || cell === before || cell === after;
                if (isChanged) paint(corners, cellColor(cell, colors, highlighted), opacity);
                used += corners;
            }
        });
        this.shapes.color.markChanged();
    }

    /** Orders the translucent shapes for this camera, from far to near. */
    sortForCamera({ view: { elements: view } }: ViewCamera): void {
        const { array: at } = this.shapes.at;
        const { array: to } = this.shapes.to;
        const { array: index } = this.translucentIndex;
        const heightOf = (points: Float32Array, v: number): number =>
            view[2]! * points[3 * v]! + view[6]! * points[3 * v + 1]! + view[10]! * points[3 * v + 2]!;
        for (let i = 0; i < this.count; ++i) {
            const [first, kind] = [this.first[i]!, this.depthKind[i]!];
            let height = heightOf(at, first); // increases toward the viewer
            if (kind === kFarEnd) height = Math.min(height, heightOf(to, first));
            else if (kind === kNearEnd) height = Math.max(height, heightOf(to, first));
            else if (kind === kMiddle) {
                for (let v = first + 1; v < first + this.size[i]!; ++v) height += heightOf(at, v);
                height /= this.size[i]!;
            }
            this.nearness[i] = height;
            this.order[i] = i;
        }
        sortByKey(this.order, [0, this.count], this.nearness, this.scratch);
        let used = 0;
        for (let k = 0; k < this.count; ++k) {
            const i = this.order[k]!;
            const first = this.first[i]!;
            if (this.depthKind[i] !== kMiddle) for (const corner of kQuadTriangles) index[used++] = first + corner;
            else {
                for (let v = 2; v < this.size[i]!; ++v) {
                    index[used++] = first;
                    index[used++] = first + v - 1;
                    index[used++] = first + v;
                }
            }
        }
        this.translucentIndex.used = used;
        this.translucentIndex.markChanged();
        this.translucent.setDrawRange(0, used);
    }

    dispose(): void {
        this.solid.dispose();
        this.translucent.dispose();
    }

    private addPolygons(
        { points, faces: { begin, corners }, seen }: ProjectionPartPolygons,
        place: (points: Float32Array, p: number) => [number, number, number],
        opacities: ShapeAlphas,
    ): void {
        for (let f = 0; f + 1 < begin.length; ++f) {
            if (opacities.ofPolygon(seen, f) === 0) continue;
            const [x, y, z] = doubleAreaVector(points, corners, [begin[f]!, begin[f + 1]!]);
            const length = Math.hypot(x, y, z) || 1;
            for (let c = begin[f]!; c < begin[f + 1]!; ++c, ++this.used) {
                this.shapes.setVector("at", this.used, ...place(points, corners[c]!));
                this.shapes.setVector("to", this.used, x / length, y / length, z / length);
                this.shapes.setShape(this.used, kFace);
            }
            this.addTranslucentShape(begin[f + 1]! - begin[f]!, kMiddle);
        }
    }

    /** Adds a translucent shape. It consists of the last `vertices` vertices that have been added. */
    private addTranslucentShape(vertices: number, depthKind: number): void {
        this.first[this.count] = this.used - vertices;
        this.size[this.count] = vertices;
        this.depthKind[this.count++] = depthKind;
    }

    private resizeBuffers(parts: ProjectionPart[], polygons: ProjectionPartPolygons[]): void {
        let [quads, faces, corners] = [0, 0, 0];
        for (const part of parts) quads += part.vertices.length / 3 + part.edges.length / 2;
        for (const { faces: own } of polygons) {
            faces += own.begin.length - 1;
            corners += own.corners.length;
        }
        for (const name of ["first", "size", "order", "scratch"] as const) {
            this[name] = ensureCapacity(this[name], quads + faces);
        }
        this.depthKind = ensureCapacity(this.depthKind, quads + faces);
        this.nearness = ensureCapacity(this.nearness, quads + faces);
        const solidGrown = this.solidIndex.resize(6 * quads);
        const translucentGrown = this.translucentIndex.resize(6 * quads + 3 * corners);
        const grown = this.shapes.resize(4 * quads + corners);
        if (!grown && !solidGrown && !translucentGrown && this.solid.index) return;
        this.shapes.attachTo(this.solid);
        this.shapes.attachTo(this.translucent);
        this.solid.setIndex(this.solidIndex.attribute);
        this.translucent.setIndex(this.translucentIndex.attribute);
    }
}

/** The opacities of the shapes of a part, from 0 to 1. Shapes with the opacity 0 are not drawn. */
interface ShapeAlphas {
    ofVertex(vertex: number): number;
    ofEdge(edge: number): number;
    /** `seen` has the visibility of each polygon, or is undefined if all are visible. */
    ofPolygon(seen: Uint32Array | undefined, polygon: number): number;
}

function opacitiesOf({ balls, opacity, seen: visibility }: ProjectionPart, { faded }: SceneDescription): ShapeAlphas {
    const opacities = [0, faded, 1];
    return {
        ofVertex: (v) => opacities[visibility?.vertices[v] ?? 2]! * (balls?.opacity[v] ?? 1),
        ofEdge: (e) => opacities[visibility?.edges[e] ?? 2]!,
        ofPolygon: (seen, f) => opacity * opacities[seen?.[f] ?? 2]!,
    };
}

/** The convex polygons to draw for a part: its faces or, if these may be nonconvex, the polygons that fill them. */
function polygonsOf({ vertices, faces, of, tints, seen, fill }: ProjectionPart): ProjectionPartPolygons {
    return fill ? polygonsOfFill(fill) : { points: vertices, faces, tints: tints ?? of.faces, seen: seen?.faces };
}

/**
 * Joins consecutive triangles of a fill to convex polygons. The triangles of a polygon form a fan around its first
 * point.
 */
function polygonsOfFill({ points, triangles, tints, seen }: Fill): ProjectionPartPolygons {
    const begin = [0];
    const corners: number[] = [];
    const first: number[] = []; // the first triangle of each polygon
    for (let t = 0, end = 0; t < tints.length; t = end) {
        first.push(t);
        corners.push(triangles[3 * t]!, triangles[3 * t + 1]!, triangles[3 * t + 2]!);
        for (end = t + 1; end < tints.length; ++end) {
            if (triangles[3 * end] !== triangles[3 * t] || triangles[3 * end + 1] !== triangles[3 * end - 1]) break;
            corners.push(triangles[3 * end + 2]!);
        }
        begin.push(corners.length);
    }
    return {
        points,
        faces: { begin: Uint32Array.from(begin), corners: Uint32Array.from(corners) },
        tints: Uint32Array.from(first, (t) => tints[t]!),
        seen: seen && Uint32Array.from(first, (t) => seen[t]!),
    };
}
