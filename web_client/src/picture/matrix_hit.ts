// Finds the point or the edge of a planar section that is drawn at a pixel of its panel.

import type { SceneDescription, SectionMatrix, Viewport } from "@oval4d/protocol";

import type { Hit } from "./hit_test";
import type { MatrixPanel } from "./matrix_panel";

type Pixel = readonly [x: number, y: number];

/**
 * The section's point nearest to the pixel, if a point is drawn at the pixel or is within `reach` pixels of it. If
 * there is no such point, the nearest edge that is drawn at the pixel or is within `reach` pixels of it. Undefined if
 * there is no such edge.
 */
export function hitInPanel(
    panel: MatrixPanel,
    matrix: SectionMatrix,
    { shown }: SceneDescription,
    { height }: Viewport,
    pixel: Pixel,
    reach: number,
): Hit | undefined {
    const { of, points, edges, seen, balls } = panel.section;
    const places = points.map((point) => panel.pixelOf(point));
    let found: Hit | undefined;
    let nearest = Infinity;
    const take = (distance: number, radius: number, hit: Hit): void => {
        if (distance > Math.max(radius, reach) || distance >= nearest) return;
        [found, nearest] = [hit, distance];
    };
    places.forEach(([x, y], i) => {
        if ((!shown.balls && !balls) || seen?.points[i] === 0) return;
        const radius = matrix.ball * height * (balls?.scale[i] ?? 1);
        take(Math.hypot(x - pixel[0], y - pixel[1]), radius, { kind: "points", source: of.points[i]! });
    });
    if (found || !shown.bars) return found;
    edges.forEach(([from, to], e) => {
        if (seen?.edges[e] === 0) return;
        const distance = distanceFromSegment(pixel, places[from]!, places[to]!);
        take(distance, (matrix.line_width / 2) * height, { kind: "faces", source: of.edges[e]! });
    });
    return found;
}

/** The distance of a pixel from a line segment. */
export function distanceFromSegment([x, y]: Pixel, [fromX, fromY]: Pixel, [toX, toY]: Pixel): number {
    const [dx, dy] = [toX - fromX, toY - fromY];
    const along = ((x - fromX) * dx + (y - fromY) * dy) / (dx * dx + dy * dy || 1);
    const part = Math.min(1, Math.max(0, along));
    return Math.hypot(fromX + part * dx - x, fromY + part * dy - y);
}
