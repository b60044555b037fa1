// The view and projection matrices of the camera. The server places the camera for one orbit; the page moves it to the
// newest orbit.

import { Matrix4, Vector3, Vector4 } from "three";

import type { Orbit, SceneDescription, Viewport } from "@oval4d/protocol";

/** A point of the picture, in pixels from its upper left corner. */
export interface ScreenPoint {
    x: number;
    y: number;
}

const kMaxPitch = 1.55; // the greatest elevation of the camera, in radians; at π/2 the up direction would be undefined

export class ViewCamera {
    readonly view = new Matrix4();
    readonly projection = new Matrix4();
    readonly eye = new Vector3();
    /** Whether the viewer has moved the camera from its initial orbit. */
    isMoved = false;
    private readonly axes = [new Vector3(), new Vector3(), new Vector3()] as const;
    private readonly clip = new Vector4();
    private width = 1;
    private height = 1;

    /**
     * Sets the camera. `from` is the orbit for which the server placed `camera`; `to` is the orbit from which to look
     * now.
     */
    set(camera: SceneDescription["camera"], viewport: Viewport, from: Orbit, to: Orbit): void {
        this.width = viewport.width;
        this.height = viewport.height;
        this.isMoved = to.azimuth !== 0 || to.elevation !== 0 || to.zoom !== 1;
        const [right, up, back] = this.axes;
        const target = right.fromArray(camera.target);
        const { x, y, z } = back.fromArray(camera.eye).sub(target);
        const distance = Math.hypot(x, y, z);
        const azimuth = Math.atan2(x, z) + to.azimuth - from.azimuth;
        const elevation = Math.asin(y / distance) + to.elevation - from.elevation;
        const pitch = Math.min(kMaxPitch, Math.max(-kMaxPitch, elevation));
        back.set(Math.sin(azimuth) * Math.cos(pitch), Math.sin(pitch), Math.cos(azimuth) * Math.cos(pitch));
        this.eye.copy(back).multiplyScalar(distance).add(target);
        right.fromArray(camera.up).cross(back).normalize();
        up.crossVectors(back, right);
        this.view.makeBasis(right, up, back).setPosition(this.eye).invert();

        const f = to.zoom / from.zoom / Math.tan(camera.fov / 2);
        const depth = camera.near - camera.far;
        const [shiftX, shiftY] = camera.shift;
        this.projection.set(
            ...([(f * this.height) / this.width, 0, -2 * shiftX, 0] as const),
            ...([0, f, -2 * shiftY, 0] as const),
            ...([0, 0, (camera.near + camera.far) / depth, (2 * camera.near * camera.far) / depth] as const),
            ...([0, 0, -1, 0] as const),
        );
    }

    /**
     * Projects a world position to pixels from the upper left corner. Returns undefined for a position behind the
     * viewer.
     */
    project(world: readonly [number, number, number]): ScreenPoint | undefined {
        const { x, y, w } = this.clip
            .set(...world, 1)
            .applyMatrix4(this.view)
            .applyMatrix4(this.projection);
        return w > 0 ? { x: ((x / w + 1) / 2) * this.width, y: ((1 - y / w) / 2) * this.height } : undefined;
    }

    /**
     * Projects a point whose camera coordinates x, y, z begin at points[at]. Writes the x and y of the point's pixel
     * into the next two elements of `points`.
     */
    cameraToScreen(points: Float32Array, at: number): void {
        const f = this.projection.elements;
        const depth = -points[at + 2]!;
        points[at + 3] = (((f[0]! * points[at]!) / depth - f[8]! + 1) / 2) * this.width;
        points[at + 4] = ((1 - (f[5]! * points[at + 1]!) / depth + f[9]!) / 2) * this.height;
    }

    /**
     * The ray through the pixel (x, y): the camera coordinates x and y of its point at the distance 1 along the view
     * axis.
     */
    rayAt(x: number, y: number): [number, number] {
        const f = this.projection.elements;
        return [((2 * x) / this.width - 1 + f[8]!) / f[0]!, (1 - (2 * y) / this.height + f[9]!) / f[5]!];
    }

    /**
     * The ray through the pixel (x, y): the vector in world space from the eye to its point at the distance 1 along the
     * view axis.
     */
    worldRayAt(x: number, y: number): [number, number, number] {
        const [right, up] = this.rayAt(x, y);
        const view = this.view.elements;
        const along = (k: number): number => right * view[k]! + up * view[k + 1]! - view[k + 2]!;
        return [along(0), along(4), along(8)];
    }

    /** The distance of a world position from the eye, along the view axis; negative behind the eye. */
    depthOf([x, y, z]: readonly [number, number, number]): number {
        const view = this.view.elements;
        return -(view[2]! * x + view[6]! * y + view[10]! * z + view[14]!);
    }

    /** The direction of the world's x, y or z axis in camera coordinates. */
    worldAxisInCamera(i: 0 | 1 | 2): Vector3 {
        return new Vector3().setFromMatrixColumn(this.view, i);
    }

    /** The number of pixels per world unit at the distance 1 along the view axis. */
    get pixelsPerUnit(): number {
        return (this.projection.elements[5]! * this.height) / 2;
    }
}
