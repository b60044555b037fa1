// Bytes as a file on the user's disk.

import { element } from "./element";

const kTaken = 60_000; // milliseconds, after which the browser has taken it

export function download(bytes: Uint8Array, name: string, type: string): void {
    const url = URL.createObjectURL(new Blob([bytes as Uint8Array<ArrayBuffer>], { type }));
    element("a", { href: url, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(url), kTaken);
}

/** The parts as a name that every file system takes. */
export function fileName(parts: string[], extension: string): string {
    const name = parts
        .join(" ")
        .replace(/\.(4?off|txt|csv|xyz)\b/gi, "") // a loaded polytope has its file's name
        .replace(/[^\p{L}\p{N}.,+-]+/gu, "-")
        .replace(/^[-.]+|[-.]+$/g, "");
    return `${name === "" ? "oval4d" : name}.${extension}`;
}
