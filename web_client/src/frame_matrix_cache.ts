// Knows where the pictures that the server draws show the matrix of planar sections. The page requests the place of the
// matrix when the matrix appears, so that the user can drag in it at once.

import type { Client, SectionMatrix, State } from "@oval4d/protocol";

import { layoutKey } from "./layout_key";
import type { Stage } from "./picture/stage";

export class FrameSectionMatrixCache {
    private known: SectionMatrix | undefined;
    // The layoutKey() of the picture whose matrix is known or requested; "" if there is none. The key omits the
    // settings of slices and surfaces, because they do not move the matrix.
    private knownFor = "";

    constructor(
        private readonly client: Client,
        private readonly stage: Stage,
    ) {}

    /**
     * The matrix as the server sent it last. Its sections may belong to an earlier picture. Undefined if the place of
     * the matrix is not known, or if no matrix is shown.
     */
    get current(): SectionMatrix | undefined {
        return this.known;
    }

    /**
     * Requests the matrix if its place has changed. Must be called when the state, the size or the rendering mode may
     * have changed.
     */
    update({ slices, levels, inside, fog, caps, ...state }: State): void {
        const isShown = state.view === "matrix" && this.stage.mode === "frames";
        const key = isShown ? layoutKey(state, this.stage.size) : "";
        if (key === this.knownFor) return;
        this.knownFor = key;
        if (!isShown) this.known = undefined; // a shown matrix stays known until the answer arrives
        if (isShown) void this.requestMatrix(key);
    }

    private async requestMatrix(key: string): Promise<void> {
        try {
            const { matrix } = await this.client.request({ type: "get", what: "slices", ...this.stage.size });
            if (this.knownFor === key) this.known = matrix;
        } catch {
            if (this.knownFor === key) this.knownFor = ""; // the next call of update() requests the matrix again
        }
    }
}
