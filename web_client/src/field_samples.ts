// The values of a field at the point under the pointer, which the server tells.

import type { At, State } from "@oval4d/protocol";

/** A point of a field: its coordinates in the box, and the values of the functions there. */
export type FieldPoint = Pick<At, "place" | "value" | "second_value">;

/**
 * A point of the picture on the surface or a contour of a level, or on a cap: the flat part that closes the body of the
 * level where the boundary of the box cuts it.
 */
export interface LevelDescription {
    /** The index of the level in the `levels` of the state. */
    level: number;
    /** Whether the point is on a cap, where the value lies inside the body of the level and is not the level itself. */
    cap: boolean;
    /** The w of the slice in which the point is; undefined in the projection and in the matrix. */
    sliceW?: number | undefined;
    /** What is known of the point without asking the server. */
    known?: FieldPoint;
    /** The revision of the picture that shows the point. */
    revision: number;
    /**
     * The point about which the server may be asked while this revision is the newest, in the form that `set` accepts.
     */
    point?: [number, number, number, number];
}

const kInterval = 70; // milliseconds between two questions, at least

export class FieldSamples {
    private wanted: LevelDescription | undefined;
    private newest: { about: string; on: string; answer: FieldPoint } = { about: "", on: "", answer: {} };
    private isAsking = false;

    /** `sample` asks the server for the values of the field at a point. `answered` is called after each answer. */
    constructor(
        private readonly state: () => State | undefined,
        private readonly sample: (point: [number, number, number, number]) => Promise<At>,
        private readonly answered: () => void,
    ) {}

    /**
     * What is known of a point. While the pointer moves on a surface, these are the newest values that the server has
     * told on this surface. Empty if there are none, or if the server has refused to answer.
     */
    of(point: LevelDescription): FieldPoint {
        return point.known ?? (this.newest.on === this.surfaceOf(point) ? this.newest.answer : {});
    }

    /**
     * Asks about this point, if the server may be asked. One question is asked at a time, so the point may be replaced
     * by another one before it is asked about.
     */
    want(point: LevelDescription | undefined): void {
        this.wanted = point;
        if (!this.isAsking) void this.askAboutWanted();
    }

    /** Asks until the values at the point that is wanted then are known. */
    private async askAboutWanted(): Promise<void> {
        this.isAsking = true;
        while (this.wanted?.point && this.wanted.revision === this.state()?.revision) {
            const { wanted } = this;
            const about = this.identityOf(wanted);
            if (about === this.newest.about) break;
            const on = this.surfaceOf(wanted);
            const interval = new Promise((resolve) => setTimeout(resolve, kInterval));
            const answer = await this.sample(this.wanted.point).catch(() => undefined);
            this.newest = { about, on, answer: answer?.revision === wanted.revision ? answer : {} };
            this.answered();
            await interval;
        }
        this.isAsking = false;
    }

    /** A text that differs for points of different surfaces, also in different pictures or of different objects. */
    private surfaceOf({ level, cap, sliceW, revision }: LevelDescription): string {
        return JSON.stringify([level, cap, sliceW, revision, this.state()?.object_serial]);
    }

    /** A text that also differs for different points of a surface. */
    private identityOf(point: LevelDescription): string {
        return JSON.stringify([point.point, this.surfaceOf(point)]);
    }
}
