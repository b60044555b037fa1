// Colors and fonts for drawing on a canvas.

const kFont = '"DejaVu Sans", Verdana, system-ui, sans-serif';

/** Converts 0xRRGGBB to a CSS color. */
export function cssColor(color: number): string {
    return `#${color.toString(16).padStart(6, "0")}`;
}

/** Sets the font with `size` in canvas pixels. Returns the height of the font's digits in canvas pixels. */
export function setFontAndMeasureDigits(pen: CanvasRenderingContext2D, size: number): number {
    pen.font = `${Math.max(1, Math.round(size))}px ${kFont}`;
    return pen.measureText("0").actualBoundingBoxAscent;
}
