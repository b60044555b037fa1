// What the page shows at the start: a shared session (URL fragment), a view (URL query), or the session from before a
// reload.

import type { Credentials } from "@oval4d/protocol";

import { readStored, writeStored } from "./tab_storage";

export interface InitialView {
    /** The session to return to, or to join. */
    credentials?: Credentials;
    /** Commands that produce the view of the query in a new session. */
    lines: string[];
}

interface StoredSession {
    credentials: Credentials;
    query: string;
}

const kIgnoredParameters = ["width", "height", "token"]; // not part of the view
const kSessionKey = `oval4d.session ${location.pathname}`;

export function readInitialView(): InitialView {
    const credentials = extractSharedSession();
    if (credentials) return { credentials, lines: [] };
    const stored = readStored<StoredSession>(kSessionKey);
    if (stored?.query === location.search) return { credentials: stored.credentials, lines: [] };
    return { lines: commandLines(location.search) };
}

/** The session of a shared link in the address bar, if any; removes it from there. */
export function extractSharedSession(): Credentials | undefined {
    const fragment = new URLSearchParams(location.hash.slice(1));
    const [session, token] = [fragment.get("session"), fragment.get("token")];
    if (session === null || token === null) return undefined;
    // The token gives access to the session, so it must not stay in the address bar.
    history.replaceState(null, "", location.pathname + location.search);
    rememberSession({ session, token });
    return { session, token };
}

/** Remembers the session across a reload. */
export function rememberSession(credentials: Credentials): void {
    const stored: StoredSession = { credentials, query: location.search };
    writeStored(kSessionKey, stored);
}

/** A link that opens this session for others. */
export function shareLink({ session, token }: Credentials): string {
    const link = new URL(location.href);
    link.search = "";
    link.hash = new URLSearchParams({ session, token }).toString();
    return link.href;
}

/** Decodes percent signs; returns the text unchanged if it is not valid UTF-8, so that the error message shows it. */
function decodePercents(text: string): string {
    try {
        return decodeURIComponent(text);
    } catch {
        return text;
    }
}

/** Converts a query such as "?polytope=24-cell&rotate=xw,yz:0.39,1.42&slices=31" to commands for the command line. */
export function commandLines(query: string): string[] {
    const parts = query
        .replace(/^\?/, "")
        .split("&")
        .filter((part) => part !== "");
    // A "+" is part of an expression, not an encoded blank.
    const settings = parts.map((part) => part.split(/=(.*)/s).map(decodePercents));
    // "toward" comes last, as in frame.png, because it depends on the polytope and the rotations.
    const isLast = ([name]: string[]): number => Number(name === "toward");
    return settings
        .filter(([name = ""]) => !kIgnoredParameters.includes(name))
        .sort((a, b) => isLast(a) - isLast(b))
        .map(([name = "", value = ""]) => {
            if (name === "polytope") return `polytope ${value.replaceAll("+", " ")}`;
            if (name === "toward") return `toward ${value.replace(":", " ")}`;
            if (name !== "rotate") return `set ${name}=${value}`;
            const [planes = "", angles = ""] = value.split(":");
            return `rotate ${planes} ${angles.replace(/\s/g, "").replaceAll(",", " ")}`;
        });
}
