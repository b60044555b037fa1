// Finds the element, or the surface of a field, at a pixel of the picture. Projects all elements to the screen, and
// intersects the surfaces with the ray through the pixel.

import type { Elements, PolytopeElement, Slice, Slices, SurfaceLevel, Vector } from "@oval4d/protocol";

import { ensureCapacity } from "./elements";
import type { ElementCounts } from "./highlighted_elements";
import { doubleAreaVector } from "./polygon";
import { hitOnSurface } from "./surface_hit";
import type { ViewCamera } from "./view_camera";

/**
 * The element that is at a pixel, in a slice, in the projection or in the matrix of planar sections. Points of planar
 * sections have the kind `points`. Edges of planar sections have the kind `faces`, because they are cut from cells like
 * the faces of slices.
 */
export interface ElementHit {
    kind: "vertices" | "edges" | "faces" | "points";
    /**
     * The element's number in the array `of` of its slice, part of the projection or planar section. elementOfHit()
     * converts it to an element of the polytope.
     */
    source: number;
    /** The slice in which the element was hit; absent in the projection and in the matrix. */
    slice?: Slice;
}

/**
 * The element of the polytope that was hit. A vertex of a slice, for example, comes from an edge or a vertex of the
 * polytope.
 */
export function elementOfHit({ kind, source }: ElementHit, counts: ElementCounts): PolytopeElement {
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

/**
 * A point on a surface of a field in a slice or in the projection, or on a contour in the matrix of planar sections.
 */
export interface LevelHit {
    /** The index of the level in the `levels` of the state. */
    level: number;
    /** Whether the point is on a cap, the flat part where the boundary of the box cuts the body. */
    cap: boolean;
    /** The coordinates x, y, z, w of the point after the rotation, in object units from the object's center. */
    point: [number, number, number, number];
    /** The slice in which the surface was hit; absent in the projection and in the matrix. */
    slice?: Slice;
}

/** A slice, or a part of the projection, with its transformation to world space. */
interface PickableMesh {
    elements: Elements;
    slice?: Slice;
    position: Vector;
    scale: number;
    magnification: number; // a bound: every vertex is within magnification · scale · circumradius of `position`
    ball: number; // the radius of balls in world units; 0 if they are not drawn
    bar: number; // the radius of bars in world units; 0 if they are not drawn
    hasFaces: boolean; // whether the faces are drawn
    surface?: PickableSurface; // the surfaces of a field that are drawn with the elements
    distance: number; // the distance from `position` to the eye
}

/** The surfaces of a field in a slice, with their scale from object units to world space. */
interface PickableSurface {
    slice: Slice;
    scale: number;
    levels: readonly SurfaceLevel[];
}

/** What was hit in a mesh, and its distance from the eye along the view axis. */
interface HitWithDepth {
    hit: ElementHit | LevelHit;
    depth: number;
}

// CSS pixels: the pointer hits a ball or bar whose middle is within this distance, however thin it is.
export const kReach = 4;
// How far the hit test moves balls and bars toward the viewer, in multiples of their radii. A ball is then nearer than
// the faces around it and the bars that end in it.
const kBallRise = 3;
const kBarRise = 2;

/**
 * Projected vertices of the tested mesh. Each vertex has kStride numbers: x, y, z in camera coordinates, and x, y in
 * pixels of the picture.
 */
let projected = new Float32Array(0);
const kStride = 5;

/**
 * Finds the element or the surface of a field at the pixel (x, y) of the picture; undefined if there is none. If
 * several meshes are at the pixel, chooses the mesh whose center is nearest to the eye. Of this mesh, finds the nearest
 * element or surface. Slices come before the projection, because they are drawn over it. In the projection of a field,
 * the surface, the bars of the box and those of the section count as one mesh. `ratio` is the number of picture pixels
 * per CSS pixel.
 */
export function hitAt(
    picture: Slices,
    viewCamera: ViewCamera,
    x: number,
    y: number,
    ratio: number,
): ElementHit | LevelHit | undefined {
    const meshes = pickableMeshes(picture, viewCamera);
    meshes.sort((a, b) => Number(!a.slice) - Number(!b.slice) || a.distance - b.distance);
    const isField = picture.scene.surfaces !== undefined;
    let found: HitWithDepth | undefined;
    for (const mesh of meshes) {
        if (found && !(isField && !found.hit.slice)) break;
        if (!mayHitMesh(mesh, picture, viewCamera, x, y)) continue;
        const hit = new MeshHitTest(mesh, viewCamera, x, y, kReach * ratio).nearestHit();
        if (hit && hit.depth < (found?.depth ?? Infinity)) found = hit;
    }
    return found?.hit;
}

function pickableMeshes({ slices, scene, projection }: Slices, { eye }: ViewCamera): PickableMesh[] {
    const { shown, scale } = scene;
    const distance = ([x, y, z]: Vector): number => Math.hypot(x - eye.x, y - eye.y, z - eye.z);
    const [ball, bar] = [shown.balls ? scene.ball : 0, shown.bars ? scene.bar : 0];
    const meshes: PickableMesh[] = [];
    for (const slice of slices) {
        const { position, vertices, drawn } = slice;
        if (!drawn || vertices.length === 0) continue;
        const hasFaces = shown.faces && !scene.surfaces; // faces of the box of a field are never drawn
        const surface = scene.surfaces && { slice, scale, levels: scene.surfaces };
        const look = { ball: slice.balls && !shown.balls ? scene.bar : ball, bar, hasFaces };
        const placed = { position, scale, magnification: 1, distance: distance(position) };
        meshes.push({ elements: slice, slice, ...placed, ...look, ...(surface && { surface }) });
    }
    const focus = slices.find((slice) => slice.focus && slice.drawn);
    for (const [i, part] of (projection?.parts ?? []).entries()) {
        const { position, scale: partScale, kind, eye: eyeW } = projection!;
        const look = { ball: part.ball, bar: part.bar, hasFaces: part.opacity > 0 };
        const { surface_scale: surfaceScale } = projection!;
        const hasSurface = i === 0 && focus && scene.surfaces && surfaceScale !== undefined;
        const surface = hasSurface && { slice: focus, scale: surfaceScale, levels: scene.surfaces! };
        // The perspective projection from 4-D moves points on the circumscribed sphere away from the center by at most
        // this factor.
        const magnification = kind === "perspective" ? eyeW / Math.sqrt(eyeW ** 2 - 1) : 1;
        const placed = { position, scale: partScale, magnification, distance: distance(position) };
        meshes.push({ elements: part, ...placed, ...look, ...(surface && { surface }) });
    }
    return meshes;
}

/** Whether the pixel (x, y) can lie on the mesh: a quick test with a sphere around the mesh. */
function mayHitMesh(mesh: PickableMesh, { scene }: Slices, viewCamera: ViewCamera, x: number, y: number): boolean {
    const { position, scale, magnification, ball, elements } = mesh;
    const center = viewCamera.project(position);
    const depth = viewCamera.depthOf(position);
    // A factor on the radius of the sphere: the pointer also hits shapes a few pixels away, and perspective enlarges
    // the near side.
    const kRoom = 2;
    const largest = elements.balls?.scale.reduce((most, one) => Math.max(most, one), 1) ?? 1;
    const radius = kRoom * magnification * scale * scene.circumradius + kBallRise * ball * largest;
    if (!center || depth <= radius) return true;
    return Math.hypot(center.x - x, center.y - y) <= (viewCamera.pixelsPerUnit * radius) / (depth - radius);
}

/**
 * Finds the nearest element or surface of one mesh at the pixel (x, y). `reach` is the least radius of balls and bars
 * for the test, in pixels of the picture.
 */
class MeshHitTest {
    private depth = Infinity;
    private hit: ElementHit | LevelHit | undefined;

    constructor(
        private readonly mesh: PickableMesh,
        private readonly viewCamera: ViewCamera,
        private readonly x: number,
        private readonly y: number,
        private readonly reach: number,
    ) {
        this.projectVertices();
    }

    nearestHit(): HitWithDepth | undefined {
        const { ball, bar, hasFaces, surface } = this.mesh;
        if (ball > 0) this.testBalls();
        if (bar > 0) this.testBars();
        if (hasFaces) this.testFaces();
        if (surface) this.testSurface(surface);
        return this.hit && { hit: this.hit, depth: this.depth };
    }

    /** Writes the camera and screen coordinates of the vertices into `projected`. */
    private projectVertices(): void {
        const { elements, position, scale } = this.mesh;
        const { vertices } = elements;
        projected = ensureCapacity(projected, (kStride * vertices.length) / 3);
        const view = this.viewCamera.view.elements;
        for (let i = 0, at = 0; i < vertices.length; i += 3, at += kStride) {
            const x = position[0] + scale * vertices[i]!;
            const y = position[1] + scale * vertices[i + 1]!;
            const z = position[2] + scale * vertices[i + 2]!;
            projected[at] = view[0]! * x + view[4]! * y + view[8]! * z + view[12]!;
            projected[at + 1] = view[1]! * x + view[5]! * y + view[9]! * z + view[13]!;
            projected[at + 2] = view[2]! * x + view[6]! * y + view[10]! * z + view[14]!;
            this.viewCamera.cameraToScreen(projected, at);
        }
    }

    /**
     * Records an element as the hit if it is the nearest so far. `depth` is the element's distance from the eye, along
     * the view axis.
     */
    private keepIfNearest(kind: ElementHit["kind"], source: number, depth: number): void {
        if (depth >= this.depth) return;
        const { slice } = this.mesh;
        this.depth = depth;
        this.hit = { kind, source, ...(slice && { slice }) };
    }

    private testBalls(): void {
        const { elements, ball } = this.mesh;
        const { of, balls, seen: visibility, vertices } = elements;
        for (let v = 0, at = 0; v < vertices.length / 3; ++v, at += kStride) {
            const depth = -projected[at + 2]!;
            if (depth <= 0 || visibility?.vertices[v] === 0 || balls?.opacity[v] === 0) continue;
            const perPixel = depth / this.viewCamera.pixelsPerUnit;
            const radius = Math.max(ball * (balls?.scale[v] ?? 1), this.reach * perPixel);
            const distance = Math.hypot(projected[at + 3]! - this.x, projected[at + 4]! - this.y) * perPixel;
            if (distance <= radius) this.keepIfNearest("vertices", of.vertices[v]!, depth - kBallRise * radius);
        }
    }

    private testBars(): void {
        const { elements, bar } = this.mesh;
        const { edges, of, seen: visibility } = elements;
        for (let e = 0; e < edges.length / 2; ++e) {
            const [a, b] = [kStride * edges[2 * e]!, kStride * edges[2 * e + 1]!];
            if (projected[a + 2]! >= 0 || projected[b + 2]! >= 0 || visibility?.edges[e] === 0) continue;
            const [ax, ay] = [projected[a + 3]!, projected[a + 4]!];
            const [dx, dy] = [projected[b + 3]! - ax, projected[b + 4]! - ay];
            const along = ((this.x - ax) * dx + (this.y - ay) * dy) / (dx * dx + dy * dy || 1);
            const part = Math.min(1, Math.max(0, along));
            const depth = -projected[a + 2]! - part * (projected[b + 2]! - projected[a + 2]!);
            const perPixel = depth / this.viewCamera.pixelsPerUnit;
            const radius = Math.max(bar, this.reach * perPixel);
            const distance = Math.hypot(ax + part * dx - this.x, ay + part * dy - this.y) * perPixel;
            if (distance <= radius) this.keepIfNearest("edges", of.edges[e]!, depth - kBarRise * radius);
        }
    }

    private testSurface({ slice: { surface, w }, scale, levels }: PickableSurface): void {
        if (!surface) return;
        const { position, slice } = this.mesh;
        const { eye } = this.viewCamera;
        const [px, py, pz] = position;
        const [x, y, z]: Vector = [(eye.x - px) / scale, (eye.y - py) / scale, (eye.z - pz) / scale];
        const [dx, dy, dz] = this.viewCamera.worldRayAt(this.x, this.y).map((value) => value / scale) as Vector;
        const hit = hitOnSurface(surface, levels, { start: [x, y, z], direction: [dx, dy, dz] });
        if (!hit || hit.depth >= this.depth) return;
        const { depth, level, cap } = hit;
        this.depth = depth;
        const point: LevelHit["point"] = [x + depth * dx, y + depth * dy, z + depth * dz, w];
        this.hit = { level, cap, point, ...(slice && { slice }) };
    }

    /**
     * Tests for all faces whether they are at the pixel. Each entry of `elements.faces` is one closed loop of corners.
     * Consecutive loops with the same number in `of.faces` form one face.
     */
    private testFaces(): void {
        const { of, seen: visibility } = this.mesh.elements;
        for (let f = 0, end = 0; f < of.faces.length; f = end) {
            const source = of.faces[f]!;
            while (end < of.faces.length && of.faces[end] === source) ++end;
            if (visibility?.faces[f] !== 0) this.keepIfNearest("faces", source, this.depthOfFace(f, end));
        }
    }

    /**
     * The depth of a face at the tested pixel; Infinity if the face does not cover the pixel. The face consists of the
     * loops firstLoop … endLoop − 1, and covers the points at which their winding number is not 0.
     */
    private depthOfFace(firstLoop: number, endLoop: number): number {
        const { begin, corners } = this.mesh.elements.faces;
        let winding = 0;
        for (let loop = firstLoop; loop < endLoop; ++loop) {
            const [first, end] = [begin[loop]!, begin[loop + 1]!];
            let p = kStride * corners[end - 1]!;
            for (let c = first; c < end; ++c) {
                const q = kStride * corners[c]!;
                if (projected[q + 2]! >= 0) return Infinity;
                const [py, qy] = [projected[p + 4]!, projected[q + 4]!];
                if (py > this.y !== qy > this.y) {
                    const part = (this.y - py) / (qy - py);
                    const crossing = projected[p + 3]! + part * (projected[q + 3]! - projected[p + 3]!);
                    if (this.x < crossing) winding += qy > py ? 1 : -1;
                }
                p = q;
            }
        }
        // Most faces do not cover the pixel, so their planes are computed only after this test.
        if (winding === 0) return Infinity;
        let [nx, ny, nz] = [0, 0, 0];
        for (let loop = firstLoop; loop < endLoop; ++loop) {
            const [x, y, z] = doubleAreaVector(projected, corners, [begin[loop]!, begin[loop + 1]!], kStride);
            [nx, ny, nz] = [nx + x, ny + y, nz + z];
        }
        const [rayX, rayY] = this.viewCamera.rayAt(this.x, this.y);
        const across = nx * rayX + ny * rayY - nz;
        if (across === 0) return Infinity;
        const p = kStride * corners[begin[firstLoop]!]!;
        return (nx * projected[p]! + ny * projected[p + 1]! + nz * projected[p + 2]!) / across;
    }
}
