// Measures the time from each request to the presentation of its picture. `:set latency` shows the times,
// `:export latency` saves them as a CSV file, and scripts find them among the page's performance measures.

import { download } from "./download";
import { byId } from "./element";
import { recall, remember } from "./memory";
import type { Mode } from "./picture/stage";

export const kMeasure = "oval4d key to picture"; // for performance.getEntriesByName

const kMaxSamples = 10_000;
const kRecentSamples = 500; // samples in the displayed statistics
const kShown = "oval4d.latency"; // storage key

interface Sample {
    /** When the request was sent, in milliseconds as in performance.now(). */
    start: number;
    milliseconds: number;
    revision: number;
    request: string;
    drawnBy: Mode;
}

export class Latency {
    private readonly output = byId("latency");
    private readonly samples: Sample[] = [];
    private waiting: Pick<Sample, "start" | "revision" | "request">[] = [];
    private seen = 0; // revision
    private seenAt = 0;
    private seenBy: Mode = "geometry";

    constructor() {
        this.output.hidden = recall<boolean>(kShown) !== true;
        this.write();
    }

    /** The last sample, in milliseconds. */
    get last(): number | undefined {
        return this.samples.at(-1)?.milliseconds;
    }

    /** Tracks a request until its picture is presented. A request that changes nothing has no picture. */
    async follow(request: string, answer: Promise<{ revision: number }>): Promise<void> {
        const start = performance.now();
        const { seen } = this;
        const { revision } = await answer;
        if (revision > seen) this.waiting.push({ start, revision, request });
        this.settle();
    }

    presented(revision: number, by: Mode): void {
        this.seen = revision;
        this.seenAt = performance.now();
        this.seenBy = by;
        this.settle();
    }

    /** Forgets the revisions: a new connection may be to a session whose revisions start at 0. */
    restart(): void {
        this.waiting = [];
        this.seen = 0;
    }

    /** Executes a command about latency; returns false for any other command. */
    command(line: string): boolean {
        const words = line.trim().replace(/\s*=\s*/, "=").replace(/\s+/g, " ");
        if (/^set latency(=on)?$/.test(words)) this.show(true);
        else if (/^set (nolatency|latency=off)$/.test(words)) this.show(false);
        else if (words === "export latency") this.save();
        else return false;
        return true;
    }

    private show(shown: boolean): void {
        remember(kShown, shown);
        this.output.hidden = !shown;
        this.write();
    }

    private save(): void {
        if (this.samples.length === 0) throw new Error("nothing has been measured yet: turn the polytope first");
        const rows = this.samples.map(({ start, milliseconds, revision, request, drawnBy }) =>
            [
                new Date(performance.timeOrigin + start).toISOString(),
                ...[milliseconds.toFixed(2), revision, request, drawnBy],
            ].join(","),
        );
        const table = ["sent,milliseconds,revision,request,drawn_by", ...rows, ""].join("\n");
        download(new TextEncoder().encode(table), "latency.csv", "text/csv");
    }

    private settle(): void {
        const done = this.waiting.filter(({ revision }) => revision <= this.seen);
        if (done.length === 0) return;
        this.waiting = this.waiting.filter(({ revision }) => revision > this.seen);
        for (const one of done) this.record({ ...one, milliseconds: this.seenAt - one.start, drawnBy: this.seenBy });
        this.write();
    }

    private record(sample: Sample): void {
        if (this.samples.length >= kMaxSamples) {
            this.samples.splice(0, kMaxSamples / 2);
            performance.clearMeasures(kMeasure);
        }
        this.samples.push(sample);
        const { start, revision, request, drawnBy } = sample;
        performance.measure(kMeasure, { start, end: this.seenAt, detail: { revision, request, drawnBy } });
    }

    private write(): void {
        if (this.output.hidden) return;
        const recent = this.samples.slice(-kRecentSamples).map((sample) => sample.milliseconds);
        if (recent.length === 0) {
            this.output.textContent = "Key to picture: press a key";
            return;
        }
        const text = (value: number): string => `${value < 10 ? value.toFixed(1) : value.toFixed(0)} ms`;
        const sorted = [...recent].sort((a, b) => a - b);
        const at = (part: number): string => text(sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))]!);
        this.output.textContent = [
            `Key to picture ${text(recent.at(-1)!)}`,
            `median ${at(0.5)}`,
            `99th percentile ${at(0.99)}`,
            `${recent.length} measured`,
        ].join(" \u00b7 ");
    }
}
