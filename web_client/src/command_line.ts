// The command line, with a history and completion.

import { byId, element } from "./element";
import { commonPrefix, type CompletableNames, type Completions, completionsOf } from "./completion";
import { toSentence } from "./format";
import { loadFromStorage, saveToStorage } from "./storage";

const kHistoryKey = "oval4d.commands";
const kMaxHistory = 100; // the most lines that the history keeps
const kPage = 0.8; // the fraction of the panel's height by which Page Up and Page Down scroll

export interface CommandLineEvents {
    /** Executes a line; rejects with an Error whose message is shown to the user. */
    runLine(line: string): Promise<unknown>;
    closed(): void;
    /** Called if a line fails after the command line was closed, or closed and opened again. */
    failedLater(error: Error): void;
    /** Returns the names that can complete a line, such as those of polytopes and keys. */
    completableNames(): CompletableNames;
}

/** The completions of a line. Each press of Tab inserts the next one. */
interface CompletionCycle extends Completions {
    /** The line as the last completion left it. If the input differs from it, the user has edited the line. */
    line: string;
    /** The index in `options` of the option that the line contains; -1 if it contains none. */
    at: number;
}

export class CommandLine {
    private readonly form = byId<HTMLFormElement>("command-line");
    private readonly input = byId<HTMLInputElement>("command");
    private readonly error = byId("command-error");
    private readonly list = byId("command-options");
    private readonly announcer = byId("spoken");
    private history = loadFromStorage<string[]>(kHistoryKey) ?? [];
    // The place of the shown line, counted from the end of the history; 0 is the line being typed.
    private historyPosition = 0;
    private draft = ""; // what the user has typed, while the input shows an earlier line
    private cycle: CompletionCycle | undefined;
    private openings = 0; // how often the command line has been opened
    private loading: Promise<unknown> | undefined; // the request for the names of polytopes, while it runs

    constructor(private readonly events: CommandLineEvents) {
        this.form.addEventListener("submit", (event) => {
            event.preventDefault();
            void this.submit();
        });
        byId("command-close").addEventListener("click", () => this.close());
        byId("command-complete").addEventListener("click", () => {
            this.input.focus();
            this.complete(1);
        });
        this.form.addEventListener("keydown", (event) => {
            const page = { PageDown: 1, PageUp: -1 }[event.key];
            if (page !== undefined) this.scroll(event, page);
            if (event.key !== "Escape") return;
            if (this.list.hidden) return this.close();
            event.stopPropagation(); // Escape must not also move the focus to the drawing
            this.hideList();
        });
        this.input.addEventListener("keydown", (event) => this.keydown(event));
        this.input.addEventListener("input", () => this.hideList());
        this.list.addEventListener("pointerdown", (event) => event.preventDefault()); // the input keeps the focus
        this.list.addEventListener("click", (event) => {
            const option = event.target instanceof Element && event.target.closest("[role=option]");
            if (option) this.choose([...this.list.children].indexOf(option));
        });
    }

    /**
     * Opens the command line. `loading` is the request for the names of polytopes; Tab waits for its answer before it
     * completes such a name.
     */
    open(loading: Promise<unknown>): void {
        this.loading = loading;
        void loading.finally(() => (this.loading = undefined));
        ++this.openings;
        this.form.hidden = false;
        this.historyPosition = 0;
        this.setText("");
        this.showError("");
        this.input.focus();
    }

    close(): void {
        if (this.form.hidden) return;
        this.hideList();
        this.form.hidden = true;
        this.events.closed();
    }

    private keydown(event: KeyboardEvent): void {
        if (event.isComposing || event.ctrlKey || event.altKey || event.metaKey) return;
        if (event.key === "Tab" && this.tab(event.shiftKey)) event.preventDefault();
        const step = { ArrowUp: 1, ArrowDown: -1 }[event.key];
        if (step === undefined) return;
        event.preventDefault();
        if (this.list.hidden) this.recall(step);
        else this.complete(-step);
    }

    /** Scrolls the panel by `pages` times kPage of its height, because a long error may not fit into the panel. */
    private scroll(event: KeyboardEvent, pages: number): void {
        event.preventDefault();
        this.form.scrollBy({ top: pages * kPage * this.form.clientHeight });
        this.form.scrollIntoView({ block: "nearest" }); // the window may have to scroll, too
    }

    /**
     * Handles Tab, or Shift-Tab if `backwards` is true: completes the line. Returns false if there is nothing to
     * complete; the key then moves the focus.
     */
    private tab(backwards: boolean): boolean {
        if (backwards && this.list.hidden) return false;
        const step = backwards ? -1 : 1;
        const { value } = this.input;
        if (!this.loading || !value.includes("polytope")) return this.complete(step);
        void this.loading.then(() => value === this.input.value && this.complete(step));
        return true;
    }

    private recall(step: number): void {
        if (this.historyPosition === 0) this.draft = this.input.value;
        this.historyPosition = Math.min(this.history.length, Math.max(0, this.historyPosition + step));
        this.setText(this.history.at(-this.historyPosition || this.history.length) ?? this.draft);
    }

    /** The completions of the text before the caret. */
    private findCompletions(): Completions {
        return completionsOf(this.input.value.slice(0, this.input.selectionEnd ?? undefined), this.events.completableNames());
    }

    /**
     * If there is only one completion, inserts it. If there are several, the first call inserts the beginning that they
     * share, and lists them. Each further call inserts the next option of the list, or the previous one if `step` is
     * -1, in place of what the last call inserted. Returns false if there is no completion.
     */
    private complete(step: number): boolean {
        const { cycle } = this;
        if (cycle && cycle.line === this.input.value) {
            const count = cycle.options.length;
            this.putOptionIntoLine(cycle.at < 0 && step < 0 ? count - 1 : (cycle.at + step + count) % count);
            return true;
        }
        this.hideList();
        const found = this.findCompletions();
        const { start, options, suffix } = found;
        if (options.length === 0) return false;
        if (options.length === 1) {
            this.replaceUpToCaret(start, options[0]! + suffix);
            this.announcer.textContent = this.input.value;
            return true;
        }
        const typed = this.input.value.slice(start, this.input.selectionEnd ?? undefined);
        const prefix = commonPrefix(options);
        if (prefix.toLowerCase().startsWith(typed.toLowerCase())) this.replaceUpToCaret(start, prefix);
        this.cycle = { ...found, line: this.input.value, at: -1 };
        this.list.replaceChildren(
            ...options.map((option, i) =>
                element("div", { role: "option", id: `command-option-${i}`, "aria-selected": "false" }, option),
            ),
        );
        this.list.hidden = false;
        this.list.scrollTop = 0;
        this.input.setAttribute("aria-expanded", "true");
        this.announcer.textContent = `${options.length} completions`;
        return true;
    }

    /** Replaces the completed text by the option with the index `at`, and marks the option in the list. */
    private putOptionIntoLine(at: number): void {
        const cycle = this.cycle!;
        this.list.children[cycle.at]?.setAttribute("aria-selected", "false");
        this.replaceUpToCaret(cycle.start, cycle.options[at]!);
        this.cycle = { ...cycle, line: this.input.value, at };
        const option = this.list.children[at]!;
        option.setAttribute("aria-selected", "true");
        option.scrollIntoView({ block: "nearest" });
        this.input.setAttribute("aria-activedescendant", option.id);
    }

    /** Inserts the option with the index `at`, and closes the list. */
    private choose(at: number): void {
        const { start, options, suffix } = this.cycle!;
        this.replaceUpToCaret(start, options[at]! + suffix);
        this.hideList();
        this.input.focus();
    }

    /** Replaces the text of the input from the index `start` to the caret. */
    private replaceUpToCaret(start: number, text: string): void {
        const { value, selectionEnd } = this.input;
        this.input.value = value.slice(0, start) + text + value.slice(selectionEnd ?? value.length);
        this.input.setSelectionRange(start + text.length, start + text.length);
    }

    private hideList(): void {
        this.cycle = undefined;
        this.list.hidden = true;
        this.list.replaceChildren();
        this.input.setAttribute("aria-expanded", "false");
        this.input.removeAttribute("aria-activedescendant");
    }

    private setText(text: string): void {
        this.hideList();
        this.input.value = text;
        this.input.setSelectionRange(text.length, text.length);
    }

    private showError(error: string): void {
        this.error.textContent = error === "" ? "" : toSentence(error);
        if (error !== "") this.form.scrollIntoView({ block: "nearest" });
        this.input.setAttribute("aria-invalid", String(error !== ""));
    }

    private async submit(): Promise<void> {
        this.hideList();
        const line = this.input.value.trim().replace(/^:\s*/, "");
        if (line === "") return this.close();
        this.history = [...this.history.filter((earlier) => earlier !== line), line].slice(-kMaxHistory);
        this.historyPosition = 0;
        saveToStorage(kHistoryKey, this.history);
        const { openings } = this;
        // Returns true unless the command line has been opened again since the line was submitted.
        const isSame = (): boolean => openings === this.openings;
        try {
            await this.events.runLine(line);
            if (isSame()) this.close();
        } catch (error) {
            if (!isSame() || this.form.hidden) {
                this.events.failedLater(error as Error);
                return undefined;
            }
            this.showError((error as Error).message);
            this.input.select();
        }
        return undefined;
    }
}
