// The frame of reference in which the object is shown, as text.

import type { Settings, State, Vector } from "@oval4d/protocol";

import { formatDecimal } from "./format";

/** The settings of a frame of reference that are velocities. */
export type VelocitySetting = "follow" | "boost";

/** A frame of reference in words such as "pace 2, follow 0.3, 0, 0"; "" for the frame in which the object was made. */
export function spokenReferenceFrame({ pace, follow, boost }: State): string {
    const spoken = (name: VelocitySetting, velocity: Vector): string =>
        velocity.some((v) => v !== 0) ? `${name} ${velocity.map((v) => formatDecimal(v, 3)).join(", ")}` : "";
    const parts = [pace === 1 ? "" : `pace ${formatDecimal(pace, 3)}`, spoken("follow", follow), spoken("boost", boost)];
    return parts.filter((part) => part !== "").join(", ");
}

/** The parameters of an address for a frame of reference, without those that have their initial values. */
export function referenceFrameQuery({ pace = 1, follow, boost }: Pick<Settings, "pace" | VelocitySetting>): Record<string, string> {
    const moves = (velocity: Vector | undefined): velocity is Vector => velocity?.some((v) => v !== 0) ?? false;
    return {
        ...(pace !== 1 && { pace: String(pace) }),
        ...(moves(follow) && { follow: String(follow) }),
        ...(moves(boost) && { boost: String(boost) }),
    };
}
