// Turns the polytope by gestures. Adds up the turns of a gesture, and sends their sum, at most once per animation frame
// and only when the server has answered the previous sum. All turns of one gesture are one undo step and one rotation,
// which keys can repeat.

import type { Plane, Request } from "@oval4d/protocol";

import type { AnglesByPlane } from "./rolling_ball";

type Rotation = Extract<Request, { type: "rotate" }>;

interface RotationGesture {
    /**
     * Whether the server has executed a rotation of the gesture. If so, later rotations of the gesture belong to the
     * same undo step.
     */
    hasStep: boolean;
    /** The angles to send, in radians. */
    unsent: Map<Plane, number>;
}

export class RotationControl {
    private gestures: RotationGesture[] = []; // the last one is the current gesture; the others still have angles to send
    private sending = false;
    private scheduled = false;

    /** `rotate` sends a request, and resolves to whether it has been executed. */
    constructor(private readonly rotate: (rotation: Rotation) => Promise<boolean>) {}

    /** Begins a gesture. */
    begin(): void {
        this.gestures = this.gestures.filter(({ unsent }) => unsent.size > 0);
        this.gestures.push({ hasStep: false, unsent: new Map() });
    }

    /** Adds turns to the current gesture; begin() must have been called before. */
    turn(turns: AnglesByPlane): void {
        const { unsent } = this.gestures.at(-1)!;
        for (const [plane, angle] of Object.entries(turns) as [Plane, number][]) {
            const sum = (unsent.get(plane) ?? 0) + angle;
            if (sum === 0) unsent.delete(plane);
            else unsent.set(plane, sum);
        }
        this.schedule();
    }

    private schedule(): void {
        if (this.sending || this.scheduled) return;
        this.scheduled = true;
        requestAnimationFrame(() => void this.send());
    }

    private async send(): Promise<void> {
        this.scheduled = false;
        const gesture = this.gestures[0]!;
        const planes = [...gesture.unsent.keys()];
        const angles = [...gesture.unsent.values()];
        gesture.unsent.clear();
        if (this.gestures.length > 1) this.gestures.shift();
        this.sending = true;
        if (planes.length > 0) {
            const continues = gesture.hasStep && { continues: true };
            gesture.hasStep = (await this.rotate({ type: "rotate", planes, angles, ...continues })) || gesture.hasStep;
        }
        this.sending = false;
        if (this.gestures[0]!.unsent.size > 0) this.schedule();
    }
}
