// What the layout of a picture depends on. When any of it changes, the page asks the server again where the parts of
// the picture are that the server has drawn.

import type { State, Viewport } from "@oval4d/protocol";

/**
 * A text that changes whenever the layout of a picture of this size may change: the state as JSON, without the members
 * that never move a part of the picture, such as the orientation, and those that describe the object, which
 * `object_serial` identifies. The function lists the members to leave out, not those to keep, so that it misses no new
 * setting.
 */
export function layoutKey(state: Partial<State>, size: Viewport): string {
    const { id, type, revision, draft, moving, turning, orientation, last, section, point, ...settings } = state;
    const { playing, speed, camera, alpha, beta, step, highlight, color, background, ...others } = settings;
    const { polytope, field, ...layout } = others;
    return JSON.stringify([layout, size]);
}
