// Reads files from the user's disk and prepares them for `load` messages.

/** The members of a `load` message. */
export interface PolytopeFile {
    name: string;
    format: "off" | "points" | "cloud";
    data: string;
}

/** The reason why a file is refused before it is sent. */
export class FileError extends Error {}

const kMaxNameLength = 64; // characters, as in `load`

/** Reads the text of a polytope from a file; throws FileError if it cannot be sent in a message of `limit` bytes. */
export async function readFile(file: File, limit: number): Promise<PolytopeFile> {
    if (file.size === 0) throw new FileError("The file is empty.");
    if (file.size > limit) throw new FileError(tooLarge(file.size, limit));
    const data = await file.text();
    if (data.includes("\0")) {
        throw new FileError("This is not a text file. oval4d reads 4OFF files, lists of points and point clouds.");
    }
    const message = { name: printable(file.name), format: formatOf(file.name, data), data };
    const bytes = new TextEncoder().encode(JSON.stringify(message)).length + 64; // allows for the other members
    if (bytes > limit) throw new FileError(tooLarge(bytes, limit));
    return message;
}

/** The format, from the keyword at the start (after any comments), or else from the file name extension. */
function formatOf(name: string, data: string): PolytopeFile["format"] {
    const [, first = ""] = /^(?:\s|#[^\n]*(?:\n|$))*([^\s#]*)/.exec(data) ?? [];
    if (/^cloud$/i.test(first)) return "cloud";
    return /OFF$/i.test(first) || /\.4?off$/i.test(name) ? "off" : "points";
}

function printable(name: string): string {
    const text = [...name.replace(/\p{C}/gu, "")].slice(-kMaxNameLength).join("").trim();
    return text === "" ? "file" : text;
}

function tooLarge(bytes: number, limit: number): string {
    const size = (count: number): string =>
        count < 2 ** 20 ? `${Math.ceil(count / 2 ** 10)} KiB` : `${(count / 2 ** 20).toFixed(1)} MiB`;
    return `The file is too large: ${size(bytes)} when sent; this server accepts up to ${size(limit)}.`;
}

/** Line `number` of the text, counted from 1, and up to `around` lines on either side. */
export function linesAround(text: string, number: number, around = 1): { number: number; text: string }[] {
    const first = Math.max(1, number - around);
    const lines = text.split("\n", number + around).slice(first - 1);
    return lines.map((line, i) => ({ number: first + i, text: line.trimEnd() }));
}
