// The page's own buttons: for what no key does.

import { element } from "./element";
import type { Mode } from "./picture/stage";
import type { Section } from "./tools";

export interface OwnTools {
    mode: Mode;
    canDrawGeometry: boolean;
    setMode(mode: Mode): void;
    reset(): void;
    resetView(): void;
    share(): void;
    save(): void;
}

export function ownSections(tools: OwnTools): Section[] {
    const drawnBy = (mode: Mode, label: string, title: string): HTMLElement => {
        const made = button(mode, label, title, () => tools.setMode(mode));
        made.toggleAttribute("disabled", mode === "geometry" && !tools.canDrawGeometry);
        made.setAttribute("aria-pressed", String(tools.mode === mode));
        return made;
    };
    return [
        {
            title: "Start again",
            content: [
                button("reset", "Orientation", "turn the polytope as it was at the start", tools.reset),
                button(
                    "reset-view",
                    "Viewpoint",
                    "look from where it was at the start (double click)",
                    tools.resetView,
                ),
            ],
        },
        {
            title: "Drawn by",
            content: [
                drawnBy(
                    "geometry",
                    "this device",
                    tools.canDrawGeometry ? "drawn here, by WebGL" : "WebGL is missing here",
                ),
                drawnBy("frames", "the server", "drawn by the server, sent as pictures"),
            ],
        },
        {
            title: "Take along",
            content: [
                button("save", "Save picture", "save a picture of the slices as a PNG file", tools.save),
                button("share", "Copy link", "copy a link with which others join this session", tools.share),
            ],
        },
    ];
}

/** Shows which mode is on. */
export function markMode(mode: Mode): void {
    for (const one of ["geometry", "frames"]) {
        document.querySelector(`[data-own="${one}"]`)?.setAttribute("aria-pressed", String(one === mode));
    }
}

function button(name: string, label: string, title: string, act: () => void): HTMLElement {
    const made = element("button", { type: "button", "data-own": name, title }, label);
    made.addEventListener("click", act);
    return made;
}
