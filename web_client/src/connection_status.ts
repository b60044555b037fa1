// Shows the user whether the page is connected to the server.

import type { Status } from "@oval4d/protocol";

import { byId, element } from "./element";
import { capitalize, formatTime, toSentence } from "./format";

const kMaxWait = 1000; // milliseconds without an answer after which the page says that it waits
const kBlocked =
    "The server answers, but no WebSocket opens. A proxy must pass on the headers Host, Upgrade and Connection.";

// If the server refuses a session for one of these reasons, the session still exists.
const kKeptSession = new Set(["later_version", "internal"]);

export class ConnectionStatusDisplay {
    private readonly root = byId("connection");
    private readonly text = this.root.querySelector("span")!;
    private readonly stale = byId("stale");
    private readonly newSession = element("button", { type: "button" }, "Begin a new session");
    private readonly drawing = byId("drawing");
    private readonly announcer = byId("connection-spoken");
    private status: Status = { kind: "connecting" };
    private refused = ""; // why the server could not open the page's session, although the session exists; otherwise ""
    private presentedAt: Date | undefined;
    private retryAt = 0; // when the next attempt to connect begins, in milliseconds as in Date.now()
    private unanswered = 0; // number of requests without an answer
    private lateAnswers = 0; // number of unanswered requests that were sent more than kMaxWait ago
    private countdown: ReturnType<typeof setInterval> | undefined;

    /** `beginNewSession` is called when the user does not want to wait for a session that the server cannot open. */
    constructor(beginNewSession: () => void) {
        this.newSession.onclick = beginNewSession;
    }

    update(status: Status): void {
        if (status.kind !== this.status.kind && status.kind !== "connecting") {
            this.announcer.textContent = statusText(status, 0);
        }
        this.status = status;
        if (status.kind === "waiting") this.refused = kKeptSession.has(status.refusal ?? "") ? status.reason : "";
        else if (status.kind !== "connecting") this.refused = "";
        clearInterval(this.countdown);
        this.retryAt = Date.now() + (status.kind === "waiting" ? status.seconds * 1000 : 0);
        this.write();
        if (status.kind === "waiting") this.countdown = setInterval(() => this.write(), 1000);
    }

    /**
     * Counts a request as unanswered until `answer` settles. While any answer is late, shows that the page waits for
     * the server.
     */
    trackRequest(answer: Promise<unknown>): void {
        this.countUnanswered(1);
        const count = (change: number): void => {
            this.lateAnswers += change;
            this.write();
        };
        let isLate = false;
        const timer = setTimeout(() => {
            isLate = true;
            count(1);
            if (this.lateAnswers === 1) this.announcer.textContent = this.text.textContent;
        }, kMaxWait);
        const settled = (): void => {
            this.countUnanswered(-1);
            clearTimeout(timer);
            if (isLate) count(-1);
        };
        answer.then(settled, settled);
    }

    /** Records, in the attribute data-revision, the revision of the state that the page's texts and controls show. */
    stateShown(revision: number): void {
        this.root.dataset["revision"] = String(revision);
    }

    /** Records that a picture has been presented; `latency` is the key-to-picture latency in milliseconds, if known. */
    picturePresented(latency: number | undefined): void {
        this.presentedAt = new Date();
        if (this.status.kind !== "open") return;
        this.root.title = latency === undefined ? "" : `Key-to-picture latency: ${latency.toFixed(0)} ms`;
        this.root.dataset["latency"] = latency === undefined ? "" : latency.toFixed(1);
    }

    private countUnanswered(change: number): void {
        this.unanswered += change;
        this.root.dataset["unanswered"] = String(this.unanswered);
    }

    private write(): void {
        const { kind } = this.status;
        const isLate = kind === "open" && this.lateAnswers > 0;
        const seconds = Math.max(0, this.retryAt - Date.now()) / 1000;
        this.root.dataset["kind"] = isLate ? "late" : kind;
        this.text.textContent = isLate ? "Waiting…" : statusText(this.status, seconds);
        const isStale = kind !== "open" && this.presentedAt !== undefined;
        this.drawing.toggleAttribute("data-stale", isStale);
        const isBlocked = "isBlocked" in this.status;
        this.stale.hidden = !isStale && !isBlocked && !this.refused;
        const age = isStale ? `Not connected. This picture is from ${formatTime(this.presentedAt!)}.` : "";
        const lines = [this.refused && toSentence(this.refused), isBlocked ? kBlocked : "", age];
        const text = lines.filter(Boolean).join(" ");
        // The button is not inserted again while the text stays the same, so that it keeps the focus.
        if (this.stale.firstChild?.textContent === text && this.newSession.isConnected === (this.refused !== "")) return;
        this.stale.replaceChildren(text, ...(this.refused ? [this.newSession] : []));
    }
}

function statusText(status: Status, seconds: number): string {
    if (status.kind === "open") return "Connected";
    if (status.kind === "connecting") return "Connecting…";
    if (status.kind === "closed") return `Closed: ${status.reason}`;
    const when = seconds < 1 ? "now" : `in ${Math.ceil(seconds)} s`;
    return `${capitalize(status.reason)}; trying again ${when}`;
}
