// Decodes the server's text and binary messages. `slices` messages in all encodings are decoded to the same type, which
// slices.ts describes.

import * as cborX from "cbor-x/decode-no-eval";

import type { Arena, TypedArrayConstructor } from "./arena.js";
import { partsFromColumns, slicesFromColumns, type SliceColumns, type ProjectionColumns } from "./columns.js";
import type { Encoding } from "./messages.js";
import type { Elements, Fog, Integers, ObjectProjection, ProjectionLook, Slice, Slices, Surface } from "./slices.js";
import type { Message } from "./types.js";

const cbor = new cborX.Decoder({ mapsAsObjects: true, useRecords: false });

/** A function of cbor-x that limits the sizes of arrays and maps. The type declarations of cbor-x lack it. */
const { setSizeLimits } = cborX as unknown as {
    setSizeLimits: (limits: { maxArraySize: number; maxMapSize: number }) => void;
};

let arena: Arena | undefined; // memory for the arrays of the message that decodeSlices() decodes at present

/** The classes of typed arrays. The keys are CBOR tags (RFC 8746) and also extension types of MessagePack. */
const kArrayTypes = new Map<number, TypedArrayConstructor<unknown>>([
    [64, Uint8Array],
    [69, Uint16Array],
    [70, Uint32Array],
    [85, Float32Array],
    [86, Float64Array],
]);

/**
 * Returns an array of the numbers in little-endian bytes. The array is a view of the bytes if they are aligned for
 * numbers of this type, otherwise a copy.
 */
function typedArrayOf<T>(bytes: Uint8Array<ArrayBuffer>, arrayType: TypedArrayConstructor<T>): T {
    const size = arrayType.BYTES_PER_ELEMENT;
    return bytes.byteOffset % size === 0
        ? new arrayType(bytes.buffer, bytes.byteOffset, bytes.length / size)
        : (arena?.copy(bytes, arrayType) ?? new arrayType(bytes.slice().buffer, 0, bytes.length / size));
}

for (const [tag, arrayType] of kArrayTypes) {
    const decode = (bytes: Uint8Array<ArrayBuffer>): unknown => typedArrayOf(bytes, arrayType);
    cborX.addExtension({ tag, decode } as Parameters<typeof cborX.addExtension>[0]);
}

/** Decodes CBOR. Throws an Error if the bytes are not CBOR. */
function readCbor(bytes: Uint8Array): unknown {
    // Each item takes at least one byte. Without these limits, cbor-x would read beyond the end of a message that
    // announces more items than it contains.
    setSizeLimits({ maxArraySize: bytes.length + 1, maxMapSize: bytes.length + 1 });
    return cbor.decode(bytes);
}

const strictUtf8 = new TextDecoder("utf-8", { fatal: true });

/** Reads a message in a binary encoding. Reading beyond the end of the message throws a RangeError. */
abstract class BinaryReader {
    protected readonly view: DataView;
    private at = 0;

    constructor(private readonly bytes: Uint8Array<ArrayBuffer>) {
        this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
    }

    /** Reads the whole message. Throws an Error if the bytes are not exactly one value. */
    message(): unknown {
        const value = this.value();
        if (this.at < this.bytes.length) throw new Error("there are bytes after the end of a binary message");
        return value;
    }

    /** Reads the value at the current position. */
    protected abstract value(): unknown;

    /** Moves forward by `count` bytes. Returns the position before the move. */
    protected skip(count: number): number {
        this.at += count;
        return this.at - count;
    }

    protected take(count: number): Uint8Array<ArrayBuffer> {
        if (count > this.bytes.length - this.at) throw new RangeError("a binary message is cut off");
        const begin = this.skip(count);
        return this.bytes.subarray(begin, begin + count);
    }

    protected text(size: number): string {
        return strictUtf8.decode(this.take(size));
    }
}

/** Reads MessagePack. Its numbers are big-endian, which is the default of DataView. */
class MsgpackReader extends BinaryReader {
    /**
     * Reads the value at the current position. The first byte states the format of the value; it also contains the
     * value, or the size of the value, if this number is small.
     */
    protected override value(): unknown {
        const format = this.view.getUint8(this.skip(1));
        if (format < 0x80) return format;
        if (format < 0x90) return this.map(format - 0x80);
        if (format < 0xa0) return this.array(format - 0x90);
        if (format < 0xc0) return this.text(format - 0xa0);
        if (format >= 0xe0) return format - 0x100;
        if (format >= 0xde) return this.map(this.unsigned(2 << (format - 0xde)));
        if (format >= 0xdc) return this.array(this.unsigned(2 << (format - 0xdc)));
        if (format >= 0xd9) return this.text(this.unsigned(1 << (format - 0xd9)));
        if (format >= 0xd4) return this.extension(1 << (format - 0xd4));
        if (format >= 0xd0) return this.signed(1 << (format - 0xd0));
        if (format >= 0xcc) return this.unsigned(1 << (format - 0xcc));
        if (format === 0xcb) return this.view.getFloat64(this.skip(8));
        if (format === 0xca) return this.view.getFloat32(this.skip(4));
        if (format >= 0xc7) return this.extension(this.unsigned(1 << (format - 0xc7)));
        if (format >= 0xc4) return this.take(this.unsigned(1 << (format - 0xc4)));
        if (format === 0xc1) throw new Error("MessagePack has no value that begins with the byte 0xc1");
        return format === 0xc0 ? null : format === 0xc3;
    }

    private unsigned(size: number): number {
        const at = this.skip(size);
        if (size === 1) return this.view.getUint8(at);
        if (size === 2) return this.view.getUint16(at);
        return size === 4 ? this.view.getUint32(at) : Number(this.view.getBigUint64(at));
    }

    private signed(size: number): number {
        const at = this.skip(size);
        if (size === 1) return this.view.getInt8(at);
        if (size === 2) return this.view.getInt16(at);
        return size === 4 ? this.view.getInt32(at) : Number(this.view.getBigInt64(at));
    }

    /** Reads an extension of `size` bytes. Returns a typed array if kArrayTypes has its type, otherwise the bytes. */
    private extension(size: number): unknown {
        const arrayType = kArrayTypes.get(this.signed(1));
        const bytes = this.take(size);
        return arrayType ? typedArrayOf(bytes, arrayType) : bytes;
    }

    // array() and map() add the items one by one instead of allocating `count` items first: a damaged message may
    // announce more items than it contains.

    private array(count: number): unknown[] {
        const items: unknown[] = [];
        while (items.length < count) items.push(this.value());
        return items;
    }

    private map(count: number): Record<string, unknown> {
        const members: [string, unknown][] = [];
        while (members.length < count) {
            const name = this.value();
            if (typeof name !== "string") throw new Error("the name of a member is not a text");
            members.push([name, this.value()]);
        }
        return Object.fromEntries(members);
    }
}

/** Decodes MessagePack. Throws an Error if the bytes are not MessagePack. */
function readMsgpack(bytes: Uint8Array): unknown {
    return new MsgpackReader(bytes as Uint8Array<ArrayBuffer>).message();
}

/** The classes of typed arrays in BJData. The keys are the markers that name the type of the numbers. */
const kBjdataArrayTypes = new Map<string, TypedArrayConstructor<unknown>>([
    ["U", Uint8Array],
    ["u", Uint16Array],
    ["m", Uint32Array],
    ["d", Float32Array],
    ["D", Float64Array],
]);

/** Reads BJData, but only the part of it that the server writes (see "BJData" in protocol/README.md). */
class BjdataReader extends BinaryReader {
    protected override value(): unknown {
        return this.valueAfter(this.marker());
    }

    private marker(): string {
        return String.fromCharCode(this.view.getUint8(this.skip(1)));
    }

    private valueAfter(marker: string): unknown {
        if (marker === "{") return this.object();
        if (marker === "[") return this.array();
        if (marker === "S") return this.text(this.countAfter(this.marker()));
        return marker === "T" || marker === "F" ? marker === "T" : this.numberAfter(marker);
    }

    private numberAfter(marker: string): number {
        if (marker === "i") return this.view.getInt8(this.skip(1));
        if (marker === "U") return this.view.getUint8(this.skip(1));
        if (marker === "I") return this.view.getInt16(this.skip(2), true);
        if (marker === "u") return this.view.getUint16(this.skip(2), true);
        if (marker === "l") return this.view.getInt32(this.skip(4), true);
        if (marker === "m") return this.view.getUint32(this.skip(4), true);
        if (marker === "L") return Number(this.view.getBigInt64(this.skip(8), true));
        if (marker === "M") return Number(this.view.getBigUint64(this.skip(8), true));
        if (marker === "d") return this.view.getFloat32(this.skip(4), true);
        if (marker === "D") return this.view.getFloat64(this.skip(8), true);
        throw new Error(`a message in BJData has a value with the unknown marker ${JSON.stringify(marker)}`);
    }

    /** Reads a length. Refuses a negative one, which would move the position back, so that reading never ends. */
    private countAfter(marker: string): number {
        const count = this.numberAfter(marker);
        if (!Number.isInteger(count) || count < 0) throw new Error("a length in BJData is not a whole number");
        return count;
    }

    private array(): unknown {
        let marker = this.marker();
        if (marker === "$") return this.typedArray();
        const items: unknown[] = [];
        for (; marker !== "]"; marker = this.marker()) items.push(this.valueAfter(marker));
        return items;
    }

    private typedArray(): unknown {
        const arrayType = kBjdataArrayTypes.get(this.marker());
        if (!arrayType || this.marker() !== "#") throw new Error("BJData has no such optimized array");
        return typedArrayOf(this.take(arrayType.BYTES_PER_ELEMENT * this.countAfter(this.marker())), arrayType);
    }

    private object(): Record<string, unknown> {
        const members: [string, unknown][] = [];
        for (let marker = this.marker(); marker !== "}"; marker = this.marker()) {
            members.push([this.text(this.countAfter(marker)), this.value()]);
        }
        return Object.fromEntries(members);
    }
}

/** Decodes BJData. Throws an Error if the bytes are not BJData in the form that the server writes. */
function readBjdata(bytes: Uint8Array): unknown {
    return new BjdataReader(bytes as Uint8Array<ArrayBuffer>).message();
}

/**
 * A kind of binary message. Its first byte is in the range `firstByte`; if `secondByte` is present, its second byte
 * equals it. `read` decodes a `slices` message; it is absent for files and frames.
 */
interface BinaryMessageKind {
    firstByte: [least: number, greatest: number];
    secondByte?: number;
    read?: (bytes: Uint8Array) => unknown;
}

/** The kinds of binary messages (see "Binary messages" in protocol/README.md). */
export const kBinaryKinds: Record<"file" | "frame" | Exclude<Encoding, "json">, BinaryMessageKind> = {
    file: { firstByte: [0x21, 0x7e] },
    frame: { firstByte: [0x89, 0x89] },
    cbor: { firstByte: [0xa0, 0xbf], read: readCbor },
    msgpack: { firstByte: [0xdf, 0xdf], read: readMsgpack },
    bjdata: { firstByte: [0x7b, 0x7b], secondByte: 0x55, read: readBjdata },
};

export function decodeText(text: string): Message {
    return withTypedArrays(JSON.parse(text) as Message);
}

/**
 * Decodes a binary message. Returns a `slices` message; for a file or a frame, which need no decoding, returns "file"
 * or "frame". If `within` is given, arrays of the message may lie in its memory; they are valid until `within` is used
 * for another message. Throws an Error if the first bytes fit no kind of message, or if a `slices` message is damaged.
 */
export function decodeBinary(bytes: Uint8Array, within?: Arena): Message | "file" | "frame" {
    const [first = -1, second] = bytes;
    let found: [name: string, kind: BinaryMessageKind] | undefined;
    for (const [name, kind] of Object.entries(kBinaryKinds)) {
        const { firstByte, secondByte = second } = kind;
        if (first < firstByte[0] || first > firstByte[1] || second !== secondByte) continue;
        // If several kinds match, a kind with a `secondByte` takes precedence.
        if (!found || kind.secondByte !== undefined) found = [name, kind];
    }
    if (found) {
        const [name, { read }] = found;
        return read ? decodeSlices(bytes, read, within) : (name as "file" | "frame");
    }
    const what = first < 0 ? "is empty" : `begins with the byte 0x${first.toString(16)}`;
    throw new Error(`a binary message ${what}: this client knows no such message`);
}

function decodeSlices(bytes: Uint8Array, read: (bytes: Uint8Array) => unknown, within?: Arena): Message {
    // Six times the message's size is enough memory to copy all arrays and to widen 1-byte integers to 4 bytes.
    within?.startMessage(6 * bytes.length);
    arena = within;
    try {
        return withTypedArrays(read(bytes) as Message);
    } finally {
        arena = undefined;
    }
}

const kPngSignature = [0x89, 0x50, 0x4e, 0x47];

function isPng(bytes: Uint8Array): boolean {
    return kPngSignature.every((byte, i) => bytes[i] === byte);
}

/**
 * Returns the text of the uncompressed iTXt chunk with this keyword in a PNG file. Returns undefined if the file has no
 * such chunk or is cut off.
 */
export function pngText(png: Uint8Array, keyword = "oval4d"): string | undefined {
    const view = new DataView(png.buffer, png.byteOffset, png.byteLength);
    const utf8 = new TextDecoder();
    for (let at = isPng(png) ? 8 : png.length; at + 12 <= png.length;) {
        const length = view.getUint32(at);
        if (at + 12 + length > png.length) return undefined;
        const data = png.subarray(at + 8, at + 8 + length);
        if (utf8.decode(png.subarray(at + 4, at + 8)) === "iTXt") {
            const nameEnd = data.indexOf(0);
            if (utf8.decode(data.subarray(0, nameEnd)) === keyword && data[nameEnd + 1] === 0) {
                const languageEnd = data.indexOf(0, nameEnd + 3);
                const keywordEnd = data.indexOf(0, languageEnd + 1);
                if (languageEnd < 0 || keywordEnd < 0) return undefined;
                return utf8.decode(data.subarray(keywordEnd + 1));
            }
        }
        at += length + 12;
    }
    return undefined;
}

type FlatOrNested<T> = T | number[] | number[][];

/** The elements of a slice, or of a part of the projection, in the JSON encoding, where most arrays are nested. */
interface JsonElements {
    vertices: number[][];
    edges: number[][];
    faces: number[][];
    of: Record<"vertices" | "edges" | "faces", number[]>;
    tints?: number[];
    seen?: Record<"vertices" | "edges" | "faces", number[]>;
    balls?: { scale: number[]; opacity: number[] };
    fill?: { points: number[][]; triangles: number[][]; tints: number[]; seen?: number[] };
}

interface JsonSlice extends Omit<Slice, keyof Elements | "surface" | "fog">, JsonElements {
    surface?: {
        color?: number;
        points: number[][];
        normals: number[][];
        triangles: number[][];
        level: number[];
        cap: number[];
        colors?: number[];
        cap_colors?: number[];
    };
    fog?: Omit<Fog, "walls" | "values"> & { walls: number[][]; values: number[][] };
}

function withTypedArrays(message: Message): Message {
    if (message.type !== "slices") return message;
    const loose = message as unknown as Omit<Slices, "slices" | "coordinates" | "density" | "projection"> & {
        coordinates?: FlatOrNested<Float32Array>;
        density?: FlatOrNested<Uint8Array>;
        slices: JsonSlice[] | SliceColumns;
        projection?: Omit<ObjectProjection, "parts"> & { parts: (JsonElements & ProjectionLook)[] | ProjectionColumns };
    };
    const { scene, slices, projection, ...rest } = loose;
    return {
        ...rest,
        scene: { ...scene, colors: { ...scene.colors, cells: flatIndices(scene.colors.cells) } },
        coordinates: flatFloats(loose.coordinates ?? []),
        density: loose.density instanceof Uint8Array ? loose.density : Uint8Array.from((loose.density ?? []).flat()),
        slices: Array.isArray(slices) ? slices.map(sliceFromJson) : slicesFromColumns(slices, allocateIntegers),
        ...(projection && {
            projection: {
                ...projection,
                parts: Array.isArray(projection.parts)
                    ? projection.parts.map(elementsFromJson)
                    : partsFromColumns(projection.parts, allocateIntegers),
            },
        }),
    };
}

function elementsFromJson<T extends JsonElements>(all: T): Omit<T, keyof JsonElements> & Elements {
    const { vertices, edges, faces, of, tints, seen, balls, fill, ...rest } = all;
    return {
        ...rest,
        vertices: flatFloats(vertices),
        edges: flatIndices(edges),
        faces: flattenFaces(faces),
        of: flatIndicesPerKind(of),
        ...(tints && { tints: flatIndices(tints) }),
        ...(seen && { seen: flatIndicesPerKind(seen) }),
        ...(balls && { balls: { scale: flatFloats(balls.scale), opacity: flatFloats(balls.opacity) } }),
        ...(fill && {
            fill: {
                points: flatFloats(fill.points),
                triangles: flatIndices(fill.triangles),
                tints: flatIndices(fill.tints),
                ...(fill.seen && { seen: flatIndices(fill.seen) }),
            },
        }),
    };
}

function sliceFromJson({ surface, fog, ...slice }: JsonSlice): Slice {
    return {
        ...elementsFromJson(slice),
        ...(surface && { surface: surfaceFromJson(surface) }),
        ...(fog && { fog: { ...fog, walls: flatFloats(fog.walls), values: Uint8Array.from(fog.values.flat()) } }),
    };
}

function surfaceFromJson({ colors, cap_colors, ...surface }: NonNullable<JsonSlice["surface"]>): Surface {
    return {
        ...surface,
        points: flatFloats(surface.points),
        normals: flatFloats(surface.normals),
        triangles: flatIndices(surface.triangles),
        level: Uint8Array.from(surface.level),
        cap: Uint8Array.from(surface.cap),
        ...(colors && { colors: flatIndices(colors) }),
        ...(cap_colors && { cap_colors: flatIndices(cap_colors) }),
    };
}

function flatIndicesPerKind(lists: JsonSlice["of"]): Slice["of"] {
    return { vertices: flatIndices(lists.vertices), edges: flatIndices(lists.edges), faces: flatIndices(lists.faces) };
}

function allocateIntegers(count: number): Uint32Array {
    return arena?.allocate(count, Uint32Array) ?? new Uint32Array(count);
}

function flatFloats(values: FlatOrNested<Float32Array>): Float32Array {
    return values instanceof Float32Array ? values : Float32Array.from((values as number[]).flat());
}

function flatIndices(values: FlatOrNested<Integers>): Uint32Array {
    if (values instanceof Uint32Array) return values;
    if (!ArrayBuffer.isView(values)) return Uint32Array.from((values as number[]).flat());
    const wide = allocateIntegers(values.length);
    wide.set(values);
    return wide;
}

function flattenFaces(faces: number[][]): Slice["faces"] {
    const begin = new Uint32Array(faces.length + 1);
    faces.forEach((face, i) => (begin[i + 1] = begin[i]! + face.length));
    return { begin, corners: Uint32Array.from(faces.flat()) };
}
