// The area of the page that shows the picture. Draws the newest slices or frame when something has changed, and reports
// when a picture has been presented.

import { pngText, type Limits, type Orbit, type Slices, type State, type Viewport } from "@oval4d/protocol";

import { FrameView } from "./frame_view";
import { GeometryView } from "./geometry_view";
import type { ElementCounts, HighlightedElements } from "./highlighted_elements";
import type { HitTester } from "./hit_tester";

/** Where slices are rendered: "geometry" on this page, "frames" on the server. */
export type RenderingMode = "geometry" | "frames";

export interface StageEvents {
    presented(revision: number, by: RenderingMode): void;
    resized(size: Viewport): void;
    /** Called before each scheduled drawing. */
    beforeDraw(): void;
    /** Called when the WebGL context is lost, or restored after a loss. */
    graphicsChanged(isAvailable: boolean): void;
}

/** The server's limits on the size of pictures. */
export type PictureSizeLimits = Partial<Pick<Limits, "min_side" | "max_width" | "max_height" | "max_pixels">>;

const kMaxPixels = 4_000_000; // the most pixels of a picture on the page; more cost time without visible benefit
const kPrintPixels = 6_000_000; // the most pixels of a printed picture: about 300 dots per inch on a sheet of A4
// The longest side of a printed picture, in pixels; some browsers do not draw larger canvases.
const kMaxPrintSide = 4096;
const kLeastText = 9; // the least height of texts, in CSS pixels
const kLeastTextInFullScreen = 0.02; // the least height of texts in full screen, in window heights

/**
 * The largest factor by which a picture of this size can be enlarged within the limits; less than 1 if its size exceeds
 * a limit.
 */
function largestScale({ width, height }: Viewport, limits: PictureSizeLimits, maxPixels: number, maxSide: number): number {
    return Math.min(
        Math.sqrt(Math.min(maxPixels, limits.max_pixels ?? Infinity) / (width * height)),
        Math.min(maxSide, limits.max_width ?? Infinity) / width,
        Math.min(maxSide, limits.max_height ?? Infinity) / height,
    );
}

export class Stage {
    orbit: Orbit = { azimuth: 0, elevation: 0, zoom: 1 };
    size: Viewport = { width: 1280, height: 720 }; // the size of the picture, in device pixels
    private currentMode: RenderingMode = "frames";
    private readonly geometry: GeometryView | undefined;
    private isContextLost = false;
    private readonly frames: FrameView;
    private readonly pointedFrame: FrameView;
    private readonly canvases: Record<"solids" | "overlay" | "frame", HTMLCanvasElement>;
    private isDraft = false; // whether a finer picture follows the newest one
    private unpresentedRevision: number | undefined; // the revision of a new picture that has not been drawn yet
    private drawn: { revision: number; by: RenderingMode } = { revision: 0, by: "frames" };
    // A message through this channel that is sent during a drawing arrives after the browser has rendered the page.
    private readonly afterRendering = new MessageChannel();
    private scheduled = false;
    private limits: PictureSizeLimits = {};

    constructor(
        private readonly root: HTMLElement,
        private readonly events: StageEvents,
    ) {
        const canvas = (name: string): HTMLCanvasElement => root.querySelector<HTMLCanvasElement>(`canvas.${name}`)!;
        this.canvases = { solids: canvas("solids"), overlay: canvas("overlay"), frame: canvas("frame") };
        this.frames = new FrameView(this.canvases.frame);
        this.pointedFrame = new FrameView(canvas("pointed-frame"));
        if (document.createElement("canvas").getContext("webgl2")) {
            this.geometry = new GeometryView(this.canvases.solids, this.canvases.overlay);
        }
        // After a loss of the WebGL context, three.js asks the browser to restore the context, and uploads its own data
        // again.
        for (const change of ["lost", "restored"]) {
            this.canvases.solids.addEventListener(`webglcontext${change}`, () => {
                this.isContextLost = change === "lost";
                this.events.graphicsChanged(!this.isContextLost);
            });
        }
        this.afterRendering.port1.onmessage = () => this.reportPresented();
        this.updateSize();
        new ResizeObserver(() => this.updateSize()).observe(root);
        this.followPixelRatio();
    }

    get canDrawGeometry(): boolean {
        return this.geometry !== undefined && !this.isContextLost;
    }

    get mode(): RenderingMode {
        return this.currentMode;
    }

    set mode(mode: RenderingMode) {
        this.currentMode = mode;
        this.root.dataset["mode"] = mode;
        this.unpresentedRevision = undefined;
    }

    /**
     * The hit tester of the picture, which finds what is at a point in device pixels. Undefined if the server draws the
     * picture.
     */
    get hitTester(): HitTester | undefined {
        return this.currentMode === "geometry" ? this.geometry?.hitTester : undefined;
    }

    /** Highlights the elements under the pointer. The caller must then draw the picture. */
    highlightPointed(pointed: HighlightedElements | undefined): void {
        this.geometry?.highlightPointed(pointed);
    }

    /**
     * Shows new slices at the next drawing. `orbit` is the orbit for which the server placed the camera of the picture.
     */
    showSlices(slices: Slices, orbit: Orbit, counts: ElementCounts): void {
        if (this.currentMode !== "geometry" || !this.geometry) return;
        this.geometry.update(slices, orbit, counts);
        this.unpresentedRevision = slices.revision;
        this.isDraft = slices.draft ?? false;
        this.scheduleRedraw();
    }

    async showFrame(png: Uint8Array): Promise<void> {
        if (this.currentMode !== "frames") return;
        const state = JSON.parse(pngText(png) ?? "{}") as Partial<State>;
        await this.frames.decode(png);
        if (this.currentMode !== "frames") return;
        this.unpresentedRevision = state.revision;
        this.isDraft = state.draft ?? false;
        this.scheduleRedraw();
    }

    /**
     * Shows a frame in which the element under the pointer is highlighted, until hidePointedFrame() is called. The
     * frame covers the newest frame of the stream. `isWanted` is called after decoding; if it returns false, the frame
     * is not shown.
     */
    async showPointedFrame(png: Uint8Array, isWanted: () => boolean): Promise<void> {
        await this.pointedFrame.decode(png);
        if (!isWanted()) return;
        this.pointedFrame.draw();
        this.root.toggleAttribute("data-pointed-frame", true);
    }

    hidePointedFrame(): void {
        this.root.toggleAttribute("data-pointed-frame", false);
    }

    /** Sets the server's limits on the size of pictures. */
    setSizeLimits(limits: PictureSizeLimits): void {
        this.limits = limits;
        this.updateSize();
    }

    /** Schedules a drawing for the next animation frame. */
    scheduleRedraw(): void {
        if (this.scheduled) return;
        this.scheduled = true;
        requestAnimationFrame(() => this.draw());
    }

    /** Draws the slices now, within the current animation frame. Does nothing if the server draws the picture. */
    drawNow(): void {
        if (this.currentMode === "geometry") this.geometry?.draw(this.orbit, this.size, this.leastText);
    }

    /**
     * The size of the picture to print, in pixels, with the aspect ratio of the picture on the page. If the server
     * draws the picture, the size is within the server's limits.
     */
    get printSize(): Viewport {
        const { width, height } = this.size;
        const within = this.currentMode === "frames" ? this.limits : {};
        const scale = Math.max(1, largestScale(this.size, within, kPrintPixels, kMaxPrintSide));
        return { width: Math.floor(width * scale), height: Math.floor(height * scale) };
    }

    /**
     * Fills `canvas` with the picture to print. The page draws the picture on white; a picture drawn by the server is
     * printed as it is shown.
     */
    drawForPrint(canvas: HTMLCanvasElement): void {
        const { frame } = this.canvases;
        const { width, height } = this.currentMode === "geometry" ? this.printSize : frame;
        Object.assign(canvas, { width, height });
        const pen = canvas.getContext("2d")!;
        if (this.currentMode === "frames") {
            if (width > 0 && height > 0) pen.drawImage(frame, 0, 0);
            return;
        }
        this.geometry?.drawForPrint(pen, this.orbit, { width, height }, (this.leastText * height) / this.size.height);
        this.drawNow();
    }

    /**
     * The height of the picture on the page, in CSS pixels. The picture may have fewer pixels than this part of the
     * screen, because kMaxPixels and the server's limits bound its size.
     */
    get shownHeight(): number {
        return this.root.clientHeight || this.size.height / devicePixelRatio; // in print, clientHeight is 0
    }

    /** The least height of texts in the picture, in picture pixels. */
    private get leastText(): number {
        const isFull = document.documentElement.hasAttribute("data-full-screen");
        const least = isFull ? Math.max(kLeastText, kLeastTextInFullScreen * innerHeight) : kLeastText;
        return Math.ceil((least * this.size.height) / this.shownHeight);
    }

    private draw(): void {
        this.scheduled = false;
        this.events.beforeDraw();
        if (this.currentMode === "geometry") this.drawNow();
        else this.frames.draw();
        if (this.unpresentedRevision === undefined) return;
        this.drawn = { revision: this.unpresentedRevision, by: this.currentMode };
        this.unpresentedRevision = undefined;
        this.afterRendering.port2.postMessage(null);
    }

    private reportPresented(): void {
        const { revision, by } = this.drawn;
        this.root.dataset["revision"] = String(revision);
        this.root.dataset["drawnBy"] = by;
        this.root.toggleAttribute("data-draft", this.isDraft);
        this.events.presented(revision, by);
    }

    /**
     * Updates the size when the window moves to a screen with another pixel ratio. The ResizeObserver does not notice
     * such a move, because the size in CSS pixels stays the same.
     */
    private followPixelRatio(): void {
        const changed = (): void => {
            this.updateSize();
            this.followPixelRatio(); // the query matches only one ratio
        };
        matchMedia(`(resolution: ${devicePixelRatio}dppx)`).addEventListener("change", changed, { once: true });
    }

    private updateSize(): void {
        const { clientWidth, clientHeight } = this.root;
        if (clientWidth === 0 || clientHeight === 0) return;
        const shown = { width: clientWidth, height: clientHeight };
        const ratio = Math.min(devicePixelRatio, largestScale(shown, this.limits, kMaxPixels, Infinity));
        const side = (length: number): number => Math.max(this.limits.min_side ?? 1, Math.floor(length * ratio));
        const size = { width: side(clientWidth), height: side(clientHeight) };
        this.scheduleRedraw(); // even at the same size, zooming the page may change the size of texts
        if (size.width === this.size.width && size.height === this.size.height) return;
        this.size = size;
        this.events.resized(size);
    }
}
