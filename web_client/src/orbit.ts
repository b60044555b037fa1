// The viewer's own motion about the slices: applied here at once, sent to the session as fast as it takes it.

import type { Client, Orbit, State } from "@oval4d/protocol";

import type { Stage } from "./picture/stage";

const kRest: Orbit = { azimuth: 0, elevation: 0, zoom: 1 };
const kLimits = { elevation: 1.5, zoom: [0.1, 10] as const };

export class OrbitControl {
    private sending = false;
    private unsent = false;

    constructor(
        private readonly client: Client,
        private readonly stage: Stage,
    ) {}

    /** Half the picture's height turns by a quarter turn. */
    drag(dx: number, dy: number): void {
        const part = Math.PI / Math.max(1, this.stage.size.height / devicePixelRatio);
        const { azimuth, elevation, zoom } = this.stage.orbit;
        const steep = Math.min(kLimits.elevation, Math.max(-kLimits.elevation, elevation + dy * part));
        const turned = (azimuth - dx * part) % (2 * Math.PI);
        this.move({ azimuth: turned, elevation: steep, zoom });
    }

    magnify(factor: number): void {
        const [least, most] = kLimits.zoom;
        this.move({ ...this.stage.orbit, zoom: Math.min(most, Math.max(least, this.stage.orbit.zoom * factor)) });
    }

    reset(): void {
        this.move(kRest);
    }

    /** Takes over what another client, or the history, has done. */
    follow(state: State): void {
        if (this.sending || this.unsent) return;
        this.stage.orbit = state.camera;
    }

    private move(orbit: Orbit): void {
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
