// Files from the user's disk, made ready for `load`.

export interface Readable {
    name: string;
    format: "off" | "points";
    data: string;
}

/** Why a file is not even sent. */
export class FileError extends Error {}

const kLongestName = 64; // characters, as `load` allows

/** Reads a file as the text of a polytope; one that cannot fit into a message of `limit` bytes is refused unread. */
export async function readFile(file: File, limit: number): Promise<Readable> {
    if (file.size === 0) throw new FileError("The file is empty.");
    if (file.size > limit) throw new FileError(tooLarge(file.size, limit));
    const data = await file.text();
    if (data.includes("\0")) throw new FileError("This is not a text file. Read are 4OFF files and lists of points.");
    const readable = { name: printable(file.name), format: formatOf(file.name, data), data };
    const bytes = new TextEncoder().encode(JSON.stringify(readable)).length + 64; // and what goes around it
    if (bytes > limit) throw new FileError(tooLarge(bytes, limit));
    return readable;
}

/** The keyword decides, wherever comments leave it; then the extension. */
function formatOf(name: string, data: string): Readable["format"] {
    const [, first = ""] = /^(?:\s|#[^\n]*(?:\n|$))*([^\s#]*)/.exec(data) ?? [];
    return /OFF$/i.test(first) || /\.4?off$/i.test(name) ? "off" : "points";
}

function printable(name: string): string {
    const text = [...name.replace(/\p{C}/gu, "")].slice(-kLongestName).join("").trim();
    return text === "" ? "file" : text;
}

function tooLarge(bytes: number, limit: number): string {
    const size = (count: number): string =>
        count < 2 ** 20 ? `${Math.ceil(count / 2 ** 10)} KiB` : `${(count / 2 ** 20).toFixed(1)} MiB`;
    return `The file is too large: ${size(bytes)} to be sent, where this server takes ${size(limit)}.`;
}

/** Line `number` of the text, from 1, and those around it. */
export function linesAround(text: string, number: number, around = 1): { number: number; text: string }[] {
    const first = Math.max(1, number - around);
    const lines = text.split("\n", number + around).slice(first - 1);
    return lines.map((line, i) => ({ number: first + i, text: line.trimEnd() }));
}
