// The viewer's orbit around the slices. The page applies a change at once, and sends the newest orbit to the session
// whenever the previous one has been answered.

import type { Client, Orbit, State } from "@oval4d/protocol";

import type { Stage } from "./picture/stage";

const kInitial: Orbit = { azimuth: 0, elevation: 0, zoom: 1 };
const kLimits = { elevation: 1.5, zoom: [0.1, 10] as const };

export class OrbitControl {
    private sending = false;
    private unsent = false;

    constructor(
        private readonly client: Client,
        private readonly stage: Stage,
    ) {}

    /** Orbits by a drag in pixels: half the height of the picture is a quarter turn. */
    drag(dx: number, dy: number): void {
        const part = Math.PI / Math.max(1, this.stage.size.height / devicePixelRatio);
        const { azimuth, elevation, zoom } = this.stage.orbit;
        const tilted = Math.min(kLimits.elevation, Math.max(-kLimits.elevation, elevation + dy * part));
        const turned = (azimuth - dx * part) % (2 * Math.PI);
        this.setOrbit({ azimuth: turned, elevation: tilted, zoom });
    }

    zoomBy(factor: number): void {
        const [min, max] = kLimits.zoom;
        this.setOrbit({ ...this.stage.orbit, zoom: Math.min(max, Math.max(min, this.stage.orbit.zoom * factor)) });
    }

    reset(): void {
        this.setOrbit(kInitial);
    }

    /** Adopts the camera of the state, unless this page has changes that the session has not answered. */
    adoptCamera(state: State): void {
        if (this.sending || this.unsent) return;
        this.stage.orbit = state.camera;
    }

    private setOrbit(orbit: Orbit): void {
        this.stage.orbit = orbit;
        if (this.stage.mode === "geometry") this.stage.redraw();
        this.unsent = true;
        void this.send();
    }

    private async send(): Promise<void> {
        if (this.sending) return;
        this.sending = true;
        while (this.unsent) {
            this.unsent = false;
            const camera = this.stage.orbit;
            await this.client.request({ type: "set", camera }).catch(() => {});
        }
        this.sending = false;
    }
}
