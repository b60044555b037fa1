// Buttons for actions of the page that have no key.

import { element } from "./element";
import type { Mode } from "./picture/stage";
import type { Section } from "./tools";

export interface PageActions {
    mode: Mode;
    canDrawGeometry: boolean;
    setMode(mode: Mode): void;
    reset(): void;
    share(): void;
    save(): void;
    openField(): void;
    usesSingleKeys: boolean;
    useSingleKeys(on: boolean): void;
}

export function pageSections(actions: PageActions): Section[] {
    const renderer = (mode: Mode, label: string, title: string): HTMLElement => {
        const made = button(mode, label, title, () => actions.setMode(mode));
        made.toggleAttribute("disabled", mode === "geometry" && !actions.canDrawGeometry);
        made.setAttribute("aria-pressed", String(actions.mode === mode));
        return made;
    };
    return [
        {
            title: "Repeat and undo",
            content: [button("reset", "Reset", "Restore the initial orientation and focus", actions.reset)],
        },
        {
            title: "Polytope",
            content: [button("field", "Field", "Show the field of a formula of x, y, z and w", actions.openField)],
        },
        {
            title: "Rendered by",
            content: [
                renderer(
                    "geometry",
                    "This device",
                    actions.canDrawGeometry ? "Render in this browser with WebGL" : "WebGL 2 is not available here",
                ),
                renderer("frames", "Server", "Render on the server, which sends pictures"),
            ],
        },
        {
            title: "Help and commands",
            content: [singleKeysButton(actions)],
        },
        {
            title: "Export and share",
            content: [
                button("save", "Save picture", "Save the picture as a PNG file", actions.save),
                button("share", "Share", "Copy a link with which others can join this session", actions.share),
            ],
        },
    ];
}

/** Marks the button of the active mode as pressed. */
export function markMode(mode: Mode): void {
    for (const name of ["geometry", "frames"]) {
        document.querySelector(`[data-page-tool="${name}"]`)?.setAttribute("aria-pressed", String(name === mode));
    }
}

/** A switch, for those who type keys unintentionally, such as by speech (WCAG 2.1.4). */
function singleKeysButton({ usesSingleKeys, useSingleKeys }: PageActions): HTMLElement {
    const made = button("single_keys", "Single keys", "Keys act without Ctrl; otherwise use the buttons", () => {
        const on = made.getAttribute("aria-pressed") !== "true";
        made.setAttribute("aria-pressed", String(on));
        useSingleKeys(on);
    });
    made.setAttribute("aria-pressed", String(usesSingleKeys));
    return made;
}

function button(name: string, label: string, title: string, act: () => void): HTMLElement {
    const made = element("button", { type: "button", "data-page-tool": name, title }, label);
    made.addEventListener("click", act);
    return made;
}
