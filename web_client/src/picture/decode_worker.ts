// Decodes PNG files off the page's thread, one after the other: each message is a file, each answer its bitmap, or words
// on why there is none.

let last = Promise.resolve();

onmessage = ({ data }: MessageEvent<ArrayBuffer>): void => {
    last = last.then(() => decode(data));
};

async function decode(png: ArrayBuffer): Promise<void> {
    try {
        const bitmap = await createImageBitmap(new Blob([png], { type: "image/png" }));
        postMessage(bitmap, { transfer: [bitmap] });
    } catch (error) {
        postMessage((error as Error).message);
    }
}
