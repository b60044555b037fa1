// Buttons for actions of the page that have no key.

import { kSchemeChoices, type ColorSchemeChoice } from "./color_scheme";
import { element } from "./element";
import { capitalize } from "./format";
import type { FullScreenMode } from "./full_screen";
import type { RenderingMode } from "./picture/stage";
import type { RollingBallKind } from "./rolling_ball";
import type { TiltControl } from "./tilt";
import type { ToolSection } from "./tools";

export interface PageToolActions {
    mode: RenderingMode;
    canDrawGeometry: boolean;
    setMode(mode: RenderingMode): void;
    reset(): void;
    share(): void;
    shareWithPhone(): void;
    copyViewLink(): void;
    copyPython(): void;
    save(): void;
    openField(): void;
    scheme: ColorSchemeChoice;
    chooseScheme(choice: ColorSchemeChoice): void;
    fullScreen: FullScreenMode;
    tilt: TiltControl;
    /** Shows an error to the user. */
    failed(error: Error): void;
    usesSingleKeys: boolean;
    useSingleKeys(on: boolean): void;
}

const kSchemeTitles: Record<ColorSchemeChoice, string> = {
    system: "A dark or a light page, as the system is set",
    dark: "A dark page",
    light: "A light page; the picture is light, too, unless it has another background",
};

/**
 * The two tilt buttons, with label and tooltip. Each lets the device's orientation roll one kind of ball (see
 * rolling_ball.ts).
 */
const kTilts = new Map<RollingBallKind, [string, string]>([
    ["4-D", ["Tilt in 4-D", "Turn in xw and yw as this device is tilted, and in zw as it is twisted"]],
    ["3-D", ["Tilt slices", "Turn every slice in place as this device is tilted and twisted"]],
]);

export function pageToolSections(actions: PageToolActions): ToolSection[] {
    const renderer = (mode: RenderingMode, label: string, title: string): HTMLElement => {
        const made = createButton(mode, label, title, () => actions.setMode(mode));
        made.toggleAttribute("disabled", mode === "geometry" && !actions.canDrawGeometry);
        made.setAttribute("aria-pressed", String(actions.mode === mode));
        return made;
    };
    return [
        ...(actions.tilt.isOffered ? [tiltSection(actions)] : []),
        {
            title: "Repeat and undo",
            content: [createButton("reset", "Reset", "Restore the initial orientation and focus", actions.reset)],
        },
        {
            title: "Polytope",
            content: [createButton("field", "Field", "Show the field of a formula of x, y, z and w", actions.openField)],
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
            title: "Appearance",
            content: [...kSchemeChoices.map((choice) => schemeButton(choice, actions)), fullScreenButton(actions)],
        },
        {
            title: "Help and commands",
            content: [singleKeysButton(actions)],
        },
        {
            title: "Export and share",
            content: [
                createButton("save", "Save picture", "Save the picture as a PNG file", actions.save),
                createButton("share", "Share", "Copy a link with which others can join this session", actions.share),
                createButton(
                    "phone",
                    "Share with a phone",
                    "Show the link with which others can join this session as a QR code",
                    actions.shareWithPhone,
                ),
                createButton(
                    "view_link",
                    "Copy link to this view",
                    "Copy a link that opens this view in a new session",
                    actions.copyViewLink,
                ),
                createButton(
                    "python",
                    "Copy as Python",
                    "Copy a script that opens this view and saves its picture",
                    actions.copyPython,
                ),
            ],
        },
    ];
}

/** Marks the button of the active rendering mode as pressed. */
export function showModePressed(mode: RenderingMode): void {
    for (const name of ["geometry", "frames"]) {
        document.querySelector(`[data-page-tool="${name}"]`)?.setAttribute("aria-pressed", String(name === mode));
    }
}

/** Marks the button of the chosen color scheme as pressed. */
export function showSchemePressed(choice: ColorSchemeChoice): void {
    for (const name of kSchemeChoices) {
        document.querySelector(`[data-page-tool="scheme_${name}"]`)?.setAttribute("aria-pressed", String(name === choice));
    }
}

/**
 * Marks as pressed the tilt button of the ball that the device's orientation rolls; no button if `ball` is undefined.
 */
export function showTiltPressed(ball: RollingBallKind | undefined): void {
    for (const kind of kTilts.keys()) {
        document.querySelector(`[data-page-tool="tilt_${kind}"]`)?.setAttribute("aria-pressed", String(kind === ball));
    }
}

/** Marks the button Full screen as pressed while the page fills the screen. */
export function showFullScreenPressed(isOn: boolean): void {
    document.querySelector('[data-page-tool="full_screen"]')?.setAttribute("aria-pressed", String(isOn));
}

function tiltSection({ tilt, failed }: PageToolActions): ToolSection {
    const content = [...kTilts].map(([ball, [label, title]]) => {
        const isAllowed = window.isSecureContext; // browsers give sensor data only to secure pages
        const made = createButton(`tilt_${ball}`, label, isAllowed ? title : "Only with HTTPS", () => {
            void tilt.toggle(ball).catch(failed);
        });
        made.toggleAttribute("disabled", !isAllowed);
        made.setAttribute("aria-pressed", String(ball === tilt.ball));
        return made;
    });
    return { title: "Tilt", after: "history", content };
}

function schemeButton(choice: ColorSchemeChoice, { scheme, chooseScheme }: PageToolActions): HTMLElement {
    const made = createButton(`scheme_${choice}`, capitalize(choice), kSchemeTitles[choice], () => chooseScheme(choice));
    made.setAttribute("aria-pressed", String(choice === scheme));
    return made;
}

function fullScreenButton({ fullScreen, failed }: PageToolActions): HTMLElement {
    const title = "Fill the screen, with texts for the back of a room; Escape ends it";
    const made = createButton("full_screen", "Full screen", title, () => void fullScreen.toggle().catch(failed));
    made.toggleAttribute("disabled", !fullScreen.isAvailable);
    made.setAttribute("aria-pressed", String(fullScreen.isOn));
    return made;
}

/**
 * A button that determines whether keys act without Ctrl. Users of speech input can switch this off, because speech
 * input may press single keys by mistake (WCAG 2.1.4).
 */
function singleKeysButton({ usesSingleKeys, useSingleKeys }: PageToolActions): HTMLElement {
    const made = createButton("single_keys", "Single keys", "Keys act without Ctrl; otherwise use the buttons", () => {
        const on = made.getAttribute("aria-pressed") !== "true";
        made.setAttribute("aria-pressed", String(on));
        useSingleKeys(on);
    });
    made.setAttribute("aria-pressed", String(usesSingleKeys));
    return made;
}

function createButton(name: string, label: string, title: string, act: () => void): HTMLElement {
    const made = element("button", { type: "button", "data-page-tool": name, title }, label);
    made.addEventListener("click", act);
    return made;
}
