// Decodes PNG files in a web worker (decode_worker.ts).

interface PendingDecode {
    resolve(bitmap: ImageBitmap): void;
    reject(error: Error): void;
}

export class ImageDecoder {
    private readonly worker = new Worker(new URL("decode_worker.js", import.meta.url), { type: "module" });
    private readonly pending: PendingDecode[] = []; // the worker answers in the order of the requests

    constructor() {
        this.worker.onmessage = ({ data }: MessageEvent<ImageBitmap | string>) => {
            const { resolve, reject } = this.pending.shift()!;
            if (typeof data === "string") reject(new Error(`The picture from the server cannot be decoded: ${data}`));
            else resolve(data);
        };
        this.worker.onerror = (event) => {
            const error = new Error(`The pictures from the server cannot be decoded: ${event.message}`);
            for (const { reject } of this.pending.splice(0)) reject(error);
        };
    }

    /** Decodes a PNG file. The buffer of `png` moves to the worker, so the caller can no longer use it. */
    decode(png: Uint8Array<ArrayBuffer>): Promise<ImageBitmap> {
        return new Promise((resolve, reject) => {
            this.pending.push({ resolve, reject });
            this.worker.postMessage(png.buffer, [png.buffer]);
        });
    }
}
