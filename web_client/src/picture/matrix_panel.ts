// Positions of the matrix panels in the picture. Pixels are counted from the picture's upper left corner.

import type { PlanarSection, SectionMatrix, Viewport } from "@oval4d/protocol";

const kAxes = [0, 1, 2, 3] as const; // x, y, z, w

/**
 * The matrix panel in row `row` and column `column`, both 0 to 3. It shows the section of the object by a plane; axis
 * `column` points to the right, axis `row` upward.
 */
export class MatrixPanel {
    readonly section: PlanarSection;
    /** The pixel at the center of the panel, where the panel shows the origin. */
    readonly x: number;
    readonly y: number;
    /** Half the side of the panel, in pixels. */
    readonly half: number;
    private readonly pixelsPerUnit: number;

    constructor(
        { left, bottom, panel, step, reach, sections }: SectionMatrix,
        readonly row: number,
        readonly column: number,
        { height }: Viewport,
    ) {
        const [first, second] = [Math.min(row, column), Math.max(row, column)];
        this.section = sections.find(({ axes }) => axes[0] === first && axes[1] === second)!;
        this.x = (left + column * step + panel / 2) * height;
        this.y = (1 - bottom - (3 - row) * step - panel / 2) * height;
        this.half = (panel / 2) * height;
        this.pixelsPerUnit = this.half / reach;
    }

    /** The pixel of a point of the section, given by its coordinates along the first and second axis of the section. */
    pixelOf([first, second]: readonly [number, number]): [x: number, y: number] {
        const [across, up] = this.column < this.row ? [first, second] : [second, first];
        return [this.x + across * this.pixelsPerUnit, this.y - up * this.pixelsPerUnit];
    }

    /** The point of the panel that is nearest to a pixel, as coordinates along axis `column` and axis `row`. */
    coordinatesAt(x: number, y: number): [across: number, up: number] {
        const within = (offset: number): number => Math.min(this.half, Math.max(-this.half, offset));
        return [within(x - this.x) / this.pixelsPerUnit, within(this.y - y) / this.pixelsPerUnit];
    }
}

/** The panels of the matrix that show a section: all except those on the diagonal. */
export function panelsOf(matrix: SectionMatrix, viewport: Viewport): MatrixPanel[] {
    return kAxes.flatMap((row) =>
        kAxes.filter((column) => column !== row).map((column) => new MatrixPanel(matrix, row, column, viewport)),
    );
}

/** The center, in pixels, of the diagonal panel that shows the name of `axis`, 0 to 3. */
export function axisNameCenter({ left, bottom, panel, step }: SectionMatrix, axis: number, { height }: Viewport) {
    return {
        x: (left + axis * step + panel / 2) * height,
        y: (1 - bottom - (3 - axis) * step - panel / 2) * height,
    };
}

/** The panel at a pixel; undefined on the diagonal of the matrix, between the panels and outside the matrix. */
export function panelAt(matrix: SectionMatrix, x: number, y: number, viewport: Viewport): MatrixPanel | undefined {
    const { left, bottom, panel, step } = matrix;
    const [across, up] = [x / viewport.height - left, 1 - y / viewport.height - bottom];
    const [column, fromBottom] = [Math.floor(across / step), Math.floor(up / step)];
    const isInside =
        column >= 0 &&
        column <= 3 &&
        fromBottom >= 0 &&
        fromBottom <= 3 &&
        across - column * step <= panel &&
        up - fromBottom * step <= panel;
    const row = 3 - fromBottom;
    return isInside && row !== column ? new MatrixPanel(matrix, row, column, viewport) : undefined;
}
