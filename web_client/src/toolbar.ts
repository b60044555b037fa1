// Makes toolbars with one tab stop each. The arrow keys, Home and End move the focus among the buttons, as in the ARIA
// Authoring Practices Guide. The button that had the focus last is the tab stop, even while a text field replaces it.

// The arrow keys Up and Down move the focus to the nearest button above or below. The distance of a button is √(across²
// + (kRowWeight · down)²). A button in the next row is therefore usually nearer than a button straight above or below
// in a farther row.
const kRowWeight = 3;

/** Makes a toolbar of an element that contains buttons. Buttons may later be added, removed and disabled. */
export function makeToolbar(root: HTMLElement, label: string): void {
    root.setAttribute("role", "toolbar");
    root.setAttribute("aria-label", label);
    const setTabStop = (wanted?: Element): void => {
        const focused = document.activeElement;
        // While a text field replaces a button and has the focus, the hidden button stays the tab stop.
        if (!wanted && focused instanceof HTMLInputElement && root.contains(focused)) return;
        const buttons = [...root.querySelectorAll("button")];
        const enabled = buttons.filter((button) => button === wanted || isUsable(button));
        const stop = enabled.find((button) => button === wanted) ?? enabled.find((button) => button.tabIndex === 0);
        for (const button of buttons) button.tabIndex = button === (stop ?? enabled[0]) ? 0 : -1;
    };
    setTabStop();
    new MutationObserver(() => setTabStop()).observe(root, {
        ...{ childList: true, subtree: true, attributes: true },
        attributeFilter: ["disabled"],
    });
    new ResizeObserver(() => setTabStop()).observe(root); // the window's width may hide or show buttons
    root.addEventListener("focusin", ({ target }) => {
        const button = target instanceof HTMLInputElement ? buttonReplacedBy(target, root) : target;
        if (button instanceof HTMLButtonElement) setTabStop(button);
    });
    root.addEventListener("keydown", (event) => {
        if (!(event.target instanceof HTMLButtonElement) || hasModifierKey(event)) return;
        const buttons = [...root.querySelectorAll("button")].filter(isUsable);
        const next = nextButton(buttons, event.target, event.key);
        if (!next) return;
        event.preventDefault();
        next.focus();
    });
}

/** The button that this text field replaces. A mouse click opens the field without a focus on the button. */
function buttonReplacedBy(field: HTMLInputElement, root: HTMLElement): Element | undefined {
    if (field.type !== "text") return undefined;
    let around: Element = field;
    while (around !== root && !around.querySelector("button")) around = around.parentElement!;
    return around === root ? undefined : around.querySelector("button")!;
}

function isUsable(button: HTMLButtonElement): boolean {
    return !button.disabled && button.checkVisibility();
}

/** The button to which a key moves the focus; undefined if the key moves no focus. */
function nextButton(buttons: HTMLButtonElement[], from: HTMLButtonElement, key: string): HTMLElement | undefined {
    const at = buttons.indexOf(from);
    if (key === "ArrowRight") return buttons[(at + 1) % buttons.length];
    if (key === "ArrowLeft") return buttons.at(at - 1);
    if (key === "Home") return buttons[0];
    if (key === "End") return buttons.at(-1);
    if (key === "ArrowDown") return nearestButtonInDirection(buttons, from, 1);
    return key === "ArrowUp" ? nearestButtonInDirection(buttons, from, -1) : undefined;
}

/** The nearest button below (direction 1) or above (direction −1); `from` itself if there is none. */
function nearestButtonInDirection(buttons: HTMLButtonElement[], from: HTMLButtonElement, direction: 1 | -1): HTMLElement {
    const { left, width, top, bottom } = from.getBoundingClientRect();
    const distance = (one: HTMLElement): number => {
        const box = one.getBoundingClientRect();
        const isBeyond = direction === 1 ? box.top >= bottom : box.bottom <= top;
        const [across, down] = [box.left + box.width / 2 - left - width / 2, box.top - top];
        return isBeyond ? Math.hypot(across, kRowWeight * down) : Infinity;
    };
    const [nearest] = buttons
        .map((button) => ({ button, away: distance(button) }))
        .filter(({ away }) => away < Infinity)
        .sort((a, b) => a.away - b.away);
    return nearest?.button ?? from;
}

function hasModifierKey({ ctrlKey, altKey, metaKey, shiftKey }: KeyboardEvent): boolean {
    return ctrlKey || altKey || metaKey || shiftKey;
}
