// What the layout of a picture depends on. When one of these settings changes, the page asks the server again where the
// parts of the server's picture are.

import type { State, Viewport } from "@oval4d/protocol";

/**
 * What the layout of a picture of this size may depend on, as JSON: all members of the state, so that no setting is
 * forgotten, except those that never move a part of the picture, such as what motions and gestures change.
 */
export function layoutKey(state: Partial<State>, size: Viewport): string {
    const { id, type, revision, draft, moving, turning, orientation, last, section, point, ...settings } = state;
    const { camera, alpha, beta, step, highlight, color, background, ...layout } = settings;
    return JSON.stringify([layout, size]);
}
