// Finds what is at a pixel of a picture, and which fraction of its slices is visible.

import type { Orbit, Slice, Slices, Viewport } from "@oval4d/protocol";

import { vertexInCoordinatesAt } from "./coordinates";
import { type ElementHit, hitAt, kReach, type LevelHit } from "./hit_test";
import { hitInPanel } from "./matrix_hit";
import { type MatrixPanel, panelAt } from "./matrix_panel";
import { heightOfCoordinates } from "./overlay";
import { ViewCamera } from "./view_camera";

export class HitTester {
    private readonly viewCamera = new ViewCamera();

    /** `orbit` is the orbit for which the server placed the picture's camera. */
    constructor(
        readonly picture: Slices,
        private readonly orbit: Orbit,
    ) {}

    /**
     * The fraction of the drawn slices that are visible in a picture of this size, as seen from `orbit`. A slice is
     * visible if its center is within the picture and not covered by the parallel coordinates.
     */
    visibleShare(orbit: Orbit, size: Viewport): number {
        this.viewCamera.set(this.picture.scene.camera, size, this.orbit, orbit);
        const drawn = this.picture.slices.filter((slice) => slice.drawn);
        const visible = drawn.filter(({ position }) => {
            const at = this.viewCamera.project(position);
            const isInside = at && at.x >= 0 && at.x <= size.width && at.y >= 0 && at.y <= size.height;
            return isInside && !this.isCovered(at.y, size);
        });
        return drawn.length === 0 ? 1 : visible.length / drawn.length;
    }

    /**
     * The slice at a point of the picture, in pixels; undefined if there is none. Each slice has a disc around its
     * center. The disc reaches to the slice's farthest vertex, and its radius is at least `minRadius` pixels. If
     * several discs contain the point, the slice with the nearest center is returned.
     */
    sliceAt(x: number, y: number, orbit: Orbit, size: Viewport, minRadius: number): Slice | undefined {
        this.viewCamera.set(this.picture.scene.camera, size, this.orbit, orbit);
        if (this.isCovered(y, size)) return undefined;
        let [found, nearest]: [Slice | undefined, number] = [undefined, Infinity];
        for (const slice of this.picture.slices) {
            const center = slice.drawn ? this.viewCamera.project(slice.position) : undefined;
            const distance = center ? Math.hypot(center.x - x, center.y - y) : Infinity;
            if (distance < nearest && distance <= Math.max(minRadius, this.radiusOf(slice))) {
                [found, nearest] = [slice, distance];
            }
        }
        return found;
    }

    /**
     * The element, or the surface or contour of a field, at a point of the picture, in pixels; undefined if there is
     * none. `ratio` is the number of picture pixels per CSS pixel.
     */
    hitAt(x: number, y: number, orbit: Orbit, size: Viewport, ratio: number): ElementHit | LevelHit | undefined {
        const { matrix, scene } = this.picture;
        const panel = this.panelAt(x, y, size);
        if (panel) return hitInPanel(panel, matrix!, scene, size, [x, y], kReach * ratio);
        this.viewCamera.set(scene.camera, size, this.orbit, orbit);
        if (this.isCovered(y, size)) return undefined;
        return hitAt(this.picture, this.viewCamera, x, y, ratio);
    }

    /**
     * The vertex whose parallel coordinates are at a point of the picture, in pixels; undefined if there is none.
     */
    vertexInCoordinatesAt(x: number, y: number, size: Viewport): number | undefined {
        return this.panelAt(x, y, size) ? undefined : vertexInCoordinatesAt(this.picture, size, x, y);
    }

    /**
     * Whether the parallel coordinates cover slices at the height `y`, in pixels from the top of the picture. The
     * caller must have set `viewCamera`.
     */
    private isCovered(y: number, size: Viewport): boolean {
        const { scene } = this.picture;
        return (
            scene.shown.coordinates && this.viewCamera.isMoved && y >= size.height - heightOfCoordinates(scene, size)
        );
    }

    /** The panel of the matrix at a point of the picture, in pixels; undefined if there is none. */
    private panelAt(x: number, y: number, size: Viewport): MatrixPanel | undefined {
        const { matrix } = this.picture;
        return matrix && panelAt(matrix, x, y, size);
    }

    /** The radius of a slice in the picture, in pixels: the largest distance of a vertex from the slice's center. */
    private radiusOf({ vertices, position: [x, y, z] }: Slice): number {
        const { scale } = this.picture.scene;
        const center = this.viewCamera.project([x, y, z]);
        let radius = 0;
        for (let i = 0; i < vertices.length; i += 3) {
            const [a, b, c] = [vertices[i]!, vertices[i + 1]!, vertices[i + 2]!];
            const at = this.viewCamera.project([x + scale * a, y + scale * b, z + scale * c]);
            if (center && at) radius = Math.max(radius, Math.hypot(at.x - center.x, at.y - center.y));
        }
        return radius;
    }
}
