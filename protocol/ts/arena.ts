// Memory for the typed arrays of one message. The arrays of the next message overwrite it. Its size is rounded up to a
// power of two, so messages of similar sizes need no new memory.

/** The class of a typed array, such as Float32Array. */
export type TypedArrayConstructor<T> = {
    new (memory: ArrayBuffer, offset: number, length: number): T;
    BYTES_PER_ELEMENT: number;
};

export class Arena {
    private memory = new ArrayBuffer(0);
    private used = 0;

    /**
     * Starts a new message whose arrays need at most `bytes` bytes. The arrays of the previous message become invalid.
     */
    startMessage(bytes: number): void {
        this.used = 0;
        if (bytes > this.memory.byteLength) this.memory = new ArrayBuffer(2 ** Math.ceil(Math.log2(bytes)));
    }

    /**
     * Copies little-endian bytes into the memory, and returns the copy as an array of numbers. Returns undefined if the
     * memory is too small.
     */
    copy<T>(bytes: Uint8Array, arrayType: TypedArrayConstructor<T>): T | undefined {
        const copied = this.allocate(bytes.length / arrayType.BYTES_PER_ELEMENT, arrayType);
        if (copied) new Uint8Array(this.memory, this.used - bytes.length, bytes.length).set(bytes);
        return copied;
    }

    /** Returns an array of `count` numbers, which may have any values. Returns undefined if the memory is too small. */
    allocate<T>(count: number, arrayType: TypedArrayConstructor<T>): T | undefined {
        const size = arrayType.BYTES_PER_ELEMENT;
        const begin = Math.ceil(this.used / size) * size;
        if (begin + count * size > this.memory.byteLength) return undefined;
        this.used = begin + count * size;
        return new arrayType(this.memory, begin, count);
    }
}
