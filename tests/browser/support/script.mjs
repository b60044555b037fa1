// A script that joins the session of a page, as a second client.
import WebSocket from "ws";

import { Client } from "../node_modules/.oval4d/client.mjs";
import { atEnd } from "./suite.mjs";
import { within } from "./hang_limit.mjs";

/** Joins the session with these credentials; without credentials, creates a session. */
export async function joinSession(url, credentials) {
    const watchers = new Set();
    let state;
    const opened = new Promise((resolve, reject) => {
        const client = new Client({
            url,
            credentials,
            webSocket: WebSocket,
            stream: "none",
            onStatus: ({ kind }) => kind === "open" && resolve(client),
            onLost: (reason) => reject(new Error(reason)),
            onState: (newer) => {
                state = newer;
                for (const watch of watchers) watch();
            },
        });
        atEnd(() => client.close());
        client.connect();
    });
    const client = await within(opened, "the script to connect");
    return {
        client,
        request: (message) => client.request(message),
        state: () => client.request({ type: "get", what: "state" }),
        /** Waits for a state for which `holds` returns true. Resolves to this state. */
        async until(holds, what) {
            let watch;
            const found = new Promise((resolve) => {
                watch = () => state && holds(state) && resolve(state);
                watchers.add(watch);
                watch();
            });
            try {
                return await within(found, what);
            } finally {
                watchers.delete(watch);
            }
        },
        leave: () => client.close(),
    };
}
