// Mouse, pen and touch gestures on the drawing:
// - A drag orbits the view; in a panel of the matrix, it moves the focus point. The wheel or a pinch zooms.
// - A click keeps the element under the pointer highlighted. A right click or a long press opens the element's menu.
// - A drag with the right or middle button, with Alt, or with two fingers rolls the 4-D ball (see rolling_ball.ts).
// - The same drag with Shift, or a drag with three fingers, rolls the 3-D ball of every slice.

import type { FocusPointDrag } from "./focus_point_drag";
import type { AreaPoint } from "./hover";
import { MultiTouchGesture } from "./multi_touch_gesture";
import type { OrbitControl } from "./orbit";
import { type RollingBallKind, turnsOfDrag, turnsOfTwist, turnsOfWheel } from "./rolling_ball";
import type { RotationSender } from "./rotation";

const kWheelZoom = 0.0015; // change of the logarithm of the zoom per pixel of the wheel
const kLineHeight = 16; // pixels per line, for wheels that report lines
const kWheelPause = 400; // milliseconds without a wheel event after which a gesture has ended
const kLongPress = 600; // milliseconds of a touch after which the menu of an element opens
const kButtons = { left: 0, middle: 1, right: 2 }; // values of MouseEvent.button
const kSlop = { mouse: 4, touch: 10 }; // the most pixels by which the pointer may move during a click

export interface GestureTargets {
    orbit: OrbitControl;
    rotation: RotationSender;
    focusPoint: FocusPointDrag;
    /** A click, or the tap of a finger, at a point of the drawing. */
    click(at: AreaPoint, isTap: boolean): void;
    /** A click with the right button, or a long press of a finger, at a point. Resolves to whether a menu opened. */
    highlightAndOpenMenu(at: AreaPoint): Promise<boolean>;
}

export function listenForGestures(drawing: HTMLElement, targets: GestureTargets): void {
    const { orbit, rotation, focusPoint } = targets;
    const fingers = new Map<number, PointerEvent>();
    let longPress: ReturnType<typeof setTimeout> | undefined;
    let isLongPress = false; // whether the last touch was long enough to open the menu
    let isMenuOpen = false; // whether the last long press has opened the menu
    let isClick = false; // whether the pointer has stayed in its place since it went down
    let isRolling = false; // whether the drag began with Alt, or with another button than the left one
    let movesPoint = false; // whether the drag began in a panel of the matrix
    // The gesture of two or three fingers; undefined for other numbers of fingers.
    let group: MultiTouchGesture | undefined;
    const moved = new Set<number>(); // the fingers that have moved since the last call of moveGroup()
    let wheelAt = -Infinity; // time of the last wheel event that turned the polytope, in milliseconds

    const placeOf = ({ clientX, clientY }: MouseEvent): AreaPoint => {
        const { left, top } = drawing.getBoundingClientRect();
        return { x: clientX - left, y: clientY - top };
    };
    const fingersChanged = (): void => {
        moved.clear();
        group = fingers.size === 2 || fingers.size === 3 ? new MultiTouchGesture([...fingers.values()]) : undefined;
        if (group) rotation.beginGesture();
    };
    const drag = (before: PointerEvent, now: PointerEvent): void => {
        const [dx, dy] = [now.clientX - before.clientX, now.clientY - before.clientY];
        if (isRolling) rotation.turn(turnsOfDrag(rolledBallOf(now), dx, dy, drawing.clientHeight));
        else if (movesPoint) focusPoint.dragTo(placeOf(now));
        else orbit.drag(dx, dy);
    };
    const moveGroup = (): void => {
        if (!group || moved.size === 0) return;
        moved.clear();
        const { dx, dy, spread, twist } = group.update([...fingers.values()]);
        const ball = fingers.size === 2 ? "4-D" : "3-D";
        if (fingers.size === 2) orbit.zoomBy(spread);
        rotation.turn({ ...turnsOfDrag(ball, dx, dy, drawing.clientHeight), ...turnsOfTwist(ball, twist) });
    };
    drawing.addEventListener("pointerdown", (event) => {
        if (event.button > kButtons.right) return;
        fingers.set(event.pointerId, event);
        drawing.setPointerCapture(event.pointerId);
        drawing.focus({ preventScroll: true });
        isClick = fingers.size === 1;
        isRolling = (event.altKey || event.button !== kButtons.left) && fingers.size === 1;
        if (isRolling) rotation.beginGesture();
        movesPoint = isClick && !isRolling && focusPoint.begin(placeOf(event));
        fingersChanged();
        clearTimeout(longPress);
        isLongPress = isMenuOpen = false;
        if (event.pointerType !== "touch" || !isClick) return;
        longPress = setTimeout(() => {
            if (!isClick) return;
            isClick = false;
            isLongPress = true;
            void targets.highlightAndOpenMenu(placeOf(event)).then((hasOpened) => (isMenuOpen = hasOpened));
        }, kLongPress);
    });
    // Suppresses the mouse events that follow a long press: they would take the focus from the menu.
    drawing.addEventListener("touchend", (event) => isLongPress && event.cancelable && event.preventDefault(), {
        passive: false,
    });
    drawing.addEventListener("pointerup", (event) => {
        if (isClick && event.button === kButtons.right) void targets.highlightAndOpenMenu(placeOf(event));
    });
    // The browser's own menu must not open. Some systems open it when the button goes down, others when it is released.
    drawing.addEventListener("contextmenu", (event) => event.preventDefault());
    drawing.addEventListener("mousedown", (event) => {
        if (event.button === kButtons.middle) event.preventDefault(); // keeps the browser from scrolling
    });
    drawing.addEventListener("pointermove", (event) => {
        const before = fingers.get(event.pointerId);
        if (!before || isMenuOpen) return;
        const slop = event.pointerType === "mouse" ? kSlop.mouse : kSlop.touch;
        const distance = Math.hypot(event.clientX - before.clientX, event.clientY - before.clientY);
        if (isClick && distance < slop) return;
        isClick = false;
        fingers.set(event.pointerId, event);
        if (group) {
            // Fingers that move together have an event each. Before the last of these events, the fingers seem to
            // spread and to twist.
            const isAgain = moved.has(event.pointerId);
            moved.add(event.pointerId);
            if (isAgain || moved.size === fingers.size) moveGroup();
        } else if (fingers.size === 1) drag(before, event);
    });
    const removeFinger = (event: PointerEvent): void => {
        clearTimeout(longPress);
        moveGroup();
        if (fingers.delete(event.pointerId)) fingersChanged();
    };
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"] as const)
        drawing.addEventListener(end, removeFinger);
    drawing.addEventListener("click", (event) => {
        // The second click of a double click does not count as a click.
        if (!isClick || event.detail !== 1 || hasModifierKey(event)) return;
        targets.click(placeOf(event), (event as PointerEvent).pointerType === "touch");
    });
    drawing.addEventListener(
        "wheel",
        (event) => {
            if (event.ctrlKey) return; // the browser zooms the page
            event.preventDefault();
            const delta = event.deltaY || event.deltaX; // while Shift is held, some systems report deltaX instead
            const pixels = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? delta : delta * kLineHeight;
            if (!event.altKey) {
                orbit.zoomBy(Math.exp(-pixels * kWheelZoom));
                return;
            }
            if (event.timeStamp - wheelAt > kWheelPause) rotation.beginGesture();
            wheelAt = event.timeStamp;
            rotation.turn(turnsOfWheel(rolledBallOf(event), pixels));
        },
        { passive: false },
    );
    drawing.addEventListener("dblclick", (event) => {
        if (!hasModifierKey(event) && !focusPoint.canMoveTo(placeOf(event))) orbit.reset();
    });
}

function rolledBallOf({ shiftKey }: MouseEvent): RollingBallKind {
    return shiftKey ? "3-D" : "4-D";
}

function hasModifierKey({ ctrlKey, altKey, metaKey, shiftKey }: MouseEvent): boolean {
    return ctrlKey || altKey || metaKey || shiftKey;
}
