// The page's side of decode_worker.ts.

interface Asked {
    resolve(bitmap: ImageBitmap): void;
    reject(error: Error): void;
}

export class Decoder {
    private readonly worker = new Worker(new URL("decode_worker.js", import.meta.url), { type: "module" });
    private readonly asked: Asked[] = []; // answered in order

    constructor() {
        this.worker.onmessage = ({ data }: MessageEvent<ImageBitmap | string>) => {
            const { resolve, reject } = this.asked.shift()!;
            if (typeof data === "string") reject(new Error(`The server's picture cannot be shown: ${data}`));
            else resolve(data);
        };
        this.worker.onerror = (event) => {
            for (const { reject } of this.asked.splice(0)) reject(new Error(`Pictures cannot be decoded: ${event.message}`));
        };
    }

    /** The file is handed over: it is no longer there afterwards. */
    decode(png: Uint8Array<ArrayBuffer>): Promise<ImageBitmap> {
        return new Promise((resolve, reject) => {
            this.asked.push({ resolve, reject });
            this.worker.postMessage(png.buffer, [png.buffer]);
        });
    }
}
