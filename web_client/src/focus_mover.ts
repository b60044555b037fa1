// Moves the focus slice to any w. Sends at most one w per animation frame, and waits for the server's answer before it
// sends the newest wanted w.

import type { Client, State } from "@oval4d/protocol";

interface FocusAtRevision {
    w: number;
    revision: number;
}

export class FocusSliceMover {
    private wanted = 0;
    private isUnsent = false;
    private continues = false; // whether the next move joins the undo step of the last move
    private isScheduled = false;
    private inFlight: number | undefined; // the w that has been sent and not answered
    private answered: FocusAtRevision = { w: NaN, revision: 0 };
    private seen: FocusAtRevision = { w: 0, revision: 0 }; // the focus in the newest state that has arrived

    /**
     * `settled` is called when all moves have been answered and none is left to send. If the last move failed,
     * `settled` gets the error.
     */
    constructor(
        private readonly client: Client,
        private readonly settled: (error?: Error) => void,
    ) {}

    /** The w of the focus slice. While a move is unsent or unanswered, the w to which the focus moves. */
    get w(): number {
        if (this.isUnsent || this.inFlight !== undefined) return this.wanted;
        return this.seen.revision >= this.answered.revision ? this.seen.w : this.answered.w;
    }

    /** Begins a gesture. One undo step reverts all moves between two calls. */
    beginGesture(): void {
        this.continues = false;
    }

    moveTo(w: number): void {
        this.wanted = w;
        this.isUnsent = true;
        this.scheduleSend();
    }

    /** Forgets a move that has not been sent. */
    cancelUnsentMove(): void {
        this.isUnsent = false;
    }

    /** Adopts the focus of a new state of the session. */
    update({ revision, section: { w } }: State): void {
        this.seen = { w, revision };
    }

    /** Forgets the revisions, because a new connection may be to a session whose revisions start at 0. */
    prepareForNewConnection(): void {
        this.answered.revision = this.seen.revision = 0;
    }

    private scheduleSend(): void {
        if (this.inFlight !== undefined || this.isScheduled) return;
        this.isScheduled = true;
        requestAnimationFrame(() => void this.sendMove());
    }

    private async sendMove(): Promise<void> {
        this.isScheduled = false;
        if (!this.isUnsent) return;
        this.isUnsent = false;
        const w = (this.inFlight = this.wanted);
        const { continues } = this;
        this.continues = true;
        let failure: Error | undefined;
        try {
            const { revision } = await this.client.request({ type: "set", slices: { w }, continues });
            this.answered = { w, revision };
        } catch (error) {
            failure = error as Error;
            this.isUnsent = false;
        }
        this.inFlight = undefined;
        if (this.isUnsent) this.scheduleSend();
        else this.settled(failure);
    }
}
