// Shows the status of the connection.

import type { Status } from "@oval4d/protocol";

import { byId } from "./element";
import { capitalized, time } from "./format";

export class ConnectionView {
    private readonly root = byId("connection");
    private readonly text = this.root.querySelector("span")!;
    private readonly stale = byId("stale");
    private readonly drawing = byId("drawing");
    private readonly live = byId("spoken");
    private status: Status = { kind: "connecting" };
    private presentedAt: Date | undefined;
    private countdown: ReturnType<typeof setInterval> | undefined;

    update(status: Status): void {
        if (status.kind !== this.status.kind && status.kind !== "connecting") this.live.textContent = words(status, 0);
        this.status = status;
        clearInterval(this.countdown);
        const until = Date.now() + (status.kind === "waiting" ? status.seconds * 1000 : 0);
        const write = (): void => this.write(Math.max(0, until - Date.now()) / 1000);
        write();
        if (status.kind === "waiting") this.countdown = setInterval(write, 1000);
    }

    /** Notes that a picture has been presented; `latency` is the time from the key to the picture in milliseconds. */
    presented(latency: number | undefined): void {
        this.presentedAt = new Date();
        if (this.status.kind !== "open") return;
        this.root.title = latency === undefined ? "" : `Key to picture: ${latency.toFixed(0)} ms`;
        this.root.dataset["latency"] = latency === undefined ? "" : latency.toFixed(1);
    }

    private write(seconds: number): void {
        const { kind } = this.status;
        this.root.dataset["kind"] = kind;
        this.text.textContent = words(this.status, seconds);
        const isStale = kind !== "open" && this.presentedAt !== undefined;
        this.drawing.toggleAttribute("data-stale", isStale);
        this.stale.hidden = !isStale;
        if (isStale) this.stale.textContent = `Not connected. This picture is from ${time(this.presentedAt!)}.`;
    }
}

function words(status: Status, seconds: number): string {
    if (status.kind === "open") return "Connected";
    if (status.kind === "connecting") return "Connecting…";
    if (status.kind === "closed") return `Closed: ${status.reason}`;
    const when = seconds < 1 ? "now" : `in ${Math.ceil(seconds)} s`;
    return `${capitalized(status.reason)}; trying again ${when}`;
}
