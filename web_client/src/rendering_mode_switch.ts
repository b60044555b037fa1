// Switches between rendering by this device and rendering by the server.

import type { RenderingMode, Stage } from "./picture/stage";
import { loadFromStorage, saveToStorage } from "./storage";

const kModeKey = "oval4d.mode"; // storage key of the mode that the user has chosen
const kNoGraphics = "The graphics card is unavailable; the server renders the pictures.";

export class RenderingModeSwitch {
    // The mode that the user has chosen. It stays while WebGL is unavailable.
    private chosen = loadFromStorage<RenderingMode>(kModeKey) ?? "geometry";

    constructor(
        private readonly stage: Stage,
        private readonly actions: { changed: (mode: RenderingMode) => void; tell: (message: string) => void },
    ) {}

    /** Sets the mode for the first pictures. */
    start(): void {
        this.stage.mode = this.stage.canDrawGeometry ? this.chosen : "frames";
    }

    /** Sets the mode that the user has chosen. Refuses "geometry" with a message while WebGL is unavailable. */
    choose(mode: RenderingMode): void {
        if (mode === "geometry" && !this.stage.canDrawGeometry) return this.actions.tell(kNoGraphics);
        this.chosen = mode;
        saveToStorage(kModeKey, mode);
        this.set(mode);
        return undefined;
    }

    /**
     * Switches to the server's pictures while the WebGL context is lost, and then back. Does nothing if the user has
     * chosen the server's pictures.
     */
    graphicsChanged(isAvailable: boolean): void {
        if (this.chosen === "frames") return;
        this.actions.tell(isAvailable ? "This device renders the pictures again." : kNoGraphics);
        this.set(isAvailable ? "geometry" : "frames");
    }

    private set(mode: RenderingMode): void {
        this.stage.mode = mode;
        this.actions.changed(mode);
    }
}
