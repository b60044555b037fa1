// How fast a held key may repeat: the next one goes when the last one's picture has been seen. Nothing is queued.

export class Pace {
    /** Milliseconds from the last key to its picture. */
    latency: number | undefined;
    private unanswered = 0;
    private awaited = 0; // revision
    private seen = 0;
    private sentAt: number | undefined;

    get free(): boolean {
        return this.unanswered === 0 && this.seen >= this.awaited;
    }

    /** Follows a request to its picture. */
    async follow(answer: Promise<{ revision: number }>): Promise<void> {
        ++this.unanswered;
        this.sentAt ??= performance.now();
        try {
            this.awaited = (await answer).revision;
        } finally {
            --this.unanswered;
            this.settle();
        }
    }

    presented(revision: number): void {
        this.seen = revision;
        this.settle();
    }

    /** A new connection may be to a session that counts anew. */
    restart(): void {
        this.awaited = this.seen = 0;
        this.sentAt = undefined;
    }

    private settle(): void {
        if (!this.free || this.sentAt === undefined) return;
        this.latency = performance.now() - this.sentAt;
        this.sentAt = undefined;
    }
}
