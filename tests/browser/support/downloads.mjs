// Files that the page downloads.

/** The bytes of a download. */
export async function bytesOf(download) {
    const chunks = [];
    for await (const chunk of await download.createReadStream()) chunks.push(chunk);
    return Buffer.concat(chunks);
}
