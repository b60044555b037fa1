// Holds the hit tester (finds the element at a pixel) for pictures that the server draws. The page makes the hit tester
// from a `slices` message. This message is as large as a picture of the geometry stream, so the page requests it only
// when it needs the hit tester.

import type { Client, State } from "@oval4d/protocol";

import { layoutKey } from "./layout_key";
import { HitTester } from "./picture/hit_tester";
import type { Stage } from "./picture/stage";

export class FrameHitTesterCache {
    private state: State | undefined;
    private known: HitTester | undefined;
    private knownFor = ""; // the layoutKey() of the picture whose hit tester is known or requested

    /** `onKnown` is called when a hit tester that currentOrRequestHitTester() has requested has arrived. */
    constructor(
        private readonly client: Client,
        private readonly stage: Stage,
        private readonly onKnown: () => void,
    ) {}

    update(state: State): void {
        this.state = state;
    }

    /** Returns the hit tester of the picture. If it is not known, requests it, and returns undefined. */
    currentOrRequestHitTester(): HitTester | undefined {
        if (!this.state) return undefined;
        const key = layoutKey(this.state, this.stage.size);
        if (key !== this.knownFor) {
            this.knownFor = key;
            this.known = undefined;
            void this.requestHitTester().then(
                (hitTester) => {
                    if (this.knownFor !== key) return;
                    this.known = hitTester;
                    this.onKnown();
                },
                () => {
                    if (this.knownFor === key) this.knownFor = ""; // the next call requests the hit tester again
                },
            );
        }
        return this.known;
    }

    /** Requests the hit tester of the newest picture. */
    async requestHitTester(): Promise<HitTester> {
        const slices = await this.client.request({ type: "get", what: "slices", ...this.stage.size });
        return new HitTester(slices, this.state!.camera);
    }
}
