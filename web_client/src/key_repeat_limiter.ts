// Limits the repetition of a held key: the key repeats only after the picture of the previous press has been presented.
// Repetitions that come too early are dropped, not queued.

export class KeyRepeatLimiter {
    private unanswered = 0; // number of requests without an answer
    private awaitedRevision = 0;
    private presentedRevision = 0;

    /** Whether a held key may repeat now. */
    get mayRepeat(): boolean {
        return this.unanswered === 0 && this.presentedRevision >= this.awaitedRevision;
    }

    /**
     * Tracks a request: mayRepeat is false until the request is answered and the picture of the answer's revision is
     * presented. Rejects if the request is rejected.
     */
    async track(answer: Promise<{ revision: number }>): Promise<void> {
        ++this.unanswered;
        try {
            this.awaitedRevision = (await answer).revision;
        } finally {
            --this.unanswered;
        }
    }

    picturePresented(revision: number): void {
        this.presentedRevision = revision;
    }

    /** Forgets the revisions, because a new connection may be to a session whose revisions start at 0. */
    prepareForNewConnection(): void {
        this.awaitedRevision = this.presentedRevision = 0;
    }
}
