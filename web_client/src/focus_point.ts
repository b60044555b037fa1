// Moves the focus point of the matrix view. The newest point is sent once per animation frame, when the previous one has
// been answered.

import type { Client, State } from "@oval4d/protocol";

/** A point x, y, z, w. */
export type Point4 = State["point"];

export interface FocusPointEvents {
    /** Called when a gesture begins, which may move the focus slice. */
    began(): void;
    failed(error: Error): void;
}

interface PointOfRevision {
    point: Point4;
    revision: number;
}

const kOrigin: Point4 = [0, 0, 0, 0];

export class FocusPoint {
    private wanted = kOrigin;
    private isUnsent = false;
    private isSending = false;
    private isScheduled = false;
    private continues = false; // whether the next move belongs to the undo step of the last one
    private answered: PointOfRevision = { point: kOrigin, revision: 0 };
    private seen: PointOfRevision = { point: kOrigin, revision: 0 }; // in the newest state

    constructor(
        private readonly client: Client,
        private readonly events: FocusPointEvents,
    ) {}

    /** Follows the focus point of the session. */
    update({ point, revision }: State): void {
        this.seen = { point, revision };
    }

    /** Forgets the revisions, because a new connection may be to a session whose revisions start at 0. */
    restart(): void {
        this.answered.revision = this.seen.revision = 0;
    }

    /** Begins a gesture: the moves up to the next call are one undo step. */
    begin(): void {
        this.continues = false;
        this.events.began();
    }

    /** Changes some coordinates of the point: pairs of an axis, 0 to 3, and a coordinate. */
    move(coordinates: readonly (readonly [axis: number, value: number])[]): void {
        const point: Point4 = [...this.point];
        for (const [axis, value] of coordinates) point[axis] = value;
        this.wanted = point;
        this.isUnsent = true;
        this.schedule();
    }

    /** Where the point is, or will be when the server has answered. */
    private get point(): Point4 {
        if (this.isUnsent || this.isSending) return this.wanted;
        return this.seen.revision >= this.answered.revision ? this.seen.point : this.answered.point;
    }

    private schedule(): void {
        if (this.isSending || this.isScheduled) return;
        this.isScheduled = true;
        requestAnimationFrame(() => void this.send());
    }

    private async send(): Promise<void> {
        this.isScheduled = false;
        this.isUnsent = false;
        this.isSending = true;
        const point = this.wanted;
        const { continues } = this;
        this.continues = true;
        try {
            const { revision } = await this.client.request({ type: "set", point, ...(continues && { continues }) });
            this.answered = { point, revision };
        } catch (error) {
            this.isUnsent = false;
            this.events.failed(error as Error);
        }
        this.isSending = false;
        if (this.isUnsent) this.schedule();
    }
}
