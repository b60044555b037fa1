// Mouse, pen and touch on the drawing: dragging orbits the view, the wheel or a pinch zooms.

import type { OrbitControl } from "./orbit";

const kWheelZoom = 0.0015; // change of the logarithm of the zoom per pixel
const kLineHeight = 16; // pixels

export function listenForGestures(drawing: HTMLElement, orbit: OrbitControl): void {
    const fingers = new Map<number, PointerEvent>();
    const fingerDistance = (): number => {
        const [a, b] = [...fingers.values()];
        return a && b ? Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY) : 0;
    };
    drawing.addEventListener("pointerdown", (event) => {
        if (event.button !== 0) return;
        fingers.set(event.pointerId, event);
        drawing.setPointerCapture(event.pointerId);
        drawing.focus({ preventScroll: true });
    });
    drawing.addEventListener("pointermove", (event) => {
        const before = fingers.get(event.pointerId);
        if (!before) return;
        const distanceBefore = fingerDistance();
        fingers.set(event.pointerId, event);
        if (fingers.size === 1) orbit.drag(event.clientX - before.clientX, event.clientY - before.clientY);
        else if (distanceBefore > 0) orbit.zoomBy(fingerDistance() / distanceBefore);
    });
    const removeFinger = (event: PointerEvent): void => void fingers.delete(event.pointerId);
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"] as const)
        drawing.addEventListener(end, removeFinger);
    drawing.addEventListener(
        "wheel",
        (event) => {
            if (event.ctrlKey) return; // the browser's own zoom
            event.preventDefault();
            const pixels = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY : event.deltaY * kLineHeight;
            orbit.zoomBy(Math.exp(-pixels * kWheelZoom));
        },
        { passive: false },
    );
    drawing.addEventListener("dblclick", () => orbit.reset());
}
