// An image of the density strip or the histogram (see coordinates.ts). New pictures overwrite its pixels in place.

import type { Slices } from "@oval4d/protocol";

export class DensityImage {
    private readonly canvas = document.createElement("canvas");
    private readonly pen = this.canvas.getContext("2d")!;
    private pixels: ImageData | undefined;
    private density: Uint8Array | undefined;

    /**
     * Converts the densities of a picture to pixels: each density becomes the alpha of its pixel. In a density strip,
     * colors between two axes are interpolated between the axes' colors. In a histogram, each panel has the color of
     * its axis.
     */
    update({ density, scene: { colors, coordinates } }: Slices): void {
        if (density === this.density) return;
        this.density = density;
        const { columns } = coordinates;
        const rows = density.length / columns;
        if (this.pixels?.width !== columns || this.pixels.height !== rows) {
            Object.assign(this.canvas, { width: columns, height: rows });
            this.pixels = this.pen.createImageData(columns, rows);
        }
        const { data } = this.pixels;
        const isHistogram = coordinates.panel > 0;
        const gap = isHistogram ? columns / 4 : (columns - 1) / 3;
        for (let column = 0; column < columns; ++column) {
            const k = Math.min(Math.floor(column / gap), isHistogram ? 3 : 2);
            const part = isHistogram ? 0 : column / gap - k;
            const [from, to] = [colors.axes[k]!, colors.axes[k + 1] ?? 0];
            for (let channel = 0; channel < 3; ++channel) {
                const shift = 16 - 8 * channel;
                const value = (1 - part) * ((from >> shift) & 255) + part * ((to >> shift) & 255);
                for (let row = 0; row < rows; ++row) data[4 * (row * columns + column) + channel] = value;
            }
        }
        for (let i = 0; i < density.length; ++i) data[4 * i + 3] = density[i]!;
        this.pen.putImageData(this.pixels, 0, 0);
    }

    /**
     * Draws the histogram panel of axis k, 0 to 3, into a rectangle. The centers of the panel's outermost pixels lie on
     * the edges of the rectangle.
     */
    drawHistogramPanel(
        pen: CanvasRenderingContext2D,
        k: number,
        x: number,
        y: number,
        width: number,
        height: number,
    ): void {
        const columns = this.canvas.width / 4;
        const left = k * columns + 0.5;
        pen.drawImage(this.canvas, left, 0.5, columns - 1, this.canvas.height - 1, x, y, width, height);
    }

    /**
     * Draws the density strip into a rectangle. The centers of the strip's outermost pixels lie on the edges of the
     * rectangle.
     */
    draw(pen: CanvasRenderingContext2D, x: number, y: number, width: number, height: number): void {
        pen.drawImage(this.canvas, 0.5, 0.5, this.canvas.width - 1, this.canvas.height - 1, x, y, width, height);
    }
}
