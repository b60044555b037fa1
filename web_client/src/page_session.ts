// Decides which session the page joins, and which view a new session gets.

import type { Client, Credentials, RequestError, State } from "@oval4d/protocol";

import type { FormulaWithBox } from "./fields";
import { isFirstVisit, kFirstVisitView } from "./first_visit";
import { extractSharedSession, type InitialView, rememberSession, sessionOfHistoryEntry } from "./link";

interface PageSessionActions {
    /** Called when the page joins another session, before anything is known of it. */
    joined: () => void;
    /** Loads a field, and shows its formula in the field panel. */
    loadField: (field: FormulaWithBox) => Promise<void>;
    /** Reloads a file that this page had loaded into the lost session. */
    reloadFile: (name: string) => Promise<unknown>;
    /** Called when a command of the initial view has produced this revision. */
    viewShown: (revision: number) => void;
    tell: (messages: string[]) => void;
    /** Shows what is wrong with the address. The messages stay until the user closes them. */
    tellFaults: (messages: string[]) => void;
}

export class PageSession {
    // The last state of a session that was lost, or that beginNewSession() has left. The new session restores this
    // state.
    private lostState: State | undefined;
    // Whether a command of the initial view has been sent, over this connection or an earlier one.
    private isViewBegun = false;

    /** `view` tells what the page shows at the start (see link.ts). The functions of this class change it. */
    constructor(
        private readonly client: Client,
        private readonly view: InitialView,
        private readonly actions: PageSessionActions,
    ) {}

    /**
     * On the first visit, makes kFirstVisitView the initial view and returns true. Does nothing and returns false on
     * later visits, or if the address contains a view or a session.
     */
    useFirstVisitView(): boolean {
        const { credentials, lines, field } = this.view;
        if (credentials || lines.length > 0 || field || !isFirstVisit()) return false;
        this.view.lines = [...kFirstVisitView];
        return true;
    }

    /**
     * Joins the session of a link that the user has pasted into the address bar. Browsers do not reload the page if
     * only the fragment of the address changes.
     */
    joinShared(): void {
        const { credentials, fault } = extractSharedSession();
        if (fault) this.actions.tellFaults([fault]);
        if (credentials) this.joinWithCredentials(credentials);
        // The pasted address has made a new entry of the history, which needs the session.
        else if (this.client.credentials) rememberSession(this.client.credentials);
    }

    /**
     * Joins the session of the current entry of the browser's history. Must be called after Back or Forward has changed
     * the entry without reloading the page.
     */
    joinSessionOfHistoryEntry(): void {
        const credentials = sessionOfHistoryEntry();
        if (credentials && credentials.session !== this.client.credentials?.session) this.joinWithCredentials(credentials);
    }

    /**
     * Records that the session is lost. `state` is the last state of the lost session, if it is known; the new session
     * restores it.
     */
    sessionLost(reason: string, state: State | undefined): void {
        this.lostState ??= state; // if a view has not been restored yet, `state` may be that of the new session
        this.client.hello({ stream: "none" }).catch(() => {}); // no pictures until the view is restored
        this.actions.tell([
            state
                ? `The session has ended (${reason}). This is a new one with the same view.`
                : `The session cannot be opened (${reason}). This is a new one.`,
        ]);
    }

    /**
     * Begins a new session, while the server cannot open the present one. Restores `state` in the new session, if it is
     * given. The present session stays in the browser's history.
     */
    beginNewSession(state: State | undefined): void {
        this.lostState ??= state;
        if (this.client.credentials) rememberSession(this.client.credentials);
        history.pushState(null, ""); // the new entry gets the new session
        this.client.credentials = undefined;
        this.client.hello({ stream: "none" }).catch(() => {}); // no pictures until the view is restored
        this.actions.tell(["This is a new session. The browser's button Back returns to the other one."]);
        this.client.connect();
    }

    /**
     * Restores the state of a lost session, if there is one, then applies the initial view, if this has not been done.
     * Tells the user what is wrong with these views. Rejects if the connection breaks; the caller must then call the
     * function again for the next connection.
     */
    async restoreOrInitializeView(): Promise<void> {
        try {
            if (this.lostState) await this.restore(this.lostState);
        } catch (error) {
            throwIfNotConnected(error);
            this.actions.tell([(error as Error).message]);
        }
        this.lostState = undefined;
        const faults = await this.applyInitialView();
        this.clearInitialView();
        this.actions.tellFaults(faults);
    }

    /** Applies the initial view, unless this has been done. Resolves to messages about what is wrong with the view. */
    private async applyInitialView(): Promise<string[]> {
        const { lines, field, faults: known } = this.view;
        const faults = [...known];
        // If the connection broke, the server may have executed commands that the page now sends again. Without a
        // reset, a repeated rotation would turn the object twice.
        if (this.isViewBegun) await this.client.request({ type: "reset" });
        this.isViewBegun = lines.length > 0 || field !== undefined;
        if (field) {
            try {
                await this.actions.loadField(field);
            } catch (error) {
                throwIfNotConnected(error);
                faults.push(`The address contains “formula=${field.formula}”: ${(error as Error).message}`);
            }
        }
        for (const line of lines) {
            try {
                const { revision } = await this.client.request({ type: "command", line });
                this.actions.viewShown(revision);
            } catch (error) {
                throwIfNotConnected(error);
                faults.push(`The address contains “${line}”: ${(error as Error).message}`);
            }
        }
        return faults;
    }

    private joinWithCredentials(credentials: Credentials): void {
        this.clearInitialView(); // the initial view is only for a new session
        this.lostState = undefined;
        this.actions.joined();
        this.client.credentials = credentials;
        this.client.connect();
    }

    private clearInitialView(): void {
        Object.assign(this.view, { lines: [], faults: [] });
        delete this.view.field;
        this.isViewBegun = false;
    }

    /**
     * Restores a state. If its object is not available, because for example another page loaded the file, restores the
     * rest.
     */
    private async restore(lost: State): Promise<void> {
        try {
            await this.actions.reloadFile(lost.polytope.name);
            await this.client.request({ ...lost, type: "set", turning: false, playing: false });
        } catch (error) {
            throwIfNotConnected(error);
            this.actions.tell([(error as Error).message]);
            const { polytope, slices, point, hidden, faded, highlight, levels, inside, fog, ...rest } = lost;
            await this.client.request({ ...rest, type: "set", turning: false, playing: false });
        }
    }
}

/** Throws the error again if it means that the connection broke before the server answered. */
function throwIfNotConnected(error: unknown): void {
    if ((error as RequestError).code === "not_connected") throw error;
}
