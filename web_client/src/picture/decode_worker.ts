// A web worker that decodes PNG files one after the other. It receives each file as a message, and answers with the
// bitmap or with an error message.

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
