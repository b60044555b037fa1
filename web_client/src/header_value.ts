// A value in the header of the page. It is a button that turns into a text field for another value.

import { byId, element } from "./element";
import { toSentence } from "./format";

const kMargin = 4; // the least distance, in pixels, of the note below the field from the right edge of the window

export interface HeaderValueEvents {
    /** Returns the text with which the field opens. It may differ from the shown value, which is rounded. */
    editableText(): string;
    /** Applies what the user has typed; rejects with an Error whose message is shown at the field. */
    apply(text: string): Promise<unknown>;
}

export class HeaderValue {
    readonly root: HTMLElement;
    private readonly output: HTMLElement;
    private readonly button: HTMLElement;
    private readonly label: HTMLElement;
    private readonly input: HTMLInputElement;
    private readonly error: HTMLElement;
    private readonly note: HTMLElement;
    private before = ""; // the text at the start of editing; the same text is not applied
    private refused: string | undefined; // the last text that could not be applied
    private pending: string | undefined; // the text that is being applied
    private focusAfter: HTMLElement | undefined; // the element that gets the focus after editing

    constructor(
        name: string,
        symbol: string,
        meaning: string,
        hint: string,
        private readonly events: HeaderValueEvents,
    ) {
        const symbolElement = (): HTMLElement =>
            element("span", { class: symbol.length === 1 ? "symbol" : "word" }, symbol);
        this.output = element("span", { "data-state-field": name }, "\u2013");
        const title = `${meaning}. Click to change`;
        this.button = element("button", { type: "button", title }, symbolElement(), " ", this.output);
        this.input = element("input", {
            type: "text",
            "data-field": name,
            "aria-label": `${symbol}: ${meaning}`,
            "aria-describedby": `state-field-hint-${name} state-field-error-${name}`,
            autocomplete: "off",
            autocapitalize: "none",
            spellcheck: "false",
            enterkeyhint: "go",
        });
        this.label = element("label", { hidden: true }, symbolElement(), " ", this.input);
        this.error = element("span", { id: `state-field-error-${name}`, role: "alert" });
        const hintElement = element("span", { id: `state-field-hint-${name}` }, hint);
        this.note = element("p", { class: "state-field-note", hidden: true }, this.error, hintElement);
        this.root = element("div", { class: "state-field" }, this.button, this.label, this.note);

        this.button.addEventListener("click", () => this.open());
        this.input.addEventListener("keydown", (event) => this.handleKeydown(event));
        this.input.addEventListener("input", () => this.showError(""));
        this.input.addEventListener("blur", () => this.submitOnBlur());
        window.addEventListener("resize", () => this.placeNote());
    }

    /** Shows a value on the button; does not change the text of a field that is open. */
    show(value: string): void {
        if (this.output.textContent !== value) this.output.textContent = value;
    }

    private open(): void {
        this.before = this.events.editableText();
        this.refused = this.pending = undefined;
        // After a click with the mouse, the drawing still has the focus, and gets it back after editing.
        this.focusAfter = document.activeElement === this.button ? this.button : byId("drawing");
        this.input.value = this.before;
        this.input.size = Math.max(5, this.before.length + 1);
        this.showError("");
        this.setOpen(true);
        this.input.select();
    }

    private setOpen(open: boolean): void {
        this.button.hidden = open;
        this.label.hidden = this.note.hidden = !open;
        this.placeNote();
    }

    /** Places the note below the field, but within the window. */
    private placeNote(): void {
        if (this.note.hidden) return;
        this.note.style.translate = "";
        const beyond = this.note.getBoundingClientRect().right - (innerWidth - kMargin);
        if (beyond > 0) this.note.style.translate = `${-Math.ceil(beyond)}px 0`;
    }

    /** Closes the field. If it has the focus, moves the focus to where it was before editing. */
    private close(): void {
        const hadFocus = document.activeElement === this.input;
        this.before = this.input.value; // so that a call of submitOnBlur(), when the field disappears, applies nothing
        this.setOpen(false);
        if (hadFocus) this.focusAfter?.focus();
    }

    private handleKeydown(event: KeyboardEvent): void {
        if (event.isComposing) return;
        if (event.key === "Escape") {
            event.stopPropagation(); // Escape must not also move the focus to the drawing
            this.close();
        }
        if (event.key === "Enter") void this.submit();
    }

    /** Applies the text when the field loses the focus, unless the whole window loses it, or the text was refused. */
    private submitOnBlur(): void {
        if (this.label.hidden || !document.hasFocus() || this.input.value === this.refused) return;
        void this.submit();
    }

    private async submit(): Promise<void> {
        const text = this.input.value.trim();
        if (text === this.before.trim()) return this.close();
        if (text === this.pending) return undefined; // Enter was pressed again, or Tab, before the answer
        this.pending = text;
        try {
            await this.events.apply(text);
            this.close();
        } catch (error) {
            this.refused = this.input.value;
            this.showError((error as Error).message);
        }
        this.pending = undefined;
        return undefined;
    }

    private showError(error: string): void {
        this.error.textContent = error === "" ? "" : toSentence(error);
        this.input.setAttribute("aria-invalid", String(error !== ""));
        this.placeNote();
    }
}
