// Loads files that are dropped on the page or chosen: shows the progress, and the server's warnings or error.

import type { Client, Done, RequestError } from "@oval4d/protocol";

import { byId, element } from "./element";
import { FileError, linesAround, type PolytopeFile, readFile } from "./files";
import { sentence } from "./format";

const kProgressInterval = 100; // milliseconds
const kDefaultLimit = 8 * 2 ** 20; // bytes of a message, if the server states no limit
const kMaxKeptFiles = 8; // as many as a session holds
const kMaxExcerptWidth = 120; // characters of a line of the file

export class Loading {
    private readonly root = byId("loading");
    private readonly title = byId("loading-title");
    private readonly progress = this.root.querySelector("progress")!;
    private readonly report = this.root.querySelector<HTMLElement>(".report")!;
    private readonly chooser = byId<HTMLInputElement>("file");
    private readonly target = byId("drop");
    private readonly kept = new Map<string, PolytopeFile>(); // files from this page that the session holds
    private queue: Promise<void> = Promise.resolve();

    constructor(private readonly client: Client) {
        this.chooser.addEventListener("change", () => {
            this.take([...(this.chooser.files ?? [])]);
            this.chooser.value = ""; // so that the same file can be chosen again after a correction
        });
        this.root.querySelector("[data-close]")!.addEventListener("click", () => this.hide());
        this.root.addEventListener("keydown", (event) => event.key === "Escape" && this.hide());
        this.listenForDrops();
    }

    /** Opens the browser's file chooser. */
    choose(): void {
        this.chooser.click();
    }

    /** Loads a file of this page again, into a new session; does nothing if there is no file of this name. */
    async reload(name: string): Promise<void> {
        const file = this.kept.get(name);
        if (file) await this.client.request({ type: "load", ...file });
    }

    /** Hides the panel, unless a file is being loaded. */
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
        let read: PolytopeFile | undefined;
        try {
            this.begin(file.name);
            read = await readFile(file, this.client.welcome?.limits["message"] ?? kDefaultLimit);
            const done = await this.send(read);
            this.keep(read);
            this.end(done.warnings ?? []);
        } catch (error) {
            this.fail(error as Error, read?.data ?? "");
        }
    }

    private async send(file: PolytopeFile): Promise<Done> {
        const answer = this.client.request({ type: "load", ...file });
        const all = this.client.unsent;
        const timer = setInterval(() => {
            const { unsent } = this.client;
            this.say(unsent > 0 ? `Sending the file: ${Math.floor(100 * (1 - unsent / all))}%` : "Checking the file");
            if (unsent > 0) this.progress.value = 1 - unsent / all;
            else this.progress.removeAttribute("value"); // the server does not report progress
        }, kProgressInterval);
        return await answer.finally(() => clearInterval(timer));
    }

    private keep(file: PolytopeFile): void {
        this.kept.delete(file.name);
        this.kept.set(file.name, file);
        if (this.kept.size > kMaxKeptFiles) this.kept.delete([...this.kept.keys()][0]!);
    }

    private begin(name: string): void {
        this.title.textContent = name;
        this.root.hidden = false;
        this.root.dataset["outcome"] = "";
        this.root.setAttribute("aria-busy", "true");
        this.progress.hidden = false;
        this.progress.removeAttribute("value");
        this.say("Reading the file");
    }

    private end(warnings: string[]): void {
        this.finish("done");
        if (warnings.length === 0) return this.hide();
        const list = element("ul", {}, ...warnings.map((warning) => element("li", {}, sentence(warning))));
        this.say("Loaded, with these warnings:", list);
        return undefined;
    }

    private fail(error: Error, data: string): void {
        this.finish("failed");
        const [, line] = /\bline (\d+)/.exec(error.message) ?? [];
        const refused = error instanceof FileError || (error as RequestError).code !== "not_connected";
        this.say(
            refused ? sentence(error.message) : "The connection was lost before the file was loaded. Try again.",
            ...(line !== undefined && data !== "" ? [excerpt(data, Number(line))] : []),
        );
    }

    private finish(outcome: "done" | "failed"): void {
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

/** The faulty line of the file, with its neighboring lines. */
function excerpt(data: string, faulty: number): HTMLElement {
    const lines = linesAround(data, faulty).map(({ number, text }) => {
        const shown = text.length > kMaxExcerptWidth ? `${text.slice(0, kMaxExcerptWidth)}…` : text;
        const attributes = number === faulty ? { class: "faulty" } : {};
        return element("div", attributes, element("i", {}, String(number)), element("code", {}, shown));
    });
    return element("div", { class: "excerpt", role: "group", "aria-label": "Excerpt of the file" }, ...lines);
}

