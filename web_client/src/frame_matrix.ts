// Where the matrix is in the pictures that the server draws. The page asks when it begins to show the matrix, so that a
// drag can begin at once.

import type { Client, SectionMatrix, State } from "@oval4d/protocol";

import type { Stage } from "./picture/stage";

export class FrameMatrix {
    private known: SectionMatrix | undefined;
    private knownFor = ""; // what the known or requested layout depends on; empty if there is none

    constructor(
        private readonly client: Client,
        private readonly stage: Stage,
    ) {}

    /** The layout, with sections that may be old; undefined if it is not known, or if there is no matrix. */
    get current(): SectionMatrix | undefined {
        return this.known;
    }

    /** Requests the layout if it has changed. To be called when the state, the size or the mode may have changed. */
    update({ view, shown, polytope }: State): void {
        const isShown = view === "matrix" && this.stage.mode === "frames";
        const key = isShown ? JSON.stringify([shown.coordinates, polytope, this.stage.size]) : "";
        if (key === this.knownFor) return;
        this.knownFor = key;
        this.known = undefined;
        if (isShown) void this.request(key);
    }

    private async request(key: string): Promise<void> {
        try {
            const { matrix } = await this.client.request({ type: "get", what: "slices", ...this.stage.size });
            if (this.knownFor === key) this.known = matrix;
        } catch {
            if (this.knownFor === key) this.knownFor = ""; // the next state asks again
        }
    }
}
