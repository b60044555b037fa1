// The one way in which elements are made here.

type Attributes = Record<string, string | boolean | undefined>;

/** Makes an element; an attribute that is true is set empty, one that is false or undefined left out. */
export function element<K extends keyof HTMLElementTagNameMap>(
    name: K,
    attributes: Attributes = {},
    ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
        if (value !== undefined && value !== false) made.setAttribute(key, value === true ? "" : value);
    }
    made.append(...children);
    return made;
}

export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
    return document.getElementById(id) as T;
}

/** "xw" with each letter in its axis's colour. */
export function planeName(plane: string): HTMLElement {
    return element(
        "span",
        { class: "plane" },
        ...[...plane].map((axis) => element("b", { class: `axis-${axis}` }, axis)),
    );
}
