// The lines of single vertices in a density strip (see coordinates.ts). The line of a vertex joins its coordinates on the
// axes x, y, z and w.

import type { Slices, Viewport } from "@oval4d/protocol";

import { cssColor } from "./pen";

// The maximum number of lines that are drawn over a density strip, as in density_strip_lines.hpp.
const kMaxLinesOverDensityStrip = 400;

/**
 * Those of the vertices of highlighted elements whose lines are drawn: all of them or, if they are more than
 * kMaxLinesOverDensityStrip, this many, spread evenly from the first to the last.
 */
function verticesWithLines(ownVertices: Iterable<number>): number[] {
    const all = [...ownVertices];
    if (all.length <= kMaxLinesOverDensityStrip) return all;
    const last = kMaxLinesOverDensityStrip - 1;
    return Array.from({ length: last + 1 }, (_, i) => all[Math.floor((i * (all.length - 1)) / last)]!);
}

/** Draws the lines of the vertices of highlighted elements. */
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
