// Turns the polytope by gamepads. While a gamepad is connected, it is read once per animation frame. Only gamepads with
// the standard mapping (W3C, Gamepad) are used, because the places of their sticks and triggers are known. A gamepad is
// used only after all its sticks, triggers and bumpers have been at rest once: an axis of another device, such as a
// joystick, may stay at one end.

import { turnsOfGamepad } from "./rolling_ball";
import type { RotationSender } from "./rotation";

const kPause = 300; // milliseconds without a turn after which a gesture has ended
// Milliseconds: the longest interval between two polls that counts; a busy page may poll later.
const kMaxInterval = 100;

export function listenForGamepads(rotation: RotationSender): void {
    let polledAt: number | undefined; // the time of the last poll in milliseconds; undefined while no gamepad is polled
    let turnedAt = -Infinity;
    const rested = new Set<number>(); // the indices of the gamepads that have been at rest once
    const poll = (now: number): void => {
        const gamepads = navigator
            .getGamepads()
            .filter((gamepad) => gamepad?.connected === true && gamepad.mapping === "standard");
        const interval = Math.min(kMaxInterval, now - (polledAt ?? now));
        polledAt = gamepads.length > 0 ? now : undefined;
        if (polledAt === undefined) return;
        for (const gamepad of gamepads) {
            const isAtRest = Object.values(turnsOfGamepad(gamepad!, 1)).every((angle) => angle === 0);
            if (isAtRest) rested.add(gamepad!.index);
            if (isAtRest || !rested.has(gamepad!.index)) continue;
            if (now - turnedAt > kPause) rotation.beginGesture();
            turnedAt = now;
            rotation.turn(turnsOfGamepad(gamepad!, interval / 1000));
        }
        requestAnimationFrame(poll);
    };
    window.addEventListener("gamepaddisconnected", ({ gamepad }) => rested.delete(gamepad.index));
    window.addEventListener("gamepadconnected", () => {
        if (polledAt === undefined) requestAnimationFrame(poll);
    });
}
