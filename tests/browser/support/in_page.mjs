// Functions that the driver of Firefox runs in the page, to find elements and to act on them.

/**
 * Runs in the page. Finds elements, and returns the result of `operation` for them. `steps` lead from the document to
 * the elements, one after another. {selector} finds descendants that match, {text} selects by text, {has} by contained
 * elements, {visible} by visibility, and {at} by position. In selectors, :visible, :text-is() and :has-text() have
 * Playwright's meaning.
 */
export function ofElements(steps, operation, given) {
    const isVisible = (one) => {
        const { width, height } = one.getBoundingClientRect();
        return width > 0 && height > 0 && one.checkVisibility({ visibilityProperty: true });
    };
    const textOf = (one) => (one.textContent ?? "").replace(/\s+/g, " ").trim();
    const conditions = {
        visible: () => isVisible,
        "text-is": (text) => (one) => textOf(one) === text,
        "has-text": (text) => (one) => textOf(one).toLowerCase().includes(text.toLowerCase()),
    };

    /**
     * The descendants of the roots that match. Elements with Playwright's pseudo-classes get an attribute temporarily.
     */
    const below = (roots, selector) => {
        const marks = [];
        const special = /:(visible|text-is|has-text)\b(?:\((["'])(.*?)\2\))?/g;
        const standard = selector.replace(special, (_, name, quote, text) => {
            marks.push({ mark: `data-condition-${marks.length}`, holds: conditions[name](text) });
            return `[${marks.at(-1).mark}]`;
        });
        const marked = marks.map(({ mark, holds }) => {
            const all = [...document.querySelectorAll("*")].filter(holds);
            for (const one of all) one.setAttribute(mark, "");
            return [mark, all];
        });
        const found = new Set(roots.flatMap((root) => [...root.querySelectorAll(standard)]));
        for (const [mark, all] of marked) for (const one of all) one.removeAttribute(mark);
        const first = [...found];
        return roots.length > 1 ? first.sort((a, b) => (a.compareDocumentPosition(b) & 4 ? -1 : 1)) : first;
    };
    const follow = (roots, path) =>
        path.reduce((all, { selector, text, has, visible, at }) => {
            if (selector !== undefined) return below(all, selector);
            if (text !== undefined) {
                const inside = all.flatMap((one) => [...one.querySelectorAll("*")]);
                const holding = inside.filter((one) => textOf(one).includes(text));
                return holding.filter((one) => !holding.some((other) => other !== one && one.contains(other)));
            }
            if (has !== undefined) return all.filter((one) => follow([one], has).length > 0);
            if (visible !== undefined) return all.filter((one) => isVisible(one) === visible);
            return all.slice(at, at + 1);
        }, roots);

    const frame = () => new Promise((resolve) => requestAnimationFrame(resolve));
    const boxOf = (one) => {
        const { x, y, width, height } = one.getBoundingClientRect();
        return { x, y, width, height };
    };
    const change = (one, ...types) => types.forEach((type) => one.dispatchEvent(new Event(type, { bubbles: true })));
    const operations = {
        all: (all) => all,
        count: (all) => all.length,
        first: ([one]) => one,
        isVisible: ([one]) => one !== undefined && isVisible(one),
        isIn: ([one], state) => {
            if (state === "attached") return one !== undefined;
            if (state === "hidden") return one === undefined || !isVisible(one);
            return one !== undefined && isVisible(one);
        },
        get: ([one], name) => one[name],
        attribute: ([one], name) => one.getAttribute(name),
        isDisabled: ([one]) => one.matches(":disabled"),
        texts: (all, name) => all.map((one) => one[name]),
        box: ([one]) => (isVisible(one) ? boxOf(one) : null),
        focus: ([one]) => one.focus(),
        show: ([one]) => one.scrollIntoView({ block: "center", inline: "center", behavior: "instant" }),
        /**
         * The point at which a user can press the element. The element must be visible, enabled, at rest and not
         * covered.
         */
        pressablePoint: async ([one], position) => {
            if (one === undefined || !isVisible(one) || one.matches(":disabled")) return undefined;
            const pointIn = ({ x, y, width, height }) => {
                if (position) return [x + one.clientLeft + position.x, y + one.clientTop + position.y];
                return [x + width / 2, y + height / 2];
            };
            const isHitAt = (point) => {
                const hit = document.elementFromPoint(...point);
                return hit !== null && (one.contains(hit) || hit.closest("label")?.control === one);
            };
            let before = boxOf(one);
            if (!isHitAt(pointIn(before))) {
                operations.show([one]);
                before = boxOf(one);
            }
            await frame();
            const box = boxOf(one);
            if (["x", "y", "width", "height"].some((side) => box[side] !== before[side])) return undefined;
            const point = pointIn(box);
            return isHitAt(point) ? { x: point[0], y: point[1] } : undefined;
        },
        fill: ([one], text) => {
            if (one === undefined || !isVisible(one) || one.disabled || one.readOnly) return false;
            one.focus();
            if (["color", "date", "range"].includes(one.type)) {
                one.value = text;
                change(one, "input", "change");
            } else {
                one.select();
                document.execCommand(text === "" ? "delete" : "insertText", false, text);
            }
            return true;
        },
        choose: ([one], value) => {
            if (one === undefined || !isVisible(one) || one.disabled) return false;
            one.value = value;
            change(one, "input", "change");
            return true;
        },
        setFiles: ([one], files) => {
            const transfer = new DataTransfer();
            for (const { name, type, base64 } of files) {
                transfer.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name, { type }));
            }
            one.files = transfer.files;
            change(one, "input", "change");
        },
    };
    return operations[operation](follow([document], steps), given);
}
