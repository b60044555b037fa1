// Controls the camera's orbit around the slices. The page applies a change at once. It sends the newest orbit to the
// session, one request at a time.

import type { Client, Orbit, RequestError, State } from "@oval4d/protocol";

import { OldStateDetector } from "./old_state_detector";
import type { HitTester } from "./picture/hit_tester";
import type { Stage } from "./picture/stage";

const kInitial: Orbit = { azimuth: 0, elevation: 0, zoom: 1 };
const kLimits = { elevation: 1.5, zoom: [0.25, 10] as const };
const kLeastVisible = 0.5; // the least fraction of the slices that orbiting and zooming keep in the picture
const kBisections = 10;
// zoomBy() tells the user that a limit has stopped the zoom if the zoom changes by no more than this fraction.
const kNoticedZoomChange = 1e-3;

const kAngleStep = Math.PI / 36; // the angle by which one key press moves the camera, in radians
const kZoomStep = 1.1;

export class OrbitControl {
    private sending = false;
    private unsent = false;
    private readonly lastChange = new OldStateDetector();
    // The orbit before the first move that limited() could not check, because no hit tester was known. Undefined if all
    // moves have been checked.
    private lastLimited: Orbit | undefined;
    /** The actions of the camera, by their names in the key table. */
    private readonly actions: Record<string, () => void> = {
        orbit_left: () => this.orbitBy(-kAngleStep, 0),
        orbit_right: () => this.orbitBy(kAngleStep, 0),
        orbit_down: () => this.orbitBy(0, -kAngleStep),
        orbit_up: () => this.orbitBy(0, kAngleStep),
        zoom_out: () => this.zoomBy(1 / kZoomStep),
        zoom_in: () => this.zoomBy(kZoomStep),
        reset_view: () => this.reset(),
    };

    /**
     * `hitTester` returns the hit tester of the picture, which tells how many slices are visible; undefined while it is
     * not known. `stopped` shows the user why the camera does not move.
     */
    constructor(
        private readonly client: Client,
        private readonly stage: Stage,
        private readonly hitTester: () => HitTester | undefined,
        private readonly stopped: (reason: string) => void,
    ) {}

    /**
     * Orbits by a drag of `dx` CSS pixels to the right and `dy` down. A drag over half the picture's height makes a
     * quarter turn.
     */
    drag(dx: number, dy: number): void {
        const part = Math.PI / Math.max(1, this.stage.shownHeight);
        this.orbitBy(-dx * part, dy * part);
    }

    zoomBy(factor: number): void {
        const [min, max] = kLimits.zoom;
        const from = this.stage.orbit;
        const to = this.limited(from, { zoom: Math.min(max, Math.max(min, from.zoom * factor)) });
        this.setAndSendOrbit(to);
        if (Math.abs(factor - 1) <= kNoticedZoomChange) return; // two fingers that only move or twist do not zoom
        if (Math.abs(to.zoom / from.zoom - 1) > kNoticedZoomChange) return;
        if (factor < 1) this.stopped("The camera is as far away as it can be.");
        else if (to.zoom >= max) this.stopped("The camera is as close as it can be.");
        else this.stopped("Closer, most slices would leave the picture. One slice (o) can be seen closer.");
    }

    reset(): void {
        this.lastLimited = undefined;
        this.setAndSendOrbit(kInitial);
    }

    /** Limits the moves made while no hit tester was known. Must be called when the hit tester becomes known. */
    onHitTesterAvailable(): void {
        const from = this.lastLimited;
        this.lastLimited = undefined;
        if (from) this.setAndSendOrbit(this.limited(from, this.stage.orbit));
    }

    prepareForNewConnection(): void {
        this.lastChange.prepareForNewConnection();
    }

    /** Performs an action of the key table; returns false if it is not an action of the camera. */
    perform(action: string): boolean {
        const move = this.actions[action];
        move?.();
        return move !== undefined;
    }

    /**
     * Orbits by two angles in radians. Each angle is limited separately, so that the camera can still move in one
     * direction if the other is blocked.
     */
    private orbitBy(azimuth: number, elevation: number): void {
        const from = this.stage.orbit;
        const turned = this.limited(from, { azimuth: from.azimuth + azimuth });
        const tilted = Math.min(kLimits.elevation, Math.max(-kLimits.elevation, from.elevation + elevation));
        this.setAndSendOrbit(this.limited(turned, { elevation: tilted }));
    }

    /**
     * Returns the orbit after a change. If too few slices would be visible, makes a smaller change in the same
     * direction. Too few means: less than the fraction kLeastVisible, and less than before the change. Without a hit
     * tester, makes the whole change, and onHitTesterAvailable() limits it later.
     */
    private limited(from: Orbit, change: Partial<Orbit>): Orbit {
        const to = { ...from, ...change };
        const hitTester = this.hitTester();
        if (!hitTester) this.lastLimited ??= from;
        const visible = (orbit: Orbit): number => hitTester?.visibleShare(orbit, this.stage.size) ?? 1;
        const least = Math.min(kLeastVisible, visible(from));
        let part = visible(to) < least ? 0 : 1;
        for (let step = 1, k = 0; part < 1 && k < kBisections; ++k) {
            step /= 2;
            if (visible(interpolateOrbits(from, to, part + step)) >= least) part += step;
        }
        return interpolateOrbits(from, to, part);
    }

    /** Adopts the camera of the state, unless this page has sent a newer camera or is about to. */
    adoptCamera(state: State): void {
        const isOld = this.lastChange.recordAndCheckIfOld(state);
        if (isOld || this.sending || this.unsent) return; // the page's orbit is newer
        this.stage.orbit = state.camera;
    }

    private setAndSendOrbit(orbit: Orbit): void {
        this.stage.orbit = { ...orbit, azimuth: orbit.azimuth % (2 * Math.PI) };
        if (this.stage.mode === "geometry") this.stage.scheduleRedraw();
        this.unsent = true;
        void this.send();
    }

    private async send(): Promise<void> {
        if (this.sending) return;
        this.sending = true;
        while (this.unsent) {
            this.unsent = false;
            const camera = this.stage.orbit;
            try {
                const { revision } = await this.client.request({ type: "set", camera });
                this.lastChange.noteRevision(revision);
            } catch (error) {
                // Without a connection, the camera can still be moved, and the page shows the missing connection
                // elsewhere.
                if ((error as RequestError).code !== "not_connected") this.stopped((error as Error).message);
            }
        }
        this.sending = false;
    }
}

/** Interpolates between two orbits: `from` if `part` is 0, `to` if `part` is 1. */
function interpolateOrbits(from: Orbit, to: Orbit, part: number): Orbit {
    const between = (a: number, b: number): number => (part === 1 ? b : a + (b - a) * part);
    return {
        azimuth: between(from.azimuth, to.azimuth),
        elevation: between(from.elevation, to.elevation),
        zoom: between(from.zoom, to.zoom),
    };
}
