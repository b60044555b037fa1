// Damages the messages, pictures and links in a folder at random, and reads them with the TypeScript client, which is
// bundled as <folder>/readers.mjs. For each kind of input, prints how many were read, how many were refused, and the
// longest time in milliseconds for a damaged and for an undamaged input.
//   node read_damaged.mjs <folder> <seed>
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [folder, seed] = process.argv.slice(2);
const kRounds = 400; // damaged copies of each file
const kMaxArrayBytes = 256 * 1024 * 1024; // bytes in typed arrays, including garbage from earlier inputs

globalThis.location = { pathname: "/", search: "", hash: "", href: "http://localhost/" };
const { Arena, commandLines, decodeBinary, decodeText, kBinaryKinds, pngText } = await import(
    pathToFileURL(join(folder, "readers.mjs"))
);

// Mulberry32, a pseudorandom generator. The seed determines its numbers.
let state = Number(seed);
function random(below) {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) % below;
}

function joined(first, second) {
    const out = new Uint8Array(first.length + second.length);
    out.set(first);
    out.set(second, first.length);
    return out;
}

/** Returns a copy of the bytes in which some are changed, removed, repeated or set to large values. */
function damagedCopy(bytes) {
    let out = Uint8Array.from(bytes);
    for (let changes = 1 + random(4); changes > 0; --changes) {
        const at = random(out.length + 1);
        const some = 1 + random(16);
        switch (random(5)) {
            case 0:
                if (at < out.length) out[at] = random(256);
                break;
            case 1:
                if (at < out.length) out[at] ^= 1 << random(8);
                break;
            case 2:
                out = joined(out.subarray(0, at), out.subarray(at + some));
                break;
            case 3:
                out = joined(out.subarray(0, at + some), out.subarray(at));
                break;
            default:
                out.fill(255, at, at + random(9));
        }
        if (random(16) === 0) out = out.slice(0, at);
    }
    return out;
}

const arena = new Arena();
const asText = (bytes) => Buffer.from(bytes).toString("latin1");
const readers = {
    json: (bytes) => decodeText(new TextDecoder().decode(bytes)),
    png: (bytes) => {
        const text = pngText(bytes);
        if (text !== undefined && typeof text !== "string") throw "pngText returned a value other than a string";
        return text ?? null;
    },
    link: (bytes) => {
        const lines = commandLines(asText(bytes)); // must not throw, because the page could not start
        if (lines.some((line) => typeof line !== "string")) throw "commandLines returned a value other than strings";
        return lines;
    },
};
for (const [encoding, { read }] of Object.entries(kBinaryKinds)) {
    if (read) readers[encoding] = (bytes) => decodeBinary(bytes, random(2) ? arena : undefined);
}

/** Reads an input. Returns the result; null if the input was refused. */
function readOrRefuse(kind, bytes) {
    try {
        return readers[kind](bytes);
    } catch (fault) {
        if (!(fault instanceof Error) || kind === "link") throw fault;
        return null;
    }
}

/**
 * Returns how many milliseconds reading an input takes. This is the least of five times, which excludes garbage
 * collection.
 */
function milliseconds(kind, bytes) {
    let least = Infinity;
    for (let time = 0; time < 5; ++time) {
        const start = performance.now();
        readOrRefuse(kind, bytes);
        least = Math.min(least, performance.now() - start);
    }
    return least;
}

const counts = {};
for (const name of readdirSync(folder)) {
    const kind = name.split(".").pop();
    if (!readers[kind]) continue;
    const whole = Uint8Array.from(readFileSync(join(folder, name)));
    if (readers[kind](whole) === null) throw new Error(`${name} cannot be read undamaged`);
    const count = (counts[kind] ??= { read: 0, refused: 0, slowest: 0, slowestUndamaged: 0 });
    count.slowestUndamaged = Math.max(count.slowestUndamaged, milliseconds(kind, whole));
    for (let round = 0; round < kRounds; ++round) {
        const bytes = damagedCopy(whole);
        const start = performance.now();
        readOrRefuse(kind, bytes) === null ? ++count.refused : ++count.read;
        if (performance.now() - start > count.slowest) count.slowest = Math.max(count.slowest, milliseconds(kind, bytes));
        const { arrayBuffers } = process.memoryUsage();
        if (arrayBuffers > kMaxArrayBytes) throw new Error(`${name}: ${arrayBuffers} bytes`);
    }
}
console.log(JSON.stringify(counts));
