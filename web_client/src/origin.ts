// Converts coordinates between pictures and files. In pictures, the origin is the object's center; in the object's
// file, the origin may be elsewhere.

import type { State } from "@oval4d/protocol";

/** The vector to add to coordinates in a picture to get coordinates in the object's file. */
export function originInFile({ polytope: { center } }: State): State["point"] {
    return center ?? [0, 0, 0, 0];
}
