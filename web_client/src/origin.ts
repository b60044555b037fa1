// Converts coordinates. In pictures, the origin is the center of the object; in the object's file, it may be elsewhere.

import type { State } from "@oval4d/protocol";

/** What to add to the coordinates in a picture to get those of the object's file. */
export function originInFile({ polytope: { center } }: State): State["point"] {
    return center ?? [0, 0, 0, 0];
}
