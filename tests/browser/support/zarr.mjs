// An object store with a multiscale image in Zarr's format, version 2.
import { createServer } from "node:http";

import { atEnd } from "./suite.mjs";

const kSizes = [8, 4]; // the number of samples along each axis, of the levels 0 and 1

/**
 * Starts an HTTP server on this machine with the image `image`: w as a function of x, y, z and w, in two levels. It
 * answers requests for the samples of level 0 only after releaseFineLevel().
 */
export async function startImageStore() {
    const objects = new Map([
        ["/image/.zgroup", { zarr_format: 2 }],
        ["/image/.zattrs", { multiscales: [{ version: "0.4", axes: axes(), datasets: kSizes.map((_, level) => dataset(level)) }] }],
    ]);
    kSizes.forEach((size, level) => {
        const shape = Array(4).fill(size);
        const kind = { zarr_format: 2, dtype: "<f4", order: "C", compressor: null, filters: null, fill_value: 0 };
        objects.set(`/image/${level}/.zarray`, { ...kind, shape, chunks: shape });
        objects.set(`/image/${level}/0.0.0.0`, samples(size));
    });
    let release;
    const released = new Promise((resolve) => (release = resolve));
    const server = createServer(async ({ url, headers }, response) => {
        const object = objects.get(url);
        if (url.startsWith("/image/0/0")) await released;
        if (object === undefined) return response.writeHead(404).end();
        const whole = Buffer.isBuffer(object) ? object : Buffer.from(JSON.stringify(object));
        const [, first, last] = /^bytes=(\d+)-(\d*)$/.exec(headers.range ?? "") ?? [];
        if (first === undefined) return response.writeHead(200, { "Content-Length": whole.length }).end(whole);
        const end = Math.min(whole.length, last === "" ? Infinity : Number(last) + 1);
        const part = whole.subarray(Number(first), end);
        const range = `bytes ${first}-${end - 1}/${whole.length}`;
        response.writeHead(206, { "Content-Length": part.length, "Content-Range": range }).end(part);
    });
    await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
    const stop = () => {
        server.close();
        server.closeAllConnections();
    };
    atEnd(stop);
    return { url: `http://127.0.0.1:${server.address().port}`, releaseFineLevel: release, stop };
}

function axes() {
    return [..."tzyx"].map((name) => ({ name }));
}

function dataset(level) {
    const scale = { type: "scale", scale: Array(4).fill(2 ** level) };
    const translation = { type: "translation", translation: Array(4).fill((2 ** level - 1) / 2) };
    return { path: String(level), coordinateTransformations: [scale, translation] };
}

/** The samples of one level: the index along the slowest axis, t. */
function samples(size) {
    return Buffer.from(Float32Array.from({ length: size ** 4 }, (_, i) => Math.floor(i / size ** 3)).buffer);
}
