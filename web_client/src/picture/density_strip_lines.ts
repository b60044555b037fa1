// The lines of single vertices in a density strip (see coordinates.ts). The line of a vertex joins its coordinates on
// the axes x, y, z and w.

import type { Slices, Viewport } from "@oval4d/protocol";

import { cssColor } from "./pen";

// The most lines that are drawn over a density strip. density_strip_lines.hpp has the same number.
const kMaxLinesOverDensityStrip = 400;
// A point at most kLineReach above or below a line counts as on the line. Distances that differ by at most kEqual count
// as equal. Both constants are in viewport heights, and are the same in density_strip_lines.hpp and .cpp.
const kLineReach = 0.006;
const kEqual = 1e-6;

/**
 * Chooses the vertices of highlighted elements whose lines are drawn. These are all vertices or, if there are too many,
 * kMaxLinesOverDensityStrip of them, spread evenly from the first to the last.
 */
function verticesWithLines(ownVertices: Iterable<number>): number[] {
    const all = [...ownVertices];
    if (all.length <= kMaxLinesOverDensityStrip) return all;
    const last = kMaxLinesOverDensityStrip - 1;
    return Array.from({ length: last + 1 }, (_, i) => all[Math.floor((i * (all.length - 1)) / last)]!);
}

/** Draws a line for each of the vertices that verticesWithLines() chooses from `ownVertices`. */
export function drawLinesOverDensityStrip(
    pen: CanvasRenderingContext2D,
    { coordinates: values, scene }: Slices,
    { height }: Viewport,
    ownVertices: Iterable<number>,
): void {
    const { circumradius, colors, coordinates: layout } = scene;
    const unit = (layout.amplitude * height) / circumradius;
    pen.strokeStyle = cssColor(colors.highlight);
    pen.lineWidth = Math.max(1, layout.line_width * height);
    pen.lineCap = pen.lineJoin = "round";
    pen.beginPath();
    for (const v of verticesWithLines(ownVertices)) {
        for (let k = 0; k < 4; ++k) {
            const x = (layout.left + k * layout.line_step + layout.line_width / 2) * height;
            const y = (1 - layout.zero) * height - values[4 * v + k]! * unit;
            if (k === 0) pen.moveTo(x, y);
            else pen.lineTo(x, y);
        }
    }
    pen.stroke();
    pen.lineCap = "butt";
    pen.lineJoin = "miter";
}

/**
 * The vertex whose line is at a point of the density strip; undefined if no line is near. The point is in viewport
 * heights from the lower left corner. vertexInDensityStripAt() in density_strip_lines.hpp uses the same rules, and
 * explains them.
 */
export function vertexInDensityStripAt(picture: Slices, atX: number, atY: number): number | undefined {
    const { coordinates: values, highlight, scene } = picture;
    const { amplitude, left, line_step: step, line_width: width, zero } = scene.coordinates;
    // The distance to the right of the middle of the axis x, in viewport heights.
    const right = atX - (left + width / 2);
    if (step <= 0 || right < -kLineReach || right > 3 * step + kLineReach) return undefined;
    const along = Math.min(Math.max(right / step, 0), 3);
    const axis = Math.min(Math.floor(along), 2);
    const unit = amplitude / scene.circumradius;
    const distanceOf = (v: number): number => {
        const [from, to] = [values[4 * v + axis]!, values[4 * v + axis + 1]!];
        return Math.abs(zero + (from + (along - axis) * (to - from)) * unit - atY);
    };
    return (
        nearestVertexWithin(verticesWithLines(highlight?.own_vertices ?? []), distanceOf, width) ??
        nearestVertexWithin(Array(values.length / 4).keys(), distanceOf, kLineReach)
    );
}

/**
 * The vertex with the least distance; the first if several have equal distances. Undefined if the least distance
 * exceeds `reach`. The vertices must be in ascending order.
 */
function nearestVertexWithin(
    vertices: Iterable<number>,
    distanceOf: (vertex: number) => number,
    reach: number,
): number | undefined {
    let [nearest, least]: [number | undefined, number] = [undefined, Infinity];
    for (const v of vertices) {
        const distance = distanceOf(v);
        if (distance < least - kEqual) [nearest, least] = [v, distance];
    }
    return least <= reach ? nearest : undefined;
}
