// Turns the polytope as a phone is tilted and twisted, by the device orientation events of the W3C. The axes of a turn
// are those of the screen as it was held at the start: a phone that is turned back to where it was has also turned each
// slice back. Tilting the phone turns in the same planes as a drag, and twisting it in the same plane as a twist of the
// fingers.

import { type BallKind, turnsOfTilt } from "./rolling_ball";
import type { RotationControl } from "./rotation";

// Radians. Smaller turns are added up first, so that the noise of the sensors of a phone at rest turns nothing.
const kLeastTurn = 0.005;

/** A unit quaternion: its real part, and its parts along x, y and z. */
type Quaternion = readonly [number, number, number, number];

/** A ball that the device rolls, from toggle() until it is switched off. */
interface ActiveTilt {
    /** The ball that is rolled. */
    ball: BallKind;
    /** Whether the next turn begins an undo step. */
    beginsStep: boolean;
    /** How the screen was held at the first event, and the device at the last event that has turned the polytope. */
    screen?: Quaternion;
    device?: Quaternion;
}

export class TiltControl {
    private active: ActiveTilt | undefined;

    /** `changed` is called when `ball` has changed, and `failed` if the device does not tell how it is held. */
    constructor(
        private readonly rotation: RotationControl,
        private readonly changed: () => void,
        private readonly failed: (error: Error) => void,
    ) {
        document.addEventListener("visibilitychange", () => document.hidden && this.stop());
    }

    /** Whether this may be a device that is held in the hand, and that tells how. */
    get isOffered(): boolean {
        return matchMedia("(pointer: coarse)").matches && "DeviceOrientationEvent" in window;
    }

    /** The ball that is rolled; undefined if the device's orientation turns nothing. */
    get ball(): BallKind | undefined {
        return this.active?.ball;
    }

    /**
     * Begins to roll a ball, or ends it. Must be called in the handler of a click, because some browsers ask for
     * permission then; throws an Error if it is refused.
     */
    async toggle(ball: BallKind): Promise<void> {
        if (this.ball === ball) return this.stop();
        const event = DeviceOrientationEvent as unknown as { requestPermission?: () => Promise<string> };
        const permission = event.requestPermission ? await event.requestPermission() : "granted";
        if (permission !== "granted") throw new Error("this browser does not tell the page how the device is held");
        this.active = { ball, beginsStep: true };
        window.addEventListener("deviceorientation", this.listener); // does nothing if it listens already
        this.changed();
        return undefined;
    }

    /** Lets the next turn begin another undo step. To be called when another command is sent. */
    endStep(): void {
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
        const device = orientationOf(alpha, beta, gamma);
        active.device ??= device;
        active.screen ??= product(device, aboutZ(-(screen.orientation?.angle ?? 0)));
        const change = product(device, conjugate(active.device));
        const turn = rotationVectorOf(product(product(conjugate(active.screen), change), active.screen));
        if (Math.hypot(...turn) < kLeastTurn) return;
        active.device = device;
        if (active.beginsStep) this.rotation.begin();
        active.beginsStep = false;
        this.rotation.turn(turnsOfTilt(active.ball, turn));
    };
}

/**
 * The orientation of a device in the frame of the Earth: the rotation about its z axis by alpha, then about its new x
 * axis by beta, then about its new y axis by gamma, in degrees.
 */
function orientationOf(alpha: number, beta: number, gamma: number): Quaternion {
    const [x, cosX] = halfAngle(beta);
    const [y, cosY] = halfAngle(gamma);
    return product(product(aboutZ(alpha), [cosX, x, 0, 0]), [cosY, 0, y, 0]);
}

function aboutZ(degrees: number): Quaternion {
    const [sin, cos] = halfAngle(degrees);
    return [cos, 0, 0, sin];
}

/** The sine and the cosine of half an angle in degrees. */
function halfAngle(degrees: number): [number, number] {
    const half = (degrees * Math.PI) / 360;
    return [Math.sin(half), Math.cos(half)];
}

function product([a, b, c, d]: Quaternion, [e, f, g, h]: Quaternion): Quaternion {
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

/** The axis of a rotation times its angle, of at most half a turn, in radians. */
function rotationVectorOf([w, x, y, z]: Quaternion): [number, number, number] {
    const sin = Math.hypot(x, y, z);
    const factor = sin === 0 ? 0 : (2 * Math.atan2(sin, Math.abs(w)) * (w < 0 ? -1 : 1)) / sin;
    return [x * factor, y * factor, z * factor];
}
