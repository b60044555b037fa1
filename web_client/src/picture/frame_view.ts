// Frame mode: shows pictures that the server drew.

export class FrameView {
    private readonly context: ImageBitmapRenderingContext;
    private bitmap: ImageBitmap | undefined;

    constructor(private readonly canvas: HTMLCanvasElement) {
        this.context = canvas.getContext("bitmaprenderer", { alpha: false })!;
    }

    async take(png: Uint8Array): Promise<void> {
        const bitmap = await createImageBitmap(new Blob([png as Uint8Array<ArrayBuffer>], { type: "image/png" }));
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
