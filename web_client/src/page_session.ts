// The session that the page shows: which one it joins, and the view with which a new one begins.

import type { Client, Credentials, RequestError, State } from "@oval4d/protocol";

import type { FormulaWithBox } from "./fields";
import { isFirstVisit, kFirstVisitView } from "./first_visit";
import { extractSharedSession, type InitialView, rememberSession, sessionOfHistoryEntry } from "./link";

interface PageSessionActions {
    /** Called when the page joins another session, of which nothing is known yet. */
    joined: () => void;
    /** Loads a field, which the panel of fields then shows. */
    loadField: (field: FormulaWithBox) => Promise<void>;
    /** Reloads a file that this page had loaded into the lost session. */
    reloadFile: (name: string) => Promise<unknown>;
    /** Called when a command of the initial view has produced this revision. */
    viewShown: (revision: number) => void;
    tell: (messages: string[]) => void;
    /** Tells what is wrong with the address, such that the user can read it while using the page. */
    tellFaults: (messages: string[]) => void;
}

export class PageSession {
    // The last state of a session that was lost, or left by beginNew(). The new session restores it.
    private lostState: State | undefined;
    // Whether a command of the initial view has been sent, in this or an earlier connection.
    private isViewBegun = false;

    /** `view` is what the page shows at the start. */
    constructor(
        private readonly client: Client,
        private readonly view: InitialView,
        private readonly actions: PageSessionActions,
    ) {}

    /**
     * On the first visit, makes kFirstVisitView the initial view, unless the address names another view or a session.
     * Returns whether kFirstVisitView is now the initial view.
     */
    useFirstVisitView(): boolean {
        const { credentials, lines, field } = this.view;
        if (credentials || lines.length > 0 || field || !isFirstVisit()) return false;
        this.view.lines = [...kFirstVisitView];
        return true;
    }

    /** Joins the session of a link that was pasted into the address bar: browsers do not reload the page for it. */
    joinShared(): void {
        const { credentials, fault } = extractSharedSession();
        if (fault) this.actions.tellFaults([fault]);
        if (credentials) this.join(credentials);
        else if (this.client.credentials) rememberSession(this.client.credentials); // for the new entry of the history
    }

    /**
     * Joins the session of the current entry of the browser's history. Must be called after Back or Forward has changed
     * the entry without reloading the page.
     */
    joinSessionOfHistoryEntry(): void {
        const credentials = sessionOfHistoryEntry();
        if (credentials && credentials.session !== this.client.credentials?.session) this.join(credentials);
    }

    /**
     * Records that the session is lost. If `state`, the last state of the lost session, is known, the new session gets
     * its view.
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
     * Begins a new session, with the view of `state` if it is known, while the server cannot open the present one. The
     * present session stays in the browser's history.
     */
    beginNew(state: State | undefined): void {
        this.lostState ??= state;
        if (this.client.credentials) rememberSession(this.client.credentials);
        history.pushState(null, ""); // the new entry gets the new session
        this.client.credentials = undefined;
        this.client.hello({ stream: "none" }).catch(() => {}); // no pictures until the view is restored
        this.actions.tell(["This is a new session. The browser's button Back returns to the other one."]);
        this.client.connect();
    }

    /**
     * Restores the view of a lost session, if a session was lost; then applies the initial view, if it has not been
     * applied yet. Tells the user what is wrong with these views. Rejects if the connection breaks; must then be called
     * again for the next connection.
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

    /**
     * Applies the initial view, if it has not been applied yet. Resolves to messages about what is wrong with the view.
     */
    private async applyInitialView(): Promise<string[]> {
        const { lines, field, faults: known } = this.view;
        const faults = [...known];
        // The commands that were sent before the connection broke may have been executed. Without a reset, a rotation
        // that is sent again would turn the object twice.
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

    private join(credentials: Credentials): void {
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

    /** Restores a view, without its polytope if that is not available: for example, if another page loaded its file. */
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

/** Throws the error again if the connection broke before the answer to a request arrived. */
function throwIfNotConnected(error: unknown): void {
    if ((error as RequestError).code === "not_connected") throw error;
}
