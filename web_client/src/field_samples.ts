// Asks the server for the values of a field at the point under the pointer.

import type { At, State } from "@oval4d/protocol";

/** A point of a field: its place in the field's box, and the values of the field's functions there. */
export type FieldSample = Pick<At, "place" | "value" | "second_value">;

/**
 * A point of the picture on a surface or a contour of a field, or on a cap. Caps are the flat parts that close a body
 * where the boundary of the field's box cuts it.
 */
export interface LevelPointDescription {
    /** The index of the level in the `levels` of the state. */
    level: number;
    /**
     * Whether the point is on a cap. The value at such a point is not the level, because the point lies inside the
     * body.
     */
    cap: boolean;
    /** The w of the slice in which the point is; undefined in the projection and in the matrix. */
    sliceW?: number | undefined;
    /** The values at the point that are known without a question to the server. */
    known?: FieldSample;
    /** The revision of the picture that shows the point. */
    revision: number;
    /**
     * The point after the rotation, in the coordinates of the object's file. Present if the page may ask the server
     * about the point. Valid only while `revision` is the newest.
     */
    point?: [number, number, number, number];
}

const kInterval = 70; // the least time between two questions to the server, in milliseconds

export class FieldSampleFetcher {
    private wanted: LevelPointDescription | undefined;
    private newest: { about: string; on: string; answer: FieldSample } = { about: "", on: "", answer: {} };
    private isAsking = false;

    /** `sample` asks the server for the values of the field at a point. `answered` is called after each answer. */
    constructor(
        private readonly state: () => State | undefined,
        private readonly sample: (point: [number, number, number, number]) => Promise<At>,
        private readonly answered: () => void,
    ) {}

    /**
     * The known values at a point. While the pointer moves on a surface, these are the newest values that the server
     * has sent for this surface. Empty if there are none, or if the server has refused to answer.
     */
    knownAt(point: LevelPointDescription): FieldSample {
        return point.known ?? (this.newest.on === this.surfaceOf(point) ? this.newest.answer : {});
    }

    /**
     * Asks the server about this point, if it has a `point`. The server is asked one question at a time. If another
     * point is wanted before a question is sent, only the newer one is asked about. If `point` is undefined, no further
     * question is sent.
     */
    askAbout(point: LevelPointDescription | undefined): void {
        this.wanted = point;
        if (!this.isAsking) void this.requestSampleOfWanted();
    }

    /** Asks about the wanted point, again and again, until the values at the newest wanted point are known. */
    private async requestSampleOfWanted(): Promise<void> {
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

    /** A text that identifies a surface in one picture of one object. */
    private surfaceOf({ level, cap, sliceW, revision }: LevelPointDescription): string {
        return JSON.stringify([level, cap, sliceW, revision, this.state()?.object_serial]);
    }

    /** A text that identifies a point on a surface. */
    private identityOf(point: LevelPointDescription): string {
        return JSON.stringify([point.point, this.surfaceOf(point)]);
    }
}
