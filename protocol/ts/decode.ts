// Bytes and text from the server → messages. JSON and CBOR slices come out alike, in flat typed arrays.

import { addExtension, Decoder } from "cbor-x/decode-no-eval";

import type { Arena, Numbers } from "./arena";
import { rowsOf, type Columns, type Integers } from "./columns";
import type { Message, Slice, Slices } from "./messages";

const cbor = new Decoder({ mapsAsObjects: true, useRecords: false });

let arena: Arena | undefined; // of the message that is being decoded

/** An array of RFC 8746, little endian: read where it lies if it is aligned, else moved. */
function readTyped<T>(tag: number, numbers: Numbers<T>): void {
    const size = numbers.BYTES_PER_ELEMENT;
    const decode = (bytes: Uint8Array<ArrayBuffer>): T =>
        bytes.byteOffset % size === 0
            ? new numbers(bytes.buffer, bytes.byteOffset, bytes.length / size)
            : (arena?.take(bytes, numbers) ?? new numbers(bytes.slice().buffer, 0, bytes.length / size));
    addExtension({ tag, decode } as Parameters<typeof addExtension>[0]);
}
readTyped(69, Uint16Array);
readTyped(70, Uint32Array);
readTyped(85, Float32Array);
readTyped(86, Float64Array);

const kPngSignature = [0x89, 0x50, 0x4e, 0x47];

export function isPng(bytes: Uint8Array): boolean {
    return kPngSignature.every((byte, i) => bytes[i] === byte);
}

/** Whether this is a file that was asked for: it begins with a character of ASCII, PNG and CBOR do not. */
export function isFile(bytes: Uint8Array): boolean {
    return bytes[0]! < 0x80;
}

export function decodeText(text: string): Message {
    return flattened(JSON.parse(text) as Message);
}

/** With an arena, the arrays are valid until it is used for another message. */
export function decodeCbor(bytes: Uint8Array, within?: Arena): Message {
    within?.begin(6 * bytes.length); // moved, or widened from 1 byte to 4
    arena = within;
    try {
        return flattened(cbor.decode(bytes) as Message);
    } finally {
        arena = undefined;
    }
}

/** The text of a PNG file's iTXt chunk with this keyword. */
export function pngText(png: Uint8Array, keyword = "oval4d"): string | undefined {
    const view = new DataView(png.buffer, png.byteOffset, png.byteLength);
    const utf8 = new TextDecoder();
    for (let at = 8; at + 12 <= png.length;) {
        const length = view.getUint32(at);
        const data = png.subarray(at + 8, at + 8 + length);
        if (utf8.decode(png.subarray(at + 4, at + 8)) === "iTXt") {
            const nameEnd = data.indexOf(0);
            if (utf8.decode(data.subarray(0, nameEnd)) === keyword && data[nameEnd + 1] === 0) {
                const languageEnd = data.indexOf(0, nameEnd + 3);
                return utf8.decode(data.subarray(data.indexOf(0, languageEnd + 1) + 1));
            }
        }
        at += length + 12;
    }
    return undefined;
}

type Loose<T> = T | number[] | number[][];

/** A slice as JSON has it: nested arrays. */
interface LooseSlice extends Omit<Slice, "vertices" | "edges" | "faces" | "of" | "tints" | "seen" | "fill"> {
    vertices: number[][];
    edges: number[][];
    faces: number[][];
    of: Record<"vertices" | "edges" | "faces", number[]>;
    tints?: number[];
    seen?: Record<"vertices" | "edges" | "faces", number[]>;
    fill?: { points: number[][]; triangles: number[][]; tints: number[]; seen?: number[] };
}

function flattened(message: Message): Message {
    if (message.type !== "slices") return message;
    const loose = message as unknown as Omit<Slices, "slices" | "coordinates" | "density"> & {
        coordinates?: Loose<Float32Array>;
        density?: Loose<Uint8Array>;
        slices: LooseSlice[] | Columns;
    };
    const { scene, slices } = loose;
    return {
        ...loose,
        scene: { ...scene, colors: { ...scene.colors, cells: indices(scene.colors.cells) } },
        coordinates: floats(loose.coordinates ?? []),
        density: loose.density instanceof Uint8Array ? loose.density : Uint8Array.from((loose.density ?? []).flat()),
        slices: Array.isArray(slices) ? slices.map(flattenedSlice) : rowsOf(slices, room),
    };
}

function flattenedSlice({ tints, seen, fill, ...slice }: LooseSlice): Slice {
    return {
        ...slice,
        vertices: floats(slice.vertices),
        edges: indices(slice.edges),
        faces: loops(slice.faces),
        of: ofAll(slice.of),
        ...(tints && { tints: indices(tints) }),
        ...(seen && { seen: ofAll(seen) }),
        ...(fill && {
            fill: {
                points: floats(fill.points),
                triangles: indices(fill.triangles),
                tints: indices(fill.tints),
                ...(fill.seen && { seen: indices(fill.seen) }),
            },
        }),
    };
}

function ofAll(lists: LooseSlice["of"]): Slice["of"] {
    return { vertices: indices(lists.vertices), edges: indices(lists.edges), faces: indices(lists.faces) };
}

function room(count: number): Uint32Array {
    return arena?.room(count, Uint32Array) ?? new Uint32Array(count);
}

function floats(values: Loose<Float32Array>): Float32Array {
    return values instanceof Float32Array ? values : Float32Array.from((values as number[]).flat());
}

function indices(values: Loose<Integers>): Uint32Array {
    if (values instanceof Uint32Array) return values;
    if (!ArrayBuffer.isView(values)) return Uint32Array.from((values as number[]).flat());
    const wide = room(values.length);
    wide.set(values);
    return wide;
}

function loops(faces: number[][]): Slice["faces"] {
    const begin = new Uint32Array(faces.length + 1);
    faces.forEach((face, i) => (begin[i + 1] = begin[i]! + face.length));
    return { begin, corners: Uint32Array.from(faces.flat()) };
}
