// Draws the matrix of planar sections, like server/render/overlay/matrix_panels.cpp.

import type { SceneDescription, SectionMatrix, Slices, Vector, Viewport } from "@oval4d/protocol";

import { cellColor, type ElementCounts, type HighlightedElements, isPointHighlighted } from "./highlighted_elements";
import { type MatrixPanel, axisNameCenter, panelsOf } from "./matrix_panel";
import { cssColor, setFontAndMeasureDigits } from "./pen";
import type { ViewCamera } from "./view_camera";

const kPanelOpacity = 0.22;
const kFillOpacity = 0.16;
const kAxisOpacity = 0.55; // the opacity of the lines through the focus point
const kCorner = 0.03; // the radius of a panel's corners, as a fraction of its side
const kAxes = ["x", "y", "z", "w"] as const;
// The font sizes of an axis's name and of its unit, as fractions of a panel's side.
const [kNameHeight, kUnitHeight] = [0.3, 0.1];
const kFocusLine = 0.0011; // the width of the lines through the focus point, in viewport heights
// The lines that mark the focus point in the focus slice: half their length in circumradii, and their width in viewport
// heights.
const kFocusReach = 0.12;
const kFocusWidth = 0.0028;

/** Data for drawing a panel that are the same for all panels of a picture. */
interface MatrixPanelDrawingContext {
    pen: CanvasRenderingContext2D;
    matrix: SectionMatrix;
    scene: SceneDescription;
    viewport: Viewport;
    highlighted: HighlightedElements;
    /** The numbers of edges, faces and cells that the polytope has. */
    counts: ElementCounts;
}

export function drawMatrix(
    pen: CanvasRenderingContext2D,
    picture: Slices,
    viewCamera: ViewCamera,
    viewport: Viewport,
    highlighted: HighlightedElements,
    counts: ElementCounts,
): void {
    const { matrix, scene } = picture;
    if (!matrix) return;
    drawFocusPoint(pen, picture, matrix, viewCamera, viewport);
    const context = { pen, matrix, scene, viewport, highlighted, counts };
    drawAxisNames(context);
    for (const panel of panelsOf(matrix, viewport)) drawPanel(panel, context);
    pen.globalAlpha = 1;
}

/** Draws the focus point in the focus slice: a line along each of the axes x, y and z through it. */
function drawFocusPoint(
    pen: CanvasRenderingContext2D,
    { scene, slices }: Slices,
    { point }: SectionMatrix,
    viewCamera: ViewCamera,
    viewport: Viewport,
): void {
    const slice = slices.find(({ focus }) => focus);
    if (!slice) return;
    pen.lineWidth = Math.max(1, kFocusWidth * viewport.height);
    pen.lineCap = "round";
    for (const axis of [0, 1, 2] as const) {
        const [from, to] = [-1, 1].map((side) => {
            const place = [0, 1, 2].map((k) => {
                const offset = k === axis ? side * kFocusReach * scene.circumradius : 0;
                return slice.position[k]! + scene.scale * (point[k]! + offset);
            });
            return viewCamera.project(place as Vector);
        });
        if (!from || !to) continue;
        pen.strokeStyle = cssColor(scene.colors.axes[axis]);
        pen.beginPath();
        pen.moveTo(from.x, from.y);
        pen.lineTo(to.x, to.y);
        pen.stroke();
    }
    pen.lineCap = "butt";
}

function drawAxisNames({ pen, matrix, scene, viewport }: MatrixPanelDrawingContext): void {
    const panel = matrix.panel * viewport.height;
    const digits = setFontAndMeasureDigits(pen, kNameHeight * panel);
    const axes = kAxes.map((name, axis) => ({ name, color: scene.colors.axes[axis]!, ...axisNameCenter(matrix, axis, viewport) }));
    for (const { name, color, x, y } of axes) {
        pen.fillStyle = cssColor(color);
        pen.fillText(name, Math.round(x), Math.round(y + digits / 2));
    }
    const unitDigits = setFontAndMeasureDigits(pen, kUnitHeight * panel);
    for (const { name, color, x, y } of axes) {
        const unit = scene.units?.[name];
        if (unit === undefined || pen.measureText(unit).width > panel) continue;
        pen.fillStyle = cssColor(color);
        pen.fillText(unit, Math.round(x), Math.round(y + digits / 2 + 1.8 * unitDigits));
    }
}

function drawPanel(panel: MatrixPanel, context: MatrixPanelDrawingContext): void {
    const { pen, matrix, scene, viewport } = context;
    const { shown, colors } = scene;
    const box = boxOf(panel);
    pen.globalAlpha = kPanelOpacity;
    pen.fillStyle = cssColor(colors.zero);
    pen.beginPath();
    pen.roundRect(box.left, box.top, box.width, box.height, kCorner * matrix.panel * viewport.height);
    pen.fill();
    const points = panel.section.points.map((point) => panel.pixelOf(point));
    if (shown.faces) drawFill(panel, points, context);
    drawFocusLines(panel, box, context);
    drawContours(panel, context);
    if (shown.bars) drawEdges(panel, points, context);
    if (shown.balls || panel.section.balls) drawPoints(panel, points, context);
}

type Box = ReturnType<typeof boxOf>;
type PixelPosition = [x: number, y: number];

function boxOf({ x, y, half }: MatrixPanel) {
    const [left, top, right, bottom] = [x - half, y - half, x + half, y + half].map(Math.round) as Quadruple;
    return { left, top, right, bottom, width: right - left, height: bottom - top };
}

type Quadruple = [number, number, number, number];

/** Fills the section of a convex polytope. Does nothing if the edges of the section do not form one closed polygon. */
function drawFill({ section: { boundary } }: MatrixPanel, points: PixelPosition[], { pen, scene }: MatrixPanelDrawingContext): void {
    // The opacity is 1 if the polytope may be nonconvex (see `opacity` in protocol/README.md).
    const isConvex = scene.opacity < 1;
    if (boundary.length === 0 || !isConvex) return;
    pen.globalAlpha = kFillOpacity;
    pen.fillStyle = cssColor(scene.colors.ball);
    pen.beginPath();
    for (const p of boundary) pen.lineTo(...points[p]!);
    pen.fill();
}

/**
 * Draws two lines through the focus point, along the two axes of the panel. Along one line, the panel's plane meets the
 * planes of the other panels in its column; along the other line, those in its row.
 */
function drawFocusLines(panel: MatrixPanel, box: Box, { pen, matrix, scene, viewport }: MatrixPanelDrawingContext): void {
    const { row, column, section } = panel;
    const [first, second] = section.axes;
    const [x, y] = panel.pixelOf([matrix.point[first]!, matrix.point[second]!]);
    const width = Math.max(1, Math.round(kFocusLine * viewport.height));
    pen.globalAlpha = kAxisOpacity;
    if (y > box.top && y < box.bottom) {
        pen.fillStyle = cssColor(scene.colors.axes[column]!);
        pen.fillRect(box.left, y - width / 2, box.width, width);
    }
    if (x > box.left && x < box.right) {
        pen.fillStyle = cssColor(scene.colors.axes[row]!);
        pen.fillRect(x - width / 2, box.top, width, box.height);
    }
}

function drawContours(panel: MatrixPanel, { pen, matrix, scene, viewport }: MatrixPanelDrawingContext): void {
    pen.globalAlpha = 1;
    pen.lineWidth = Math.max(1, matrix.line_width * viewport.height);
    pen.lineCap = pen.lineJoin = "round";
    for (const { level, points } of panel.section.contours ?? []) {
        const look = scene.surfaces?.find((one) => one.level === level);
        pen.strokeStyle = cssColor(look?.color ?? scene.colors.bar);
        pen.beginPath();
        for (const point of points) pen.lineTo(...panel.pixelOf(point));
        pen.stroke();
    }
    pen.lineCap = "butt";
    pen.lineJoin = "miter";
}

function drawEdges(
    { section }: MatrixPanel,
    points: PixelPosition[],
    { pen, matrix, scene, viewport, highlighted }: MatrixPanelDrawingContext,
): void {
    const opacities = [0, scene.faded, 1];
    pen.lineWidth = Math.max(1, matrix.line_width * viewport.height);
    pen.lineCap = "round";
    section.edges.forEach(([from, to], e) => {
        const opacity = opacities[section.seen?.edges[e] ?? 2]!;
        if (opacity === 0) return;
        pen.globalAlpha = opacity;
        pen.strokeStyle = cssColor(cellColor(section.tints[e]!, scene.colors, highlighted));
        pen.beginPath();
        pen.moveTo(...points[from]!);
        pen.lineTo(...points[to]!);
        pen.stroke();
    });
    pen.lineCap = "butt";
}

function drawPoints({ section }: MatrixPanel, points: PixelPosition[], context: MatrixPanelDrawingContext): void {
    const { pen, matrix, scene, viewport, highlighted, counts } = context;
    const { balls, of, seen } = section;
    const opacities = [0, scene.faded, 1];
    points.forEach(([x, y], i) => {
        const opacity = opacities[seen?.points[i] ?? 2]! * (balls?.opacity[i] ?? 1);
        if (opacity === 0) return;
        const isLit = isPointHighlighted(of.points[i]!, highlighted, counts);
        pen.globalAlpha = opacity;
        pen.fillStyle = cssColor(isLit ? scene.colors.highlight : scene.colors.ball);
        pen.beginPath();
        pen.arc(x, y, Math.max(1, matrix.ball * viewport.height * (balls?.scale[i] ?? 1)), 0, 2 * Math.PI);
        pen.fill();
    });
}
