// Draws the parallel coordinates at the bottom of the picture. Each vertex has four vertical lines, which show its
// coordinates. If there are many vertices, a density strip replaces these lines: each vertex is then a line that joins
// its coordinates on four axes. The strip shows how many of these lines pass through each point. Only highlighted
// vertices then have visible lines. For a field, four histograms show how its values are distributed along each axis.

import type { AxisUnits, HistogramScales, SceneDescription, Slices, Viewport } from "@oval4d/protocol";

import { DensityImage } from "./density_image";
import { drawLinesOverDensityStrip, vertexInDensityStripAt } from "./density_strip_lines";
import type { HighlightedElements } from "./highlighted_elements";
import { cssColor, setFontAndMeasureDigits } from "./pen";

const kHighlightOpacity = 0.35; // the opacity of the bands behind highlighted vertices
const kLevelOpacity = 0.8; // the opacity of the lines of levels in a histogram
const kPlateOpacity = 0.6; // the opacity of the plate behind the quantity's name
const kFocusMark = 0.009; // half the width of the mark at the focus slice's w, as a fraction of the viewport's height

const density = new DensityImage();

/**
 * Draws the parallel coordinates, the density strip or the histograms of a picture. `leastText` is the least font size
 * of names, in canvas pixels.
 */
export function drawCoordinates(
    pen: CanvasRenderingContext2D,
    picture: Slices,
    viewport: Viewport,
    leastText: number,
    highlighted: HighlightedElements,
): void {
    if (picture.histogram) drawHistogram(pen, picture, picture.histogram, viewport, leastText);
    else if (picture.scene.coordinates.columns > 0) drawDensityStrip(pen, picture, viewport, leastText, highlighted);
    else drawLines(pen, picture, viewport, leastText, highlighted);
}

/**
 * The vertex whose parallel coordinates are at the pixel (x, y); undefined if there is none, or if a histogram or
 * nothing is drawn. For density strips, see vertexInDensityStripAt(). Otherwise, each vertex has a band, the rectangle
 * around its four lines that drawLines() fills to highlight it; the pixel must lie in this band.
 * ElementPicker::pickCoordinates() in pick.cpp finds the same vertex.
 */
export function vertexInCoordinatesAt(picture: Slices, { height }: Viewport, x: number, y: number): number | undefined {
    const { coordinates: values, scene } = picture;
    const { columns, per_row: perRow, rows, amplitude, ...layout } = scene.coordinates;
    if (!scene.shown.coordinates || layout.panel > 0) return undefined;
    if (columns > 0) return vertexInDensityStripAt(picture, x / height, 1 - y / height);
    const fromFirst = x / height - (layout.left - layout.line_step / 2);
    const column = Math.floor(fromFirst / layout.column_step);
    // The distance below the zero line of the first row, in viewport heights.
    const belowTop = layout.zero - (1 - y / height);
    const row = Math.round(belowTop / layout.row_step);
    const vertex = row * perRow + column;
    const isInTable = column >= 0 && column < perRow && row >= 0 && row < rows;
    const isInRow = Math.abs(belowTop - row * layout.row_step) <= amplitude;
    const isInColumn = fromFirst - column * layout.column_step <= 4 * layout.line_step + layout.line_width;
    return isInTable && isInRow && isInColumn && vertex < values.length / 4 ? vertex : undefined;
}

function drawLines(
    pen: CanvasRenderingContext2D,
    { coordinates: values, scene }: Slices,
    viewport: Viewport,
    leastText: number,
    highlighted: HighlightedElements,
): void {
    const { height } = viewport;
    const { per_row: perRow, amplitude, named, ...layout } = scene.coordinates;
    const [left, columnStep, lineStep] = [layout.left * height, layout.column_step * height, layout.line_step * height];
    const thickness = layout.line_width * height;
    // Lines at least one pixel wide are sharpest at whole pixels.
    const snap = (x: number): number => (thickness >= 1 ? Math.round(x) : x);
    const zeroOf = (row: number): number => height - Math.round((layout.zero - row * layout.row_step) * height);
    const count = values.length / 4;

    pen.fillStyle = cssColor(scene.colors.zero);
    for (let row = 0; row * perRow < count; ++row) {
        const columns = Math.min(perRow, count - row * perRow);
        pen.fillRect(snap(left), zeroOf(row) - 0.5, snap((columns - 1) * columnStep + 3 * lineStep + thickness), 1);
    }
    pen.fillStyle = cssColor(scene.colors.highlight);
    pen.globalAlpha = kHighlightOpacity;
    for (const i of highlighted.ownVertices) {
        const column = left + (i % perRow) * columnStep;
        const [from, to] = [snap(column - lineStep / 2), snap(column + 3.5 * lineStep + thickness)];
        pen.fillRect(from, zeroOf(Math.floor(i / perRow)) - amplitude * height, to - from, 2 * amplitude * height);
    }
    pen.globalAlpha = 1;
    const unit = (amplitude * height) / scene.circumradius;
    for (let k = 0; k < 4; ++k) {
        pen.fillStyle = cssColor(scene.colors.axes[k]!);
        pen.beginPath();
        for (let i = 0; i < count; ++i) {
            const x = snap(left + (i % perRow) * columnStep + k * lineStep);
            pen.rect(x, zeroOf(Math.floor(i / perRow)), snap(thickness), -values[4 * i + k]! * unit);
        }
        pen.fill();
    }
    if (!named) return;
    const wanted = 0.85 * scene.text * height;
    const digits = setFontAndMeasureDigits(pen, Math.max(wanted, leastText));
    // Enlarged names need more room, so only some of them are drawn.
    const every = wanted < leastText ? Math.ceil((3 * leastText) / columnStep) : 1;
    pen.fillStyle = cssColor(scene.colors.text);
    const lastRow = Math.floor((count - 1) / perRow);
    for (let i = 0; i < count; i += every) {
        const row = Math.floor(i / perRow);
        const x = left + (i % perRow) * columnStep + (3 * lineStep + thickness) / 2;
        const y = zeroOf(row) + amplitude * height + 1.4 * digits;
        const isOverNextRow = wanted < leastText && row < lastRow && y > zeroOf(row + 1) - amplitude * height;
        if (!isOverNextRow) drawLabelText(pen, `P${i}`, x, y, viewport);
    }
}

/** Draws a name centered at x with its baseline at y. Draws nothing if an edge of the picture would cut the name. */
function drawLabelText(pen: CanvasRenderingContext2D, name: string, x: number, y: number, { width, height }: Viewport): void {
    const half = pen.measureText(name).width / 2;
    if (x >= half && x <= width - half && Math.round(y) <= height) pen.fillText(name, Math.round(x), Math.round(y));
}

function drawDensityStrip(
    pen: CanvasRenderingContext2D,
    picture: Slices,
    viewport: Viewport,
    leastText: number,
    highlighted: HighlightedElements,
): void {
    const { height } = viewport;
    const { colors, circumradius, coordinates: layout, text } = picture.scene;
    const [zero, amplitude] = [(1 - layout.zero) * height, layout.amplitude * height];
    const centerOf = (k: number): number => (layout.left + k * layout.line_step + layout.line_width / 2) * height;
    density.update(picture);
    density.draw(pen, centerOf(0), zero - amplitude, centerOf(3) - centerOf(0), 2 * amplitude);

    const thickness = Math.max(1, Math.round(layout.line_width * height));
    const digits = setFontAndMeasureDigits(pen, Math.max(0.85 * text * height, leastText));
    for (let k = 0; k < 4; ++k) {
        const left = Math.round(centerOf(k) - thickness / 2);
        pen.fillStyle = cssColor(colors.axes[k]!);
        pen.fillRect(left, zero - amplitude, thickness, 2 * amplitude);
        if (layout.named) drawLabelText(pen, "xyzw"[k]!, left + thickness / 2, zero + amplitude + 1.4 * digits, viewport);
    }
    drawLinesOverDensityStrip(pen, picture, viewport, highlighted.ownVertices);
    const focus = picture.slices.find((slice) => slice.focus);
    if (!focus || Math.abs(focus.w) > circumradius) return;
    const level = Math.round(zero - (focus.w / circumradius) * amplitude);
    pen.fillStyle = cssColor(colors.focus);
    pen.fillRect(centerOf(3) - kFocusMark * height, level - thickness / 2, 2 * kFocusMark * height, thickness);
}

function drawHistogram(
    pen: CanvasRenderingContext2D,
    picture: Slices,
    { reach, range: [least, greatest], levels, quantity }: HistogramScales,
    viewport: Viewport,
    leastText: number,
): void {
    const { height } = viewport;
    const { colors, coordinates: layout, text, units = {} } = picture.scene;
    const [zero, amplitude] = [(1 - layout.zero) * height, layout.amplitude * height];
    const [top, bottom] = [Math.round(zero - amplitude), Math.round(zero + amplitude)];
    const leftOf = (k: number): number => (layout.left + k * layout.line_step) * height;
    const width = layout.panel * height;
    density.update(picture);
    for (let k = 0; k < 4; ++k) density.drawHistogramPanel(pen, k, leftOf(k), zero - amplitude, width, 2 * amplitude);

    const thickness = Math.max(1, Math.round(layout.line_width * height));
    const focus = picture.slices.find((slice) => slice.focus);
    if (focus && Math.abs(focus.w) <= reach[3]) {
        pen.fillStyle = cssColor(colors.focus);
        const left = Math.round(leftOf(3) + ((focus.w / reach[3] + 1) / 2) * width - thickness / 2);
        pen.fillRect(left, top, thickness, bottom - top);
    }
    const digits = setFontAndMeasureDigits(pen, Math.max(0.85 * text * height, leastText));
    for (let k = 0; k < 4; ++k) {
        const left = Math.round(leftOf(k));
        pen.globalAlpha = kLevelOpacity;
        for (const { value, color } of levels) {
            const level = bottom - ((value - least) / (greatest - least)) * (bottom - top);
            pen.fillStyle = cssColor(color);
            pen.fillRect(left, Math.round(level - thickness / 2), width, thickness);
        }
        pen.globalAlpha = 1;
        pen.fillStyle = cssColor(colors.axes[k]!);
        pen.fillRect(left, bottom, width, thickness);
        const label = axisLabel(k, units);
        const fits = pen.measureText(label).width <= width;
        drawLabelText(pen, fits ? label : label.slice(0, 1), left + width / 2, bottom + 1.4 * digits, viewport);
    }
    const edges = { left: Math.round(leftOf(0)), right: Math.round(leftOf(3)) + width, top };
    if (quantity !== undefined) drawQuantity(pen, quantity, edges, digits, colors);
}

/** The name of an axis and its unit, such as "x, m"; the name alone if the unit is not known. */
function axisLabel(axis: number, units: AxisUnits): string {
    const name = (["x", "y", "z", "w"] as const)[axis]!;
    const unit = units[name];
    return unit === undefined ? name : `${name}, ${unit}`;
}

/**
 * Draws the name of the quantity that the values measure, in the upper left corner of the histogram. Draws nothing if
 * the name is wider than the histogram. A plate in the background color keeps the name legible.
 */
function drawQuantity(
    pen: CanvasRenderingContext2D,
    quantity: string,
    { left, right, top }: { left: number; right: number; top: number },
    digits: number,
    colors: SceneDescription["colors"],
): void {
    const { width } = pen.measureText(quantity);
    const margin = Math.round(digits / 2);
    if (width + 2 * margin > right - left) return;
    pen.globalAlpha = kPlateOpacity;
    pen.fillStyle = cssColor(colors.background);
    pen.fillRect(left, top, width + 2 * margin, digits + 2 * margin);
    pen.globalAlpha = 1;
    pen.fillStyle = cssColor(colors.text);
    pen.fillText(quantity, Math.round(left + margin + width / 2), Math.round(top + margin + digits));
}
