// Sends values one at a time: while a value is on its way, only the newest of the later values is kept.

export class NewestOnly<T> {
    private waiting: T | undefined;
    private timer: ReturnType<typeof setTimeout> | undefined;
    private isSending = false;

    /** `send` sends a value, and resolves when it has been answered; it must not reject. */
    constructor(private readonly send: (value: T) => Promise<void>) {}

    /** Whether a value has been sent and not answered, or waits to be sent. */
    get isBusy(): boolean {
        return this.isSending || this.waiting !== undefined;
    }

    /** Sends a value when no other follows within `delay` milliseconds, and the previous one has been answered. */
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
