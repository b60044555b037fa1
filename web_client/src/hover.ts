// Reports where a mouse or pen hovers over a part of the page.

/** A point of an area of the page: x to the right and y down from the area's upper left corner, in CSS pixels. */
export interface AreaPoint {
    x: number;
    y: number;
}

/**
 * Calls `moved` with the place of the pointer in `area` whenever the pointer moves. The place is undefined if the
 * pointer leaves `area`, has a button down, or is a finger.
 */
export function followHover(area: HTMLElement, moved: (at: AreaPoint | undefined) => void): void {
    const follow = ({ pointerType, buttons, clientX, clientY }: PointerEvent): void => {
        const { left, top } = area.getBoundingClientRect();
        moved(pointerType === "touch" || buttons !== 0 ? undefined : { x: clientX - left, y: clientY - top });
    };
    area.addEventListener("pointermove", follow);
    area.addEventListener("pointerup", follow);
    area.addEventListener("pointerdown", () => moved(undefined));
    area.addEventListener("pointerleave", () => moved(undefined));
}
