// How fast a held key may repeat: the next one goes when the last one's picture has been seen. Nothing is queued.

export class Pace {
    private unanswered = 0;
    private awaited = 0; // revision
    private seen = 0;

    get free(): boolean {
        return this.unanswered === 0 && this.seen >= this.awaited;
    }

    /** Follows a request to its picture. */
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

    /** A new connection may be to a session that counts anew. */
    restart(): void {
        this.awaited = this.seen = 0;
    }
}
