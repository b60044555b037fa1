// Starts a real server on its own port.
import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { within } from "./hang_limit.mjs";
import { atEnd } from "./suite.mjs";

const top = join(dirname(fileURLToPath(import.meta.url)), "../../..");
const binary = process.env.OVAL4D ?? process.env.OVAL4D_SERVER ?? join(top, "build/release/bin/oval4d");
/** The folder with the files of the built page. */
export const webRoot = process.env.OVAL4D_WEB_ROOT ?? join(top, "web_client/dist");

/** Starts a server on any free port. */
export async function startServer({ options = [] } = {}) {
    if (!existsSync(binary)) throw new Error(`there is no server at ${binary}: build it, or set OVAL4D`);
    if (!existsSync(join(webRoot, "app.js"))) throw new Error(`there is no page in ${webRoot}: build web_client`);
    const child = spawn(binary, ["--port", "0", "--web-root", webRoot, ...options]);
    const kill = () => child.kill();
    atEnd(kill);
    process.on("exit", kill);
    let said = "";
    const listening = new Promise((resolve, reject) => {
        const listen = (chunk) => {
            said += chunk;
            const [, found] = /listening url=(\S+)/.exec(said) ?? [];
            if (found && /\bready\b/.test(said)) resolve(found);
        };
        child.stdout.on("data", listen);
        child.stderr.on("data", listen);
        child.once("exit", (code) => reject(new Error(`the server ended with ${code}:\n${said}`)));
    });
    const ended = new Promise((resolve) => child.once("exit", resolve));
    void ended.then(() => process.off("exit", kill));
    const url = await within(listening, "the server to listen");
    return {
        url,
        ended,
        /** Stops the server as an operator does. */
        async stop() {
            child.kill("SIGTERM");
            await within(ended, "the server to end");
        },
    };
}
