// A vertex buffer that each new picture overwrites. Its size grows to powers of two, so most pictures allocate no
// memory.

import { BufferAttribute, DynamicDrawUsage } from "three";

type NumberArray = Float32Array | Int8Array | Uint8Array | Uint32Array;

export class GrowingBuffer<T extends NumberArray> {
    attribute: BufferAttribute;
    used = 0; // the number of items in use; an item has `itemSize` numbers

    constructor(
        private readonly make: new (length: number) => T,
        private readonly itemSize: number,
        private readonly normalized = false,
    ) {
        this.attribute = this.allocate(1024);
    }

    get array(): T {
        return this.attribute.array as T;
    }

    /**
     * Sets the number of items; the caller must then write all of them. Returns true if a larger buffer was allocated.
     */
    resize(items: number): boolean {
        this.used = items;
        if (items <= this.attribute.count) return false;
        this.attribute = this.allocate(2 ** Math.ceil(Math.log2(items)));
        return true;
    }

    /** Marks all items in use as changed. The next rendering then uploads them to the graphics card. */
    markChanged(): void {
        this.attribute.clearUpdateRanges();
        this.attribute.addUpdateRange(0, this.used * this.itemSize);
        this.attribute.needsUpdate = true;
    }

    private allocate(items: number): BufferAttribute {
        const attribute = new BufferAttribute(new this.make(items * this.itemSize), this.itemSize, this.normalized);
        return attribute.setUsage(DynamicDrawUsage);
    }
}
