// The printed page: only the picture, on white, with its title and the values of the header.

import type { Client } from "@oval4d/protocol";

import { byId, element } from "./element";
import type { Stage } from "./picture/stage";

export class PrintView {
    private readonly root = byId("print");
    private frame: ImageBitmap | undefined; // the picture on white, if the server draws the pictures
    private isPrepared = false;
    // The element that had the focus before printing. Printing takes the focus away.
    private focused: HTMLElement | undefined;

    /** `title` returns the heading to print. `failed` is called if the server does not send the picture to print. */
    constructor(
        private readonly client: Client,
        private readonly stage: Stage,
        private readonly title: () => string,
        private readonly failed: (error: Error) => void,
    ) {
        window.addEventListener("beforeprint", () => this.prepare());
        window.addEventListener("afterprint", () => this.clear());
        matchMedia("print").addEventListener("change", ({ matches }) => (matches ? this.prepare() : this.clear()));
        document.addEventListener("keydown", (event) => this.keydown(event));
        document.addEventListener("focusin", ({ target }) => (this.focused = target as HTMLElement));
    }

    /** Handles Ctrl-P: if the server draws the pictures, requests a picture on white, and prints this picture. */
    private keydown(event: KeyboardEvent): void {
        const isPrintKey = !event.repeat && event.key.toLowerCase() === "p" && event.ctrlKey !== event.metaKey;
        if (!isPrintKey || event.altKey || event.shiftKey || this.stage.mode !== "frames") return;
        event.preventDefault();
        void this.printFrame();
    }

    private async printFrame(): Promise<void> {
        try {
            const request = { what: "frame", background: "white", ...this.stage.printSize } as const;
            const png = await this.client.request({ type: "get", ...request });
            this.frame = await createImageBitmap(new Blob([png as Uint8Array<ArrayBuffer>], { type: "image/png" }));
        } catch (error) {
            this.failed(error as Error); // the picture is then printed as the page shows it
        }
        window.print();
    }

    private prepare(): void {
        if (this.isPrepared) return;
        this.isPrepared = true;
        const canvas = element("canvas");
        if (this.frame) {
            const { width, height } = this.frame;
            Object.assign(canvas, { width, height });
            canvas.getContext("2d")!.drawImage(this.frame, 0, 0);
        } else {
            this.stage.drawForPrint(canvas);
        }
        const values = [...document.querySelectorAll("#state-fields .state-field > button")];
        const section = (byId("focus-section").textContent ?? "").trim();
        this.root.replaceChildren(
            element("h1", {}, this.title()),
            element("p", {}, ...values.map((value) => element("span", {}, (value.textContent ?? "").trim()))),
            ...(section === "" ? [] : [element("p", {}, section)]),
            canvas,
        );
    }

    private clear(): void {
        this.isPrepared = false;
        this.root.replaceChildren();
        this.frame?.close();
        this.frame = undefined;
        if (document.activeElement === document.body) this.focused?.focus({ preventScroll: true });
    }
}
