// Dragging in the panels of the matrix: the focus point follows the pointer along the two axes of the panel.

import type { SectionMatrix } from "@oval4d/protocol";

import type { FocusPointMover } from "./focus_point_control";
import { followHover, type AreaPoint } from "./hover";
import { type MatrixPanel, panelAt } from "./picture/matrix_panel";
import type { Stage } from "./picture/stage";

export class FocusPointDrag {
    private panel: MatrixPanel | undefined; // the panel in which the drag began
    private hovering: AreaPoint | undefined; // where the mouse hovers; undefined if it does not

    /**
     * `matrix` returns the matrix of planar sections in the picture; undefined if the picture has none, or while the
     * place of the matrix is not known.
     */
    constructor(
        private readonly drawing: HTMLElement,
        private readonly stage: Stage,
        private readonly focusPointControl: FocusPointMover,
        private readonly matrix: () => SectionMatrix | undefined,
    ) {
        followHover(drawing, (at) => {
            this.hovering = at;
            this.updateCursor();
        });
    }

    /** Shows a different mouse cursor over the panels of the matrix. Must be called when the picture changes. */
    updateCursor(): void {
        if (this.hovering) this.showCursor(this.hovering);
    }

    /** Whether a point of the drawing, in pixels, is in a panel. */
    canMoveTo(at: AreaPoint): boolean {
        return this.panelAt(at) !== undefined;
    }

    /** Begins a drag; returns false if there is no panel at this point of the drawing. */
    begin(at: AreaPoint): boolean {
        this.panel = this.panelAt(at);
        this.showCursor(at);
        if (!this.panel) return false;
        this.focusPointControl.begin();
        return true;
    }

    /** Continues the drag. If the pointer leaves the panel, the focus point stays at the edge of the panel. */
    dragTo(at: AreaPoint): void {
        if (this.panel) this.moveFocusPointInPanel(this.panel, at);
    }

    /**
     * Moves the focus point to the 4-D point that a matrix panel shows at the place `at` of the drawing. Returns false
     * if no panel is at this place.
     */
    moveTo(at: AreaPoint): boolean {
        const panel = this.panelAt(at);
        if (!panel) return false;
        this.focusPointControl.begin();
        this.moveFocusPointInPanel(panel, at);
        return true;
    }

    private moveFocusPointInPanel(panel: MatrixPanel, at: AreaPoint): void {
        const { x, y } = this.toPicturePixels(at);
        const [across, up] = panel.coordinatesAt(x, y);
        this.focusPointControl.move([[panel.column, across], [panel.row, up]]);
    }

    private panelAt(at: AreaPoint): MatrixPanel | undefined {
        const matrix = this.matrix();
        const { x, y } = this.toPicturePixels(at);
        return matrix && panelAt(matrix, x, y, this.stage.size);
    }

    /** Converts a point of the drawing, in CSS pixels, to pixels of the picture. */
    private toPicturePixels({ x, y }: AreaPoint): AreaPoint {
        const ratio = this.stage.size.height / this.drawing.clientHeight;
        return { x: x * ratio, y: y * ratio };
    }

    private showCursor(at: AreaPoint): void {
        this.drawing.toggleAttribute("data-panel", this.canMoveTo(at));
    }
}
