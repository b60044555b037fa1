// Sends values one at a time: while one is on its way, only the newest of those that follow is kept.

export class NewestOnly<T> {
    private waiting: T | undefined;
    private timer: ReturnType<typeof setTimeout> | undefined;
    private isSending = false;

    /** `send` sends a value, and resolves when it has been answered; it must not reject. */
    constructor(private readonly send: (value: T) => Promise<void>) {}

    /** Whether a value is on its way or waits. */
    get isBusy(): boolean {
        return this.isSending || this.waiting !== undefined;
    }

    /** Sends a value after a delay in milliseconds without another value, and after the answer to the previous one. */
    submit(value: T, delay: number): void {
        this.waiting = value;
        clearTimeout(this.timer);
        this.timer = setTimeout(() => {
            this.timer = undefined;
            void this.flush();
        }, delay);
    }

    private async flush(): Promise<void> {
        if (this.isSending) return;
        this.isSending = true;
        while (this.waiting !== undefined && this.timer === undefined) {
            const value = this.waiting;
            this.waiting = undefined;
            await this.send(value);
        }
        this.isSending = false;
    }
}
