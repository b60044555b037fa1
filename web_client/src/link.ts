// What the page shows at the start: a shared session from the URL's fragment, a view from its query, or the session
// from before a reload.

import type { Credentials } from "@oval4d/protocol";

import { recall, remember } from "./memory";

export interface Start {
    /** The session to return to, or to join. */
    credentials?: Credentials;
    /** Command lines that produce the view of the query in a new session. */
    lines: string[];
}

interface Kept {
    credentials: Credentials;
    query: string;
}

const kIgnored = ["width", "height", "token"]; // only for pictures: the page has its own size
const kKept = `oval4d.session ${location.pathname}`;

export function readStart(): Start {
    const fragment = new URLSearchParams(location.hash.slice(1));
    const [session, token] = [fragment.get("session"), fragment.get("token")];
    if (session !== null && token !== null) {
        // The token gives access to the session, so it must not stay in the address bar.
        history.replaceState(null, "", location.pathname + location.search);
        keep({ session, token });
        return { credentials: { session, token }, lines: [] };
    }
    const kept = recall<Kept>(kKept);
    if (kept?.query === location.search) return { credentials: kept.credentials, lines: [] };
    return { lines: commandLines(location.search) };
}

/** Remembers the session across a reload. */
export function keep(credentials: Credentials): void {
    const kept: Kept = { credentials, query: location.search };
    remember(kKept, kept);
}

/** A link that opens this session for others. */
export function shareLink({ session, token }: Credentials): string {
    const link = new URL(location.href);
    link.search = "";
    link.hash = new URLSearchParams({ session, token }).toString();
    return link.href;
}

/** Decodes percent signs; returns the text unchanged if it is not valid UTF-8, so that the error message shows it. */
function decoded(text: string): string {
    try {
        return decodeURIComponent(text);
    } catch {
        return text;
    }
}

/** Converts a query such as "?polytope=24-cell&rotate=xw,yz:0.39,1.42&slices=31" to command lines. */
export function commandLines(query: string): string[] {
    const parts = query
        .replace(/^\?/, "")
        .split("&")
        .filter((part) => part !== "");
    // A "+" is part of an expression, not an encoded blank.
    const settings = parts.map((part) => part.split(/=(.*)/s).map(decoded));
    return settings
        .filter(([name = ""]) => !kIgnored.includes(name))
        .map(([name = "", value = ""]) => {
            if (name === "polytope") return `polytope ${value.replaceAll("+", " ")}`;
            if (name !== "rotate") return `set ${name}=${value}`;
            const [planes = "", angles = ""] = value.split(":");
            return `rotate ${planes} ${angles.replace(/\s/g, "").replaceAll(",", " ")}`;
        });
}
