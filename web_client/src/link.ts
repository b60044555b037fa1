// Determines what the page shows at the start. In this order: a shared session (URL fragment); the session that this
// entry of the browser's history or this tab had before, as after a reload or Back; or a view (URL query).

import type { Credentials } from "@oval4d/protocol";

import address from "../../protocol/address.json";
import { boxOf, kUsualBox, parseNumbers, type FormulaWithBox } from "./fields";
import { readStored, writeStored } from "./storage";

export interface InitialView {
    /** The session to return to, or to join. */
    credentials?: Credentials;
    /** The field of the query, which is loaded in a new session before the commands. */
    field?: FormulaWithBox;
    /**
     * What is wrong with the link to a session, or with the query's `box`, or with `box` or `values` without `formula`.
     * The server reports all other faults in the query.
     */
    faults: string[];
    /** Commands of the command line that produce the view that the query describes, except its field. */
    lines: string[];
}

interface StoredSession {
    credentials: Credentials;
    /** The query of the address when the session was stored. */
    query: string;
}

/** The state of an entry of the browser's history. */
interface HistoryEntry {
    credentials?: Credentials;
}

// Parameters of the server's API that do not belong to the view.
const kIgnoredParameters = ["width", "height", "token"];
const kFieldParameters = ["formula", "values", "box"]; // parameters that are not converted to commands
const kSessionKey = `oval4d.session ${location.pathname}`; // storage key of the tab's newest session

export function extractInitialView(): InitialView {
    const { credentials, fault } = extractSharedSession();
    const faults = fault ? [fault] : [];
    if (credentials) return { credentials, lines: [], faults };
    const known = sessionOfHistoryEntry() ?? sessionOfTab();
    if (known) return { credentials: known, lines: [], faults };
    const view = fieldOf(location.search);
    return { ...view, lines: commandLines(location.search), faults: [...faults, ...view.faults] };
}

/**
 * The session of a shared link in the address bar, if there is one. Remembers the session, and removes the fragment
 * with its token from the address bar. `fault` says whether the name or the token is missing in the link.
 */
export function extractSharedSession(): { credentials?: Credentials; fault?: string } {
    const fragment = new URLSearchParams(repaired(location.hash.slice(1)));
    const [session, token] = [fragment.get("session"), fragment.get("token")];
    if (!/session|token/.test(location.hash)) return {};
    // The token gives access to the session, so it must not stay in the address bar.
    history.replaceState(null, "", location.pathname + location.search);
    if (!session || !token) {
        const missing = session ? "the token that gives access to it" : "the name of the session";
        return { fault: `The link to a shared session is damaged: ${missing} is missing. Copy the whole link again.` };
    }
    rememberSession({ session, token });
    return { credentials: { session, token } };
}

/** The session that the present entry of the browser's history has, if any. */
export function sessionOfHistoryEntry(): Credentials | undefined {
    return (history.state as HistoryEntry | null)?.credentials;
}

/**
 * The last session of this tab; undefined if there is none, or if the current address has a query or had one when the
 * session was stored. A link with a query therefore opens a new session.
 */
function sessionOfTab(): Credentials | undefined {
    const stored = readStored<StoredSession>(kSessionKey);
    return location.search === "" && stored?.query === "" ? stored.credentials : undefined;
}

/** Remembers the session for reloads, and for the return to this entry of the browser's history. */
export function rememberSession({ session, token }: Credentials): void {
    const credentials = { session, token };
    const entry: HistoryEntry = { credentials };
    // Browsers limit how often the state is replaced.
    if (JSON.stringify(history.state) !== JSON.stringify(entry)) history.replaceState(entry, "");
    const stored: StoredSession = { credentials, query: location.search };
    writeStored(kSessionKey, stored);
}

/** The server's own token, if the address of the page has it. */
export function serverTokenOfAddress(): string | undefined {
    return new URLSearchParams(location.search).get("token") || undefined;
}

/** A link that opens this session for others; with the server's own token, also for those who do not know this. */
export function shareLink({ session, token }: Credentials, serverToken?: string): string {
    const link = new URL(location.href);
    link.search = serverToken === undefined ? "" : new URLSearchParams({ token: serverToken }).toString();
    link.hash = new URLSearchParams({ session, token }).toString();
    return link.href;
}

/** Whether this host of an address is the computer on which the page is: other devices cannot reach it by this name. */
export function isOwnComputer(host: string): boolean {
    return /^(.+\.)?localhost\.?$|^127(\.\d+){3}$|^0\.0\.0\.0$|^\[::1?\]$/.test(host);
}

/** A link that opens the view of a query in a new session. */
export function viewLink(query: string): string {
    const link = new URL(location.href);
    link.search = query;
    link.hash = "";
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

/**
 * Restores a query or fragment in which a mailer or a forum has replaced "&" by "&amp;", or encoded the percent signs a
 * second time (%252C).
 */
function repaired(text: string): string {
    return text.replaceAll("&amp;", "&").replace(/%25(?=[0-9a-f]{2})/gi, "%");
}

/** Whether this is the name of a parameter that other sites append to addresses, such as those for tracking. */
function isIgnored(name: string): boolean {
    return address.ignored.some((rule) => (rule.endsWith("*") ? name.startsWith(rule.slice(0, -1)) : name === rule));
}

/**
 * The parameters of a query, without those that protocol/address.json ignores. "+" stands for a blank, as in a form,
 * and so it does before a unit: 10+deg. But between two operands, "+" is a plus sign, because a person may have typed
 * it: 0.1+pi/8. The server reads the queries of the API in the same way.
 */
function parametersOf(query: string): [name: string, value: string][] {
    const parts = repaired(query)
        .replace(/^\?/, "")
        .split("&")
        .filter((part) => part !== "");
    return parts
        .map((part): [string, string] => {
            const [name = "", value = ""] = part.split(/=(.*)/s);
            const isArithmetic = !address.texts.includes(decodePercents(name));
            const pieces = value.split("+").map(decodePercents);
            const text = pieces.reduce((before, after) => {
                const adds = isArithmetic && /[\p{L}\p{N}.)°]$/u.test(before) && /^(?!(?:deg|rad)(?![a-z(]))[\p{L}\p{N}.(]/iu.test(after);
                return before + (adds ? "+" : " ") + after;
            });
            return [decodePercents(name), text];
        })
        .filter(([name]) => !isIgnored(name));
}

/**
 * The field that a query describes, such as "?formula=x^2+y^2<w&box=-1,1,-1,1,-1,1,0,2"; absent if the query has no
 * `formula`. If `box` is not valid, the field has kUsualBox. `faults` has a text if `box` is not valid, and one for
 * each of `box` and `values` that the query has without `formula`.
 */
function fieldOf(query: string): Pick<InitialView, "field" | "faults"> {
    const { formula, box, values } = Object.fromEntries(parametersOf(query));
    if (formula === undefined) {
        const alone = Object.entries({ box, values }).filter(([, value]) => value !== undefined);
        return {
            faults: alone.map(([name, value]) => `The address contains “${name}=${value}”: ${name} needs a formula`),
        };
    }
    const given = box === undefined ? kUsualBox : boxOf(parseNumbers(box));
    const fault = `The address contains “box=${box}”: it must be eight numbers, the ranges of x, y, z and w`;
    return { field: { formula, box: given ?? kUsualBox, ...(values && { values }) }, faults: given ? [] : [fault] };
}

/**
 * Converts a query such as "?polytope=24-cell&rotate=xw,yz:0.39,1.42&slices=31" to commands for the command line.
 * "field=tiger" is the same as "polytope=tiger".
 */
export function commandLines(query: string): string[] {
    // "toward" comes last, as in the query of the API's frame.png, because it depends on the polytope and the
    // rotations.
    const isLast = ([name]: [string, string]): number => Number(name === "toward");
    return parametersOf(query)
        .filter(([name]) => ![...kIgnoredParameters, ...kFieldParameters].includes(name))
        .sort((a, b) => isLast(a) - isLast(b))
        .map(([name, value]) => {
            if (name === "polytope" || name === "field") return `polytope ${value}`;
            if (name === "toward") return `toward ${value.replace(":", " ")}`;
            const plain = value.replace(/\s*([,:])\s*/g, "$1").trim();
            if (name !== "rotate") return `set ${name}=${plain}`;
            const [planes = "", angles = ""] = plain.split(":");
            return `rotate ${planes} ${angles.replace(/\s/g, "").replaceAll(",", " ")}`;
        });
}
