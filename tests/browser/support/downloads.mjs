// Files that the page downloads.

/** The bytes of a downloaded file. */
export async function bytesOf(download) {
    const chunks = [];
    for await (const chunk of await download.createReadStream()) chunks.push(chunk);
    return Buffer.concat(chunks);
}

// Chromium drops a page's downloads beyond the tenth within one second.
const kDownloadsOfPage = 8;

/** Splits a list whose items each cause a download. Each part needs its own page. */
export function pagesOf(items) {
    const count = Math.ceil(items.length / kDownloadsOfPage);
    return Array.from({ length: count }, (_, i) => items.slice(i * kDownloadsOfPage, (i + 1) * kDownloadsOfPage));
}
