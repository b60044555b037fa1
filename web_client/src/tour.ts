// The tour of the page: a panel beside the part that it explains. The page stays usable during the tour. The steps are
// in index.html. Each step lists selectors of elements, and points at the first visible element: at all of it, or at a
// part of its height. A step may also name an object; the picture shows it during the step.

import { byId } from "./element";

const kGap = 12; // pixels between the panel and what it explains, or the edges of the window
const kRingGap = 4; // pixels between the explained part and the ring around it

export class Tour {
    private readonly root = byId("tour");
    private readonly ring = byId("tour-ring");
    private readonly back = byId<HTMLButtonElement>("tour-back");
    private readonly next = byId("tour-next");
    private readonly end = byId("tour-end");
    private readonly steps = [...this.root.querySelectorAll<HTMLElement>("[data-target]")];
    private at = 0;

    /**
     * `showObject` is called at each step with the name of the object to show; without a name if the step shows none,
     * and at the end. `ended` is called after the tour if the focus was in its panel.
     */
    constructor(
        private readonly showObject: (name: string | undefined) => void,
        private readonly ended: () => void,
    ) {
        this.root.addEventListener("mousedown", (event) => event.preventDefault()); // a click does not move the focus
        this.back.addEventListener("click", () => this.show(this.at - 1));
        this.next.addEventListener("click", () => this.show(this.at + 1));
        this.end.addEventListener("click", () => this.stop());
        new ResizeObserver(() => this.place()).observe(byId("drawing"));
        document.addEventListener("scroll", () => this.place(), { capture: true, passive: true });
    }

    start(): void {
        this.root.hidden = false;
        this.next.hidden = false;
        this.next.focus();
        this.show(0);
    }

    stop(): void {
        if (this.root.hidden) return;
        const hadFocus = this.root.contains(document.activeElement);
        this.root.hidden = this.ring.hidden = true;
        this.showObject(undefined);
        if (hadFocus) this.ended();
    }

    private show(at: number): void {
        this.at = at;
        const focused = document.activeElement;
        this.steps.forEach((step, i) => (step.hidden = i !== at));
        byId("tour-number").textContent = `${at + 1} of ${this.steps.length}`;
        this.back.disabled = at === 0;
        this.next.hidden = at === this.steps.length - 1;
        // If the button with the focus can no longer be pressed, another button gets the focus.
        if (focused === this.next && this.next.hidden) this.end.focus();
        if (focused === this.back && this.back.disabled) this.next.focus();
        this.target?.scrollIntoView({ block: "nearest" });
        this.place();
        this.showObject(this.steps[at]!.dataset["object"]);
    }

    /** The element at which the current step points; undefined if none is visible. */
    private get target(): Element | undefined {
        const selectors = this.steps[this.at]!.dataset["target"]!.split(",");
        const found = selectors.map((selector) => document.querySelector(selector));
        return found.find((one) => one?.checkVisibility()) ?? undefined;
    }

    /** Places the ring around the explained part, and the panel beside the ring. */
    private place(): void {
        if (this.root.hidden) return;
        const { from = "0", to = "1" } = this.steps[this.at]!.dataset;
        const { target } = this;
        this.ring.hidden = !target;
        const whole = (target ?? byId("drawing")).getBoundingClientRect();
        const top = Math.max(0, whole.top + Number(from) * whole.height);
        const bottom = Math.min(innerHeight, whole.top + Number(to) * whole.height);
        const box = { left: whole.left, right: whole.right, top, bottom };
        placeRingAround(this.ring, box);
        const { offsetWidth: width, offsetHeight: height } = this.root;
        const middle = { x: (box.left + box.right - width) / 2, y: (top + bottom - height) / 2 };
        const right = innerWidth - kGap - width;
        const lowest = innerHeight - kGap - height;
        const x = clampToWindow(middle.x, right);
        const places = [
            { x: box.left - kGap - width, y: middle.y },
            { x: box.right + kGap, y: middle.y },
            { x, y: bottom + kGap },
            { x, y: top - kGap - height },
        ];
        const fits = (at: { x: number; y: number }): boolean =>
            at.x >= kGap && at.x <= right && at.y >= kGap && at.y <= lowest;
        const place = places.find(fits) ?? { x, y: clampToWindow(top + 0.35 * (bottom - top) - height / 2, lowest) };
        this.root.style.left = `${place.x}px`;
        this.root.style.top = `${place.y}px`;
    }
}

function clampToWindow(value: number, max: number): number {
    return Math.max(kGap, Math.min(value, max));
}

/** A box in the window, in CSS pixels from the window's upper left corner. */
interface WindowBox {
    left: number;
    right: number;
    top: number;
    bottom: number;
}

/** Places the element `one` around a box, kRingGap pixels away from it, but within the window. */
function placeRingAround(one: HTMLElement, box: WindowBox): void {
    const left = Math.max(0, box.left - kRingGap);
    const top = Math.max(0, box.top - kRingGap);
    one.style.left = `${left}px`;
    one.style.top = `${top}px`;
    one.style.width = `${Math.min(innerWidth, box.right + kRingGap) - left}px`;
    one.style.height = `${Math.min(innerHeight, box.bottom + kRingGap) - top}px`;
}
