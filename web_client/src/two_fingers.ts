// Two fingers on the drawing: how far they have moved, spread and twisted. A movement or a twist counts only after it
// has left a dead zone, so that a pinch does not also turn the polytope.

const kMoveDeadZone = 16; // pixels
const kTwistDeadZone = 0.15; // radians

export interface Finger {
    clientX: number;
    clientY: number;
}

interface FingerPair {
    x: number; // `x` and `y` are those of the point in the middle between the fingers, in pixels
    y: number;
    distance: number;
    angle: number; // of the line from one finger to the other, in radians clockwise from the direction to the right
}

export class TwoFingers {
    private last: FingerPair;
    private moved = { x: 0, y: 0 }; // pixels since the fingers touched the drawing
    private twisted = 0; // radians since the fingers touched the drawing
    private moves = false; // whether the movement has left its dead zone
    private twists = false; // whether the twist has left its dead zone

    constructor(a: Finger, b: Finger) {
        this.last = fingerPairOf(a, b);
    }

    /**
     * Returns the changes since the last call: the movement of the midpoint in pixels, the new distance between the
     * fingers divided by the old one (`spread`), and the clockwise rotation in radians (`twist`). A movement or a twist
     * that has not left its dead zone counts as 0.
     */
    update(a: Finger, b: Finger): { dx: number; dy: number; spread: number; twist: number } {
        const { last } = this;
        const now = (this.last = fingerPairOf(a, b));
        const [dx, dy, twist] = [now.x - last.x, now.y - last.y, wrapped(now.angle - last.angle)];
        const change = {
            ...(this.moves ? { dx, dy } : { dx: 0, dy: 0 }),
            spread: now.distance / Math.max(1, last.distance),
            twist: this.twists ? twist : 0,
        };
        this.moved = { x: this.moved.x + dx, y: this.moved.y + dy };
        this.twisted += twist;
        this.moves ||= Math.hypot(this.moved.x, this.moved.y) > kMoveDeadZone;
        this.twists ||= Math.abs(this.twisted) > kTwistDeadZone;
        return change;
    }
}

function fingerPairOf(a: Finger, b: Finger): FingerPair {
    const [dx, dy] = [b.clientX - a.clientX, b.clientY - a.clientY];
    const [x, y] = [(a.clientX + b.clientX) / 2, (a.clientY + b.clientY) / 2];
    return { x, y, distance: Math.hypot(dx, dy), angle: Math.atan2(dy, dx) };
}

/** The angle between −π and π that differs from `angle` by full turns. */
function wrapped(angle: number): number {
    return Math.atan2(Math.sin(angle), Math.cos(angle));
}
