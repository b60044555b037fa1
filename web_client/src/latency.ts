// Measures the key-to-picture latency: the time from each request to the presentation of its picture. `:set latency`
// shows statistics, `:export latency` saves the samples as a CSV file, and scripts on the page read them with
// performance.getEntriesByName(kMeasure).
//
// A browser does not report when a canvas appears on the screen. A measurement therefore ends in the first task after
// the animation frame that drew the picture (see Stage). By then, the browser has rendered the page. The compositor,
// the graphics card and the screen add time that the page cannot measure.

import { download } from "./download";
import { byId } from "./element";
import { loadFromStorage, saveToStorage } from "./storage";
import type { RenderingMode } from "./picture/stage";

export const kMeasure = "oval4d key to picture"; // the name of all performance measures that the page records

const kMaxSamples = 10_000;
const kRecentSamples = 500; // the statistics on the page cover this many newest samples
const kShownKey = "oval4d.latency"; // key in sessionStorage: whether the statistics are shown

interface LatencySample {
    /** When the request was sent, in milliseconds as in performance.now(). */
    start: number;
    milliseconds: number;
    revision: number;
    request: string;
    drawnBy: RenderingMode;
}

export class LatencyMeter {
    private readonly output = byId("latency");
    private readonly samples: LatencySample[] = [];
    private pending: Pick<LatencySample, "start" | "revision" | "request">[] = [];
    private presentedRevision = 0;
    private presentedAt = 0; // milliseconds, as in performance.now()
    private presentedBy: RenderingMode = "geometry";

    constructor() {
        this.output.hidden = loadFromStorage<boolean>(kShownKey) !== true;
        this.updateText();
    }

    /** The newest measured latency in milliseconds; undefined before the first measurement. */
    get last(): number | undefined {
        return this.samples.at(-1)?.milliseconds;
    }

    /**
     * Measures the time until the picture of a request is presented. A request that changes nothing has no picture, and
     * is not measured.
     */
    async track(request: string, answer: Promise<{ revision: number }>): Promise<void> {
        const start = performance.now();
        const { presentedRevision } = this;
        const { revision } = await answer;
        if (revision > presentedRevision) this.pending.push({ start, revision, request });
        this.completeSamples();
    }

    picturePresented(revision: number, by: RenderingMode): void {
        this.presentedRevision = revision;
        this.presentedAt = performance.now();
        this.presentedBy = by;
        this.completeSamples();
    }

    /** Forgets the revisions: a new connection may be to a session whose revisions start at 0. */
    prepareForNewConnection(): void {
        this.pending = [];
        this.presentedRevision = 0;
    }

    /**
     * Executes a command about latency; returns false for any other command. Throws an Error if there is nothing to
     * export.
     */
    execute(line: string): boolean {
        const command = line.trim().replace(/\s*=\s*/, "=").replace(/\s+/g, " ");
        if (/^set latency(=on)?$/.test(command)) this.setShown(true);
        else if (/^set (nolatency|latency=off)$/.test(command)) this.setShown(false);
        else if (command === "export latency") this.saveCsv();
        else return false;
        return true;
    }

    private setShown(shown: boolean): void {
        saveToStorage(kShownKey, shown);
        this.output.hidden = !shown;
        this.updateText();
    }

    private saveCsv(): void {
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

    private completeSamples(): void {
        const done = this.pending.filter(({ revision }) => revision <= this.presentedRevision);
        if (done.length === 0) return;
        this.pending = this.pending.filter(({ revision }) => revision > this.presentedRevision);
        for (const request of done) {
            const milliseconds = this.presentedAt - request.start;
            this.record({ ...request, milliseconds, drawnBy: this.presentedBy });
        }
        this.updateText();
    }

    private record(sample: LatencySample): void {
        if (this.samples.length >= kMaxSamples) {
            this.samples.splice(0, kMaxSamples / 2);
            performance.clearMeasures(kMeasure);
        }
        this.samples.push(sample);
        const { start, revision, request, drawnBy } = sample;
        performance.measure(kMeasure, { start, end: this.presentedAt, detail: { revision, request, drawnBy } });
    }

    private updateText(): void {
        if (this.output.hidden) return;
        const recent = this.samples.slice(-kRecentSamples).map((sample) => sample.milliseconds);
        if (recent.length === 0) {
            this.output.textContent = "Key-to-picture latency: press a key";
            return;
        }
        const text = (value: number): string => `${value < 10 ? value.toFixed(1) : value.toFixed(0)} ms`;
        const sorted = [...recent].sort((a, b) => a - b);
        const quantile = (part: number): string =>
            text(sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))]!);
        this.output.textContent = [
            `Key-to-picture latency ${text(recent.at(-1)!)}`,
            `median ${quantile(0.5)}`,
            `99th percentile ${quantile(0.99)}`,
            `${recent.length} measured`,
        ].join(" \u00b7 ");
    }
}
