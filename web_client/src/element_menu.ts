// The menu of an element of the polytope. It offers actions on the element, and opens at a right click or a long press.

import { byId, element } from "./element";
import type { AreaPoint } from "./hover";

/** An item of the menu. The menu calls `act` when the user chooses the item. */
export interface ElementMenuItem {
    label: string;
    act(): void;
}

const kMargin = 4; // the least distance, in pixels, of the menu from the edges of the drawing
const kSteps: Record<string, number> = { ArrowDown: 1, ArrowUp: -1 };

export class ElementMenu {
    private readonly menu = byId("element-menu");
    private at: AreaPoint = { x: 0, y: 0 }; // where the menu was opened

    constructor(private readonly drawing: HTMLElement) {
        document.addEventListener("pointerdown", ({ target }) => this.menu.contains(target as Node) || this.hide());
        this.menu.addEventListener("keydown", (event) => this.keydown(event));
        this.menu.addEventListener("focusout", ({ relatedTarget }) => this.menu.contains(relatedTarget as Node) || this.hide());
        new ResizeObserver(() => this.place()).observe(drawing);
    }

    /** Opens the menu at a point of the drawing, with the focus on its first item. */
    open(title: string, at: AreaPoint, items: ElementMenuItem[]): void {
        const buttons = items.map(({ label, act }) => {
            const button = element("button", { type: "button", role: "menuitem", tabindex: "-1" }, label);
            button.addEventListener("click", () => {
                this.close();
                act();
            });
            return button;
        });
        this.menu.setAttribute("aria-label", title);
        this.menu.replaceChildren(element("b", { role: "presentation" }, title), ...buttons);
        this.menu.hidden = false;
        this.at = at;
        this.place();
        buttons[0]!.focus();
    }

    /** Places the menu at the point where it was opened, but within the drawing. */
    private place(): void {
        const { at } = this;
        const { offsetWidth: width, offsetHeight: height } = this.menu;
        const { clientWidth, clientHeight } = this.drawing;
        const left = Math.max(kMargin, Math.min(at.x, clientWidth - width - kMargin));
        const top = Math.max(kMargin, Math.min(at.y, clientHeight - height - kMargin));
        this.menu.style.transform = `translate(${Math.round(left)}px, ${Math.round(top)}px)`;
    }

    private hide(): void {
        this.menu.hidden = true;
    }

    private close(): void {
        this.hide();
        this.drawing.focus({ preventScroll: true });
    }

    /**
     * Handles keys: Up, Down, Home and End move the focus; Escape and Tab close the menu. Other keys keep their
     * usual effects.
     */
    private keydown(event: KeyboardEvent): void {
        event.stopPropagation();
        const buttons = [...this.menu.querySelectorAll("button")];
        const at = buttons.indexOf(document.activeElement as HTMLButtonElement);
        const step = kSteps[event.key];
        if (event.key === "Escape" || event.key === "Tab") this.close();
        else if (step !== undefined) buttons.at((at + step) % buttons.length)!.focus();
        else if (event.key === "Home") buttons[0]!.focus();
        else if (event.key === "End") buttons.at(-1)!.focus();
        else return;
        event.preventDefault();
    }
}
