// The page's own buttons, for actions that have no key.

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
    const renderer = (mode: Mode, label: string, title: string): HTMLElement => {
        const made = button(mode, label, title, () => tools.setMode(mode));
        made.toggleAttribute("disabled", mode === "geometry" && !tools.canDrawGeometry);
        made.setAttribute("aria-pressed", String(tools.mode === mode));
        return made;
    };
    return [
        {
            title: "Reset",
            content: [
                button("reset", "Orientation", "Restore the initial orientation and focus", tools.reset),
                button("reset-view", "Viewpoint", "Restore the initial viewpoint (double click)", tools.resetView),
            ],
        },
        {
            title: "Rendered by",
            content: [
                renderer(
                    "geometry",
                    "This device",
                    tools.canDrawGeometry ? "Render in this browser with WebGL" : "WebGL 2 is not available here",
                ),
                renderer("frames", "Server", "Render on the server, which sends pictures"),
            ],
        },
        {
            title: "Export and share",
            content: [
                button("save", "Save picture", "Save the picture as a PNG file", tools.save),
                button("share", "Copy link", "Copy a link with which others can join this session", tools.share),
            ],
        },
    ];
}

/** Marks the button of the active mode as pressed. */
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
