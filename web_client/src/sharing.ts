// Links and scripts that open the session, or its view, elsewhere.

import type { Client, RequestError } from "@oval4d/protocol";

import { fileName } from "./download";
import { shareLink, viewLink } from "./link";
import type { Notice } from "./notice";

export class Sharing {
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

    /** Copies a Python script that opens the present view and saves its picture. */
    async copyPython(objectName: string, { width, height }: { width: number; height: number }): Promise<void> {
        try {
            const link = JSON.stringify(await this.linkForScript());
            const picture = JSON.stringify(fileName([objectName], "png"));
            const lines = [
                "from oval4d_client import connect  # pip install ./protocol/python",
                "",
                `with connect(${link}) as oval:`,
                "    oval.hello()",
                `    with open(${picture}, "wb") as file:`,
                `        file.write(oval.frame(${width}, ${height}))`,
                "",
            ];
            await this.copy("Python script", lines.join("\n"), "It opens this view and saves its picture");
        } catch (error) {
            this.notice.show((error as Error).message);
        }
    }

    /** Copies a link; `effect` says what it does. */
    async copyLink(link: string, effect: string): Promise<void> {
        await this.copy("link", link, effect);
    }

    /** The link that opens the view or, if the object is from a file, which only this session has, the session's. */
    private async linkForScript(): Promise<string> {
        try {
            return viewLink((await this.client.request({ type: "get", what: "address" })).query);
        } catch (error) {
            const { credentials } = this.client;
            if ((error as RequestError).code !== "unknown_polytope" || !credentials) throw error;
            return shareLink(credentials);
        }
    }

    /** Copies a text, or shows it for copying. */
    private async copy(what: string, text: string, effect: string): Promise<void> {
        try {
            await navigator.clipboard.writeText(text);
            this.notice.show(`${what} copied. ${effect}.`);
        } catch {
            this.notice.show(`Copy this ${what}. ${effect}:`, text);
        }
    }
}
