// Memory for the typed arrays of one message at a time, used again for the next: it grows by doubling, so that a steady
// stream of messages allocates nothing.

export type Numbers<T> = { new (memory: ArrayBuffer, offset: number, length: number): T; BYTES_PER_ELEMENT: number };

export class Arena {
    private memory = new ArrayBuffer(0);
    private used = 0;

    /** From now on the memory is that of another message, which needs so many bytes. */
    begin(bytes: number): void {
        this.used = 0;
        if (bytes > this.memory.byteLength) this.memory = new ArrayBuffer(2 ** Math.ceil(Math.log2(bytes)));
    }

    /** These bytes, little endian, as numbers; nothing where there is no room. */
    take<T>(bytes: Uint8Array, numbers: Numbers<T>): T | undefined {
        const room = this.room(bytes.length / numbers.BYTES_PER_ELEMENT, numbers);
        if (room) new Uint8Array(this.memory, this.used - bytes.length, bytes.length).set(bytes);
        return room;
    }

    /** Room for so many numbers, if there is any. */
    room<T>(count: number, numbers: Numbers<T>): T | undefined {
        const size = numbers.BYTES_PER_ELEMENT;
        const begin = Math.ceil(this.used / size) * size;
        if (begin + count * size > this.memory.byteLength) return undefined;
        this.used = begin + count * size;
        return new numbers(this.memory, begin, count);
    }
}
