// The values of w at which vertices of the rotated object lie: only there does the section w = const change its type
// (Coxeter, Regular Polytopes, §13.1). The parallel coordinates give them at once, but rounded. Their exact values are
// in the exported CSV file, which the page requests when the object has come to rest.

import type { Client, Slices, State } from "@oval4d/protocol";

/** A w at which vertices lie, and their number. */
export interface Level {
    w: number;
    vertices: number;
}

const kRestTime = 200; // milliseconds without a turn after which the exact values are requested
const kRounding = 1e-6; // circumradii: rounded values that differ by less count as equal
const kHeading = "critical_w,vertices\n"; // the first line of the table of levels in the CSV file

export class CriticalLevels {
    /** From the lowest w to the highest; empty before the first are known. */
    all: Level[] = [];
    /** Whether they are those of the newest state; otherwise they are those of an earlier one. */
    isCurrent = false;
    /** Whether they are exact and those of the newest state. */
    isExact = false;
    private knownFor = ""; // what the known or requested levels depend on
    private timer: ReturnType<typeof setTimeout> | undefined;

    constructor(
        private readonly client: Client,
        private readonly onChange: () => void,
    ) {}

    update({ polytope, orientation, slices }: State): void {
        const key = JSON.stringify([polytope, orientation, slices.spacing]); // δ changes if another object has this name
        if (key === this.knownFor) return;
        this.knownFor = key;
        this.isCurrent = this.isExact = false;
        clearTimeout(this.timer);
        this.timer = setTimeout(() => void this.request(key), kRestTime);
        this.onChange();
    }

    /** Takes rounded values from the picture of the newest state, if it has the parallel coordinates. */
    adopt({ coordinates, scene }: Slices): void {
        if (this.isCurrent || coordinates.length === 0) return;
        const heights = coordinates.filter((_, i) => i % 4 === 3).sort();
        this.all = [];
        for (const w of heights) {
            const last = this.all.at(-1);
            if (last && w - last.w <= kRounding * scene.circumradius) ++last.vertices;
            else this.all.push({ w, vertices: 1 });
        }
        this.isCurrent = true;
        this.onChange();
    }

    private async request(key: string): Promise<void> {
        try {
            const file = await this.client.request({ type: "get", what: "file", format: "csv" });
            if (this.knownFor !== key) return;
            this.all = parse(new TextDecoder().decode(file));
            this.isCurrent = this.isExact = true;
            this.onChange();
        } catch {
            if (this.knownFor === key) this.knownFor = ""; // the next state requests them again
        }
    }
}

function parse(csv: string): Level[] {
    const table = csv.slice(csv.indexOf(kHeading) + kHeading.length);
    return table
        .trim()
        .split("\n")
        .map((line) => line.split(",").map(Number))
        .map(([w, vertices]) => ({ w: w!, vertices: vertices! }));
}
