// Tells which states are older than a change that this page has made. The server sends states with pictures, so a state
// from before a change may arrive after the answer to the change. A control that showed this old state would jump back
// for a moment.

import type { State } from "@oval4d/protocol";

export class OldStateDetector {
    private revision = 0; // the revision after the newest change that this page has made
    private seen = 0; // the revision of the newest state

    /** Takes note of the revision in the answer to a change. */
    answered(revision: number): void {
        this.revision = revision;
    }

    /** Forgets the revisions, because a new connection may be to a session whose revisions start again. */
    prepareForNewConnection(): void {
        this.revision = this.seen = 0;
    }

    /**
     * Records a state, which must be the newest one. Returns whether it is from before the last change by this page.
     */
    recordAndCheckIfOld({ revision }: State): boolean {
        if (revision < this.seen) this.revision = 0; // the state is of another session
        this.seen = revision;
        return revision < this.revision;
    }
}
