// Frame mode: shows pictures that the server has drawn.

import { ImageDecoder } from "./image_decoder";

export class FrameView {
    private readonly context: ImageBitmapRenderingContext;
    private decoder: ImageDecoder | undefined;
    private bitmap: ImageBitmap | undefined;

    constructor(private readonly canvas: HTMLCanvasElement) {
        this.context = canvas.getContext("bitmaprenderer")!; // has an alpha channel, for transparent pictures
    }

    /**
     * Decodes a picture in a web worker. The next call of draw() shows it. The buffer of `png` moves to the worker, so
     * the caller can no longer use it.
     */
    async decode(png: Uint8Array): Promise<void> {
        this.decoder ??= new ImageDecoder();
        const bitmap = await this.decoder.decode(png as Uint8Array<ArrayBuffer>);
        this.bitmap?.close();
        this.bitmap = bitmap;
    }

    draw(): void {
        if (!this.bitmap) return;
        const { width, height } = this.bitmap;
        if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
        this.context.transferFromImageBitmap(this.bitmap);
        this.bitmap = undefined;
    }
}
