// Reads files from the user's disk and prepares them for `load` messages.

import { pngText, type State } from "@oval4d/protocol";

/** The members of a `load` message that loads a polytope or points from a file. */
export interface FileLoadMessage {
    name: string;
    format: "off" | "points" | "cloud";
    data: string;
    center?: "origin";
}

/** The error with which the page refuses a file before sending it. The message states the reason. */
export class FileError extends Error {}

const kMaxNameLength = 64; // the most characters of a name, as in the message `load`

/**
 * Reads the text of a polytope or a list of points from a file. Throws FileError if the file is empty, or too large to
 * be sent in a message of `limit` bytes.
 */
export async function readFile(file: File, limit: number): Promise<FileLoadMessage> {
    if (file.size === 0) throw new FileError("The file is empty.");
    if (file.size > limit) throw new FileError(fileTooLargeText(file.size, limit));
    const data = await readText(file);
    const message = { name: nameOf(file), format: formatOf(file.name, data), data };
    // The 64 bytes are for the members that are not in `message`.
    const bytes = new TextEncoder().encode(JSON.stringify(message)).length + 64;
    if (bytes > limit) throw new FileError(fileTooLargeText(bytes, limit));
    return message;
}

/**
 * The encoding of a text in UTF-16; undefined for other files. UTF-16 is recognized by the first two bytes: they are a
 * byte order mark, or exactly one of them is 0. The server uses the same rule.
 */
export function detectUtf16([first, second]: Uint8Array): "utf-16le" | "utf-16be" | undefined {
    if (first === undefined || second === undefined) return undefined;
    if ((first === 0xff && second === 0xfe) || (first !== 0 && second === 0)) return "utf-16le";
    return (first === 0xfe && second === 0xff) || (first === 0 && second !== 0) ? "utf-16be" : undefined;
}

/** Decodes a text file in UTF-8 or UTF-16 (some programs on Windows write UTF-16). Omits the byte order mark. */
async function readText(file: Blob): Promise<string> {
    const bytes = new Uint8Array(await file.arrayBuffer());
    return new TextDecoder(detectUtf16(bytes) ?? "utf-8").decode(bytes);
}

/**
 * Reads the state from a picture that oval4d has made, or from a JSON file. Resolves to undefined for a file that
 * begins neither like a PNG file nor with "{". Throws FileError if the file contains no state, or if a JSON file has
 * more than `limit` bytes.
 */
export async function readState(file: File, limit: number): Promise<State | undefined> {
    const start = file.slice(0, 64);
    const isPicture = /^\x89PNG/.test(String.fromCharCode(...new Uint8Array(await start.arrayBuffer())));
    if (!isPicture && !/^\s*\{/.test(await readText(start))) return undefined;
    if (!isPicture && file.size > limit) throw new FileError(fileTooLargeText(file.size, limit));
    const text = isPicture ? pngText(new Uint8Array(await file.arrayBuffer())) : await readText(file);
    if (text === undefined) throw new FileError("The picture contains no state: oval4d has not made it.");
    try {
        const state = JSON.parse(text) as Partial<State> | null;
        if (state?.type === "state") return state as State;
    } catch {
        throw new FileError("The file starts like a JSON object, but is not valid JSON.");
    }
    throw new FileError('The JSON object is not a state of oval4d, whose "type" is "state".');
}

/**
 * The format of a text file. A keyword at the start of the text, after any comments, names the format; without a
 * keyword, the file name extension does. The server recognizes the same keywords (isOffFormat() in off4.hpp).
 */
function formatOf(name: string, data: string): FileLoadMessage["format"] {
    const [, first = ""] = /^(?:\s|#[^\r\n]*(?:[\r\n]|$))*([^\s#]*)/.exec(data) ?? [];
    if (/^cloud$/i.test(first)) return "cloud";
    return /^[stcn\d_-]*off[_-]*(?:\d|$)/i.test(first) || /\.4?off$/i.test(name) ? "off" : "points";
}

/** The name under which a file is loaded: at most the last kMaxNameLength characters of the file's name; never "". */
export function nameOf({ name }: { name: string }): string {
    const text = [...name.replace(/\p{C}/gu, "")].slice(-kMaxNameLength).join("").trim();
    return text === "" ? "file" : text;
}

/** The error message for a file that is larger than the limit. The size and the limit are in bytes. */
export function fileTooLargeText(bytes: number, limit: number): string {
    return `The file is too large: ${sizeText(bytes)} when sent; this server accepts up to ${sizeText(limit)}.`;
}

/** Formats a number of bytes as KiB or MiB, for display. */
export function sizeText(bytes: number): string {
    return bytes < 2 ** 20 ? `${Math.ceil(bytes / 2 ** 10)} KiB` : `${(bytes / 2 ** 20).toFixed(1)} MiB`;
}

/** Line `number` of the text, counted from 1, and up to `around` lines on either side. */
export function linesAround(text: string, number: number, around = 1): { number: number; text: string }[] {
    const first = Math.max(1, number - around);
    const lines = text.split("\n", number + around).slice(first - 1);
    return lines.map((line, i) => ({ number: first + i, text: line.trimEnd() }));
}
