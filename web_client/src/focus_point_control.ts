// Moves the focus point of the matrix view. Sends at most one point per animation frame, and waits for the server's
// answer before it sends the newest wanted point.

import type { Client, State } from "@oval4d/protocol";

import { OldStateDetector } from "./old_state_detector";
import { originInFile } from "./origin";

/** A point x, y, z, w. */
export type Point4 = State["point"];

export interface FocusPointEvents {
    /**
     * Called when a gesture that moves the focus point begins, such as a drag. The gesture may also move the focus
     * slice, because this slice lies at the w of the focus point.
     */
    gestureBegan(): void;
    failed(error: Error): void;
}

const kOrigin: Point4 = [0, 0, 0, 0];

export class FocusPointMover {
    private wanted = kOrigin;
    private isUnsent = false;
    private isSending = false;
    private isScheduled = false;
    private continues = false; // whether the next move joins the undo step of the last move
    private current = kOrigin; // the focus point of the session
    private readonly lastChange = new OldStateDetector();
    private origin = kOrigin; // the vector to add to coordinates in the picture to get coordinates in the object's file

    constructor(
        private readonly client: Client,
        private readonly events: FocusPointEvents,
    ) {}

    /** Adopts the focus point of a new state of the session. */
    update(state: State): void {
        if (!this.lastChange.recordAndCheckIfOld(state)) this.current = state.point;
        this.origin = originInFile(state);
    }

    prepareForNewConnection(): void {
        this.lastChange.prepareForNewConnection();
    }

    /** Begins a gesture. One undo step reverts all moves between two calls. */
    begin(): void {
        this.continues = false;
        this.events.gestureBegan();
    }

    /**
     * Changes some coordinates of the focus point. Each pair has an axis, 0 to 3, and the new coordinate along it, in
     * object units from the object's center.
     */
    move(coordinates: readonly (readonly [axis: number, value: number])[]): void {
        const point: Point4 = [...this.point];
        for (const [axis, value] of coordinates) point[axis] = this.origin[axis]! + value;
        this.wanted = point;
        this.isUnsent = true;
        this.schedule();
    }

    /**
     * The focus point of the session. While a move is unsent or unanswered, the point to which the focus point moves.
     */
    private get point(): Point4 {
        return this.isUnsent || this.isSending ? this.wanted : this.current;
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
            this.current = point;
            this.lastChange.noteRevision(revision);
        } catch (error) {
            this.isUnsent = false;
            this.events.failed(error as Error);
        }
        this.isSending = false;
        if (this.isUnsent) this.schedule();
    }
}
