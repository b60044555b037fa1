// A gesture of two or more fingers on the drawing: their common movement, spread and twist. A movement or a twist
// counts only after it has left a dead zone, so that a pinch does not also turn the polytope.

const kMoveDeadZone = 16; // pixels; a smaller movement of the fingers' center has no effect
const kTwistDeadZone = 0.15; // radians; a smaller twist has no effect

/** The position of a finger in the window, in CSS pixels. */
export interface Finger {
    clientX: number;
    clientY: number;
}

/** A point or a vector on the screen, in pixels. x points right, and y points down. */
interface ScreenVector {
    x: number;
    y: number;
}

interface FingerGeometry {
    /** The mean of the fingers' positions. */
    center: ScreenVector;
    /** The vectors from the center to each finger. */
    arms: ScreenVector[];
    /** The sum of the lengths of the arms; for two fingers, their distance. */
    extent: number;
}

export class MultiTouchGesture {
    private last: FingerGeometry;
    private moved: ScreenVector = { x: 0, y: 0 }; // the movement since the fingers touched the drawing
    private twisted = 0; // the angle, in radians, by which the fingers have twisted since they touched the drawing
    private moves = false; // whether the movement has left its dead zone
    private twists = false; // whether the twist has left its dead zone

    constructor(fingers: readonly Finger[]) {
        this.last = fingerGeometryOf(fingers);
    }

    /**
     * Returns the changes since the last call. `dx` and `dy` are the movement of the center in pixels. `spread` is the
     * new extent divided by the old extent. `twist` is the clockwise rotation in radians. A movement or a twist within
     * its dead zone is returned as 0. The fingers must be in the same order at each call.
     */
    update(fingers: readonly Finger[]): { dx: number; dy: number; spread: number; twist: number } {
        const { last } = this;
        const now = (this.last = fingerGeometryOf(fingers));
        const [dx, dy] = [now.center.x - last.center.x, now.center.y - last.center.y];
        const twist = rotationBetween(last.arms, now.arms);
        const change = {
            ...(this.moves ? { dx, dy } : { dx: 0, dy: 0 }),
            spread: now.extent / Math.max(1, last.extent),
            twist: this.twists ? twist : 0,
        };
        this.moved = { x: this.moved.x + dx, y: this.moved.y + dy };
        this.twisted += twist;
        this.moves ||= Math.hypot(this.moved.x, this.moved.y) > kMoveDeadZone;
        this.twists ||= Math.abs(this.twisted) > kTwistDeadZone;
        return change;
    }
}

function fingerGeometryOf(fingers: readonly Finger[]): FingerGeometry {
    const mean = (values: number[]): number => values.reduce((sum, value) => sum + value, 0) / values.length;
    const center = { x: mean(fingers.map((one) => one.clientX)), y: mean(fingers.map((one) => one.clientY)) };
    const arms = fingers.map(({ clientX, clientY }) => ({ x: clientX - center.x, y: clientY - center.y }));
    return { center, arms, extent: arms.reduce((sum, { x, y }) => sum + Math.hypot(x, y), 0) };
}

/**
 * The clockwise angle of the rotation that best maps the old arms to the new arms, by least squares. With vectors as
 * complex numbers, this is the argument of the sum of new · conjugate(old) over all arms.
 */
function rotationBetween(before: readonly ScreenVector[], now: readonly ScreenVector[]): number {
    let [real, imaginary] = [0, 0];
    before.forEach((old, i) => {
        const { x, y } = now[i]!;
        real += x * old.x + y * old.y;
        imaginary += y * old.x - x * old.y;
    });
    return Math.atan2(imaginary, real);
}
