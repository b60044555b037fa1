// Finds the point of a field's surfaces at a pixel of a slice.

import type { Surface, SurfaceLevel, Vector } from "@oval4d/protocol";

/** A ray in the coordinates of a slice. Its point at depth t is start + t · direction. */
export interface SliceRay {
    start: Vector;
    direction: Vector;
}

/** A point of a surface on a ray. */
export interface SurfaceHit {
    depth: number;
    /** The index of the level in the `levels` of the state. */
    level: number;
    /** Whether the point is on a cap, the flat part where the boundary of the box cuts the body. */
    cap: boolean;
}

const kSlack = 1e-6; // the test enlarges triangles by this fraction, so that no ray passes between two neighbors

/**
 * Finds the first drawn triangle that a ray meets in front of the eye; undefined if the ray meets none. Tests all
 * triangles by the algorithm of Möller and Trumbore, which takes about 10 ns for each triangle.
 */
export function hitOnSurface(
    { points, triangles, level, cap }: Surface,
    looks: readonly SurfaceLevel[],
    { start, direction }: SliceRay,
): SurfaceHit | undefined {
    const isDrawn = new Uint8Array(512); // at the index 2 · level + cap: 1 if such triangles are drawn
    for (const look of looks) {
        isDrawn[2 * look.level] = 1;
        isDrawn[2 * look.level + 1] = look.caps ? 1 : 0;
    }
    const [ox, oy, oz] = start;
    const [dx, dy, dz] = direction;
    let nearest = Infinity;
    let found = -1;
    for (let t = 0; t < level.length; ++t) {
        if (isDrawn[2 * level[t]! + cap[t]!] !== 1) continue;
        const a = 3 * triangles[3 * t]!;
        const b = 3 * triangles[3 * t + 1]!;
        const c = 3 * triangles[3 * t + 2]!;
        const ax = points[a]!;
        const ay = points[a + 1]!;
        const az = points[a + 2]!;
        const bx = points[b]! - ax;
        const by = points[b + 1]! - ay;
        const bz = points[b + 2]! - az;
        const cx = points[c]! - ax;
        const cy = points[c + 1]! - ay;
        const cz = points[c + 2]! - az;
        const px = dy * cz - dz * cy;
        const py = dz * cx - dx * cz;
        const pz = dx * cy - dy * cx;
        const determinant = bx * px + by * py + bz * pz;
        if (determinant === 0) continue; // the triangle is seen edge-on
        const sx = ox - ax;
        const sy = oy - ay;
        const sz = oz - az;
        const u = (sx * px + sy * py + sz * pz) / determinant;
        if (u < -kSlack || u > 1 + kSlack) continue;
        const qx = sy * bz - sz * by;
        const qy = sz * bx - sx * bz;
        const qz = sx * by - sy * bx;
        const v = (dx * qx + dy * qy + dz * qz) / determinant;
        if (v < -kSlack || u + v > 1 + kSlack) continue;
        const depth = (cx * qx + cy * qy + cz * qz) / determinant;
        if (depth <= 0 || depth >= nearest) continue;
        nearest = depth;
        found = t;
    }
    return found < 0 ? undefined : { depth: nearest, level: level[found]!, cap: cap[found] === 1 };
}
