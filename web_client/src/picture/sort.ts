// A stable merge sort. Unlike the built-in sort, it allocates no memory.

const kRun = 8; // insertion sort makes runs of this many items, which are then merged

/**
 * Sorts items[begin] … items[end − 1] by keys[item], ascending and stably. `scratch` must have at least `end` elements.
 */
export function sortByKey(
    items: Uint32Array,
    [begin, end]: readonly [begin: number, end: number],
    keys: Float32Array,
    scratch: Uint32Array,
): void {
    for (let from = begin; from < end; from += kRun) insertionSort(items, from, Math.min(from + kRun, end), keys);
    let [source, target] = [items, scratch];
    for (let run = kRun; run < end - begin; run *= 2) {
        for (let from = begin; from < end; from += 2 * run) {
            mergeRuns(source, target, from, Math.min(from + run, end), Math.min(from + 2 * run, end), keys);
        }
        [source, target] = [target, source];
    }
    if (source !== items) for (let i = begin; i < end; ++i) items[i] = source[i]!;
}

function insertionSort(items: Uint32Array, begin: number, end: number, keys: Float32Array): void {
    for (let i = begin + 1; i < end; ++i) {
        const item = items[i]!;
        let k = i;
        for (; k > begin && keys[items[k - 1]!]! > keys[item]!; --k) items[k] = items[k - 1]!;
        items[k] = item;
    }
}

function mergeRuns(
    from: Uint32Array,
    to: Uint32Array,
    begin: number,
    middle: number,
    end: number,
    keys: Float32Array,
): void {
    for (let [a, b, k] = [begin, middle, begin]; k < end; ++k) {
        const first = b >= end || (a < middle && keys[from[a]!]! <= keys[from[b]!]!);
        to[k] = first ? from[a++]! : from[b++]!;
    }
}
