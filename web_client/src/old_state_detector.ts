// Detects states that are older than a change by this page. The server sends states together with pictures, so a state
// from before a change may arrive after the answer to the change. A control that showed such a state would jump back
// for a moment.

import type { State } from "@oval4d/protocol";

export class OldStateDetector {
    private revision = 0; // the revision after the newest change that this page has made
    private seen = 0; // the revision of the newest state

    /** Records the revision in the server's answer to a change by this page. */
    noteRevision(revision: number): void {
        this.revision = revision;
    }

    /** Forgets the revisions, because a new connection may be to a session whose revisions start again. */
    prepareForNewConnection(): void {
        this.revision = this.seen = 0;
    }

    /** Records the newest state. Returns whether this state is older than the last change by this page. */
    recordAndCheckIfOld({ revision }: State): boolean {
        if (revision < this.seen) this.revision = 0; // the state is of another session
        this.seen = revision;
        return revision < this.revision;
    }
}
