// The command line, with a history.

import { byId } from "./element";
import { sentence } from "./format";
import { recall, remember } from "./memory";

const kHistory = "oval4d.commands";
const kMaxHistory = 100; // lines

export class CommandLine {
    private readonly form = byId<HTMLFormElement>("command-line");
    private readonly input = byId<HTMLInputElement>("command");
    private readonly error = byId("command-error");
    private history = recall<string[]>(kHistory) ?? [];
    private at = 0; // position in the history, counted from its end; 0 is the line being typed

    /** `run` executes a line; it throws an Error whose message is shown to the user. */
    constructor(
        private readonly run: (line: string) => Promise<unknown>,
        private readonly closed: () => void,
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
        this.at = 0;
        this.write(text);
        this.say("");
        this.input.focus();
    }

    close(): void {
        if (this.form.hidden) return;
        this.form.hidden = true;
        this.closed();
    }

    private keydown(event: KeyboardEvent): void {
        const back = { ArrowUp: 1, ArrowDown: -1 }[event.key];
        if (back === undefined) return;
        event.preventDefault();
        this.at = Math.min(this.history.length, Math.max(0, this.at + back));
        this.write(this.history.at(-this.at || this.history.length) ?? "");
    }

    private write(text: string): void {
        this.input.value = text;
        this.input.setSelectionRange(text.length, text.length);
    }

    private say(error: string): void {
        this.error.textContent = error === "" ? "" : sentence(error);
        this.input.toggleAttribute("aria-invalid", error !== "");
    }

    private async submit(): Promise<void> {
        const line = this.input.value.trim().replace(/^:\s*/, "");
        if (line === "") return this.close();
        this.history = [...this.history.filter((one) => one !== line), line].slice(-kMaxHistory);
        this.at = 0;
        remember(kHistory, this.history);
        try {
            await this.run(line);
            this.close();
        } catch (error) {
            this.say((error as Error).message);
            this.input.select();
        }
        return undefined;
    }
}
