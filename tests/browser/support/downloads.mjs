// Files that the page downloads.

/** The bytes of a download. */
export async function bytesOf(download) {
    const chunks = [];
    for await (const chunk of await download.createReadStream()) chunks.push(chunk);
    return Buffer.concat(chunks);
}

// Chromium drops the downloads of a page beyond the tenth within one second.
const kDownloadsOfPage = 8;

/** Parts of a list whose items each download a file: each part needs a page of its own. */
export function pagesOf(items) {
    const count = Math.ceil(items.length / kDownloadsOfPage);
    return Array.from({ length: count }, (_, i) => items.slice(i * kDownloadsOfPage, (i + 1) * kDownloadsOfPage));
}
