// A file that is dropped on the page, or chosen: how far it has come, and what the server says of it.

import type { Client, Done, RequestError } from "@oval4d/protocol";

import { byId, element } from "./element";
import { FileError, linesAround, readFile, type Readable } from "./files";

const kProgress = 100; // milliseconds between two looks at how far it is
const kDefaultLimit = 8 * 2 ** 20; // bytes of a message, where the server names none
const kMostKept = 8; // files: as many as a session holds
const kMostShown = 120; // characters of a line of the file

export class Loading {
    private readonly root = byId("loading");
    private readonly title = byId("loading-title");
    private readonly progress = this.root.querySelector("progress")!;
    private readonly report = this.root.querySelector<HTMLElement>(".report")!;
    private readonly chooser = byId<HTMLInputElement>("file");
    private readonly target = byId("drop");
    private readonly kept = new Map<string, Readable>(); // what the session has of this page's files
    private queue: Promise<void> = Promise.resolve();

    constructor(private readonly client: Client) {
        this.chooser.addEventListener("change", () => {
            this.take([...(this.chooser.files ?? [])]);
            this.chooser.value = ""; // the same file may be chosen again, mended
        });
        this.root.querySelector("[data-close]")!.addEventListener("click", () => this.hide());
        this.root.addEventListener("keydown", (event) => event.key === "Escape" && this.hide());
        this.listenForDrops();
    }

    /** Has the user choose a file. */
    choose(): void {
        this.chooser.click();
    }

    /** Loads the file of this name once more, into a session that has not got it; without such a file nothing. */
    async again(name: string): Promise<void> {
        const readable = this.kept.get(name);
        if (readable) await this.client.request({ type: "load", ...readable });
    }

    /** Puts away what was said, unless a file is on its way. */
    hide(): void {
        if (this.root.hasAttribute("aria-busy")) return;
        const within = this.root.contains(document.activeElement);
        this.root.hidden = true;
        if (within) byId("drawing").focus();
    }

    private take(files: File[]): void {
        for (const file of files) this.queue = this.queue.then(() => this.load(file));
    }

    private async load(file: File): Promise<void> {
        let readable: Readable | undefined;
        try {
            this.begin(file.name);
            readable = await readFile(file, this.client.welcome?.limits["message"] ?? kDefaultLimit);
            const done = await this.send(readable);
            this.keep(readable);
            this.end(done.warnings ?? []);
        } catch (error) {
            this.fail(error as Error, readable?.data ?? "");
        }
    }

    private async send(readable: Readable): Promise<Done> {
        const answer = this.client.request({ type: "load", ...readable });
        const all = this.client.unsent;
        const timer = setInterval(() => {
            const { unsent } = this.client;
            this.say(unsent > 0 ? `Sending, ${Math.floor(100 * (1 - unsent / all))} %` : "Being read and checked");
            if (unsent > 0) this.progress.value = 1 - unsent / all;
            else this.progress.removeAttribute("value"); // it takes as long as it takes
        }, kProgress);
        return await answer.finally(() => clearInterval(timer));
    }

    private keep(readable: Readable): void {
        this.kept.delete(readable.name);
        this.kept.set(readable.name, readable);
        if (this.kept.size > kMostKept) this.kept.delete([...this.kept.keys()][0]!);
    }

    private begin(name: string): void {
        this.title.textContent = name;
        this.root.hidden = false;
        this.root.dataset["outcome"] = "";
        this.root.setAttribute("aria-busy", "true");
        this.progress.hidden = false;
        this.progress.removeAttribute("value");
        this.say("Reading");
    }

    private end(warnings: string[]): void {
        this.rest("done");
        if (warnings.length === 0) return this.hide();
        const list = element("ul", {}, ...warnings.map((warning) => element("li", {}, sentence(warning))));
        this.say("It is shown, after repairs:", list);
        return undefined;
    }

    private fail(error: Error, data: string): void {
        this.rest("failed");
        const [, line] = /\bline (\d+)/.exec(error.message) ?? [];
        const refused = error instanceof FileError || (error as RequestError).code !== "not_connected";
        this.say(
            refused ? sentence(error.message) : "The connection was lost while the file was on its way. Try again.",
            ...(line !== undefined && data !== "" ? [excerpt(data, Number(line))] : []),
        );
    }

    private rest(outcome: "done" | "failed"): void {
        this.root.removeAttribute("aria-busy");
        this.root.dataset["outcome"] = outcome;
        this.progress.hidden = true;
    }

    private say(text: string, ...more: Node[]): void {
        if (this.report.firstChild?.textContent === text && more.length === 0) return;
        this.report.replaceChildren(element("p", {}, text), ...more);
    }

    private listenForDrops(): void {
        const hasFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes("Files") ?? false;
        const show = (over: boolean): void => void (this.target.hidden = !over);
        window.addEventListener("dragover", (event) => {
            if (!hasFiles(event)) return;
            event.preventDefault();
            event.dataTransfer!.dropEffect = "copy";
            show(true);
        });
        window.addEventListener("dragleave", (event) => event.relatedTarget === null && show(false));
        window.addEventListener("drop", (event) => {
            if (!hasFiles(event)) return;
            event.preventDefault();
            show(false);
            this.take([...event.dataTransfer!.files]);
        });
    }
}

/** The faulty line of the file, and its neighbours. */
function excerpt(data: string, faulty: number): HTMLElement {
    const lines = linesAround(data, faulty).map(({ number, text }) => {
        const shown = text.length > kMostShown ? `${text.slice(0, kMostShown)}…` : text;
        const attributes = number === faulty ? { class: "faulty" } : {};
        return element("div", attributes, element("i", {}, String(number)), element("code", {}, shown));
    });
    return element("div", { class: "excerpt", role: "group", "aria-label": "From the file" }, ...lines);
}

function sentence(text: string): string {
    const begun = text.charAt(0).toUpperCase() + text.slice(1);
    return /[.?!]$/.test(begun) ? begun : `${begun}.`;
}
