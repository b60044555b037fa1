// Geometry of polygons in flat arrays.

/**
 * Computes the normal of a polygon by Newell's method; its length is twice the polygon's area. The polygon has the
 * corners corners[begin] … corners[end − 1]. The coordinates of point p begin at points[stride · p].
 */
export function doubleAreaVector(
    points: Float32Array,
    corners: Uint32Array,
    [begin, end]: readonly [begin: number, end: number],
    stride = 3,
): [number, number, number] {
    let [x, y, z] = [0, 0, 0];
    let p = stride * corners[end - 1]!;
    for (let c = begin; c < end; ++c) {
        const q = stride * corners[c]!;
        x += (points[p + 1]! - points[q + 1]!) * (points[p + 2]! + points[q + 2]!);
        y += (points[p + 2]! - points[q + 2]!) * (points[p]! + points[q]!);
        z += (points[p]! - points[q]!) * (points[p + 1]! + points[q + 1]!);
        p = q;
    }
    return [x, y, z];
}
