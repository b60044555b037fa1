// Handles clicks on the picture, and the menu of the element under the pointer.

import type { Command, PolytopeElement, State } from "@oval4d/protocol";

import { ElementMenu, type ElementMenuItem } from "./element_menu";
import { capitalize } from "./format";
import type { AreaPoint } from "./hover";
import type { HitTester } from "./picture/hit_tester";
import type { Stage } from "./picture/stage";
import { isElement, type PointerHighlighter } from "./pointing";

// CSS pixels: a click this near to the center of a slice hits the slice, however small the slice is.
const kLeastDisc = 12;

interface ClickActions {
    state: () => State | undefined;
    /**
     * Resolves to the hit tester of the shown picture, which finds the element at a pixel. If the server does not send
     * the hit tester, tells the user why, and resolves to undefined.
     */
    hitTester: () => Promise<HitTester | undefined>;
    /** Called at each click, before its effect. */
    began: () => void;
    /**
     * Moves the focus point to the 4-D point that a matrix panel shows at the place `at` of the drawing. Returns false
     * if no panel is at this place.
     */
    moveFocusPoint: (at: AreaPoint) => boolean;
    send: (command: Command) => void;
    exportElement: (element: PolytopeElement) => void;
}

export class ClickHandler {
    private readonly menu: ElementMenu;

    constructor(
        private readonly drawing: HTMLElement,
        private readonly stage: Stage,
        private readonly pointing: PointerHighlighter,
        private readonly actions: ClickActions,
    ) {
        this.menu = new ElementMenu(drawing);
    }

    /**
     * Handles a click at a point, given in pixels of the drawing. The effect depends on what is there:
     * - An element: it is highlighted. If it is in a slice, this slice becomes the focus slice.
     * - A panel of the matrix, but no element: the focus point moves there.
     * - The surface of a field in a slice, or a place near a slice: the slice becomes the focus slice.
     * - The surface in the projection: nothing changes.
     * - The background: the highlight is removed.
     *
     * `isTap` tells that a finger made the click. The name of the element or surface is then shown, too.
     */
    async click({ x, y }: AreaPoint, isTap: boolean): Promise<void> {
        const { orbit, size } = this.stage;
        const ratio = size.height / this.drawing.clientHeight;
        const hitTester = await this.actions.hitTester();
        this.actions.began();
        if (!hitTester) return;
        const pointed = this.pointing.targetAt(x, y, hitTester);
        const element = pointed && isElement(pointed) ? pointed : undefined;
        if (!element && this.actions.moveFocusPoint({ x, y })) return;
        if (pointed && isTap) this.pointing.showTappedName(pointed, hitTester, { x, y });
        const slice = pointed
            ? pointed.slice
            : hitTester.sliceAt(x * ratio, y * ratio, orbit, size, kLeastDisc * ratio);
        const kept = this.actions.state()?.highlight ?? null;
        const keeps = pointed !== undefined || slice !== undefined;
        const highlight = element ? { element: element.element, number: element.number } : keeps ? kept : null;
        const isKept = highlight?.element === kept?.element && highlight?.number === kept?.number;
        const change = {
            ...(slice && !slice.focus && { slices: { focus: slice.index } }),
            ...(!isKept && { highlight }),
        };
        if (Object.keys(change).length > 0) this.actions.send({ type: "set", ...change });
    }

    /** Highlights the element at a point of the drawing; opens its menu. Resolves to false if no element is there. */
    async highlightAndOpenMenu(at: AreaPoint): Promise<boolean> {
        const hitTester = await this.actions.hitTester();
        const pointed = hitTester && this.pointing.targetAt(at.x, at.y, hitTester);
        if (!pointed || !isElement(pointed)) return false;
        const { element, number, slice } = pointed;
        this.actions.send({ type: "set", highlight: { element, number } });
        const command = (label: string, line: string): ElementMenuItem => ({
            label,
            act: () => this.actions.send({ type: "command", line }),
        });
        const focus = slice && !slice.focus && command("Make its slice the focus", `focus ${slice.index}`);
        this.menu.open(`${capitalize(element)} ${number}`, at, [
            command("Turn it toward +w", `toward ${element} ${number}`),
            ...(focus ? [focus] : []),
            ...(element === "cell" ? [command("Hide its kind of cell", "hide"), command("Fade its kind of cell", "fade")] : []),
            { label: "Export it…", act: () => this.actions.exportElement({ element, number }) },
            command("Remove its highlight", "highlight none"),
        ]);
        return true;
    }
}
