// Full-screen display, as on a projector. The texts become large enough for the back of a room.

export class FullScreenMode {
    // Also matches when F11 has made the page full-screen.
    private readonly display = matchMedia("(display-mode: fullscreen)");
    private wasOn = false;

    /** `changed` is called when the page enters or leaves full screen. */
    constructor(private readonly changed: (isOn: boolean) => void) {
        document.addEventListener("fullscreenchange", () => this.update());
        this.display.addEventListener("change", () => this.update());
    }

    get isAvailable(): boolean {
        return document.fullscreenEnabled;
    }

    get isOn(): boolean {
        return document.fullscreenElement !== null || this.display.matches;
    }

    /** Enters full screen, or leaves it; throws an Error if the browser forbids it. */
    async toggle(): Promise<void> {
        if (document.fullscreenElement) await document.exitFullscreen();
        else await document.documentElement.requestFullscreen({ navigationUI: "hide" });
    }

    /**
     * Calls `changed` if full screen has begun or ended since the last call. Must also be called at the start, because
     * the page may begin in full screen.
     */
    update(): void {
        const { isOn } = this;
        if (isOn === this.wasOn) return;
        this.wasOn = isOn;
        document.documentElement.toggleAttribute("data-full-screen", isOn);
        this.changed(isOn);
    }
}
