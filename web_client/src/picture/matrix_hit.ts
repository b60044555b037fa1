// Finds the point, edge or contour of a planar section at a pixel of a matrix panel.

import type { SceneDescription, SectionMatrix, Viewport } from "@oval4d/protocol";

import type { ElementHit, LevelHit } from "./hit_test";
import type { MatrixPanel } from "./matrix_panel";

type PixelPosition = readonly [x: number, y: number];

/**
 * Finds what is drawn at the pixel, or within `reach` pixels of it: the nearest point of the section; without a point,
 * the nearest edge; without an edge, the nearest contour. Undefined if there is none.
 */
export function hitInPanel(
    panel: MatrixPanel,
    matrix: SectionMatrix,
    { shown }: SceneDescription,
    { height }: Viewport,
    pixel: PixelPosition,
    reach: number,
): ElementHit | LevelHit | undefined {
    const { of, points, edges, seen, balls } = panel.section;
    const places = points.map((point) => panel.pixelOf(point));
    let found: ElementHit | undefined;
    let nearest = Infinity;
    const take = (distance: number, radius: number, hit: ElementHit): void => {
        if (distance > Math.max(radius, reach) || distance >= nearest) return;
        [found, nearest] = [hit, distance];
    };
    places.forEach(([x, y], i) => {
        if ((!shown.balls && !balls) || seen?.points[i] === 0) return;
        const radius = matrix.ball * height * (balls?.scale[i] ?? 1);
        take(Math.hypot(x - pixel[0], y - pixel[1]), radius, { kind: "points", source: of.points[i]! });
    });
    if (found) return found;
    edges.forEach(([from, to], e) => {
        if (!shown.bars || seen?.edges[e] === 0) return;
        const distance = distanceFromSegment(pixel, places[from]!, places[to]!);
        take(distance, (matrix.line_width / 2) * height, { kind: "faces", source: of.edges[e]! });
    });
    return found ?? contourAt(panel, matrix, pixel, Math.max((matrix.line_width / 2) * height, reach));
}

/** The nearest contour within `reach` pixels of a pixel; undefined if there is none. */
function contourAt(panel: MatrixPanel, { point }: SectionMatrix, pixel: PixelPosition, reach: number): LevelHit | undefined {
    const { axes, contours = [] } = panel.section;
    let found: LevelHit | undefined;
    let nearest = reach;
    for (const { level, points } of contours) {
        const places = points.map((one) => panel.pixelOf(one));
        for (let i = 0; i + 1 < places.length; ++i) {
            const distance = distanceFromSegment(pixel, places[i]!, places[i + 1]!);
            if (distance > nearest) continue;
            nearest = distance;
            const part = nearestSegmentParameter(pixel, places[i]!, places[i + 1]!);
            const at: LevelHit["point"] = [...point];
            axes.forEach((axis, k) => (at[axis] = points[i]![k]! + part * (points[i + 1]![k]! - points[i]![k]!)));
            found = { level, cap: false, point: at };
        }
    }
    return found;
}

/** The distance of a pixel from a line segment. */
export function distanceFromSegment(pixel: PixelPosition, from: PixelPosition, to: PixelPosition): number {
    const part = nearestSegmentParameter(pixel, from, to);
    return Math.hypot(from[0] + part * (to[0] - from[0]) - pixel[0], from[1] + part * (to[1] - from[1]) - pixel[1]);
}

/** The position on a line segment that is nearest to a pixel: 0 at the segment's start, 1 at its end. */
function nearestSegmentParameter([x, y]: PixelPosition, [fromX, fromY]: PixelPosition, [toX, toY]: PixelPosition): number {
    const [dx, dy] = [toX - fromX, toY - fromY];
    const along = ((x - fromX) * dx + (y - fromY) * dy) / (dx * dx + dy * dy || 1);
    return Math.min(1, Math.max(0, along));
}
