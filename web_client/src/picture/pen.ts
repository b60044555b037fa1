// Colours and letters on a canvas.

const kFont = '"DejaVu Sans", Verdana, system-ui, sans-serif';

export const kLeastText = 9; // pixels of the page

/** 0xRRGGBB as CSS has it. */
export function css(colour: number): string {
    return `#${colour.toString(16).padStart(6, "0")}`;
}

/** Sets the font; returns the height of its digits. */
export function setFont(pen: CanvasRenderingContext2D, size: number): number {
    pen.font = `${Math.max(1, Math.round(size))}px ${kFont}`;
    return pen.measureText("0").actualBoundingBoxAscent;
}
