// The critical values of w, at which the section w = const changes its type. For a polytope, they are the values of w
// at which vertices lie (Coxeter, Regular Polytopes, §13.1); for a field, those at which the body changes its topology.
// The parallel coordinates of a picture contain the w of a polytope's vertices, but rounded. The page uses these values
// at once, and requests the exact values when the object has come to rest.

import type { Client, Slices, State } from "@oval4d/protocol";

/**
 * A value of w at which the section changes its type. For a polytope, `vertices` is the number of vertices at this w.
 */
export interface CriticalValue {
    w: number;
    vertices?: number;
}

// The exact values are requested after this many milliseconds without a change. The time is longer for a field, because
// the server's search then takes seconds.
const kRestTime = 200;
const kFieldRestTime = 1500;
const kRounding = 1e-6; // in circumradii of the object: rounded values of w that differ by at most this count as equal

export class CriticalValueTracker {
    /** The critical values from the lowest w to the highest; empty before the first are known. */
    all: CriticalValue[] = [];
    /** Whether `all` and `range` belong to the newest state, not to an earlier one. */
    isCurrent = false;
    /** Whether `all` and `range` are exact and belong to the newest state. */
    isExact = false;
    /**
     * The lowest and the highest w of the object. For a field, the lowest and the highest w of its slices, until the
     * server has answered.
     */
    range: [number, number] = [0, 0];
    // The w of the object's center in the coordinates of its file; in pictures, the center has w = 0.
    private originW = 0;
    // Identifies the object and the settings whose critical values are known or requested; "" if a request has failed.
    private knownFor = "";
    private restTime = kRestTime;
    private isAsking = false; // whether an answer is outstanding: there is one request at a time
    private timer: ReturnType<typeof setTimeout> | undefined;

    constructor(
        private readonly client: Client,
        private readonly onChange: () => void,
    ) {}

    update(state: State): void {
        const { object_serial, polytope, pace, follow, boost, orientation, slices, field, levels, inside } = state;
        const key = JSON.stringify([object_serial, pace, follow, boost, orientation, levels, inside]);
        if (key === this.knownFor) return;
        this.knownFor = key;
        this.originW = polytope.center?.[3] ?? 0;
        this.restTime = field ? kFieldRestTime : kRestTime;
        this.scheduleRequest();
        this.isCurrent = this.isExact = false;
        if (field) {
            // Until the critical values are known, the range is that of the slices.
            const reach = (slices.spacing * (slices.count - 1)) / 2;
            this.all = [];
            this.range = [slices.offset - reach, slices.offset + reach];
            this.isCurrent = true;
        }
        this.onChange();
    }

    /** Takes rounded values from the picture of the newest state, if the picture has the parallel coordinates. */
    adoptFromPicture({ coordinates, scene }: Slices): void {
        if (this.isCurrent || coordinates.length === 0) return;
        const heights = coordinates.filter((_, i) => i % 4 === 3).sort();
        this.all = [];
        for (const height of heights) {
            const w = this.originW + height;
            const last = this.all.at(-1);
            if (last && w - last.w <= kRounding * scene.circumradius) last.vertices = (last.vertices ?? 0) + 1;
            else this.all.push({ w, vertices: 1 });
        }
        this.range = [this.all[0]!.w, this.all.at(-1)!.w];
        this.isCurrent = true;
        this.onChange();
    }

    private scheduleRequest(): void {
        clearTimeout(this.timer);
        this.timer = setTimeout(() => void this.requestCriticalValues(), this.restTime);
    }

    private async requestCriticalValues(): Promise<void> {
        if (this.isAsking) return;
        const key = this.knownFor;
        this.isAsking = true;
        try {
            const { least_w, most_w, sections } = await this.client.request({ type: "get", what: "critical" });
            if (this.knownFor !== key) return;
            this.all = sections;
            this.range = [least_w, most_w];
            this.isCurrent = this.isExact = true;
            this.onChange();
        } catch {
            if (this.knownFor === key) this.knownFor = ""; // the next state requests the values again
        } finally {
            this.isAsking = false;
            if (this.knownFor !== key && this.knownFor !== "") this.scheduleRequest();
        }
    }
}
