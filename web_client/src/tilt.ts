// Turns the polytope as the user tilts and twists a phone, by the W3C's device orientation events. Tilting turns in the
// same planes as a drag, and twisting in the same plane as a twist of two fingers. All turns are about the axes of the
// screen at the start. Therefore a phone that is turned back to its first position has also turned each slice back.

import { type RollingBallKind, turnsOfTilt } from "./rolling_ball";
import type { RotationSender } from "./rotation";

// The least turn in radians. Smaller turns are added up first, so that sensor noise of a phone at rest turns nothing.
const kLeastTurn = 0.005;

/** A unit quaternion: its real part, and its components along x, y and z. */
type Quaternion = readonly [number, number, number, number];

/** The state of tilting while it is switched on. */
interface ActiveTilt {
    /** The kind of ball that the device rolls. */
    ball: RollingBallKind;
    /** Whether the next turn begins an undo step. */
    beginsStep: boolean;
    /**
     * The orientation of the screen at the first event, and of the device at the last event that has turned the
     * polytope.
     */
    screen?: Quaternion;
    device?: Quaternion;
}

export class TiltControl {
    private active: ActiveTilt | undefined;

    /**
     * `changed` is called when `ball` has changed. `failed` is called if the device does not report its orientation.
     */
    constructor(
        private readonly rotation: RotationSender,
        private readonly changed: () => void,
        private readonly failed: (error: Error) => void,
    ) {
        document.addEventListener("visibilitychange", () => document.hidden && this.stop());
    }

    /** Whether the tilt buttons are offered: the device may be held in the hand, and can report its orientation. */
    get isOffered(): boolean {
        return matchMedia("(pointer: coarse)").matches && "DeviceOrientationEvent" in window;
    }

    /** The kind of ball that the device rolls; undefined while tilting is switched off. */
    get ball(): RollingBallKind | undefined {
        return this.active?.ball;
    }

    /**
     * Switches the rolling of a ball on or off. Must be called in the handler of a click, because some browsers then
     * ask the user for permission. Throws an Error if the user refuses.
     */
    async toggle(ball: RollingBallKind): Promise<void> {
        if (this.ball === ball) return this.stop();
        const event = DeviceOrientationEvent as unknown as { requestPermission?: () => Promise<string> };
        const permission = event.requestPermission ? await event.requestPermission() : "granted";
        if (permission !== "granted") throw new Error("this browser does not tell the page how the device is held");
        this.active = { ball, beginsStep: true };
        window.addEventListener("deviceorientation", this.listener); // has no effect if it already listens
        this.changed();
        return undefined;
    }

    /** Makes the next turn begin a new undo step. Must be called when another command is sent. */
    endUndoStep(): void {
        if (this.active) this.active.beginsStep = true;
    }

    private stop(): void {
        if (!this.active) return;
        this.active = undefined;
        window.removeEventListener("deviceorientation", this.listener);
        this.changed();
    }

    private readonly listener = ({ alpha, beta, gamma }: DeviceOrientationEvent): void => {
        const { active } = this;
        if (!active) return;
        if (alpha === null || beta === null || gamma === null) {
            if (active.device) return;
            this.stop();
            this.failed(new Error("this device does not tell how it is held"));
            return;
        }
        const device = deviceOrientation(alpha, beta, gamma);
        active.device ??= device;
        active.screen ??= quaternionProduct(device, rotationAboutZ(-(screen.orientation?.angle ?? 0)));
        const change = quaternionProduct(device, conjugate(active.device));
        const turn = rotationVectorOf(quaternionProduct(quaternionProduct(conjugate(active.screen), change), active.screen));
        if (Math.hypot(...turn) < kLeastTurn) return;
        active.device = device;
        if (active.beginsStep) this.rotation.beginGesture();
        active.beginsStep = false;
        this.rotation.turn(turnsOfTilt(active.ball, turn));
    };
}

/**
 * The orientation of a device relative to the Earth, from angles in degrees. The device turns about its z axis by
 * `alpha`, then about its new x axis by `beta`, then about its new y axis by `gamma`.
 */
function deviceOrientation(alpha: number, beta: number, gamma: number): Quaternion {
    const [x, cosX] = sinCosOfHalfAngle(beta);
    const [y, cosY] = sinCosOfHalfAngle(gamma);
    return quaternionProduct(quaternionProduct(rotationAboutZ(alpha), [cosX, x, 0, 0]), [cosY, 0, y, 0]);
}

function rotationAboutZ(degrees: number): Quaternion {
    const [sin, cos] = sinCosOfHalfAngle(degrees);
    return [cos, 0, 0, sin];
}

/** The sine and cosine of half an angle. `degrees` is the whole angle. */
function sinCosOfHalfAngle(degrees: number): [number, number] {
    const half = (degrees * Math.PI) / 360;
    return [Math.sin(half), Math.cos(half)];
}

function quaternionProduct([a, b, c, d]: Quaternion, [e, f, g, h]: Quaternion): Quaternion {
    return [
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    ];
}

function conjugate([w, x, y, z]: Quaternion): Quaternion {
    return [w, -x, -y, -z];
}

/** The rotation vector of a unit quaternion: the axis times the angle in radians, which is at most π. */
function rotationVectorOf([w, x, y, z]: Quaternion): [number, number, number] {
    const sin = Math.hypot(x, y, z);
    const factor = sin === 0 ? 0 : (2 * Math.atan2(sin, Math.abs(w)) * (w < 0 ? -1 : 1)) / sin;
    return [x * factor, y * factor, z * factor];
}
