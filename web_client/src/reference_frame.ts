// Texts for the frame of reference in which an object is shown.

import type { Settings, State, Vector } from "@oval4d/protocol";

import { formatDecimal } from "./format";

/** The settings of the frame of reference that are velocities: one to follow, and one of a Lorentz boost. */
export type VelocitySetting = "follow" | "boost";

/** A frame of reference in words, such as "pace 2, follow 0.3, 0, 0"; "" for the object's original frame. */
export function spokenReferenceFrame({ pace, follow, boost }: State): string {
    const spoken = (name: VelocitySetting, velocity: Vector): string =>
        velocity.some((v) => v !== 0) ? `${name} ${velocity.map((v) => formatDecimal(v, 3)).join(", ")}` : "";
    const parts = [pace === 1 ? "" : `pace ${formatDecimal(pace, 3)}`, spoken("follow", follow), spoken("boost", boost)];
    return parts.filter((part) => part !== "").join(", ");
}

/** The parameters of an address for a frame of reference. Parameters with their default values are omitted. */
export function referenceFrameQuery({ pace = 1, follow, boost }: Pick<Settings, "pace" | VelocitySetting>): Record<string, string> {
    const moves = (velocity: Vector | undefined): velocity is Vector => velocity?.some((v) => v !== 0) ?? false;
    return {
        ...(pace !== 1 && { pace: String(pace) }),
        ...(moves(follow) && { follow: String(follow) }),
        ...(moves(boost) && { boost: String(boost) }),
    };
}
