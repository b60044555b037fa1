// Limits the repetition of a held key: the key repeats only after the picture of its previous press has been presented.
// Repetitions that come too early are dropped, not queued.

export class Pace {
    private unanswered = 0;
    private awaited = 0; // revision
    private seen = 0; // revision

    /** Whether a held key may repeat now. */
    get free(): boolean {
        return this.unanswered === 0 && this.seen >= this.awaited;
    }

    /** Tracks a request until its picture is presented. */
    async follow(answer: Promise<{ revision: number }>): Promise<void> {
        ++this.unanswered;
        try {
            this.awaited = (await answer).revision;
        } finally {
            --this.unanswered;
        }
    }

    presented(revision: number): void {
        this.seen = revision;
    }

    /** Forgets the revisions: a new connection may be to a session whose revisions start at 0. */
    restart(): void {
        this.awaited = this.seen = 0;
    }
}
