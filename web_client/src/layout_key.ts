// A text that identifies the layout of a picture. When the text changes, the page asks the server again for the places
// of the parts of the picture.

import type { State, Viewport } from "@oval4d/protocol";

/**
 * Returns a text that changes whenever the layout of a picture of this size may change. The text is the state as JSON,
 * without two groups of members. Some members, such as the orientation, never move a part of the picture; others
 * describe the object, which `object_serial` identifies. The function lists the members to omit, not those to keep, so
 * that the text includes every new setting.
 */
export function layoutKey(state: Partial<State>, size: Viewport): string {
    const { id, type, revision, draft, moving, turning, orientation, last, section, point, ...settings } = state;
    const { playing, speed, camera, alpha, beta, step, highlight, color, background, ...others } = settings;
    const { polytope, field, ...layout } = others;
    return JSON.stringify([layout, size]);
}
