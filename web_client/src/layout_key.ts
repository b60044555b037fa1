// What the layout of a picture depends on. When it changes, the page asks again where the parts of a picture are that
// the server draws.

import type { State, Viewport } from "@oval4d/protocol";

/**
 * What the layout of a picture of this size may depend on, as JSON. It is all of the state, so that no setting is
 * forgotten, except what changes during motions and gestures and never moves a part of the picture.
 */
export function layoutKey(state: Partial<State>, size: Viewport): string {
    const { id, type, revision, draft, moving, turning, orientation, last, section, point, ...settings } = state;
    const { camera, alpha, beta, step, highlight, color, background, ...layout } = settings;
    return JSON.stringify([layout, size]);
}
