// Makes links and scripts that open the session or its view elsewhere.

import type { Client, RequestError, Scheme, Viewport } from "@oval4d/protocol";

import { fileName } from "./download";
import { shareLink, viewLink } from "./link";
import type { Notice } from "./notice";

export class SessionSharing {
    constructor(
        private readonly client: Client,
        private readonly notice: Notice,
    ) {}

    /** Copies a link with which others join this session. */
    async copySessionLink(): Promise<void> {
        if (!this.client.credentials) return;
        await this.copyLink(shareLink(this.client.credentials), "Anyone who opens it joins this session");
    }

    /** Copies a link that opens the present view in a new session. */
    async copyViewLink(): Promise<void> {
        try {
            const { query } = await this.client.request({ type: "get", what: "address" });
            await this.copyLink(viewLink(query), "It opens this view in a new session");
        } catch (error) {
            this.notice.show((error as Error).message);
        }
    }

    /** Copies a Python script. It opens the present view, and saves its picture with this size and color scheme. */
    async copyPython(objectName: string, { width, height }: Viewport, scheme: Scheme): Promise<void> {
        try {
            const { link, joins } = await this.linkForScript();
            const picture = JSON.stringify(fileName([objectName], "png"));
            const lines = [
                "from oval4d_client import connect  # pip install ./protocol/python",
                "",
                `with connect(${JSON.stringify(link)}) as oval:`,
                `    oval.hello(${scheme === "light" ? 'scheme="light"' : ""})`,
                `    with open(${picture}, "wb") as file:`,
                `        file.write(oval.frame(${width}, ${height}))`,
                "",
            ];
            const effect = joins ? "Anyone who runs it joins this session" : "It opens this view and saves its picture";
            await this.copy("Python script", lines.join("\n"), effect);
        } catch (error) {
            this.notice.show((error as Error).message);
        }
    }

    /** Copies a link. `effect` is a sentence that tells the user what the link does. */
    async copyLink(link: string, effect: string): Promise<void> {
        await this.copy("link", link, effect);
    }

    /**
     * A link for a script, which opens the present view in a new session. If the object comes from a file, only this
     * session has it: the link then joins this session, and `joins` is true.
     */
    private async linkForScript(): Promise<{ link: string; joins: boolean }> {
        try {
            const { query } = await this.client.request({ type: "get", what: "address" });
            return { link: viewLink(query), joins: false };
        } catch (error) {
            const { credentials } = this.client;
            if ((error as RequestError).code !== "unknown_polytope" || !credentials) throw error;
            return { link: shareLink(credentials), joins: true };
        }
    }

    /** Copies a text. If the browser forbids this, shows the text so that the user can copy it. */
    private async copy(what: string, text: string, effect: string): Promise<void> {
        try {
            await navigator.clipboard.writeText(text);
            this.notice.show(`${what} copied. ${effect}.`);
        } catch {
            this.notice.show(`Copy this ${what}. ${effect}:`, text);
        }
    }
}
