// The color scheme of the page, dark or light. It is the scheme of the system or the user's choice, which the browser
// remembers. Pictures whose background is "auto" have the same scheme.

import type { Background, Scheme } from "@oval4d/protocol";

import colors from "../../protocol/colors.json";
import { loadFromStorage, saveToStorage } from "./storage";

export const kSchemeChoices = ["system", "dark", "light"] as const;
export type ColorSchemeChoice = (typeof kSchemeChoices)[number];

/** The backgrounds that are a color: all except "auto" and "transparent". */
export type OpaqueBackground = keyof typeof colors.grounds;

const kSchemeKey = "oval4d.scheme"; // storage key of the choice, in localStorage

export class ColorScheme {
    private readonly system = matchMedia("(prefers-color-scheme: light)");
    private chosen: ColorSchemeChoice;
    current: Scheme;

    /** `changed` is called when the scheme has changed. */
    constructor(private readonly changed: () => void) {
        const stored = loadFromStorage<ColorSchemeChoice>(kSchemeKey, true);
        this.chosen = stored !== undefined && kSchemeChoices.includes(stored) ? stored : "system";
        this.current = this.wanted;
        this.applyToPage();
        this.system.addEventListener("change", () => this.update());
    }

    get choice(): ColorSchemeChoice {
        return this.chosen;
    }

    set choice(choice: ColorSchemeChoice) {
        this.chosen = choice;
        saveToStorage(kSchemeKey, choice, true);
        this.update();
    }

    private get wanted(): Scheme {
        if (this.chosen !== "system") return this.chosen;
        return this.system.matches ? "light" : "dark";
    }

    private update(): void {
        if (this.current === this.wanted) return;
        this.current = this.wanted;
        this.applyToPage();
        this.changed();
    }

    private applyToPage(): void {
        document.documentElement.dataset["scheme"] = this.current;
        document.querySelector('meta[name="theme-color"]')?.setAttribute("content", colors.grounds[this.current]);
    }
}

/** The opaque background on which a viewer with this scheme sees a picture. A transparent picture is shown on white. */
export function opaqueBackgroundOf(background: Background, scheme: Scheme): OpaqueBackground {
    if (background === "auto") return scheme;
    return background === "transparent" ? "white" : background;
}

/** The scheme of the colors in the picture that the page shows. */
export function schemeOfPicture(): Scheme {
    const { ground = "dark" } = document.documentElement.dataset;
    return ground === "dark" ? "dark" : "light";
}
