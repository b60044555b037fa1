// Sends values one at a time. While a value is unanswered, keeps only the newest of the submitted values.

export class NewestValueSender<T> {
    private waiting: T | undefined;
    private timer: ReturnType<typeof setTimeout> | undefined;
    private isSending = false;

    /** `send` sends a value, and resolves when the server has answered it. `send` must not reject. */
    constructor(private readonly send: (value: T) => Promise<void>) {}

    /** Whether a value waits to be sent, or has been sent and not yet answered. */
    get isBusy(): boolean {
        return this.isSending || this.waiting !== undefined;
    }

    /**
     * Sends a value after `delay` milliseconds, and after the answer to the previous value. Drops the value if a newer
     * one is submitted before it is sent.
     */
    submit(value: T, delay: number): void {
        this.waiting = value;
        clearTimeout(this.timer);
        this.timer = setTimeout(() => {
            this.timer = undefined;
            void this.sendWaiting();
        }, delay);
    }

    private async sendWaiting(): Promise<void> {
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
