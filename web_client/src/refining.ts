// Shows a text at the top of the picture while the picture shows a coarse level of a multiscale image, and a finer
// level will follow.

import type { State } from "@oval4d/protocol";

import { byId } from "./element";

export function showRefining({ field }: State): void {
    const root = byId("refining");
    const { shape, resolution } = field ?? {};
    const text = shape && resolution?.refining ? `Refining… ${shape.join(" × ")} samples are shown.` : "";
    if (root.textContent !== text) root.textContent = text; // a screen reader speaks only changes
}
