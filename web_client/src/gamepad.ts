// Turns the polytope by gamepads, which are polled once per animation frame while one is connected.

import { turnsOfGamepad } from "./rolling_ball";
import type { RotationControl } from "./rotation";

const kPause = 300; // milliseconds at rest after which a gesture has ended
const kMaxInterval = 100; // milliseconds between two polls, if the page was too busy to poll

export function listenForGamepads(rotation: RotationControl): void {
    let polledAt: number | undefined; // milliseconds; undefined while no gamepad is polled
    let turnedAt = -Infinity;
    const poll = (now: number): void => {
        const gamepads = navigator.getGamepads().filter((gamepad) => gamepad?.connected === true);
        const interval = Math.min(kMaxInterval, now - (polledAt ?? now));
        polledAt = gamepads.length > 0 ? now : undefined;
        if (polledAt === undefined) return;
        for (const gamepad of gamepads) {
            const turns = turnsOfGamepad(gamepad!, interval / 1000);
            if (Object.values(turns).every((angle) => angle === 0)) continue;
            if (now - turnedAt > kPause) rotation.begin();
            turnedAt = now;
            rotation.turn(turns);
        }
        requestAnimationFrame(poll);
    };
    window.addEventListener("gamepadconnected", () => {
        if (polledAt === undefined) requestAnimationFrame(poll);
    });
}
