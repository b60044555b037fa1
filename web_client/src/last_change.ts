// Tells which states are older than a change that this page has made. States are sent with pictures, so one from before a
// change may arrive after the answer to the change; a control that showed it would jump back for a moment.

import type { State } from "@oval4d/protocol";

export class LastChange {
    private revision = 0; // of the newest change
    private seen = 0; // of the newest state

    /** Takes note of the revision in the answer to a change. */
    answered(revision: number): void {
        this.revision = revision;
    }

    /** Forgets the revisions, because a new connection may be to a session whose revisions start again. */
    restart(): void {
        this.revision = this.seen = 0;
    }

    /** Whether this state, the newest one, is from before the last change. */
    isAfter({ revision }: State): boolean {
        if (revision < this.seen) this.revision = 0; // the revisions of another session
        this.seen = revision;
        return revision < this.revision;
    }
}
