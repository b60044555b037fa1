// Draws the axes, labels, parallel coordinates and matrix of planar sections over the picture. Rounds positions to
// whole pixels, so that lines are sharp.

import type { SceneDescription, Slice, Slices, Viewport } from "@oval4d/protocol";

import { drawCoordinates } from "./coordinates";
import type { ElementCounts, HighlightedElements } from "./highlighted_elements";
import { drawMatrix } from "./matrix_drawing";
import { cssColor, setFontAndMeasureDigits } from "./pen";
import type { ViewCamera } from "./view_camera";

/** Draws everything that lies over the slices. `leastText` is the least font size of labels, in canvas pixels. */
export function drawOverlay(
    pen: CanvasRenderingContext2D,
    picture: Slices,
    viewCamera: ViewCamera,
    viewport: Viewport,
    leastText: number,
    highlighted: HighlightedElements,
    counts: ElementCounts,
): void {
    const { scene, slices } = picture;
    pen.clearRect(0, 0, viewport.width, viewport.height);
    pen.textAlign = "center";
    pen.textBaseline = "alphabetic";
    if (scene.shown.coordinates && viewCamera.isMoved) clearCoordinatesArea(pen, scene, viewport);
    if (scene.shown.coordinates) drawCoordinates(pen, picture, viewport, leastText, highlighted);
    drawLabels(pen, slices, scene, viewCamera, viewport, leastText);
    drawAxes(pen, scene, viewCamera, viewport, leastText);
    drawMatrix(pen, picture, viewCamera, viewport, highlighted, counts);
}

/**
 * The height of the parallel coordinates, from the bottom of the picture to their upper edge, in pixels.
 * ParallelCoordinatesLayout::top() in C++ computes the same height.
 */
export function heightOfCoordinates({ coordinates: { zero, amplitude } }: SceneDescription, { height }: Viewport): number {
    return (zero + amplitude + 0.01) * height;
}

/**
 * Covers the parts of slices that extend into the parallel coordinates. This happens only after the viewer has moved
 * the camera.
 */
function clearCoordinatesArea(pen: CanvasRenderingContext2D, scene: SceneDescription, viewport: Viewport): void {
    const top = Math.round(heightOfCoordinates(scene, viewport));
    pen.fillStyle = cssColor(scene.colors.background);
    pen.fillRect(0, viewport.height - top, viewport.width, top);
}

/** The label of a slice, with its position in the picture. All lengths are in canvas pixels. */
interface PlacedSliceLabel {
    slice: Slice;
    x: number;
    y: number;
    size: number; // font size
    digits: number; // height of the digits
    half: number; // half the width of the text
    room: number; // half the width that the label reserves for itself
}

/**
 * Draws the labels of the slices. Enlarges labels that are too small to read. Omits a label that an edge of the picture
 * would cut. Also omits a label that overlaps the label of a slice nearer to the focus slice. Always draws the label of
 * the focus slice.
 */
function drawLabels(
    pen: CanvasRenderingContext2D,
    slices: Slice[],
    scene: SceneDescription,
    viewCamera: ViewCamera,
    viewport: Viewport,
    leastText: number,
): void {
    const placed: PlacedSliceLabel[] = [];
    const bottom =
        scene.shown.coordinates && viewCamera.isMoved
            ? viewport.height - heightOfCoordinates(scene, viewport)
            : viewport.height;
    const labeled = slices.filter((slice) => slice.drawn && slice.label !== "");
    // Each label reserves the width of the widest label. Otherwise minus signs would cause more omitted labels on one
    // side of the focus slice than on the other.
    const sample = 100; // the font size at which the labels are measured
    setFontAndMeasureDigits(pen, sample);
    const widest = Math.max(...labeled.map((slice) => (slice.focus ? 0 : pen.measureText(slice.label).width / sample)));
    // Labels nearer to the focus slice are placed first. At equal distances, the first in `slices` comes first, as in
    // LabelLayout::removeOverlappingLabels() in C++.
    const focusIndex = slices.find((slice) => slice.focus)?.index ?? 0;
    const fromFocus = ({ index }: Slice): number => Math.abs(index - focusIndex);
    labeled.sort((a, b) => fromFocus(a) - fromFocus(b));
    for (const slice of labeled) {
        const at = viewCamera.project(slice.label_at);
        if (!at) continue;
        const wanted = scene.text * slice.label_size * viewport.height;
        const size = Math.max(wanted, leastText);
        const digits = setFontAndMeasureDigits(pen, size);
        const half = pen.measureText(slice.label).width / 2;
        const label = { slice, ...at, size, digits, half, room: Math.max(half, (widest * size) / 2) };
        const whole =
            label.x >= label.half &&
            label.x <= viewport.width - label.half &&
            label.y >= 0 &&
            label.y <= bottom - digits;
        const apart = (other: PlacedSliceLabel): boolean =>
            Math.abs(other.x - label.x) > other.room + label.room + digits / 2 ||
            Math.abs(other.y - label.y) > 1.1 * digits;
        if (slice.focus || (whole && placed.every(apart))) placed.push(label);
    }
    // The label of the focus slice is drawn last, on top.
    for (const label of placed.reverse()) drawLabel(pen, scene, label);
}

function drawLabel(pen: CanvasRenderingContext2D, { colors }: SceneDescription, label: PlacedSliceLabel): void {
    const { slice, digits } = label;
    const { focus } = slice;
    setFontAndMeasureDigits(pen, label.size);
    const x = Math.round(label.x);
    const baseline = Math.round(label.y + digits);
    // A background behind the label keeps it legible over another slice.
    const half = Math.round(label.half) + Math.round((focus ? 0.9 : 0.25) * digits);
    const margin = Math.round((focus ? 0.6 : 0.13) * digits);
    const height = digits + 2 * margin;
    pen.beginPath();
    pen.roundRect(x - half, baseline - digits - margin, 2 * half, height, height / 2);
    const fill = (color: number, opacity: number): void => {
        pen.fillStyle = cssColor(color);
        pen.globalAlpha = opacity;
        pen.fill();
    };
    fill(colors.background, focus ? 0.8 : 0.6);
    if (focus) fill(colors.focus, 0.16);
    pen.globalAlpha = 1;
    pen.fillStyle = cssColor(focus ? colors.focus : colors.text);
    pen.fillText(slice.label, x, baseline);
}

/**
 * Draws the axes x, y and z, as the camera sees them, in the upper left corner of the picture. Draws far axes first.
 */
function drawAxes(
    pen: CanvasRenderingContext2D,
    scene: SceneDescription,
    viewCamera: ViewCamera,
    viewport: Viewport,
    leastText: number,
): void {
    const length = scene.axes.length * viewport.height;
    const [x, y] = [scene.axes.x * viewport.height, scene.axes.y * viewport.height];
    const ball = (atX: number, atY: number, radius: number, color: string): void => {
        pen.fillStyle = color;
        pen.beginPath();
        pen.arc(atX, atY, radius * length, 0, 2 * Math.PI);
        pen.fill();
    };
    const axes = ([0, 1, 2] as const).map((i) => {
        return { direction: viewCamera.worldAxisInCamera(i), color: cssColor(scene.colors.axes[i]), name: "xyz"[i]! };
    });
    axes.sort((a, b) => a.direction.z - b.direction.z);
    const digits = setFontAndMeasureDigits(pen, Math.max(scene.text * viewport.height, leastText));
    const paint = ({ direction, color, name }: (typeof axes)[number]): void => {
        const [tipX, tipY] = [x + direction.x * length, y - direction.y * length];
        pen.strokeStyle = color;
        pen.lineWidth = 0.09 * length;
        pen.beginPath();
        pen.moveTo(x, y);
        pen.lineTo(tipX, tipY);
        pen.stroke();
        ball(tipX, tipY, 0.065, color);
        // If an axis points toward the viewer, its name is beside the axis.
        const across = Math.hypot(direction.x, direction.y);
        const [nameX, nameY] = across * 1.28 < 0.3 ? [0.3, -0.3] : [direction.x * 1.28, direction.y * 1.28];
        pen.fillText(name, Math.round(x + nameX * length), Math.round(y - nameY * length + 0.4 * digits));
    };
    for (const axis of axes) if (axis.direction.z <= 0) paint(axis);
    ball(x, y, 0.1, cssColor(scene.colors.text));
    for (const axis of axes) if (axis.direction.z > 0) paint(axis);
}
