// The area of the picture: draws either kind of stream, only when needed, and reports when a picture has been
// presented.

import { pngText, type Orbit, type Slices, type State, type Viewport } from "@oval4d/protocol";

import { FrameView } from "./frame_view";
import { GeometryView } from "./geometry_view";

/** Where the slices are rendered: on this page, or on the server. */
export type Mode = "geometry" | "frames";

export interface StageEvents {
    presented(revision: number, by: Mode): void;
    resized(size: Viewport): void;
    /** The WebGL context was lost. */
    lost(): void;
}

/** The server's limits on the size of pictures. */
export interface SizeLimits {
    min_side?: number;
    max_width?: number;
    max_height?: number;
    max_pixels?: number;
}

const kMaxPixels = 4_000_000; // more pixels take time without a visible benefit

export class Stage {
    orbit: Orbit = { azimuth: 0, elevation: 0, zoom: 1 };
    size: Viewport = { width: 1280, height: 720 }; // device pixels
    private current: Mode = "frames";
    private geometry: GeometryView | undefined;
    private readonly frames: FrameView;
    private readonly canvases: Record<"solids" | "overlay" | "frame", HTMLCanvasElement>;
    private unpresented: number | undefined;
    private drawn: { revision: number; by: Mode } = { revision: 0, by: "frames" };
    private readonly painted = new MessageChannel(); // delivers a message after the browser has painted
    private scheduled = false;
    private limits: SizeLimits = {};

    constructor(
        private readonly root: HTMLElement,
        private readonly events: StageEvents,
    ) {
        const canvas = (name: string): HTMLCanvasElement => root.querySelector<HTMLCanvasElement>(`canvas.${name}`)!;
        this.canvases = { solids: canvas("solids"), overlay: canvas("overlay"), frame: canvas("frame") };
        this.frames = new FrameView(this.canvases.frame);
        if (document.createElement("canvas").getContext("webgl2")) {
            this.geometry = new GeometryView(this.canvases.solids, this.canvases.overlay);
        }
        this.canvases.solids.addEventListener("webglcontextlost", () => {
            this.geometry = undefined;
            this.events.lost();
        });
        this.painted.port1.onmessage = () => this.presented();
        this.measure();
        new ResizeObserver(() => this.measure()).observe(root);
    }

    get canDrawGeometry(): boolean {
        return this.geometry !== undefined;
    }

    get mode(): Mode {
        return this.current;
    }

    set mode(mode: Mode) {
        this.current = mode;
        this.root.dataset["mode"] = mode;
        this.unpresented = undefined;
    }

    showSlices(slices: Slices, orbit: Orbit): void {
        if (this.current !== "geometry" || !this.geometry) return;
        this.geometry.take(slices, orbit);
        this.unpresented = slices.revision;
        this.redraw();
    }

    async showFrame(png: Uint8Array): Promise<void> {
        if (this.current !== "frames") return;
        const state = JSON.parse(pngText(png) ?? "{}") as Partial<State>;
        await this.frames.take(png);
        if (this.current !== "frames") return;
        this.unpresented = state.revision;
        this.redraw();
    }

    /** Sets the limits on the size. */
    limit(limits: SizeLimits): void {
        this.limits = limits;
        this.measure();
    }

    /** Schedules a drawing for the next animation frame. */
    redraw(): void {
        if (this.scheduled) return;
        this.scheduled = true;
        requestAnimationFrame(() => this.draw());
    }

    private draw(): void {
        this.scheduled = false;
        if (this.current === "geometry") this.geometry?.draw(this.orbit, this.size);
        else this.frames.draw();
        if (this.unpresented === undefined) return;
        this.drawn = { revision: this.unpresented, by: this.current };
        this.unpresented = undefined;
        this.painted.port2.postMessage(null);
    }

    private presented(): void {
        const { revision, by } = this.drawn;
        this.root.dataset["revision"] = String(revision);
        this.root.dataset["drawnBy"] = by;
        this.events.presented(revision, by);
    }

    private measure(): void {
        const { clientWidth, clientHeight } = this.root;
        if (clientWidth === 0 || clientHeight === 0) return;
        const { min_side: minSide = 1, max_width: maxWidth = Infinity, max_height: maxHeight = Infinity } = this.limits;
        const maxPixels = Math.min(kMaxPixels, this.limits.max_pixels ?? Infinity);
        const ratio = Math.min(
            devicePixelRatio,
            Math.sqrt(maxPixels / (clientWidth * clientHeight)),
            maxWidth / clientWidth,
            maxHeight / clientHeight,
        );
        const side = (length: number): number => Math.max(minSide, Math.floor(length * ratio));
        const size = { width: side(clientWidth), height: side(clientHeight) };
        if (size.width === this.size.width && size.height === this.size.height) return;
        this.size = size;
        this.redraw();
        this.events.resized(size);
    }
}
