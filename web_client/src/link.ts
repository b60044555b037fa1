// Determines what the page shows at the start. The first of these that exists is used:
// 1. A shared session, from the fragment of the URL.
// 2. The previous session of this browser history entry or this tab, as after a reload or Back.
// 3. A view, from the query of the URL.

import type { Credentials } from "@oval4d/protocol";

import address from "../../protocol/address.json";
import { boxOf, kUsualBox, parseNumbers, type FormulaWithBox } from "./fields";
import { loadFromStorage, saveToStorage } from "./storage";

export interface InitialView {
    /** The session that the page joins, or returns to, instead of opening a new one. */
    credentials?: Credentials;
    /** The field that the query describes. A new session loads the field before it executes `lines`. */
    field?: FormulaWithBox;
    /**
     * What is wrong with the address: with the link to a session, with `box` in the query, or with `box` or `values`
     * without `formula`. The server reports all other faults in the query.
     */
    faults: string[];
    /** Lines for the command line. They produce the view that the query describes, except its field. */
    lines: string[];
}

interface StoredSession {
    credentials: Credentials;
    /** The query of the page's address at the time of storing. */
    query: string;
}

/** What the page stores in an entry of the browser's history. */
interface BrowserHistoryEntry {
    credentials?: Credentials;
}

// Parameters that the query of the server's frame.png has, but a view does not.
const kIgnoredParameters = ["width", "height", "token"];
const kFieldParameters = ["formula", "values", "box"]; // parameters of a field, which do not become commands
const kSessionKey = `oval4d.session ${location.pathname}`; // storage key of the tab's newest session

export function extractInitialView(): InitialView {
    const { credentials, fault } = extractSharedSession();
    const faults = fault ? [fault] : [];
    if (credentials) return { credentials, lines: [], faults };
    const known = sessionOfHistoryEntry() ?? sessionOfTab();
    if (known) return { credentials: known, lines: [], faults };
    const view = fieldInQuery(location.search);
    return { ...view, lines: commandLines(location.search), faults: [...faults, ...view.faults] };
}

/**
 * The session of a shared link in the address bar, if there is one. Remembers the session, and removes the link's
 * fragment, which contains the token, from the address bar. `fault` is an error message if the name or the token is
 * missing.
 */
export function extractSharedSession(): { credentials?: Credentials; fault?: string } {
    const fragment = new URLSearchParams(repairedQuery(location.hash.slice(1)));
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

/** Returns the session of the current entry of the browser's history; undefined if it has none. */
export function sessionOfHistoryEntry(): Credentials | undefined {
    return (history.state as BrowserHistoryEntry | null)?.credentials;
}

/**
 * The last session of this tab. Undefined if there is none, or if the address has a query now or had one when the
 * session was stored: a link with a query opens a new session.
 */
function sessionOfTab(): Credentials | undefined {
    const stored = loadFromStorage<StoredSession>(kSessionKey);
    return location.search === "" && stored?.query === "" ? stored.credentials : undefined;
}

/** Remembers the session for reloads of the page, and for a return to the current entry of the browser's history. */
export function rememberSession({ session, token }: Credentials): void {
    const credentials = { session, token };
    const entry: BrowserHistoryEntry = { credentials };
    // Browsers limit how often a page may replace the state of a history entry.
    if (JSON.stringify(history.state) !== JSON.stringify(entry)) history.replaceState(entry, "");
    const stored: StoredSession = { credentials, query: location.search };
    saveToStorage(kSessionKey, stored);
}

/** The server's own token, which some servers require of everyone, if the page's address contains it. */
export function serverTokenOfAddress(): string | undefined {
    return new URLSearchParams(location.search).get("token") || undefined;
}

/**
 * A link that opens this session for others. With `serverToken`, it also lets in those who do not know the server's own
 * token.
 */
export function shareLink({ session, token }: Credentials, serverToken?: string): string {
    const link = new URL(location.href);
    link.search = serverToken === undefined ? "" : new URLSearchParams({ token: serverToken }).toString();
    link.hash = new URLSearchParams({ session, token }).toString();
    return link.href;
}

/** Whether a host name means the computer that shows the page. Other devices cannot reach it by such a name. */
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

/**
 * Decodes percent-encoded characters, such as %20. Returns the text unchanged if it is not valid UTF-8, so that an
 * error message can show it.
 */
function decodePercents(text: string): string {
    try {
        return decodeURIComponent(text);
    } catch {
        return text;
    }
}

/**
 * Repairs a query or fragment that a mailer or forum has changed: replaces "&amp;" by "&", and undoes a second encoding
 * of percent signs (%252C).
 */
function repairedQuery(text: string): string {
    return text.replaceAll("&amp;", "&").replace(/%25(?=[0-9a-f]{2})/gi, "%");
}

/** Whether a parameter is one that other sites append to addresses, for example for tracking. */
function isIgnoredParameter(name: string): boolean {
    return address.ignored.some((rule) => (rule.endsWith("*") ? name.startsWith(rule.slice(0, -1)) : name === rule));
}

/**
 * The parameters of a query, without those that protocol/address.json ignores. "+" stands for a blank, as in a form,
 * also before a unit: 10+deg. Between two operands, "+" is a plus sign, because a person may have typed it: 0.1+pi/8.
 * Values that are texts, such as names, have no operands. The server uses the same rules.
 */
function queryParameters(query: string): [name: string, value: string][] {
    const parts = repairedQuery(query)
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
        .filter(([name]) => !isIgnoredParameter(name));
}

/**
 * The field that a query such as "?formula=x^2+y^2<w&box=-1,1,-1,1,-1,1,0,2" describes. If the query has no `formula`,
 * there is no `field` in the result, and `faults` has a text for each of `box` and `values` in the query. If `box` is
 * not valid, `faults` says so, and the field has kUsualBox.
 */
function fieldInQuery(query: string): Pick<InitialView, "field" | "faults"> {
    const { formula, box, values } = Object.fromEntries(queryParameters(query));
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
    // The command "toward" comes last, because it depends on the polytope and the rotations. The query of frame.png has
    // the same order.
    const isLast = ([name]: [string, string]): number => Number(name === "toward");
    return queryParameters(query)
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
