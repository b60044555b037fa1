// Creates the parts of the page, and connects the session to the picture, the keys, the buttons and the display of the
// state. This file is long because every connection between two parts is made here, so that the parts need not know
// each other.

import { Client, RequestError } from "@oval4d/protocol";
import type { Command, Done, Keymap, PolytopeElement, Settings, State } from "@oval4d/protocol";

import { ClickHandler } from "./clicks";
import { ColorControls } from "./color_controls";
import { ColorScheme, opaqueBackgroundOf, type ColorSchemeChoice } from "./color_scheme";
import { CommandLine } from "./command_line";
import { namesOfServerKeys } from "./completion";
import { ConnectionStatusDisplay } from "./connection_status";
import { download, fileName } from "./download";
import { byId } from "./element";
import { ElementMeasurementFetcher } from "./element_measurements";
import { ExportDialog } from "./export_dialog";
import { FieldPanel } from "./field_panel";
import { FieldSampleFetcher } from "./field_samples";
import { fieldInCommandLine, formulaLoadOf, type FormulaWithBox } from "./fields";
import { FileLoading } from "./file_loading";
import { nameOf } from "./files";
import { WelcomeLine } from "./first_visit";
import { FocusPointMover } from "./focus_point_control";
import { FocusPointDrag } from "./focus_point_drag";
import { FocusSlider } from "./focus_slider";
import { FrameHitTesterCache } from "./frame_hit_tester_cache";
import { FrameSectionMatrixCache } from "./frame_matrix_cache";
import { FramePointerHighlighter } from "./frame_pointing";
import { FullScreenMode } from "./full_screen";
import { listenForGamepads } from "./gamepad";
import { listenForGestures } from "./gestures";
import { HeaderValues } from "./header_values";
import { HelpDialog } from "./help";
import { KeyRepeatLimiter } from "./key_repeat_limiter";
import { Keyboard } from "./keyboard";
import { LatencyMeter } from "./latency";
import { extractInitialView, rememberSession } from "./link";
import { Notice } from "./notice";
import { OrbitControl } from "./orbit";
import { PageSession } from "./page_session";
import { pageToolSections, showFullScreenPressed, showModePressed, showSchemePressed, showTiltPressed } from "./page_tools";
import { executePageCommand } from "./page_commands";
import { PhoneLinkDialog } from "./phone_link_dialog";
import { PolytopePicker } from "./picker";
import type { HitTester } from "./picture/hit_tester";
import { type RenderingMode, Stage } from "./picture/stage";
import { PointerLabel } from "./pointed_label";
import { PointerHighlighter } from "./pointing";
import { PrintView } from "./print_view";
import { showRefining } from "./refining";
import { RenderingModeSwitch } from "./rendering_mode_switch";
import { SessionSharing } from "./sharing";
import { RotationSender } from "./rotation";
import { TiltControl } from "./tilt";
import { ToolsPanel } from "./tools";
import { Tour } from "./tour";
import { TourObjectSwitch } from "./tour_object_switch";

// After a change of the drawing's size, the page waits this many milliseconds without another change. Then it requests
// pictures of the new size.
const kResizeDelay = 120;

export class App {
    private readonly drawing = byId("drawing");
    private readonly polytopeButton = byId("polytope");
    private readonly notice = new Notice();
    private readonly connection = new ConnectionStatusDisplay(() => this.session.beginNewSession(this.state));
    private readonly keyRepeatLimiter = new KeyRepeatLimiter();
    private readonly latency = new LatencyMeter();
    private readonly initialView = extractInitialView();
    private readonly colorScheme = new ColorScheme(() => this.schemeChanged());
    private readonly stage = new Stage(this.drawing, {
        presented: (revision, by) => this.picturePresented(revision, by),
        resized: () => this.stageResized(),
        beforeDraw: () => {
            this.pointing.update();
            this.focusPointDrag.updateCursor();
        },
        graphicsChanged: (isAvailable) => this.renderingModeSwitch.graphicsChanged(isAvailable),
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
            this.phoneLinkDialog.update(welcome);
            this.stage.setSizeLimits(welcome.limits);
        },
        onRequest: (answer) => this.connection.trackRequest(answer),
        onState: (state) => this.update(state),
        onSlices: (slices) => {
            this.slider.updateFromPicture(slices);
            this.fieldPanel.updateFromPicture(slices);
            // The server sends the state of a picture before the picture, so `this.state` belongs to these slices.
            if (this.state) this.stage.showSlices(slices, this.state.camera, this.state.polytope);
        },
        onFrame: (png) => this.stage.showFrame(png).catch((error: Error) => this.notice.show(error.message)),
        onError: (error) => this.notice.show(error.message),
        // If the server refuses `hello` because of the size of the picture, the client sends `hello` with the default
        // size. The server's answer `welcome` states the limits on sizes. The page then sends `hello` again, with a
        // size within these limits.
        onRefused: ({ code }) => (code === "out_of_range" ? "default" : undefined),
        onLost: (reason) => this.session.sessionLost(reason, this.state),
    });
    private readonly session = new PageSession(this.client, this.initialView, {
        joined: () => (this.state = undefined),
        loadField: async (field) => this.fieldPanel.adoptLoaded(field, await this.loadField(field, {})),
        reloadFile: (name) => this.fileLoading.reloadIntoNewSession(name),
        viewShown: (revision) => this.welcomeLine.firstVisitViewComplete(revision),
        tell: (messages) => this.notice.showAll(messages),
        tellFaults: (messages) => this.notice.showLasting(messages),
    });
    private readonly frameHitTesterCache = new FrameHitTesterCache(this.client, this.stage, () =>
        this.orbit.onHitTesterAvailable(),
    );
    private readonly orbit: OrbitControl = new OrbitControl(
        this.client,
        this.stage,
        () => this.stage.hitTester ?? this.frameHitTesterCache.currentOrRequestHitTester(),
        (reason) => this.notice.show(reason),
    );
    private readonly slider: FocusSlider = new FocusSlider(this.client, {
        pressKey: (key, held) => this.keyboard.send({ key, shift: false, ctrl: false }, held),
        send: (command) => void this.send(command),
        failed: (error) => this.notice.show(error.message),
    });
    private readonly frameMatrixCache = new FrameSectionMatrixCache(this.client, this.stage);
    private readonly focusPointControl = new FocusPointMover(this.client, {
        gestureBegan: () => this.slider.stop(),
        failed: (error) => this.notice.show(error.message),
    });
    private readonly focusPointDrag = new FocusPointDrag(this.drawing, this.stage, this.focusPointControl, () =>
        this.stage.hitTester ? this.stage.hitTester.picture.matrix : this.frameMatrixCache.current,
    );
    private readonly rotation = new RotationSender((rotation) => this.send(rotation));
    private readonly tilt: TiltControl = new TiltControl(
        this.rotation,
        () => showTiltPressed(this.tilt.ball),
        (error) => this.notice.show(error.message),
    );
    private readonly measurements: ElementMeasurementFetcher = new ElementMeasurementFetcher(
        () => this.state,
        ({ element, number }) => this.client.request({ type: "measure", element, number, highlight: true }),
        () => {
            this.pointedLabel.update();
            this.pointing.completeHighlight();
        },
    );
    private readonly samples: FieldSampleFetcher = new FieldSampleFetcher(
        () => this.state,
        (point) => this.client.request({ type: "get", what: "at", point }),
        () => this.pointedLabel.update(),
    );
    private readonly pointedLabel = new PointerLabel(this.drawing, () => this.state, this.measurements, this.samples);
    private readonly pointing: PointerHighlighter = new PointerHighlighter(
        this.drawing,
        this.stage,
        this.pointedLabel,
        this.measurements,
        () => this.state,
        (revision) => revision >= this.objectSince,
    );
    private readonly framePointing: FramePointerHighlighter = new FramePointerHighlighter(
        this.drawing,
        this.stage,
        this.client,
        this.pointedLabel,
        (revision) => revision === this.state?.revision && !this.state.moving && this.keyRepeatLimiter.mayRepeat,
    );
    private readonly renderingModeSwitch = new RenderingModeSwitch(this.stage, {
        changed: (mode) => this.modeChanged(mode),
        tell: (message) => this.notice.show(message),
    });
    private readonly clicks: ClickHandler = new ClickHandler(this.drawing, this.stage, this.pointing, {
        state: () => this.state,
        hitTester: () => this.requestHitTester(),
        began: () => this.slider.stop(),
        moveFocusPoint: (at) => this.focusPointDrag.moveTo(at),
        send: (command) => void this.send(command),
        exportElement: (element) => this.openExport(element),
    });
    private readonly help = new HelpDialog();
    private readonly commandLine = new CommandLine({
        runLine: (line) => this.execute(line),
        closed: () => this.drawing.focus(),
        failedLater: (error) => this.notice.show(error.message),
        completableNames: () => ({
            polytopes: this.picker.catalogue,
            kinds: this.state?.polytope.kinds?.map(({ name }) => name) ?? [],
            keys: namesOfServerKeys(this.keyboard.keys),
        }),
    });
    private readonly headerValues = new HeaderValues((line) => this.request({ type: "command", line }));
    private readonly picker = new PolytopePicker(
        (name, isData) => (isData ? this.loadFromDataFolder(name) : this.request({ type: "set", polytope: name })),
        (error) => this.notice.show(error.message),
    );
    private readonly fileLoading = new FileLoading(this.client, (state) =>
        this.request({ ...state, type: "set", turning: false, playing: false }),
    );
    private readonly sharing = new SessionSharing(this.client, this.notice);
    private readonly phoneLinkDialog = new PhoneLinkDialog(this.client);
    private readonly fieldPanel = new FieldPanel({
        loadFormula: (...change) => this.loadField(...change),
        changeSettings: (settings) => this.request({ type: "set", ...settings }),
        shareAddress: (address) => void this.sharing.copyLink(address, "It opens this field"),
        closed: () => this.drawing.focus(),
    });
    private readonly exportDialog = new ExportDialog(
        this.client,
        () => this.stage.size,
        (warnings) => this.notice.showAll(warnings),
    );
    private readonly keyboard: Keyboard = new Keyboard(this.keyRepeatLimiter, {
        send: (command) => void this.send(command),
        escape: (event) => this.escape(event),
        camera: (action) => this.orbit.perform(action),
        page: {
            command_line: () => this.openCommandLine(),
            help: () => this.help.open(),
            find: () => this.openPicker(),
            open: () => this.fileLoading.chooseFile(),
            export: () => this.openExport(),
        },
    });
    private readonly tools = new ToolsPanel({ press: (...binding) => this.keyboard.press(...binding) });
    private readonly tourObjectSwitch = new TourObjectSwitch(
        this.client,
        (command) => this.request(command),
        (error) => this.notice.show(error.message),
    );
    private readonly tour = new Tour(
        (name) => this.tourObjectSwitch.show(name),
        () => this.drawing.focus(),
    );
    private readonly welcomeLine = new WelcomeLine(this.drawing, {
        startTour: () => this.tour.start(),
        showObject: (name) => void this.send({ type: "set", polytope: name }),
        closed: () => this.drawing.focus(),
    });
    private readonly colorControls = new ColorControls((change) => void this.send({ type: "set", ...change }));
    private readonly fullScreen = new FullScreenMode((isOn) => this.fullScreenChanged(isOn));
    private state: State | undefined;
    private objectSince = 0; // the revision of the first state with the present object
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
        this.renderingModeSwitch.start();
        listenForGestures(this.drawing, {
            orbit: this.orbit,
            rotation: this.rotation,
            focusPoint: this.focusPointDrag,
            click: (at, isTap) => void this.clicks.click(at, isTap),
            highlightAndOpenMenu: (at) => this.clicks.highlightAndOpenMenu(at),
        });
        listenForGamepads(this.rotation);
        document.addEventListener("keydown", (event) => this.keyboard.keydown(event));
        document.addEventListener("pointerdown", () => this.keyboard.cancelSequence());
        this.polytopeButton.addEventListener("click", () => this.openPicker());
        document.querySelector("header")!.addEventListener("mousedown", (event) => {
            // A click on a button of the header leaves the keyboard focus on the drawing.
            if (event.target instanceof Element && event.target.closest("button")) event.preventDefault();
        });
        byId("export-button").addEventListener("click", () => this.openExport());
        byId("share-button").addEventListener("click", () => void this.sharing.copySessionLink());
        byId("help-button").addEventListener("click", () => this.help.open());
        byId("help-tour").addEventListener("click", () => this.startTour());
        // Keys pressed in the tour's panel act on the drawing, so that the user can try them. Only the space bar
        // presses the tour's buttons.
        byId("tour").addEventListener("keydown", (event) => event.key !== " " && this.keyboard.keydown(event));
        this.listenForToolsButton();
        document.addEventListener("visibilitychange", () => this.updateStreamAndConnection());
        window.addEventListener("online", () => this.updateStreamAndConnection());
        // An "offline" event only tests the connection: a server on this computer can be reached without a network.
        window.addEventListener("offline", () => this.client.test());
        window.addEventListener("hashchange", () => this.session.joinShared());
        window.addEventListener("popstate", () => this.session.joinSessionOfHistoryEntry());
        window.addEventListener("pageshow", (event) => event.persisted && this.client.connect());
        this.drawing.focus();
        if (this.session.useFirstVisitView()) this.welcomeLine.showAndRememberVisit();
        // Without a connection, hello() only stores the size, which the client then sends in its first message `hello`.
        this.client.hello({ viewport: this.stage.size }).catch(() => {});
        this.client.connect();
    }

    private startTour(): void {
        this.help.close();
        this.welcomeLine.hide();
        this.tour.start();
    }

    /** Handles a new connection. The server may be another one than before, with another key table. */
    private async connectionOpened(): Promise<void> {
        this.keyRepeatLimiter.prepareForNewConnection();
        this.latency.prepareForNewConnection();
        for (const part of [this.slider, this.orbit, this.focusPointControl, this.fieldPanel]) part.prepareForNewConnection();
        try {
            await this.session.restoreOrInitializeView();
            this.updateStreamAndConnection();
            const keymap = await this.client.request({ type: "get", what: "keymap" });
            if (JSON.stringify(keymap.keys) !== JSON.stringify(this.keyboard.keys)) this.applyKeymap(keymap);
            if (this.state) this.update(this.state);
            if (this.picker.isOpen) void this.refreshPickerEntries();
        } catch (error) {
            if ((error as RequestError).code !== "not_connected") this.notice.show((error as Error).message);
        }
    }

    private applyKeymap(keymap: Keymap): void {
        this.keyboard.keys = keymap.keys;
        this.help.show(keymap);
        const page = pageToolSections({
            mode: this.stage.mode,
            canDrawGeometry: this.stage.canDrawGeometry,
            setMode: (mode) => this.renderingModeSwitch.choose(mode),
            reset: () => void this.send({ type: "reset" }),
            share: () => void this.sharing.copySessionLink(),
            shareWithPhone: () => this.openPhoneLinkDialog(),
            copyViewLink: () => void this.sharing.copyViewLink(),
            copyPython: () => {
                void this.sharing.copyPython(this.state?.polytope.name ?? "", this.stage.size, this.colorScheme.current);
            },
            save: () => void this.savePicture(),
            openField: () => this.fieldPanel.open(),
            scheme: this.colorScheme.choice,
            chooseScheme: (choice) => this.chooseScheme(choice),
            fullScreen: this.fullScreen,
            tilt: this.tilt,
            failed: (error) => this.notice.show(error.message),
            usesSingleKeys: this.keyboard.usesSingleKeys,
            useSingleKeys: (on) => (this.keyboard.usesSingleKeys = on),
        });
        this.tools.show(keymap, [...this.colorControls.sections, ...page]);
    }

    /**
     * Requests the stream of pictures for the current rendering mode, or no stream while the page is hidden. If the
     * page is visible, also tests the connection or, if there is none, connects without further delay.
     */
    private updateStreamAndConnection(): void {
        const stream = document.hidden ? "none" : this.stage.mode;
        this.helloShowingRefusal({ stream, viewport: this.stage.size });
        if (document.hidden) return;
        if (this.client.status.kind === "waiting") this.client.connect();
        else this.client.test(); // the connection may have broken without an event
    }

    /**
     * Sends a message `hello` with changed members. If the server refuses the message, shows the reason. Without a
     * connection, shows nothing: the client sends the changed members when it connects again, and calls `onRefused` if
     * the server then refuses them.
     */
    private helloShowingRefusal(change: Parameters<Client["hello"]>[0]): void {
        this.client.hello(change).catch((error: Error) => {
            if (this.client.status.kind === "open") this.notice.show(error.message);
        });
    }

    private update(state: State): void {
        const before = this.state;
        // Whether `before` is an earlier state with the same object in the same session. In another session, the object
        // may be the same, but revisions start again, so the new revision may be lower.
        const isContinued = before && before.object_serial === state.object_serial && before.revision <= state.revision;
        if (!isContinued) this.objectSince = state.revision;
        this.state = state;
        document.documentElement.dataset["ground"] = opaqueBackgroundOf(state.background, this.colorScheme.current);
        this.orbit.adoptCamera(state);
        this.frameHitTesterCache.update(state);
        this.frameMatrixCache.update(state);
        this.focusPointControl.update(state);
        this.slider.update(state);
        const { name } = state.polytope;
        this.polytopeButton.querySelector("b")!.textContent = name;
        this.polytopeButton.title = `${name}: search for another object`;
        document.title = `${name} \u2013 oval4d`;
        this.headerValues.update(state);
        this.welcomeLine.update(state);
        this.tools.update(state);
        this.colorControls.update(state);
        this.fieldPanel.update(state);
        this.exportDialog.updateSlices(state);
        showRefining(state);
        this.connection.stateShown(state.revision);
    }

    private picturePresented(revision: number, by: RenderingMode): void {
        this.client.shown(revision);
        this.keyRepeatLimiter.picturePresented(revision);
        this.latency.picturePresented(revision, by);
        this.framePointing.picturePresented(revision);
        this.connection.picturePresented(this.latency.last);
    }

    private stageResized(): void {
        clearTimeout(this.resizing);
        this.resizing = setTimeout(() => {
            this.updateStreamAndConnection();
            if (this.state) this.frameMatrixCache.update(this.state);
        }, kResizeDelay);
    }

    private modeChanged(mode: RenderingMode): void {
        this.framePointing.reset();
        showModePressed(mode);
        this.updateStreamAndConnection();
        if (this.state) this.frameMatrixCache.update(this.state);
    }

    private chooseScheme(choice: ColorSchemeChoice): void {
        this.colorScheme.choice = choice;
        showSchemePressed(choice);
    }

    /** Shows the state in the new color scheme of the page, and asks the server for pictures in this scheme. */
    private schemeChanged(): void {
        if (this.state) this.update(this.state);
        this.helloShowingRefusal({ scheme: this.colorScheme.current });
    }

    /**
     * When full screen begins, hides the tools; the button Tools shows them again. When full screen ends, shows the
     * tools if they were open before it.
     */
    private fullScreenChanged(isOn: boolean): void {
        if (isOn) this.hadTools = !document.body.hasAttribute("data-tools-hidden");
        this.setToolsOpen(!isOn && this.hadTools);
        // The button that had the focus may now be hidden.
        if (document.activeElement === document.body) this.drawing.focus();
        showFullScreenPressed(isOn);
        this.stage.scheduleRedraw();
    }

    /**
     * Hides the messages over the picture, and focuses the drawing. If the drawing had the focus before, also removes
     * the highlight.
     */
    private escape(event: KeyboardEvent): void {
        const isInDrawing = event.target === this.drawing;
        if (isInDrawing && this.state?.highlight) void this.send({ type: "set", highlight: null });
        this.dismissMessages();
        this.drawing.focus();
    }

    private openCommandLine(): void {
        this.notice.hide();
        this.commandLine.open(this.refreshPickerEntries());
    }

    /**
     * Executes a line of the command line. The command line closes before a dialog opens, so that the drawing gets the
     * focus back when the dialog closes.
     */
    private async execute(line: string): Promise<unknown> {
        if (this.latency.execute(line)) return undefined;
        const isOfPage = await executePageCommand(line, {
            help: (topic) => {
                this.help.filter(topic);
                this.commandLine.close();
                this.help.open(topic);
            },
            exportFile: async (description) => {
                if (description !== "") return this.exportAndSaveFile(description);
                this.commandLine.close();
                return this.openExport();
            },
            share: () => {
                this.commandLine.close();
                this.openPhoneLinkDialog();
            },
        });
        if (isOfPage) return undefined;
        const { revision } = await this.request({ type: "command", line });
        const field = fieldInCommandLine(line);
        if (!field) return undefined;
        this.fieldPanel.adoptLoaded(field, revision);
        return undefined;
    }

    /**
     * Loads a formula, then changes settings; resolves to the revision after both commands. Rejects if the server
     * refuses the formula. If it refuses only the settings, shows why, and resolves to the revision after the formula.
     * `continues` tells whether the formula belongs to the undo step of the previous command.
     */
    private async loadField(field: FormulaWithBox, settings: Settings, continues = false): Promise<number> {
        // Both requests are sent at once, so that no picture shows the formula without the settings.
        const answers = [this.request({ type: "load", ...formulaLoadOf(field), ...(continues && { continues }) })];
        if (Object.keys(settings).length > 0) {
            answers.push(this.request({ type: "set", continues: true, ...settings }));
        }
        const [loaded, changed] = await Promise.allSettled(answers);
        if (loaded!.status === "rejected") throw loaded!.reason;
        this.notice.showAll(loaded!.value.warnings ?? []);
        if (changed?.status === "rejected") this.notice.show((changed.reason as Error).message);
        return (changed?.status === "fulfilled" ? changed : loaded!).value.revision;
    }

    /** Loads the array at `path` in the server's data folder. Rejects if the server refuses it. */
    private async loadFromDataFolder(path: string): Promise<void> {
        const data = { name: nameOf({ name: path }), path };
        const { warnings = [] } = await this.request({ type: "load", ...data });
        this.notice.showAll(warnings);
        this.fileLoading.keep(data);
    }

    private openPicker(): void {
        this.notice.hide();
        this.picker.open(this.state?.polytope.name ?? "");
        void this.refreshPickerEntries();
    }

    /**
     * Lists the catalogue in the picker. Requests the catalogue at each call, because polytopes may have been loaded
     * since the last call.
     */
    private async refreshPickerEntries(): Promise<void> {
        try {
            this.picker.setEntries((await this.client.request({ type: "get", what: "catalogue" })).polytopes);
        } catch (error) {
            const { code, message } = error as RequestError;
            this.picker.showFailure(code === "not_connected" ? "The server cannot be reached" : message);
        }
    }

    private dismissMessages(): void {
        this.notice.close();
        this.fileLoading.hide();
        this.welcomeLine.hide();
        this.tour.stop();
    }

    /** Opens the export dialog. If an element is given, the dialog chooses this element as the content of the file. */
    private openExport(highlight?: PolytopeElement): void {
        this.notice.hide();
        this.slider.stop(); // so that the file contains the slice that the dialog names
        if (!this.state) return;
        if (highlight) this.exportDialog.open({ ...this.state, highlight }, "highlight");
        else this.exportDialog.open(this.state);
    }

    private openPhoneLinkDialog(): void {
        this.notice.hide();
        this.phoneLinkDialog.open();
    }

    /** Saves the file that `description` describes: a format and options, as in "stl fit=5". */
    private async exportAndSaveFile(description: string): Promise<void> {
        this.slider.stop();
        // A move of the focus may be on its way to the server. The file will show the slice after this move, so the
        // file's name is made from the state after the move.
        const state = await this.client.request({ type: "get", what: "state" });
        await this.exportDialog.save(description, state);
    }

    /** Sends a command, and tracks it until its picture is presented. Resolves to the server's answer. */
    private async request(command: Command): Promise<Done> {
        if (command.type !== "rotate") this.tilt.endUndoStep();
        const answer = this.client.request(command);
        try {
            await Promise.all([this.keyRepeatLimiter.track(answer), this.latency.track(command.type, answer)]);
        } finally {
            this.framePointing.update();
        }
        return answer;
    }

    /** Sends a command; shows an error as a notice. Resolves to whether the command has been executed. */
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

    /**
     * Resolves to the hit tester of the picture that is shown, which finds the element at a pixel. If the page must
     * request the hit tester and the server refuses, shows the error, and resolves to undefined.
     */
    private async requestHitTester(): Promise<HitTester | undefined> {
        try {
            return this.stage.hitTester ?? (await this.frameHitTesterCache.requestHitTester());
        } catch (error) {
            this.notice.show((error as Error).message);
            return undefined;
        }
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
