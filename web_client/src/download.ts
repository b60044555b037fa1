// Saves bytes as a file on the user's disk.

import { element } from "./element";

const kRevokeDelay = 60_000; // milliseconds after which the URL is freed; by then, the browser has read the data

export function download(bytes: Uint8Array, name: string, type: string): void {
    const url = URL.createObjectURL(new Blob([bytes as Uint8Array<ArrayBuffer>], { type }));
    element("a", { href: url, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(url), kRevokeDelay);
}

/** Joins the texts in `parts` to a file name that is valid on every file system. */
export function fileName(parts: string[], extension: string): string {
    const name = parts
        .join(" ")
        // Removes the extension, because a polytope from a file is named after the file.
        .replace(/\.(4?off|txt|csv|xyz)\b/gi, "")
        .replace(/[^\p{L}\p{N}.,+-]+/gu, "-")
        .replace(/^[-.]+|[-.]+$/g, "");
    return `${name === "" ? "oval4d" : name}.${extension}`;
}
