// The dialog with the list of keys, generated from the key table.

import type { Keymap } from "@oval4d/protocol";

import { byId, element } from "./element";

const kGestures = [
    ["Drag", "Orbit the view"],
    ["Wheel, pinch", "Zoom"],
    ["Double click", "Reset the viewpoint"],
] as const;

export class Help {
    private readonly dialog = byId<HTMLDialogElement>("help");

    constructor() {
        this.dialog.addEventListener("keydown", (event) => {
            if (event.key !== "?") return;
            event.preventDefault();
            this.dialog.close();
        });
        this.dialog.addEventListener("click", (event) => {
            if (event.target === this.dialog) this.dialog.close(); // a click outside the sheet
        });
    }

    show({ groups, keys }: Keymap): void {
        const sections = groups.map(({ name, title }) => {
            const lines = keys.filter((key) => key.group === name);
            const inverse = lines.some((key) => key.shift === "inverse");
            return element(
                "section",
                {},
                element("h3", {}, title),
                element(
                    "table",
                    {},
                    ...lines.map((key) => tableRow(key.name, key.text)),
                    ...(inverse ? [tableRow("Shift +", "Apply the inverse rotation")] : []),
                ),
            );
        });
        const gestures = element("table", {}, ...kGestures.map(([name, text]) => tableRow(name, text, "span")));
        const pointer = element("section", {}, element("h3", {}, "Mouse and touch"), gestures);
        this.dialog.querySelector(".sheet")!.replaceChildren(...sections, pointer);
    }

    open(): void {
        if (!this.dialog.open) this.dialog.showModal();
    }
}

function tableRow(name: string, text: string, tag: "kbd" | "span" = "kbd"): HTMLElement {
    return element("tr", {}, element("th", { scope: "row" }, element(tag, {}, name)), element("td", {}, text));
}
