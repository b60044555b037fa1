// Creation and lookup of HTML elements.

type Attributes = Record<string, string | boolean | undefined>;

/** Creates an element. An attribute that is true is set to ""; one that is false or undefined is omitted. */
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

/** The element with this id, which must exist. */
export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
    return document.getElementById(id) as T;
}

/** The name of a plane, such as "xw", with each letter in the color of its axis. */
export function planeName(plane: string): HTMLElement {
    return element(
        "span",
        { class: "plane" },
        ...[...plane].map((axis) => element("b", { class: `axis-${axis}` }, axis)),
    );
}
