// Computes the rotations of gestures by Hanson's rolling ball. In three dimensions, a drag turns the near side of the
// ball (+z) in the direction of the drag; in four dimensions, it turns the side that faces the 4-D eye (+w). Both
// motions are sums of rotations in single planes. A. J. Hanson, "Rotations for N-dimensional graphics", Graphics Gems
// V, 1995.

import type { Plane } from "@oval4d/protocol";

/**
 * The angles, in radians, by which to turn in planes. A positive angle in "xw" turns the +x axis toward the +w axis.
 */
export type AnglesByPlane = Partial<Record<Plane, number>>;

/**
 * The kind of ball that a gesture rolls. "4-D" turns the whole object; "3-D" turns every slice within its hyperplane.
 */
export type RollingBallKind = "4-D" | "3-D";

const kWheelTurn = 0.0015; // radians of rotation per pixel by which the wheel scrolls
const kStickRate = Math.PI / 2; // radians of rotation per second while a stick or trigger is at its end
const kStickDeadZone = 0.15; // deflections of sticks and triggers below this fraction of the greatest one count as 0

/**
 * The angles for a drag of `dx` pixels to the right and `dy` down. A drag over `height`, the height of the picture,
 * makes half a turn.
 */
export function turnsOfDrag(ball: RollingBallKind, dx: number, dy: number, height: number): AnglesByPlane {
    const perPixel = Math.PI / Math.max(1, height);
    return rollingAngles(ball, dx * perPixel, dy * perPixel);
}

/**
 * The angle for a movement of the mouse wheel by `pixels`. The wheel turns in the plane in which drags cannot roll the
 * ball: zw for the 4-D ball, xy for the 3-D ball.
 */
export function turnsOfWheel(ball: RollingBallKind, pixels: number): AnglesByPlane {
    return ball === "4-D" ? { zw: -pixels * kWheelTurn } : { xy: -pixels * kWheelTurn };
}

/**
 * The angle for fingers that twist clockwise by `angle` radians. A twist turns in the plane in which drags cannot roll
 * the ball: zw for the 4-D ball, xy for the 3-D ball. The 3-D ball follows the fingers.
 */
export function turnsOfTwist(ball: RollingBallKind, angle: number): AnglesByPlane {
    return ball === "4-D" ? { zw: angle } : { xy: -angle };
}

/**
 * The angles by which a gamepad of the standard layout turns the object in `seconds` seconds. The left stick rolls the
 * 4-D ball, and the right stick the 3-D ball. The triggers turn in zw, and the bumpers in xy. A stick, trigger or
 * bumper at its end turns at the rate kStickRate.
 */
export function turnsOfGamepad({ axes, buttons }: Pick<Gamepad, "axes" | "buttons">, seconds: number): AnglesByPlane {
    const rate = (value = 0): number => (Math.abs(value) < kStickDeadZone ? 0 : value * kStickRate * seconds);
    const difference = (less: number, more: number): number =>
        rate((buttons[more]?.value ?? 0) - (buttons[less]?.value ?? 0));
    return {
        ...rollingAngles("4-D", rate(axes[0]), rate(axes[1])),
        ...rollingAngles("3-D", rate(axes[2]), rate(axes[3])),
        zw: difference(6, 7),
        xy: difference(4, 5),
    };
}

/**
 * The angles for a device that turns by this rotation vector. Its components are in radians, about the axes to the
 * right, up and out of the screen. The ball turns like the device.
 */
export function turnsOfTilt(ball: RollingBallKind, [right, up, out]: readonly [number, number, number]): AnglesByPlane {
    return { ...rollingAngles(ball, up, right), ...turnsOfTwist(ball, -out) };
}

/** The angles for rolling a ball to the right by `right` radians and down by `down` radians. */
function rollingAngles(ball: RollingBallKind, right: number, down: number): AnglesByPlane {
    return ball === "4-D" ? { xw: -right, yw: down } : { xz: -right, yz: down };
}
