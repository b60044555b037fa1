// The page: connects the session to the picture, the keys, the buttons and the display of the state.

import { Client, RequestError } from "@oval4d/protocol";
import type { Credentials, Done, KeyBinding, Keymap, PolytopeElement, Request, Settings, State } from "@oval4d/protocol";

import { ColorScheme, groundOf, type SchemeChoice } from "./color_scheme";
import { Colors } from "./colors";
import { CommandLine } from "./command_line";
import { namesOfKeys } from "./completion";
import { ConnectionStatus } from "./connection_status";
import { download, fileName } from "./download";
import { byId } from "./element";
import { ElementMenu, type MenuItem } from "./element_menu";
import { ExportDialog } from "./export_dialog";
import { FieldPanel } from "./field_panel";
import { fieldOfLine, type FormulaField, loadOf } from "./fields";
import { FileLoading } from "./file_loading";
import { isFirstVisit, kFirstView, Welcome } from "./first_visit";
import { FocusPoint } from "./focus_point";
import { FocusPointDrag } from "./focus_point_drag";
import { FocusSlider } from "./focus_slider";
import { capitalize } from "./format";
import { FrameLayout } from "./frame_layout";
import { FrameMatrix } from "./frame_matrix";
import { FramePointing } from "./frame_pointing";
import { FullScreen } from "./full_screen";
import { listenForGamepads } from "./gamepad";
import { listenForGestures } from "./gestures";
import { Help } from "./help";
import type { Point } from "./hover";
import { KeyRepeat } from "./key_repeat";
import { editingAction, isForControl, strokeFromEvent, strokesOfBinding, type KeyStroke } from "./keys";
import { Latency } from "./latency";
import { extractSharedSession, readInitialView, rememberSession, sessionOfEntry } from "./link";
import { Notice } from "./notice";
import { OrbitControl } from "./orbit";
import { markFullScreen, markMode, markScheme, pageSections } from "./page_tools";
import { executePageCommand } from "./page_commands";
import { Picker } from "./picker";
import { type Mode, Stage } from "./picture/stage";
import { PointedLabel } from "./pointed_label";
import { Pointing } from "./pointing";
import { PrintView } from "./print_view";
import { Sharing } from "./sharing";
import { StateFields } from "./state_fields";
import { RotationControl } from "./rotation";
import { readStored, writeStored } from "./storage";
import { Tools } from "./tools";
import { Tour } from "./tour";

const kModeKey = "oval4d.mode"; // storage key of the rendering mode
const kSingleKeysKey = "oval4d.single_keys"; // lasting storage key of whether keys act without Ctrl
const kNoGraphics = "The graphics card is unavailable; the server renders the pictures.";
const kLeastDisc = 12; // pixels: the radius within which a click hits a slice, however small it is
const kResizeDelay = 120; // milliseconds after the last change of the window's size

type Command = Exclude<Request, { type: "hello" | "get" | "shown" | "ping" }>;

export class App {
    private readonly drawing = byId("drawing");
    private readonly polytopeButton = byId("polytope");
    private readonly notice = new Notice();
    private readonly connection = new ConnectionStatus();
    private readonly keyRepeat = new KeyRepeat();
    private readonly latency = new Latency();
    private readonly initialView = readInitialView();
    private usesSingleKeys = readStored<boolean>(kSingleKeysKey, true) ?? true;
    private readonly colorScheme = new ColorScheme(() => this.schemeChanged());
    private readonly stage = new Stage(this.drawing, {
        presented: (revision, by) => this.picturePresented(revision, by),
        resized: () => this.stageResized(),
        beforeDraw: () => {
            this.pointing.update();
            this.focusPointDrag.update();
        },
        graphicsChanged: (isAvailable) => this.graphicsChanged(isAvailable),
    });
    private readonly client = new Client({
        url: new URL(".", location.href),
        encoding: "cbor",
        scheme: this.colorScheme.current,
        transient: true,
        ...(this.initialView.credentials && { credentials: this.initialView.credentials }),
        onStatus: (status) => {
            this.connection.update(status);
            if (status.kind === "open") void this.connectionOpened();
        },
        onWelcome: (welcome) => {
            rememberSession(welcome);
            this.stage.setSizeLimits(welcome.limits);
        },
        onRequest: (answer) => this.connection.follow(answer),
        onState: (state) => this.update(state),
        onSlices: (slices) => {
            this.slider.updatePicture(slices);
            this.fieldPanel.updatePicture(slices);
            // The state of a picture arrives before it.
            if (this.state) this.stage.showSlices(slices, this.state.camera, this.state.polytope);
        },
        onFrame: (png) => this.stage.showFrame(png).catch((error: Error) => this.notice.show(error.message)),
        onError: (error) => this.notice.show(error.message),
        onLost: (reason) => this.sessionLost(reason),
    });
    private readonly frameLayout = new FrameLayout(this.client, this.stage, () => this.orbit.layoutKnown());
    private readonly orbit: OrbitControl = new OrbitControl(
        this.client,
        this.stage,
        () => this.stage.layout ?? this.frameLayout.current,
        (reason) => this.notice.show(reason),
    );
    private readonly slider: FocusSlider = new FocusSlider(this.client, {
        pressKey: (key, held) => this.sendStroke({ key, shift: false, ctrl: false }, held),
        failed: (error) => this.notice.show(error.message),
    });
    private readonly frameMatrix = new FrameMatrix(this.client, this.stage);
    private readonly focusPoint = new FocusPoint(this.client, {
        began: () => this.slider.stop(),
        failed: (error) => this.notice.show(error.message),
    });
    private readonly focusPointDrag = new FocusPointDrag(this.drawing, this.stage, this.focusPoint, () =>
        this.stage.layout ? this.stage.layout.picture.matrix : this.frameMatrix.current,
    );
    private readonly rotation = new RotationControl((rotation) => this.send(rotation));
    private readonly pointedLabel = new PointedLabel(this.drawing);
    private readonly pointing: Pointing = new Pointing(this.drawing, this.stage, this.pointedLabel, () => this.state);
    private readonly framePointing: FramePointing = new FramePointing(
        this.drawing,
        this.stage,
        this.client,
        this.pointedLabel,
        (revision) => revision === this.state?.revision && !this.state.moving && this.keyRepeat.mayRepeat,
    );
    private readonly elementMenu = new ElementMenu(this.drawing);
    private readonly help = new Help();
    private readonly commandLine = new CommandLine({
        run: (line) => this.execute(line),
        closed: () => this.drawing.focus(),
        names: () => ({
            polytopes: this.picker.catalogue,
            kinds: this.state?.polytope.kinds?.map(({ name }) => name) ?? [],
            keys: namesOfKeys(this.keymap?.keys ?? []),
        }),
    });
    private readonly stateFields = new StateFields((line) => this.request({ type: "command", line }));
    private readonly picker = new Picker((name, isData) =>
        this.request(isData ? { type: "load", name, path: name } : { type: "set", polytope: name }),
    );
    private readonly fileLoading = new FileLoading(this.client, (state) =>
        this.request({ ...state, type: "set", turning: false }),
    );
    private readonly sharing = new Sharing(this.client, this.notice);
    private readonly fieldPanel = new FieldPanel({
        load: (...change) => this.loadField(...change),
        set: (settings) => this.request({ type: "set", ...settings }),
        shareAddress: (address) => void this.sharing.copyLink(address, "It opens this field"),
        closed: () => this.drawing.focus(),
    });
    private readonly exportDialog = new ExportDialog(
        this.client,
        () => this.stage.size,
        (warnings) => this.notice.showAll(warnings),
    );
    private readonly tools = new Tools({ press: (...binding) => this.press(...binding) });
    private readonly tour = new Tour(() => this.drawing.focus());
    private readonly welcome = new Welcome(
        this.drawing,
        () => this.tour.start(),
        () => this.drawing.focus(),
    );
    private readonly colors = new Colors((change) => void this.send({ type: "set", ...change }));
    private readonly fullScreen = new FullScreen((isOn) => this.fullScreenChanged(isOn));
    private chosenMode = readStored<Mode>(kModeKey) ?? "geometry"; // by the user; WebGL may be unavailable
    private keymap: Keymap | undefined;
    private state: State | undefined;
    private lostState: State | undefined; // the last state of a lost session, which the new session restores
    private resizing: ReturnType<typeof setTimeout> | undefined;
    private hadTools = true; // whether the tools were open before full screen

    start(): void {
        this.fullScreen.update();
        new PrintView(
            this.client,
            this.stage,
            () => this.state?.polytope.name ?? "",
            (error) => this.notice.show(error.message),
        );
        this.stage.mode = this.stage.canDrawGeometry ? this.chosenMode : "frames";
        listenForGestures(this.drawing, {
            orbit: this.orbit,
            rotation: this.rotation,
            focusPoint: this.focusPointDrag,
            click: (at, isTap) => void this.click(at, isTap),
            openMenu: (at) => this.openElementMenu(at),
        });
        listenForGamepads(this.rotation);
        document.addEventListener("keydown", (event) => this.keydown(event));
        this.polytopeButton.addEventListener("click", () => this.openPicker());
        document.querySelector("header")!.addEventListener("mousedown", (event) => {
            // The drawing keeps the focus, as when a button of Tools is clicked.
            if (event.target instanceof Element && event.target.closest("button")) event.preventDefault();
        });
        byId("export-button").addEventListener("click", () => this.openExport());
        byId("share-button").addEventListener("click", () => void this.sharing.copySessionLink());
        byId("help-button").addEventListener("click", () => this.help.open());
        byId("help-tour").addEventListener("click", () => this.startTour());
        // Keys act on the drawing while the tour explains them, but the space bar presses the tour's buttons.
        byId("tour").addEventListener("keydown", (event) => event.key !== " " && this.keydown(event));
        this.listenForToolsButton();
        document.addEventListener("visibilitychange", () => this.requestStream());
        window.addEventListener("online", () => this.requestStream());
        window.addEventListener("offline", () => this.client.test()); // a server on this computer still answers
        window.addEventListener("hashchange", () => this.joinSharedSession());
        window.addEventListener("popstate", () => this.joinSessionOfEntry());
        window.addEventListener("pageshow", (event) => event.persisted && this.client.connect());
        this.drawing.focus();
        this.welcomeFirstVisit();
        this.client.hello({ viewport: this.stage.size }).catch(() => {}); // sets the size for the first connection
        this.client.connect();
    }

    /** Shows the first view, unless the address names another view or session. */
    private welcomeFirstVisit(): void {
        const { credentials, lines } = this.initialView;
        if (credentials || lines.length > 0 || this.initialView.field || !isFirstVisit()) return;
        this.initialView.lines = [...kFirstView];
        this.welcome.show();
    }

    private startTour(): void {
        this.help.close();
        this.welcome.hide();
        this.tour.start();
    }

    /** Joins the session of a link that was pasted into the address bar, which does not load the page again. */
    private joinSharedSession(): void {
        const { credentials, fault } = extractSharedSession();
        if (fault) this.notice.show(fault);
        if (credentials) this.join(credentials);
        else if (this.client.credentials) rememberSession(this.client.credentials); // this entry of the history is new
    }

    /** Returns to the session of an entry of the browser's history that does not load the page again. */
    private joinSessionOfEntry(): void {
        const credentials = sessionOfEntry();
        if (credentials && credentials.session !== this.client.credentials?.session) this.join(credentials);
    }

    private join(credentials: Credentials): void {
        this.clearInitialView(); // another session's view does not apply to this one
        this.state = this.lostState = undefined;
        this.client.credentials = credentials;
        this.client.connect();
    }

    /** Handles a new connection. The server may be another one, with another key table. */
    private async connectionOpened(): Promise<void> {
        this.keyRepeat.restart();
        this.latency.restart();
        for (const part of [this.slider, this.orbit, this.focusPoint, this.fieldPanel]) part.restart();
        try {
            await this.restoreView();
            this.requestStream();
            const keymap = await this.client.request({ type: "get", what: "keymap" });
            if (JSON.stringify(keymap.keys) !== JSON.stringify(this.keymap?.keys)) this.showKeys(keymap);
            if (this.state) this.update(this.state);
            if (this.picker.isOpen) void this.listPolytopes();
        } catch (error) {
            if ((error as RequestError).code !== "not_connected") this.notice.show((error as Error).message);
        }
    }

    private clearInitialView(): void {
        Object.assign(this.initialView, { lines: [], faults: [] });
        delete this.initialView.field;
    }

    private showKeys(keymap: Keymap): void {
        this.keymap = keymap;
        this.help.show(keymap);
        const page = pageSections({
            mode: this.stage.mode,
            canDrawGeometry: this.stage.canDrawGeometry,
            setMode: (mode) => this.chooseMode(mode),
            reset: () => void this.send({ type: "reset" }),
            share: () => void this.sharing.copySessionLink(),
            copyViewLink: () => void this.sharing.copyViewLink(),
            copyPython: () => {
                void this.sharing.copyPython(this.state?.polytope.name ?? "", this.stage.size, this.colorScheme.current);
            },
            save: () => void this.savePicture(),
            openField: () => this.fieldPanel.open(),
            scheme: this.colorScheme.choice,
            chooseScheme: (choice) => this.chooseScheme(choice),
            fullScreen: this.fullScreen,
            failed: (error) => this.notice.show(error.message),
            usesSingleKeys: this.usesSingleKeys,
            useSingleKeys: (on) => {
                this.usesSingleKeys = on;
                writeStored(kSingleKeysKey, on, true);
            },
        });
        this.tools.show(keymap, [...this.colors.sections, ...page]);
    }

    /** In a new session, restores the view of a lost session or applies the view in the page's address. */
    private async restoreView(): Promise<void> {
        const { lines, field, faults } = this.initialView;
        const lost = this.lostState;
        this.clearInitialView();
        this.lostState = undefined;
        if (lost) await this.restore(lost);
        if (field) {
            try {
                this.fieldPanel.adopt(field, await this.loadField(field, {}));
            } catch (error) {
                faults.push(`The address contains “formula=${field.formula}”: ${(error as Error).message}`);
            }
        }
        for (const line of lines) {
            try {
                const { revision } = await this.client.request({ type: "command", line });
                this.welcome.viewShown(revision);
            } catch (error) {
                faults.push(`The address contains “${line}”: ${(error as Error).message}`);
            }
        }
        this.notice.showAll(faults);
    }

    /** Restores a view. Omits its polytope if it is not available, for example a file that another page has loaded. */
    private async restore(lost: State): Promise<void> {
        try {
            await this.fileLoading.reload(lost.polytope.name);
            await this.client.request({ ...lost, type: "set", turning: false });
        } catch (error) {
            if ((error as RequestError).code === "not_connected") throw error;
            this.notice.show((error as Error).message);
            const { polytope, slices, point, hidden, faded, levels, inside, fog, ...rest } = lost;
            await this.client.request({ ...rest, type: "set", turning: false });
        }
    }

    /** Requests the stream for the current mode, or no stream while the page is hidden; tests the connection. */
    private requestStream(): void {
        const stream = document.hidden ? "none" : this.stage.mode;
        // Without a connection, the hello of the next connection requests the stream.
        this.client.hello({ stream, viewport: this.stage.size }).catch(() => {});
        if (document.hidden) return;
        if (this.client.status.kind === "waiting") this.client.connect();
        else this.client.test(); // the connection may have broken without an event
    }

    private update(state: State): void {
        this.state = state;
        document.documentElement.dataset["ground"] = groundOf(state.background, this.colorScheme.current);
        this.orbit.adoptCamera(state);
        this.frameLayout.update(state);
        this.frameMatrix.update(state);
        this.focusPoint.update(state);
        this.slider.update(state);
        const { name } = state.polytope;
        this.polytopeButton.querySelector("b")!.textContent = name;
        this.polytopeButton.title = `${name}: search for another object`;
        document.title = `${name} \u2013 oval4d`;
        this.stateFields.update(state);
        this.welcome.update(state);
        this.tools.update(state);
        this.colors.update(state);
        this.fieldPanel.update(state);
        this.connection.stateShown(state.revision);
    }

    private picturePresented(revision: number, by: Mode): void {
        this.client.shown(revision);
        this.keyRepeat.picturePresented(revision);
        this.latency.picturePresented(revision, by);
        this.framePointing.picturePresented(revision);
        this.connection.picturePresented(this.latency.last);
    }

    private stageResized(): void {
        clearTimeout(this.resizing);
        this.resizing = setTimeout(() => {
            this.requestStream();
            if (this.state) this.frameMatrix.update(this.state);
        }, kResizeDelay);
    }

    /** Sets the mode that the user chose. */
    private chooseMode(mode: Mode): void {
        if (mode === "geometry" && !this.stage.canDrawGeometry) return this.notice.show(kNoGraphics);
        this.chosenMode = mode;
        writeStored(kModeKey, mode);
        this.setMode(mode);
        return undefined;
    }

    /** Shows the server's pictures while the WebGL context is lost, if this device is chosen to render them. */
    private graphicsChanged(isAvailable: boolean): void {
        if (this.chosenMode === "frames") return;
        this.notice.show(isAvailable ? "This device renders the pictures again." : kNoGraphics);
        this.setMode(isAvailable ? "geometry" : "frames");
    }

    private setMode(mode: Mode): void {
        this.stage.mode = mode;
        this.framePointing.reset();
        markMode(mode);
        this.requestStream();
        if (this.state) this.frameMatrix.update(this.state);
    }

    private chooseScheme(choice: SchemeChoice): void {
        this.colorScheme.choice = choice;
        markScheme(choice);
    }

    /** Asks for pictures in the new color scheme of the page. */
    private schemeChanged(): void {
        if (this.state) this.update(this.state);
        this.client.hello({ scheme: this.colorScheme.current }).catch(() => {}); // applies to later connections, too
    }

    /** In full screen, the picture takes the room of the tools, until the button Tools is pressed. */
    private fullScreenChanged(isOn: boolean): void {
        if (isOn) this.hadTools = !document.body.hasAttribute("data-tools-hidden");
        this.setToolsOpen(!isOn && this.hadTools);
        if (document.activeElement === document.body) this.drawing.focus(); // the button may be hidden now
        markFullScreen(isOn);
        this.stage.redraw();
    }

    private keydown(event: KeyboardEvent): void {
        if (event.defaultPrevented || document.querySelector("dialog[open]")) return;
        if (event.key === "Escape" && !event.isComposing) {
            const isInDrawing = event.target === this.drawing;
            if (isInDrawing && this.state?.highlight) void this.send({ type: "set", highlight: null });
            this.dismissMessages();
            this.drawing.focus();
        }
        if (isForControl(event)) return;
        const keys = this.keymap?.keys ?? [];
        const action = editingAction(event);
        const stroke = strokeFromEvent(event, keys);
        const binding = keys.find((row) => (action ? row.action === action : row.client && row.key === stroke?.key));
        if (!binding && !stroke) return;
        const isSingle = action === undefined && stroke?.key.length === 1 && !stroke.ctrl;
        if (isSingle && !this.usesSingleKeys) return;
        event.preventDefault();
        if (binding) this.press(binding, false, event.repeat);
        else if (stroke) this.sendStroke(stroke, event.repeat);
    }

    private sendStroke(stroke: KeyStroke, held: boolean): void {
        if (held && !this.keyRepeat.mayRepeat) return;
        const movesFocus = this.keymap?.keys.some(({ group, key }) => group === "focus" && key.startsWith(stroke.key));
        if (movesFocus) this.slider.stop();
        void this.send({ type: "key", ...stroke });
    }

    private press(binding: KeyBinding, inverse: boolean, held: boolean): void {
        if (binding.action === "command_line") this.openCommandLine();
        else if (binding.action === "help") this.help.open();
        else if (binding.action === "find") this.openPicker();
        else if (binding.action === "open") this.fileLoading.chooseFile();
        else if (binding.action === "export") this.openExport();
        else if (this.orbit.perform(binding.action)) return;
        else if (held && !this.keyRepeat.mayRepeat) return;
        else for (const stroke of strokesOfBinding(binding, inverse)) this.sendStroke(stroke, false);
    }

    /**
     * Highlights the element at a point of the drawing, in pixels, and makes its slice the focus slice. Beside the
     * elements, only a slice becomes the focus; in a panel of the matrix, the focus point moves there; on the background,
     * the highlight ends.
     */
    private async click({ x, y }: Point, isTap: boolean): Promise<void> {
        const { orbit, size } = this.stage;
        const ratio = size.height / this.drawing.clientHeight;
        const layout = this.stage.layout ?? (await this.frameLayout.request());
        this.slider.stop();
        if (!layout) return;
        const pointed = this.pointing.elementAt(x, y, layout);
        if (!pointed && this.focusPointDrag.moveTo({ x, y })) return;
        if (pointed && isTap) this.pointing.name(pointed, layout, { x, y });
        const slice = pointed
            ? pointed.slice
            : layout.sliceAt(x * ratio, y * ratio, orbit, size, kLeastDisc * ratio);
        const kept = this.state?.highlight ?? null;
        const highlight = pointed ? { element: pointed.element, number: pointed.number } : slice ? kept : null;
        const isKept = highlight?.element === kept?.element && highlight?.number === kept?.number;
        const change = {
            ...(slice && !slice.focus && { slices: { focus: slice.index } }),
            ...(!isKept && { highlight }),
        };
        if (Object.keys(change).length > 0) void this.send({ type: "set", ...change });
    }

    /** Lights the element at a point of the drawing, and offers what can be done with it. */
    private async openElementMenu(at: Point): Promise<boolean> {
        const layout = this.stage.layout ?? (await this.frameLayout.request());
        const pointed = layout && this.pointing.elementAt(at.x, at.y, layout);
        if (!pointed) return false;
        const { element, number, slice } = pointed;
        void this.send({ type: "set", highlight: { element, number } });
        const command = (label: string, line: string): MenuItem => ({
            label,
            act: () => void this.send({ type: "command", line }),
        });
        const focus = slice && !slice.focus && command("Make its slice the focus", `focus ${slice.index}`);
        this.elementMenu.open(`${capitalize(element)} ${number}`, at, [
            command("Turn it toward +w", `toward ${element} ${number}`),
            ...(focus ? [focus] : []),
            ...(element === "cell" ? [command("Hide its kind of cell", "hide"), command("Fade its kind of cell", "fade")] : []),
            { label: "Export it…", act: () => this.openExport({ element, number }) },
            command("Remove its highlight", "highlight none"),
        ]);
        return true;
    }

    private openCommandLine(): void {
        this.notice.hide();
        this.commandLine.open(this.listPolytopes());
    }

    /** Executes a line of the command line, which closes before a dialog opens, so that the focus returns here. */
    private async execute(line: string): Promise<unknown> {
        if (this.latency.execute(line)) return undefined;
        const isOfPage = await executePageCommand(line, {
            help: (topic) => {
                this.help.filter(topic);
                this.commandLine.close();
                this.help.open(topic);
            },
            exportFile: (description) => {
                if (description !== "") return this.state && this.exportDialog.save(description, this.state);
                this.commandLine.close();
                return this.openExport();
            },
        });
        if (isOfPage) return undefined;
        const { revision } = await this.request({ type: "command", line });
        const field = fieldOfLine(line);
        if (!field) return undefined;
        this.fieldPanel.adopt(field, revision);
        return undefined;
    }

    /** Loads a formula, then changes settings; returns the revision. */
    private async loadField(field: FormulaField, settings: Settings, continues = false): Promise<number> {
        // Both are sent at once, so that no picture shows the formula without the settings.
        const answers = [this.request({ type: "load", ...loadOf(field), ...(continues && { continues }) })];
        if (Object.keys(settings).length > 0) {
            answers.push(this.request({ type: "set", continues: true, ...settings }));
        }
        const [loaded, changed] = await Promise.allSettled(answers);
        if (loaded!.status === "rejected") throw loaded!.reason;
        return (changed?.status === "fulfilled" ? changed : loaded!).value.revision;
    }

    private openPicker(): void {
        this.notice.hide();
        this.picker.open(this.state?.polytope.name ?? "");
        void this.listPolytopes();
    }

    /** Lists the catalogue in the picker. Requests it each time, because polytopes may have been loaded meanwhile. */
    private async listPolytopes(): Promise<void> {
        try {
            this.picker.setEntries((await this.client.request({ type: "get", what: "catalogue" })).polytopes);
        } catch (error) {
            const { code, message } = error as RequestError;
            this.picker.showFailure(code === "not_connected" ? "The server cannot be reached" : message);
        }
    }

    private dismissMessages(): void {
        this.notice.hide();
        this.fileLoading.hide();
        this.welcome.hide();
        this.tour.stop();
    }

    /** Opens the export dialog; with an element, to export only this. */
    private openExport(highlight?: PolytopeElement): void {
        this.notice.hide();
        if (!this.state) return;
        if (highlight) this.exportDialog.open({ ...this.state, highlight }, "highlight");
        else this.exportDialog.open(this.state);
    }

    /** Requests a change, and tracks it until its picture is presented. */
    private async request(command: Command): Promise<Done> {
        const answer = this.client.request(command);
        try {
            await Promise.all([this.keyRepeat.track(answer), this.latency.track(command.type, answer)]);
        } finally {
            this.framePointing.update();
        }
        return answer;
    }

    /** Like request(), but shows an error as a notice. Resolves to whether the command has been executed. */
    private async send(command: Command): Promise<boolean> {
        this.notice.hide();
        try {
            await this.request(command);
        } catch (error) {
            this.notice.show((error as Error).message);
            return false;
        }
        return true;
    }

    private sessionLost(reason: string): void {
        this.lostState = this.state;
        this.client.hello({ stream: "none" }).catch(() => {}); // no pictures until the view is restored
        this.notice.show(
            this.state
                ? `The session has ended (${reason}). This is a new one with the same view.`
                : `The session cannot be opened (${reason}). This is a new one.`,
        );
    }

    private async savePicture(): Promise<void> {
        try {
            const png = await this.client.request({ type: "get", what: "frame", ...this.stage.size });
            download(png, fileName([this.state?.polytope.name ?? ""], "png"), "image/png");
        } catch (error) {
            this.notice.show((error as Error).message);
        }
    }

    private listenForToolsButton(): void {
        const button = byId("tools-button");
        button.addEventListener("click", () => this.setToolsOpen(button.getAttribute("aria-expanded") === "false"));
    }

    private setToolsOpen(open: boolean): void {
        document.body.toggleAttribute("data-tools-hidden", !open);
        byId("tools-button").setAttribute("aria-expanded", String(open));
    }
}
