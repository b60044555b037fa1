// What stands beside the slices and explains them: axes, labels and the parallel coordinates. All in the canvas's own
// pixels, so that lines stay sharp.

import type { SceneDescription, Slice, Slices, Viewport } from "@oval4d/protocol";

import { drawCoordinates } from "./coordinates";
import type { Lens } from "./lens";
import { css, kLeastText, setFont } from "./pen";

export function drawOverlay(pen: CanvasRenderingContext2D, picture: Slices, lens: Lens, viewport: Viewport): void {
    const { scene, slices } = picture;
    pen.clearRect(0, 0, viewport.width, viewport.height);
    pen.textAlign = "center";
    pen.textBaseline = "alphabetic";
    if (scene.shown.coordinates) drawCoordinates(pen, picture, viewport);
    drawLabels(pen, slices, scene, lens, viewport);
    drawAxes(pen, scene, lens, viewport);
}

/** The w under each slice. Where letters would be too small to read they are larger, and some are left out. */
function drawLabels(
    pen: CanvasRenderingContext2D,
    slices: Slice[],
    scene: SceneDescription,
    lens: Lens,
    viewport: Viewport,
): void {
    const least = kLeastText * devicePixelRatio;
    const taken: { x: number; y: number; half: number; height: number }[] = [];
    const labelled = slices.filter((slice) => slice.drawn && slice.label !== "");
    labelled.sort((a, b) => Number(b.focus) - Number(a.focus) || Math.abs(a.position[0]) - Math.abs(b.position[0]));
    for (const slice of labelled) {
        const at = lens.project(slice.label_at);
        if (!at) continue;
        const size = scene.text * slice.label_size * viewport.height;
        const digits = setFont(pen, Math.max(size, least));
        const box = { ...at, half: pen.measureText(slice.label).width / 2, height: digits };
        if (size < least) {
            const apart = (one: typeof box): boolean =>
                Math.abs(one.x - box.x) > one.half + box.half + digits / 2 || Math.abs(one.y - box.y) > 1.5 * digits;
            if (!taken.every(apart)) continue;
        }
        taken.push(box);
        drawLabel(pen, slice, scene, box);
    }
}

function drawLabel(
    pen: CanvasRenderingContext2D,
    { label, focus }: Slice,
    { colors }: SceneDescription,
    { x: middle, y, half: textHalf, height: digits }: { x: number; y: number; half: number; height: number },
): void {
    const x = Math.round(middle);
    const baseline = Math.round(y + digits);
    if (focus) {
        const half = Math.round(textHalf + 0.7 * digits);
        const margin = Math.round(0.55 * digits);
        const height = digits + 2 * margin;
        pen.fillStyle = css(colors.focus);
        pen.globalAlpha = 0.16;
        pen.beginPath();
        pen.roundRect(x - half, baseline - digits - margin, 2 * half, height, height / 2);
        pen.fill();
        pen.globalAlpha = 1;
    }
    pen.fillStyle = css(focus ? colors.focus : colors.text);
    pen.fillText(label, x, baseline);
}

/** The x, y and z axes as the camera sees them, far ones first. */
function drawAxes(pen: CanvasRenderingContext2D, scene: SceneDescription, lens: Lens, viewport: Viewport): void {
    const length = scene.axes.length * viewport.height;
    const [x, y] = [scene.axes.x * viewport.height, scene.axes.y * viewport.height];
    const ball = (atX: number, atY: number, radius: number, colour: string): void => {
        pen.fillStyle = colour;
        pen.beginPath();
        pen.arc(atX, atY, radius * length, 0, 2 * Math.PI);
        pen.fill();
    };
    const axes = ([0, 1, 2] as const).map((i) => {
        return { direction: lens.axis(i), colour: css(scene.colors.axes[i]), name: "xyz"[i]! };
    });
    axes.sort((a, b) => a.direction.z - b.direction.z);
    const digits = setFont(pen, scene.text * viewport.height);
    const paint = ({ direction, colour, name }: (typeof axes)[number]): void => {
        const [tipX, tipY] = [x + direction.x * length, y - direction.y * length];
        pen.strokeStyle = colour;
        pen.lineWidth = 0.09 * length;
        pen.beginPath();
        pen.moveTo(x, y);
        pen.lineTo(tipX, tipY);
        pen.stroke();
        ball(tipX, tipY, 0.065, colour);
        // An axis that points at the viewer has its name beside it.
        const across = Math.hypot(direction.x, direction.y);
        const [nameX, nameY] = across * 1.28 < 0.3 ? [0.3, -0.3] : [direction.x * 1.28, direction.y * 1.28];
        pen.fillText(name, Math.round(x + nameX * length), Math.round(y - nameY * length + 0.4 * digits));
    };
    for (const axis of axes) if (axis.direction.z <= 0) paint(axis);
    ball(x, y, 0.1, css(scene.colors.text));
    for (const axis of axes) if (axis.direction.z > 0) paint(axis);
}
