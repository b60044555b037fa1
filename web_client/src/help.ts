// The dialog with the list of keys, generated from the key table.

import type { Keymap } from "@oval4d/protocol";

import { byId, element } from "./element";

const kGestures = [
    ["Drag", "Orbit the view"],
    ["Wheel, pinch", "Zoom"],
    ["Click", "Make the slice the focus"],
    ["Double click", "Reset the view"],
    ["Alt + drag", "Turn in xw and yw: roll the 4-D ball"],
    ["Alt + wheel", "Turn in zw"],
    ["Alt + Shift + drag", "Turn in xz and yz, in every slice"],
    ["Alt + Shift + wheel", "Turn in xy"],
    ["Drag with two fingers", "Turn in xw and yw"],
    ["Twist two fingers", "Turn in zw"],
] as const;

const kSticks = [
    ["Left stick", "Turn in xw and yw"],
    ["Right stick", "Turn in xz and yz"],
    ["Triggers", "Turn in zw"],
    ["Bumpers", "Turn in xy"],
] as const;

const kCommonKeys = [
    ["Ctrl-z", "Undo; on a Mac, Cmd-z"],
    ["Ctrl-y", "Redo; also Ctrl-Shift-z"],
    ["Esc", "Return the focus to the drawing"],
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
        this.dialog
            .querySelector(".sheet")!
            .replaceChildren(
                ...sections,
                section("Common keys", kCommonKeys, "kbd"),
                section("Mouse and touch", kGestures, "span"),
                section("Gamepad", kSticks, "span"),
            );
    }

    open(): void {
        if (!this.dialog.open) this.dialog.showModal();
    }
}

function section(title: string, rows: readonly (readonly [string, string])[], tag: "kbd" | "span"): HTMLElement {
    const lines = rows.map(([name, text]) => tableRow(name, text, tag));
    return element("section", {}, element("h3", {}, title), element("table", {}, ...lines));
}

function tableRow(name: string, text: string, tag: "kbd" | "span" = "kbd"): HTMLElement {
    return element("tr", {}, element("th", { scope: "row" }, element(tag, {}, name)), element("td", {}, text));
}
