// Turns the polytope by gestures. Adds up the turns of a gesture, and sends the sum at most once per animation frame.
// Each sum waits until the server has answered the previous one. All turns of a gesture form one undo step and one
// rotation, which keys can repeat.

import type { Plane, Request } from "@oval4d/protocol";

import type { AnglesByPlane } from "./rolling_ball";

type RotationRequest = Extract<Request, { type: "rotate" }>;

/** The turns of a gesture that have not been sent to the server. */
interface PendingRotation {
    /**
     * Whether the server has executed a rotation of this gesture. Later rotations of the gesture then continue its undo
     * step.
     */
    hasStep: boolean;
    /** The angles to send, in radians. */
    unsent: Map<Plane, number>;
}

export class RotationSender {
    // The last entry belongs to the current gesture. The other entries belong to earlier gestures with unsent angles.
    private pending: PendingRotation[] = [];
    private sending = false;
    private scheduled = false;

    /** `rotate` sends a request. It resolves to true if the server has executed the request, else to false. */
    constructor(private readonly rotate: (rotation: RotationRequest) => Promise<boolean>) {}

    /** Begins a gesture. Its turns become a new undo step. */
    beginGesture(): void {
        this.pending = this.pending.filter(({ unsent }) => unsent.size > 0);
        this.pending.push({ hasStep: false, unsent: new Map() });
    }

    /** Adds turns to the current gesture. beginGesture() must have been called before. */
    turn(turns: AnglesByPlane): void {
        const { unsent } = this.pending.at(-1)!;
        for (const [plane, angle] of Object.entries(turns) as [Plane, number][]) {
            const sum = (unsent.get(plane) ?? 0) + angle;
            if (sum === 0) unsent.delete(plane);
            else unsent.set(plane, sum);
        }
        this.scheduleSend();
    }

    private scheduleSend(): void {
        if (this.sending || this.scheduled) return;
        this.scheduled = true;
        requestAnimationFrame(() => void this.sendTurns());
    }

    private async sendTurns(): Promise<void> {
        this.scheduled = false;
        const first = this.pending[0]!;
        const planes = [...first.unsent.keys()];
        const angles = [...first.unsent.values()];
        first.unsent.clear();
        if (this.pending.length > 1) this.pending.shift();
        this.sending = true;
        if (planes.length > 0) {
            const continues = first.hasStep && { continues: true };
            first.hasStep = (await this.rotate({ type: "rotate", planes, angles, ...continues })) || first.hasStep;
        }
        this.sending = false;
        if (this.pending[0]!.unsent.size > 0) this.scheduleSend();
    }
}
