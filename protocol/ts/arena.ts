// Memory for the typed arrays of one message; the arrays of the next message take the same memory. Its size is a power
// of two, so that messages of about the same size need no new memory.

/** The class of a typed array, such as Float32Array. */
export type Numbers<T> = { new (memory: ArrayBuffer, offset: number, length: number): T; BYTES_PER_ELEMENT: number };

export class Arena {
    private memory = new ArrayBuffer(0);
    private used = 0;

    /** Starts a new message, whose arrays need at most this many bytes. Invalidates the arrays of the previous one. */
    begin(bytes: number): void {
        this.used = 0;
        if (bytes > this.memory.byteLength) this.memory = new ArrayBuffer(2 ** Math.ceil(Math.log2(bytes)));
    }

    /** Copies little-endian bytes into an array of numbers, and returns it; undefined if there is not enough memory. */
    take<T>(bytes: Uint8Array, numbers: Numbers<T>): T | undefined {
        const room = this.room(bytes.length / numbers.BYTES_PER_ELEMENT, numbers);
        if (room) new Uint8Array(this.memory, this.used - bytes.length, bytes.length).set(bytes);
        return room;
    }

    /** Returns an uninitialized array of `count` numbers; undefined if there is not enough memory. */
    room<T>(count: number, numbers: Numbers<T>): T | undefined {
        const size = numbers.BYTES_PER_ELEMENT;
        const begin = Math.ceil(this.used / size) * size;
        if (begin + count * size > this.memory.byteLength) return undefined;
        this.used = begin + count * size;
        return new numbers(this.memory, begin, count);
    }
}
