// The page: connects the session to the picture, the keys, the buttons and the display of the state.

import { Client, RequestError, type KeyBinding, type Keymap, type Request, type State } from "@oval4d/protocol";

import { Colors } from "./colors";
import { CommandLine } from "./command_line";
import { ConnectionView } from "./connection";
import { download, fileName } from "./download";
import { byId } from "./element";
import { ExportDialog } from "./export_dialog";
import { listenForGestures } from "./gestures";
import { Help } from "./help";
import { strokeOf, strokesOf } from "./keys";
import { Latency } from "./latency";
import { keep, readStart, shareLink } from "./link";
import { Loading } from "./loading";
import { recall, remember } from "./memory";
import { Notice } from "./notice";
import { OrbitControl } from "./orbit";
import { Pace } from "./pace";
import { markMode, ownSections } from "./own_tools";
import { Picker } from "./picker";
import { type Mode, Stage } from "./picture/stage";
import { Readings } from "./readings";
import { Tools } from "./tools";

const kMode = "oval4d.mode"; // storage key of the rendering mode
const kResizeDelay = 120; // milliseconds after the last change of the window's size

type Command = Exclude<Request, { type: "hello" | "get" | "shown" }>;

export class App {
    private readonly drawing = byId("drawing");
    private readonly polytope = byId("polytope");
    private readonly notice = new Notice();
    private readonly connection = new ConnectionView();
    private readonly pace = new Pace();
    private readonly latency = new Latency();
    private readonly begin = readStart();
    private readonly stage = new Stage(this.drawing, {
        presented: (revision, by) => this.presented(revision, by),
        resized: () => this.resized(),
        lost: () => this.setMode("frames", "The graphics card is unavailable; the server now renders the pictures."),
    });
    private readonly client = new Client({
        url: new URL(".", location.href),
        encoding: "cbor",
        transient: true,
        ...(this.begin.credentials && { credentials: this.begin.credentials }),
        onStatus: (status) => {
            this.connection.update(status);
            if (status.kind === "open") void this.opened();
        },
        onWelcome: (welcome) => {
            keep(welcome);
            this.stage.limit(welcome.limits);
        },
        onState: (state) => this.update(state),
        onSlices: (slices) => this.stage.showSlices(slices, this.state?.camera ?? this.stage.orbit),
        onFrame: (png) => this.stage.showFrame(png).catch((error: Error) => this.notice.show(error.message)),
        onError: (error) => this.notice.show(error.message),
        onLost: (reason) => this.lost(reason),
    });
    private readonly orbit = new OrbitControl(this.client, this.stage);
    private readonly help = new Help();
    private readonly commandLine = new CommandLine(
        async (line) => this.latency.command(line) || this.request({ type: "command", line }),
        () => this.drawing.focus(),
    );
    private readonly readings = new Readings((command) => this.commandLine.open(command));
    private readonly picker = new Picker((name) => this.request({ type: "set", polytope: name }));
    private readonly loading = new Loading(this.client);
    private readonly exporting = new ExportDialog(this.client, () => this.stage.size);
    private readonly tools = new Tools({ press: (...binding) => this.press(...binding) });
    private readonly colors = new Colors((change) => this.send({ type: "set", ...change }));
    private keymap: Keymap | undefined;
    private state: State | undefined;
    private lostState: State | undefined; // the last state of a lost session, to be restored in the new one
    private resizing: ReturnType<typeof setTimeout> | undefined;

    start(): void {
        this.stage.mode = this.stage.canDrawGeometry ? (recall<Mode>(kMode) ?? "geometry") : "frames";
        listenForGestures(this.drawing, this.orbit);
        this.drawing.addEventListener("keydown", (event) => this.keydown(event));
        this.polytope.addEventListener("click", () => this.find());
        document.querySelector("header")!.addEventListener("mousedown", (event) => {
            // The drawing keeps the focus, as in Tools.
            if (event.target instanceof Element && event.target.closest("button")) event.preventDefault();
        });
        byId("help-button").addEventListener("click", () => this.help.open());
        this.listenForTools();
        document.addEventListener("visibilitychange", () => this.stream());
        window.addEventListener("online", () => this.stream());
        window.addEventListener("pageshow", (event) => event.persisted && this.client.connect());
        this.drawing.focus();
        this.client.hello({ viewport: this.stage.size }).catch(() => {}); // sets the size for the connection to come
        this.client.connect();
    }

    /** Handles a new connection, which may be to another server with another key table. */
    private async opened(): Promise<void> {
        this.pace.restart();
        this.latency.restart();
        try {
            await this.restoreView();
            this.stream();
            const keymap = await this.client.request({ type: "get", what: "keymap" });
            if (JSON.stringify(keymap.keys) !== JSON.stringify(this.keymap?.keys)) this.showKeys(keymap);
            if (this.state) this.update(this.state);
        } catch (error) {
            if ((error as RequestError).code !== "not_connected") this.notice.show((error as Error).message);
        }
    }

    private showKeys(keymap: Keymap): void {
        this.keymap = keymap;
        this.help.show(keymap);
        const own = ownSections({
            mode: this.stage.mode,
            canDrawGeometry: this.stage.canDrawGeometry,
            setMode: (mode) => this.setMode(mode),
            reset: () => this.send({ type: "reset" }),
            resetView: () => this.orbit.reset(),
            share: () => void this.share(),
            save: () => void this.save(),
        });
        this.tools.show(keymap, [this.colors.section, ...own]);
    }

    /** In a new session, restores the view of a lost session or applies the view in the page's address. */
    private async restoreView(): Promise<void> {
        const { lines } = this.begin;
        const lost = this.lostState;
        this.begin.lines = [];
        this.lostState = undefined;
        if (lost) await this.restore(lost);
        for (const line of lines) {
            await this.client.request({ type: "command", line }).catch((error: RequestError) => {
                this.notice.show(`The address contains “${line}”: ${error.message}`);
            });
        }
    }

    /** Restores a view, but without its polytope if that is not available, such as another page's file. */
    private async restore(lost: State): Promise<void> {
        try {
            await this.loading.reload(lost.polytope.name);
            await this.client.request({ ...lost, type: "set", turning: false });
        } catch (error) {
            if ((error as RequestError).code === "not_connected") throw error;
            this.notice.show((error as Error).message);
            const { polytope, slices, hidden, faded, ...rest } = lost;
            await this.client.request({ ...rest, type: "set", turning: false });
        }
    }

    /** Requests the stream for the current mode, or none while the page is hidden; checks the connection. */
    private stream(): void {
        const stream = document.hidden ? "none" : this.stage.mode;
        this.client.hello({ stream, viewport: this.stage.size }).catch(() => {}); // later, if there is no connection
        if (document.hidden) return;
        if (this.client.status.kind === "waiting") this.client.connect();
        else this.client.test(); // the connection may have died unnoticed
    }

    private update(state: State): void {
        this.state = state;
        this.orbit.follow(state);
        const { name } = state.polytope;
        this.polytope.querySelector("b")!.textContent = name;
        document.title = `${name} \u2013 oval4d`;
        this.readings.update(state);
        this.tools.update(state);
        this.colors.update(state);
    }

    private presented(revision: number, by: Mode): void {
        this.client.shown(revision);
        this.pace.presented(revision);
        this.latency.presented(revision, by);
        this.connection.presented(this.latency.last);
    }

    private resized(): void {
        clearTimeout(this.resizing);
        this.resizing = setTimeout(() => this.stream(), kResizeDelay);
    }

    private setMode(mode: Mode, why?: string): void {
        if (why !== undefined) this.notice.show(why);
        this.stage.mode = mode;
        markMode(mode);
        remember(kMode, mode);
        this.stream();
    }

    private keydown(event: KeyboardEvent): void {
        if (event.key === "Escape") this.dismissMessages();
        const stroke = strokeOf(event, this.keymap?.keys ?? []);
        if (!stroke) return;
        event.preventDefault();
        const binding = this.keymap?.keys.find((one) => one.client && one.key === stroke.key);
        if (binding) this.press(binding, false, event.repeat);
        else if (!event.repeat || this.pace.free) this.send({ type: "key", ...stroke });
    }

    private press(binding: KeyBinding, inverse: boolean, held: boolean): void {
        if (binding.action === "command_line") this.commandLine.open();
        else if (binding.action === "help") this.help.open();
        else if (binding.action === "find") this.find();
        else if (binding.action === "open") this.loading.choose();
        else if (binding.action === "export") this.export();
        else if (held && !this.pace.free) return;
        else for (const stroke of strokesOf(binding, inverse)) this.send({ type: "key", ...stroke });
    }

    /** Opens the picker. Requests the catalogue each time, because polytopes may have been loaded meanwhile. */
    private find(): void {
        this.notice.hide();
        this.picker.open(this.state?.polytope.name ?? "");
        this.client.request({ type: "get", what: "catalogue" }).then(
            ({ polytopes }) => this.picker.show(polytopes),
            (error: Error) => this.notice.show(error.message),
        );
    }

    private dismissMessages(): void {
        this.notice.hide();
        this.loading.hide();
    }

    private export(): void {
        this.notice.hide();
        if (this.state) this.exporting.open(this.state);
    }

    /** Requests a change, and tracks it until its picture is presented. */
    private async request(command: Command): Promise<void> {
        const answer = this.client.request(command);
        await Promise.all([this.pace.follow(answer), this.latency.follow(command.type, answer)]);
    }

    /** Like request(), but shows an error as a notice. */
    private send(command: Command): void {
        this.notice.hide();
        this.request(command).catch((error: Error) => this.notice.show(error.message));
    }

    private lost(reason: string): void {
        this.lostState = this.state;
        this.client.hello({ stream: "none" }).catch(() => {}); // until the view is restored
        this.notice.show(
            this.state
                ? `The session has ended (${reason}). This is a new one with the same view.`
                : `The session cannot be opened (${reason}). This is a new one.`,
        );
    }

    private async share(): Promise<void> {
        if (!this.client.credentials) return;
        const link = shareLink(this.client.credentials);
        try {
            await navigator.clipboard.writeText(link);
            this.notice.show("Link copied. Anyone who opens it joins this session.");
        } catch {
            this.notice.show("Copy this link. Anyone who opens it joins this session:", link);
        }
    }

    private async save(): Promise<void> {
        try {
            const png = await this.client.request({ type: "get", what: "frame", ...this.stage.size });
            download(png, fileName([this.state?.polytope.name ?? ""], "png"), "image/png");
        } catch (error) {
            this.notice.show((error as Error).message);
        }
    }

    private listenForTools(): void {
        const button = byId("tools-button");
        const show = (open: boolean): void => {
            document.body.toggleAttribute("data-tools-hidden", !open);
            button.setAttribute("aria-expanded", String(open));
        };
        button.addEventListener("click", () => show(button.getAttribute("aria-expanded") === "false"));
    }
}
