// The editor for the transfer function of fog. It shows a curve of opacity with draggable control points, and behind
// the curve the distribution of the field's values. Number fields show the same points.

import type { FogControlPoint, Settings, Slices, State } from "@oval4d/protocol";

import { schemeOfPicture } from "./color_scheme";
import { byId, element } from "./element";
import { type ValueDistribution, colorOf, valueDistributionOf, hexDigitsOf, isValidTransferFunction, distributionsLookAlike } from "./fog";
import { kMaxFogControlPoints, kMinFogControlPoints, defaultFog, withNewPoint, withMovedPoint } from "./fog";
import { parseNumbers } from "./fields";
import { toSentence } from "./format";
import { NewestValueSender } from "./newest_only";
import { OldStateDetector } from "./old_state_detector";

const kTypingDelay = 150; // milliseconds without further typing before a change is sent
// The width, height and margin of the curve's SVG, in units of its viewBox.
const [kWidth, kHeight, kMargin] = [240, 96, 9];
const kSvg = "http://www.w3.org/2000/svg";

/** The row of a control point: its input fields, and the button that removes the point. */
interface FogControlPointRow {
    root: HTMLElement;
    value: HTMLInputElement;
    opacity: HTMLInputElement;
    color: HTMLInputElement;
    remove: HTMLButtonElement;
}

export class FogEditor {
    private readonly curve = byId("fog-curve");
    private readonly list = byId("fog-points");
    private readonly error = byId("fog-error");
    private mistake = ""; // what is wrong with the texts in the fields; "" if all are valid
    private refusal = ""; // why the server refused the last change; "" if it did not
    private readonly addButton = byId<HTMLButtonElement>("fog-add");
    private readonly showButton = byId<HTMLButtonElement>("fog-show");
    private readonly offButton = byId<HTMLButtonElement>("fog-off");
    private readonly changes = new NewestValueSender<{ fog: FogControlPoint[]; drag?: number }>((change) => this.apply(change));
    private readonly lastChange = new OldStateDetector();
    private rows: FogControlPointRow[] = [];
    private points: FogControlPoint[] = []; // the control points that the editor shows
    private state: State | undefined;
    private field = ""; // fieldKeyOf() of the newest state: a text that identifies its field
    // How the values of the state's field are distributed; undefined until a picture of the field has a histogram.
    private distribution: ValueDistribution | undefined;
    private ends: [number, number] = [0, 1]; // the least and the greatest value that the curve shows
    private dragged: number | undefined; // the index of the point that is dragged
    // The number of the newest drag, on the curve or in a color dialog. All changes of one drag form one undo step.
    private drag = 0;
    private sentDrag: number | undefined; // the number of the drag to which the last sent change belongs

    /** `set` changes settings; it rejects with an Error whose message is shown. */
    constructor(private readonly set: (change: Settings & { continues?: boolean }) => Promise<{ revision: number }>) {
        this.addButton.addEventListener("click", () => this.change(withNewPoint(this.points)));
        this.showButton.addEventListener("click", () => this.change(this.usualPoints()));
        this.offButton.addEventListener("click", () => {
            this.change([]);
            this.showButton.focus(); // the button Off, which had the focus, disappears
        });
        this.curve.addEventListener("pointerdown", (event) => this.grab(event));
        this.curve.addEventListener("pointermove", (event) => this.moveGrabbed(event));
        for (const end of ["pointerup", "pointercancel"]) this.curve.addEventListener(end, () => this.release());
    }

    prepareForNewConnection(): void {
        this.lastChange.prepareForNewConnection();
    }

    update(state: State): void {
        this.state = state;
        this.showButton.disabled = state.fog === undefined;
        const field = fieldKeyOf(state);
        if (field !== this.field) {
            this.field = field;
            this.distribution = undefined;
            this.draw();
        }
        const isOld = this.lastChange.recordAndCheckIfOld(state);
        if (isOld || this.dragged !== undefined || this.changes.isBusy) return; // the editor shows newer points
        this.points = state.fog ?? [];
        this.draw();
    }

    /**
     * Shows the distribution of values from the histogram of a picture. Ignores a picture that does not show the newest
     * state.
     */
    updateFromPicture(picture: Slices): void {
        if (picture.revision !== this.state?.revision) return;
        const distribution = valueDistributionOf(picture);
        if (!distribution || (this.distribution && distributionsLookAlike(distribution, this.distribution))) return;
        this.distribution = distribution;
        if (this.dragged === undefined) this.draw();
    }

    private usualPoints(): FogControlPoint[] {
        const { levels = [0], inside = "below" } = this.state ?? {};
        const level = levels[0]!;
        return defaultFog(this.distribution?.range ?? [level - 1, level + 1], level, inside);
    }

    /**
     * Shows control points, and sends them after `delay` milliseconds. `drag` is the number of the drag that made the
     * change; undefined for a change without a drag.
     */
    private change(points: FogControlPoint[], delay = 0, drag?: number): void {
        this.points = points;
        this.mistake = "";
        this.draw();
        this.changes.submit({ fog: points, ...(drag !== undefined && { drag }) }, delay);
    }

    private async apply({ fog, drag }: { fog: FogControlPoint[]; drag?: number }): Promise<void> {
        // A change continues an undo step if a change of the same drag has been sent before. Only apply() knows this:
        // `changes` drops a change if a newer one is submitted before it is sent.
        const continues = drag !== undefined && drag === this.sentDrag;
        try {
            const { revision } = await this.set({ fog, ...(continues && { continues }) });
            this.sentDrag = drag;
            this.lastChange.noteRevision(revision);
            this.refusal = "";
        } catch (error) {
            this.refusal = toSentence((error as Error).message);
        }
        this.showErrors();
    }

    /** Shows the mistake in the text fields. Without a mistake, shows why the server refused the last change. */
    private showErrors(): void {
        this.error.textContent = this.mistake || this.refusal;
    }

    // Dragging on the curve

    private grab(event: PointerEvent): void {
        const handle = (event.target as Element).closest<SVGElement>("[data-point]");
        if (!handle) return;
        event.preventDefault();
        this.curve.setPointerCapture(event.pointerId);
        this.dragged = Number(handle.dataset["point"]);
        ++this.drag;
    }

    private moveGrabbed(event: PointerEvent): void {
        if (this.dragged === undefined) return;
        const { left, top, width, height } = this.curve.getBoundingClientRect();
        const along = ((event.clientX - left) / width) * kWidth;
        const down = ((event.clientY - top) / height) * kHeight;
        const value = this.ends[0] + ((along - kMargin) / (kWidth - 2 * kMargin)) * (this.ends[1] - this.ends[0]);
        const opacity = 1 - (down - kMargin) / (kHeight - 2 * kMargin);
        this.change(withMovedPoint(this.points, this.dragged, value, opacity, this.ends), 0, this.drag);
    }

    private release(): void {
        this.dragged = undefined;
        ++this.drag;
        this.draw();
    }

    private draw(): void {
        const { points } = this;
        const isOn = points.length > 0;
        for (const part of [this.curve, this.list, this.addButton, this.offButton]) part.toggleAttribute("hidden", !isOn);
        this.showButton.textContent = isOn ? "Reset" : "Show fog";
        this.addButton.disabled = points.length >= kMaxFogControlPoints;
        this.showRows();
        if (!isOn) return;
        if (this.dragged === undefined) {
            const { range = [points[0]!.value, points.at(-1)!.value] } = this.distribution ?? {};
            this.ends = [Math.min(range[0], points[0]!.value), Math.max(range[1], points.at(-1)!.value)];
        }
        const places = points.map(({ value, opacity }) => [this.x(value), this.y(opacity)] as const);
        const inner = places.map(([x, y]) => `${x},${y}`).join(" ");
        const line = `${kMargin},${places[0]![1]} ${inner} ${kWidth - kMargin},${places.at(-1)![1]}`;
        const floor = kHeight - kMargin;
        const stops = places.map(([x], i) => {
            const offset = String((x - kMargin) / (kWidth - 2 * kMargin));
            return svgElement("stop", { offset, "stop-color": `#${hexDigitsOf(colorOf(points, i, schemeOfPicture()))}` });
        });
        const gradient = svgElement("linearGradient", {
            ...{ id: "fog-colors", gradientUnits: "userSpaceOnUse" },
            ...{ x1: String(kMargin), x2: String(kWidth - kMargin) },
        });
        gradient.append(...stops);
        this.curve.replaceChildren(
            gradient,
            svgElement("path", { class: "values", d: this.distributionOutline() }),
            svgElement("polygon", { class: "fog", points: `${kMargin},${floor} ${line} ${kWidth - kMargin},${floor}` }),
            svgElement("polyline", { points: line }),
            ...places.map(([x, y], i) => {
                const place = { cx: String(x), cy: String(y) };
                const handle = svgElement("g", { "data-point": String(i) });
                const fill = `#${hexDigitsOf(colorOf(points, i, schemeOfPicture()))}`;
                handle.append(svgElement("circle", { ...place, r: "11", class: "reach" }), svgElement("circle", { ...place, r: "5", fill }));
                return handle;
            }),
        );
    }

    private x(value: number): number {
        const [least, greatest] = this.ends;
        return kMargin + ((value - least) / (greatest - least)) * (kWidth - 2 * kMargin);
    }

    private y(opacity: number): number {
        return kHeight - kMargin - opacity * (kHeight - 2 * kMargin);
    }

    /** The outline of the value distribution, as an SVG path. */
    private distributionOutline(): string {
        if (!this.distribution) return "";
        const { range, tones } = this.distribution;
        const at = tones.map((tone, i) => {
            const value = range[0] + (i / (tones.length - 1)) * (range[1] - range[0]);
            return `${this.x(value).toFixed(2)} ${this.y(tone).toFixed(2)}`;
        });
        return `M${this.x(range[0])} ${this.y(0)}L${at.join("L")}L${this.x(range[1])} ${this.y(0)}Z`;
    }

    // The number fields of the control points

    private showRows(): void {
        while (this.rows.length < this.points.length) this.rows.push(this.makeRow(this.rows.length));
        this.rows.length = this.points.length;
        if (this.list.children.length !== this.rows.length) this.list.replaceChildren(...this.rows.map(({ root }) => root));
        this.points.forEach(({ value, opacity }, i) => {
            const row = this.rows[i]!;
            for (const [input, number] of [[row.value, value], [row.opacity, opacity]] as const) {
                if (document.activeElement === input || parseNumbers(input.value)[0] === number) continue;
                input.value = String(number);
            }
            const color = `#${hexDigitsOf(colorOf(this.points, i, schemeOfPicture()))}`;
            if (document.activeElement !== row.color) row.color.value = color;
            row.remove.disabled = this.points.length <= kMinFogControlPoints;
        });
    }

    private changeToTyped(): void {
        const points = this.points.map((point, i) => {
            const [value = NaN, opacity = NaN] = [this.rows[i]!.value, this.rows[i]!.opacity].map(
                (input) => parseNumbers(input.value)[0] ?? NaN,
            );
            return { ...point, value, opacity };
        });
        const isValid = isValidTransferFunction(points);
        this.mistake = isValid ? "" : "Type values from the least to the greatest, and opacities from 0 to 1.";
        this.refusal = "";
        this.showErrors();
        if (isValid) this.change(points, kTypingDelay);
    }

    private makeRow(i: number): FogControlPointRow {
        const field = (name: string): HTMLInputElement => {
            const input = element("input", {
                ...{ type: "text", inputmode: "text", autocomplete: "off", spellcheck: "false" },
                ...{ "aria-label": `${name} of point ${i + 1}`, "aria-describedby": "fog-error", "data-fog": `${name} ${i + 1}` },
            });
            input.addEventListener("input", () => this.changeToTyped());
            return input;
        };
        const [value, opacity] = [field("value"), field("opacity")];
        const color = element("input", { type: "color", "aria-label": `color of point ${i + 1}`, "data-fog": `color ${i + 1}` });
        color.addEventListener("input", () => {
            const chosen = parseInt(color.value.slice(1), 16);
            this.change(
                this.points.map((point, k) => (k === i ? { ...point, color: chosen } : point)),
                kTypingDelay,
                this.drag,
            );
        });
        color.addEventListener("change", () => ++this.drag);
        const remove = element("button", { type: "button", "aria-label": `Remove point ${i + 1}`, title: "Remove" }, "\u00d7");
        remove.addEventListener("click", () => {
            this.change(this.points.filter((_, k) => k !== i));
            const next = this.rows[Math.min(i, this.rows.length - 1)]!.remove;
            // The rows have been removed and inserted again, so none of them has the focus.
            (next.disabled ? this.addButton : next).focus();
        });
        const root = element("div", { role: "group", "aria-label": `Point ${i + 1}` }, value, opacity, color, remove);
        return { root, value, opacity, color, remove };
    }
}

/** A text that identifies the field of a state. Arrays with the same name, shape, range and box have the same text. */
function fieldKeyOf({ polytope, field }: State): string {
    return field ? JSON.stringify([polytope.name, field.formula, field.shape, field.range, field.box]) : "";
}

function svgElement(name: string, attributes: Record<string, string>): SVGElement {
    const made = document.createElementNS(kSvg, name) as SVGElement;
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return made;
}
