// Loads files that the user chooses or drops on the page, and shows the progress and the server's warnings or error. A
// text is sent in a `load` message; an array is uploaded over HTTP. A picture saved by oval4d, or a JSON file with a
// state, restores the state.

import type { Client, Done, RequestError, State } from "@oval4d/protocol";

import { isBinaryFile, uploadArray } from "./array_upload";
import { byId, element } from "./element";
import { FileError, linesAround, type FileLoadMessage, nameOf, readFile, readState, fileTooLargeText } from "./files";
import { toSentence } from "./format";

const kProgressInterval = 100; // milliseconds between two updates of the progress
const kDefaultLimit = 8 * 2 ** 20; // bytes: the limit on messages, if the server states none
const kMaxKept = 8; // the most objects that can be loaded again: as many as a session holds
const kMaxExcerptWidth = 120; // in the excerpt of a faulty file, longer lines are cut to this many characters

/** An object that can be loaded again: a text, an array, or a field of the server's data folder. */
type ReloadableObject = FileLoadMessage | File | { name: string; path: string };

export class FileLoading {
    private readonly root = byId("loading");
    private readonly title = byId("loading-title");
    private readonly progress = this.root.querySelector("progress")!;
    private readonly report = this.root.querySelector<HTMLElement>(".report")!;
    private readonly chooser = byId<HTMLInputElement>("file");
    private readonly dropTarget = byId("drop");
    private readonly kept = new Map<string, ReloadableObject>(); // what this page loaded, by name
    private queue: Promise<void> = Promise.resolve();

    constructor(
        private readonly client: Client,
        private readonly showState: (state: State) => Promise<unknown>, // shows a state in the session
    ) {
        this.chooser.addEventListener("change", () => {
            this.enqueue([...(this.chooser.files ?? [])]);
            this.chooser.value = ""; // so that the user can choose the same file again after correcting it
        });
        this.root.querySelector("[data-close]")!.addEventListener("click", () => this.hide());
        this.root.addEventListener("keydown", (event) => event.key === "Escape" && this.hide());
        this.listenForDrops();
    }

    /** Opens the browser's file chooser. */
    chooseFile(): void {
        this.chooser.click();
    }

    /** Keeps an object that this page has loaded, so that reloadIntoNewSession() can load it again. */
    keep(object: ReloadableObject): void {
        const name = object instanceof File ? nameOf(object) : object.name;
        this.kept.delete(name);
        this.kept.set(name, object);
        if (this.kept.size > kMaxKept) this.kept.delete([...this.kept.keys()][0]!);
    }

    /**
     * Loads the object of this name into a new session; does nothing if this page has not loaded such an object before.
     */
    async reloadIntoNewSession(name: string): Promise<void> {
        const object = this.kept.get(name);
        if (object instanceof File) await this.upload(object);
        else if (object) await this.client.request({ type: "load", ...object });
    }

    /** Hides the panel, unless a file is being loaded. */
    hide(): void {
        if (this.root.hasAttribute("aria-busy")) return;
        const within = this.root.contains(document.activeElement);
        this.root.hidden = true;
        if (within) byId("drawing").focus();
    }

    private enqueue(files: File[]): void {
        for (const file of files) this.queue = this.queue.then(() => this.load(file));
    }

    private async load(file: File): Promise<void> {
        let read: FileLoadMessage | undefined;
        try {
            this.beginProgress(file.name);
            const limit = this.client.welcome?.limits.message ?? kDefaultLimit;
            const state = await readState(file, limit);
            if (state) {
                await this.showState(state);
                this.finishLoading([]);
                return;
            }
            if (await isBinaryFile(file)) {
                this.finishLoading((await this.upload(file)).warnings ?? []);
                this.keep(file);
                return;
            }
            read = await readFile(file, limit);
            await this.loadObject(read);
        } catch (error) {
            this.showError(error as Error, read?.data ?? "");
        }
    }

    private async loadObject(object: FileLoadMessage): Promise<void> {
        const { warnings = [] } = await this.send(object);
        this.keep(object);
        this.finishLoading(warnings, warnings.length > 0 ? await this.originButton(object) : []);
    }

    /**
     * A list with one button. The button loads the object again, so that it turns about the origin of its file. The
     * list is empty if the object already turns about this origin, or if another object is shown.
     */
    private async originButton(object: FileLoadMessage): Promise<Node[]> {
        const { polytope } = await this.client.request({ type: "get", what: "state" });
        if (polytope.name !== object.name || !polytope.center) return [];
        const button = element("button", { type: "button" }, "Turn about the origin of the file");
        button.addEventListener("click", () => {
            byId("drawing").focus(); // the button, which had the focus, disappears
            this.queue = this.queue.then(() => this.loadAgain({ ...object, center: "origin" }));
        });
        return [button];
    }

    private async loadAgain(object: FileLoadMessage): Promise<void> {
        try {
            this.beginProgress(object.name);
            await this.loadObject(object);
        } catch (error) {
            this.showError(error as Error, object.data);
        }
    }

    private upload(file: File): Promise<Done> {
        const { welcome, credentials } = this.client;
        const limit = welcome?.limits.upload ?? Infinity;
        if (file.size > limit) throw new FileError(fileTooLargeText(file.size, limit));
        if (!credentials) throw new FileError("There is no connection to a session. Try again.");
        return uploadArray(file, nameOf(file), credentials, limit, (part) => this.showSent(part));
    }

    /** Shows the progress. `part` is the fraction of the file that has been sent, from 0 to 1. */
    private showSent(part: number): void {
        this.showReport(part < 1 ? `Sending the file: ${Math.floor(100 * part)}%` : "Checking the file");
        if (part < 1) this.progress.value = part;
        else this.progress.removeAttribute("value"); // the server does not report the progress of its check
    }

    private async send(content: FileLoadMessage): Promise<Done> {
        const answer = this.client.request({ type: "load", ...content });
        const all = this.client.unsentBytes;
        const timer = setInterval(() => {
            const { unsentBytes } = this.client;
            this.showSent(unsentBytes > 0 ? Math.min(1 - unsentBytes / all, 0.999) : 1);
        }, kProgressInterval);
        return await answer.finally(() => clearInterval(timer));
    }

    private beginProgress(name: string): void {
        this.title.textContent = name;
        this.root.hidden = false;
        this.root.dataset["outcome"] = "";
        this.root.setAttribute("aria-busy", "true");
        this.progress.hidden = false;
        this.progress.removeAttribute("value");
        this.showReport("Reading the file");
    }

    /** Shows the server's warnings; hides the panel if there are none. */
    private finishLoading(warnings: string[], buttons: Node[] = []): void {
        this.endProgress("done");
        if (warnings.length === 0) return this.hide();
        const list = element("ul", {}, ...warnings.map((warning) => element("li", {}, toSentence(warning))));
        this.showReport("Loaded, with these warnings:", list, ...buttons);
        return undefined;
    }

    private showError(error: Error, data: string): void {
        this.endProgress("failed");
        const [, line] = /\bline (\d+)/.exec(error.message) ?? [];
        const refused = error instanceof FileError || (error as RequestError).code !== "not_connected";
        this.showReport(
            refused ? toSentence(error.message) : "The connection was lost before the file was loaded. Try again.",
            ...(line !== undefined && data !== "" ? [createExcerpt(data, Number(line))] : []),
        );
    }

    private endProgress(outcome: "done" | "failed"): void {
        this.root.removeAttribute("aria-busy");
        this.root.dataset["outcome"] = outcome;
        this.progress.hidden = true;
    }

    private showReport(text: string, ...more: Node[]): void {
        if (this.report.firstChild?.textContent === text && more.length === 0) return;
        this.report.replaceChildren(element("p", {}, text), ...more);
    }

    private listenForDrops(): void {
        const hasFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes("Files") ?? false;
        const showDropTarget = (over: boolean): void => void (this.dropTarget.hidden = !over);
        window.addEventListener("dragover", (event) => {
            if (!hasFiles(event)) return;
            event.preventDefault();
            event.dataTransfer!.dropEffect = "copy";
            showDropTarget(true);
        });
        window.addEventListener("dragleave", (event) => event.relatedTarget === null && showDropTarget(false));
        window.addEventListener("drop", (event) => {
            if (!hasFiles(event)) return;
            event.preventDefault();
            showDropTarget(false);
            this.enqueue([...event.dataTransfer!.files]);
        });
    }
}

/** The line `faulty` of a file, counted from 1, and the lines before and after it. */
function createExcerpt(data: string, faulty: number): HTMLElement {
    const lines = linesAround(data, faulty).map(({ number, text }) => {
        const shown = text.length > kMaxExcerptWidth ? `${text.slice(0, kMaxExcerptWidth)}…` : text;
        const attributes = number === faulty ? { class: "faulty" } : {};
        return element("div", attributes, element("i", {}, String(number)), element("code", {}, shown));
    });
    return element("div", { class: "excerpt", role: "group", "aria-label": "Excerpt of the file" }, ...lines);
}

