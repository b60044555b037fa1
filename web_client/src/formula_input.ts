// A text field for a formula. It shows the mistake that the server has found in the formula.

import { byId, element } from "./element";
import { toSentence } from "./format";
import { excerptAround, parseFormulaMistake } from "./formula";

const kReach = 14; // an excerpt shows this many characters on either side of a mistake

export class FormulaInput {
    readonly input: HTMLTextAreaElement | HTMLInputElement;
    private readonly error: HTMLElement;
    private readonly excerpt: HTMLElement;

    /** `typed` is called when the text changes, `entered` when Enter is pressed. */
    constructor(ids: { input: string; error: string; excerpt: string }, typed: () => void, entered: () => void) {
        this.input = byId<HTMLTextAreaElement | HTMLInputElement>(ids.input);
        this.error = byId(ids.error);
        this.excerpt = byId(ids.excerpt);
        this.input.addEventListener("input", typed);
        this.input.addEventListener("keydown", (event) => {
            const { key, isComposing } = event as KeyboardEvent;
            if (key !== "Enter" || isComposing) return;
            event.preventDefault();
            entered();
        });
    }

    get value(): string {
        return this.input.value;
    }

    set value(text: string) {
        this.input.value = text;
    }

    /**
     * Shows an error of the server, and marks the wrong character if the error names one. If `message` is undefined,
     * clears the error and the mark.
     */
    showError(message: string | undefined): void {
        const mistake = message === undefined ? undefined : parseFormulaMistake(message);
        const where = mistake ? `Character ${mistake.at + 1}: ${mistake.what}` : (message ?? "");
        const text = where === "" ? "" : toSentence(where);
        // Setting the same text again would make screen readers repeat it.
        if (this.error.textContent !== text) this.error.textContent = text;
        this.input.setAttribute("aria-invalid", String(message !== undefined));
        this.excerpt.hidden = mistake === undefined;
        if (!mistake) return;
        const [before, character, after] = excerptAround(this.value, mistake.at, kReach);
        this.excerpt.replaceChildren(before, element("mark", {}, character.trim() === "" ? "\u00a0" : character), after);
    }
}
