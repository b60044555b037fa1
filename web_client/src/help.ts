// The help dialog: the list of keys, made from the key table, and the list of commands.

import type { Keymap } from "@oval4d/protocol";

import { kCommands, kSettings } from "./commands";
import { byId, element } from "./element";

const kGestures = [
    ["Drag", "Orbit the view"],
    ["Wheel, pinch", "Zoom"],
    ["Point", "Name what is under the pointer, and light it everywhere"],
    ["Click", "Keep it lit, and make its slice the focus; on the background: end the light"],
    ["Right click, long press", "Open the menu of what is under the pointer"],
    ["Double click", "Reset the view"],
    ["Drag or click in the matrix", "Move the focus point there"],
    ["Right or middle button, or Alt + drag", "Turn in xw and yw: roll the 4-D ball"],
    ["Alt + wheel", "Turn in zw"],
    ["The same drag with Shift", "Turn in xz and yz, in every slice"],
    ["Alt + Shift + wheel", "Turn in xy"],
    ["Drag with two fingers", "Turn in xw and yw"],
    ["Twist two fingers", "Turn in zw"],
    ["Drag with three fingers", "Turn in xz and yz, in every slice"],
    ["Twist three fingers", "Turn in xy"],
    ["Tilt in 4-D, Tilt slices", "Turn as the phone is turned; buttons on touch screens"],
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
    ["Ctrl-p", "Print the picture alone, on white"],
    ["Esc", "Return the focus to the drawing; there, end the light"],
] as const;

export class HelpDialog {
    private readonly dialog = byId<HTMLDialogElement>("help");
    private readonly sheet = this.dialog.querySelector(".sheet")!;
    private readonly topic = byId("help-topic");

    constructor() {
        this.dialog.addEventListener("keydown", (event) => {
            if (event.key !== "?") return;
            event.preventDefault();
            this.dialog.close();
        });
        this.dialog.addEventListener("click", (event) => {
            if (event.target === this.dialog) this.dialog.close(); // a click outside the content of the dialog
        });
        byId("help-all").addEventListener("click", () => this.filter(""));
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
                    ...lines.map((key) => tableRow(key.name, key.text, { searchTerms: key.action })),
                    ...(inverse ? [tableRow("Shift +", "Apply the inverse rotation")] : []),
                ),
            );
        });
        this.sheet.replaceChildren(
            ...sections,
            helpSection("Common keys", kCommonKeys, "kbd"),
            helpSection("Mouse and touch", kGestures, "span"),
            helpSection("Gamepad", kSticks, "span"),
            commandSection(),
        );
    }

    /** Opens the dialog with only the lines that mention the topic; throws an Error if no line does. See filter(). */
    open(topic = ""): void {
        this.filter(topic);
        if (!this.dialog.open) this.dialog.showModal();
    }

    close(): void {
        this.dialog.close();
    }

    /**
     * Shows only the lines that mention the topic; if it is "", shows all lines. Throws an Error if no line mentions
     * the topic.
     */
    filter(topic: string): void {
        const wanted = topic.toLowerCase();
        const mentions = (line: HTMLElement): boolean =>
            `${line.textContent} ${line.dataset["searchTerms"] ?? ""}`.toLowerCase().includes(wanted);
        const lines = [...this.sheet.querySelectorAll<HTMLElement>("tr, dl > div")];
        if (topic !== "" && !lines.some(mentions)) {
            throw new Error(`the help does not mention “${topic}”; write help to see all of it`);
        }
        for (const line of lines) line.hidden = !mentions(line);
        for (const section of this.sheet.querySelectorAll("section")) {
            section.hidden = section.querySelector(":is(tr, dl > div):not([hidden])") === null;
        }
        this.topic.hidden = topic === "";
        this.topic.querySelector("span")!.textContent = `Only what mentions “${topic}”`;
        this.dialog.scrollTop = 0;
    }
}

function helpSection(title: string, rows: readonly (readonly [string, string])[], tag: "kbd" | "span"): HTMLElement {
    const lines = rows.map(([name, text]) => tableRow(name, text, { tag }));
    return element("section", {}, element("h3", {}, title), element("table", {}, ...lines));
}

/** The list of commands, with an example of each. */
function commandSection(): HTMLElement {
    const lines = kCommands.map(({ name, text, example }) => {
        const meaning = name === "set" ? `${text}: ${[...kSettings.keys()].join(", ")}` : text;
        const line = [element("dt", {}, element("code", {}, `:${example}`)), element("dd", {}, meaning)];
        return element("div", { "data-command": name }, ...line);
    });
    const title = element("h3", {}, "Commands, with examples");
    return element("section", { class: "commands" }, title, element("dl", {}, ...lines));
}

/** A row of a table in the help. filter() finds a topic in the row's texts and in `searchTerms`. */
function tableRow(name: string, text: string, { tag = "kbd", searchTerms = "" }: HelpRowOptions = {}): HTMLElement {
    const head = element("th", { scope: "row" }, element(tag, {}, name));
    return element("tr", { "data-search-terms": searchTerms || undefined }, head, element("td", {}, text));
}

/** `tag` is the HTML tag of the name; filter() finds topics also in `searchTerms`. */
interface HelpRowOptions {
    tag?: "kbd" | "span";
    searchTerms?: string;
}
