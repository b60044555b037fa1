// The command line, with a history.

import { byId } from "./element";
import { toSentence } from "./format";
import { readStored, writeStored } from "./tab_storage";

const kHistoryKey = "oval4d.commands";
const kMaxHistory = 100; // lines

export class CommandLine {
    private readonly form = byId<HTMLFormElement>("command-line");
    private readonly input = byId<HTMLInputElement>("command");
    private readonly error = byId("command-error");
    private history = readStored<string[]>(kHistoryKey) ?? [];
    private historyPosition = 0; // counted from the end of the history; 0 is the line being typed

    /** `run` executes a line; it throws an Error, whose message the user sees. `onClosed` is called after closing. */
    constructor(
        private readonly run: (line: string) => Promise<unknown>,
        private readonly onClosed: () => void,
    ) {
        this.form.addEventListener("submit", (event) => {
            event.preventDefault();
            void this.submit();
        });
        byId("command-close").addEventListener("click", () => this.close());
        this.form.addEventListener("keydown", (event) => event.key === "Escape" && this.close());
        this.input.addEventListener("keydown", (event) => this.keydown(event));
    }

    open(text = ""): void {
        this.form.hidden = false;
        this.historyPosition = 0;
        this.setText(text);
        this.showError("");
        this.input.focus();
    }

    close(): void {
        if (this.form.hidden) return;
        this.form.hidden = true;
        this.onClosed();
    }

    private keydown(event: KeyboardEvent): void {
        const step = { ArrowUp: 1, ArrowDown: -1 }[event.key];
        if (step === undefined) return;
        event.preventDefault();
        this.historyPosition = Math.min(this.history.length, Math.max(0, this.historyPosition + step));
        this.setText(this.history.at(-this.historyPosition || this.history.length) ?? "");
    }

    private setText(text: string): void {
        this.input.value = text;
        this.input.setSelectionRange(text.length, text.length);
    }

    private showError(error: string): void {
        this.error.textContent = error === "" ? "" : toSentence(error);
        this.input.toggleAttribute("aria-invalid", error !== "");
    }

    private async submit(): Promise<void> {
        const line = this.input.value.trim().replace(/^:\s*/, "");
        if (line === "") return this.close();
        this.history = [...this.history.filter((earlier) => earlier !== line), line].slice(-kMaxHistory);
        this.historyPosition = 0;
        writeStored(kHistoryKey, this.history);
        try {
            await this.run(line);
            this.close();
        } catch (error) {
            this.showError((error as Error).message);
            this.input.select();
        }
        return undefined;
    }
}
