// Where the slices are in the pictures that the server draws. The page asks when it needs to know, because the answer is
// as large as a picture of the geometry stream.

import type { Client, State } from "@oval4d/protocol";

import { SliceLayout } from "./picture/slice_layout";
import type { Stage } from "./picture/stage";

export class FrameLayout {
    private state: State | undefined;
    private known: SliceLayout | undefined;
    private knownFor = ""; // what the known or requested layout depends on

    /** `onKnown` is called when a layout that `current` requested has arrived. */
    constructor(
        private readonly client: Client,
        private readonly stage: Stage,
        private readonly onKnown: () => void,
    ) {}

    update(state: State): void {
        this.state = state;
    }

    /** The layout if it is known; otherwise requests it, and returns undefined. */
    get current(): SliceLayout | undefined {
        if (!this.state) return undefined;
        const { slices, view, shown, projection, polytope } = this.state;
        const key = JSON.stringify([slices, view, shown, projection, polytope.name, this.stage.size]);
        if (key !== this.knownFor) {
            this.knownFor = key;
            this.known = undefined;
            void this.request().then((layout) => {
                if (this.knownFor !== key) return;
                this.known = layout;
                if (layout) this.onKnown();
                else this.knownFor = "";
            });
        }
        return this.known;
    }

    /** Requests the layout of the newest picture; undefined if there is no answer. */
    async request(): Promise<SliceLayout | undefined> {
        try {
            const slices = await this.client.request({ type: "get", what: "slices", ...this.stage.size });
            return new SliceLayout(slices, this.state!.camera);
        } catch {
            return undefined;
        }
    }
}
