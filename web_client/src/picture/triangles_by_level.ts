// Groups the triangles of a surface by level. The caps of each level are a separate group. Triangles that are already
// in the order of the groups are not copied.

import type { Integers, Surface } from "@oval4d/protocol";

const kMaxLevels = 4; // the most levels of a field, as in protocol/README.md
const kGroups = 2 * kMaxLevels;

export class TrianglesByLevel {
    /** Three indices of points for each triangle, group by group. Valid until the arrays of the surface change. */
    triangles: Integers = new Uint8Array(0);
    private readonly begin = new Uint32Array(kGroups + 1); // group g has the triangles begin[g] … begin[g + 1] − 1
    private readonly next = new Uint32Array(kGroups);
    private memory = new ArrayBuffer(0); // holds `triangles` if they had to be reordered

    /** Groups the triangles of a surface. */
    update(surface: Surface): void {
        const { level, cap, triangles } = surface;
        const { begin, next } = this;
        begin.fill(0);
        let sorted = true;
        for (let t = 0, previous = 0; t < level.length; ++t) {
            const group = triangleGroupOf(level[t]!, cap[t]!);
            ++begin[group + 1]!;
            sorted &&= group >= previous;
            previous = group;
        }
        for (let g = 0; g < kGroups; ++g) begin[g + 1]! += begin[g]!;
        this.triangles = sorted ? triangles : this.reusableArrayLike(triangles);
        if (sorted) return;
        next.set(begin.subarray(0, kGroups));
        const out = this.triangles;
        for (let t = 0; t < level.length; ++t) {
            const to = 3 * next[triangleGroupOf(level[t]!, cap[t]!)]!++;
            out[to] = triangles[3 * t]!;
            out[to + 1] = triangles[3 * t + 1]!;
            out[to + 2] = triangles[3 * t + 2]!;
        }
    }

    /** The range of a level's triangles: the triangles of its caps (cap = 1), or all others (cap = 0). */
    range(level: number, cap: number): [begin: number, end: number] {
        const group = triangleGroupOf(level, cap);
        return [this.begin[group]!, this.begin[group + 1]!];
    }

    /**
     * Returns an array of the type and length of `triangles`. Its contents are undefined, and the next surface reuses
     * its memory.
     */
    private reusableArrayLike(triangles: Integers): Integers {
        if (triangles.byteLength > this.memory.byteLength) {
            this.memory = new ArrayBuffer(2 ** Math.ceil(Math.log2(triangles.byteLength)));
        }
        const Numbers = triangles.constructor as new (memory: ArrayBuffer, from: number, length: number) => Integers;
        return new Numbers(this.memory, 0, triangles.length);
    }
}

function triangleGroupOf(level: number, cap: number): number {
    return (2 * level + cap) & (kGroups - 1);
}
