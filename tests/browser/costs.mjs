// The costs of showing a stream and of loading the page, counted as operations and bytes instead of time.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { get } from "node:http";

import { common, openPage, openWithScript, presented } from "./support/browser.mjs";
import { within } from "./support/hang_limit.mjs";
import { faceIn, labeled, openTurned } from "./support/pointing.mjs";
import { webRoot } from "./support/server.mjs";
import { test } from "./support/suite.mjs";

const kMaxSize = 250 * 1024; // the most bytes of all files of the page, compressed

/**
 * Runs in the page. Counts in `window.counts` arrays with their own memory, graphics buffers, draw calls and decoded
 * images.
 */
function countAllocations() {
    const counts = (window.counts = { arrays: 0, buffers: 0, drawings: 0, decodings: 0 });
    const kMinSize = 256; // bytes; smaller arrays are vectors and matrices
    const Memory = ArrayBuffer;
    for (const name of ["ArrayBuffer", "Float32Array", "Float64Array", "Uint32Array", "Uint8Array", "Int8Array"]) {
        const plain = window[name];
        const counting = new Proxy(plain, {
            construct(target, given, made) {
                const array = Reflect.construct(target, given, made === counting ? target : made);
                if (array.byteLength >= kMinSize && !(given[0] instanceof Memory)) ++counts.arrays;
                return array;
            },
        });
        plain.prototype.constructor = window[name] = counting; // copies of an array use the constructor, too
    }
    const watch = (owner, method, what) => {
        const plain = owner[method];
        owner[method] = function (...given) {
            ++counts[what];
            return plain.apply(this, given);
        };
    };
    watch(WebGL2RenderingContext.prototype, "createBuffer", "buffers");
    watch(WebGL2RenderingContext.prototype, "bufferData", "buffers");
    watch(WebGL2RenderingContext.prototype, "drawElements", "drawings");
    watch(window, "createImageBitmap", "decodings");
}

const countsOf = (page) => page.evaluate(() => ({ ...window.counts }));

test("costs: geometry is drawn from buffers that are updated in place", async () => {
    const viewport = { width: 640, height: 400 }; // small, so that it is drawn quickly without a graphics card
    const { page, script, errors, close } = await openWithScript({ before: countAllocations, viewport, isStopped: true });
    await script.request({ type: "set", polytope: "24-cell" });
    const turn = async (angle) => {
        const { revision } = await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [angle, 2 * angle] });
        await presented(page, revision);
    };
    await turn(0.3);
    assert.ok((await countsOf(page)).arrays > 10, "the counting works");
    const there = async () => {
        for (let i = 0; i < 30; ++i) await turn(0.02);
    };
    const back = async () => {
        for (let i = 0; i < 30; ++i) await turn(-0.02);
    };
    await there(); // all buffers grow to their final sizes
    const before = await countsOf(page);
    await back();
    await there();
    const after = await countsOf(page);
    assert.equal(after.buffers - before.buffers, 0, "buffers of the graphics card");
    assert.equal(after.arrays - before.arrays, 0, "arrays");
    assert.ok(after.drawings - before.drawings >= 60, "each picture was drawn");
    assert.deepEqual(errors, []);
    await close();
});

test("costs: lighting the element under the pointer changes no buffers but those of colors", async () => {
    const opened = await openTurned({}, {
        before: () => {
            const uploaded = (window.uploaded = []);
            for (const name of ["bufferData", "bufferSubData"]) {
                const upload = WebGL2RenderingContext.prototype[name];
                WebGL2RenderingContext.prototype[name] = function (...given) {
                    uploaded.push(given.find((one) => ArrayBuffer.isView(one))?.constructor.name ?? "nothing");
                    return upload.apply(this, given);
                };
            }
        },
    });
    const { page, size, picture, moveTo, errors, close } = opened;
    const { at } = faceIn(await picture(), size, 1);
    const uploaded = async () => [...new Set(await page.evaluate(() => window.uploaded.splice(0)))];
    assert.ok((await uploaded()).includes("Float32Array"), "the counting works");
    await moveTo(...at);
    await labeled(page, /^Cell/);
    assert.deepEqual(await uploaded(), ["Uint8Array"]);
    await moveTo(4, 4);
    await labeled(page, /^$/);
    assert.deepEqual(await uploaded(), ["Uint8Array"]);
    assert.deepEqual(errors, []);
    await close();
});

test("costs: frames are decoded off the page's thread, and acknowledged after they are drawn", async () => {
    const { page, script, errors, close } = await openWithScript({
        before: () => {
            const log = (window.log = []);
            const { send } = WebSocket.prototype;
            WebSocket.prototype.send = function (text) {
                const message = JSON.parse(text);
                if (message.type === "shown") log.push(`shown ${message.revision}`);
                return send.call(this, text);
            };
            const { transferFromImageBitmap } = ImageBitmapRenderingContext.prototype;
            ImageBitmapRenderingContext.prototype.transferFromImageBitmap = function (bitmap) {
                log.push("drawn");
                return transferFromImageBitmap.call(this, bitmap);
            };
            const decode = window.createImageBitmap;
            window.createImageBitmap = (...given) => {
                log.push("decoded here");
                return decode(...given);
            };
        },
    });
    await page.click("[data-page-tool=frames]");
    await page.waitForSelector("#drawing[data-drawn-by=frames]");
    await page.evaluate(() => void (window.log.length = 0));
    for (let i = 0; i < 5; ++i) {
        const { revision } = await script.request({ type: "rotate", planes: ["xy"], angles: [0.1] });
        await presented(page, revision);
    }
    const log = await page.evaluate(() => window.log);
    assert.equal(log.filter((entry) => entry === "drawn").length, 5);
    assert.ok(!log.includes("decoded here"));
    log.forEach((entry, i) => assert.equal(entry.startsWith("shown"), i % 2 === 1, log.join(", ")));
    assert.equal(page.workers().length, 1);
    assert.match(page.workers()[0].url(), /decode_worker\.js$/);
    assert.deepEqual(errors, []);
    await close();
});

/** The size in bytes of the answer's body for a client that accepts only gzip. */
function sizeWithGzip(url) {
    return new Promise((resolve, reject) => {
        const request = get(url, { headers: { "accept-encoding": "gzip" } }, (response) => {
            let size = 0;
            response.on("data", (chunk) => (size += chunk.length));
            response.on("error", reject);
            response.on("end", () => {
                const { statusCode, headers } = response;
                if (statusCode === 200 && headers["content-encoding"] === "gzip") resolve(size);
                else reject(new Error(`${url}: ${statusCode}, ${headers["content-encoding"]}`));
            });
        });
        request.on("error", reject);
    });
}

test("costs: the page is compressed, and loads nothing but its files, which together are small", async () => {
    const { url } = await common();
    const answers = new Map();
    const { page, errors, close } = await openPage({ seen: (response) => answers.set(response.url(), response) });
    // Counts all files, including the worker that decodes frames. The page loads this worker only for the server's
    // pictures.
    const files = readdirSync(webRoot).filter((name) => !/^\.|\.(br|gz)$/.test(name));
    for (const name of ["index.html", "app.js", "decode_worker.js", "style.css", "favicon.svg"]) {
        assert.ok(files.includes(name), name);
    }
    const sizes = await Promise.all(files.map((name) => sizeWithGzip(new URL(name, url))));
    const total = sizes.reduce((sum, size) => sum + size, 0);
    assert.ok(total <= kMaxSize, `${total} bytes: ${files.map((name, i) => `${name} ${sizes[i]}`).join(", ")}`);

    const own = new Set(["", ...files].map((name) => new URL(name, url).href));
    for (const name of ["", "app.js", "style.css"]) assert.ok(answers.has(new URL(name, url).href), name);
    for (const [address, response] of answers) {
        if (response.status() === 101) continue; // the WebSocket, which only Firefox reports
        assert.ok(own.has(address), `${address} is one of the files that are counted`);
        assert.match(response.headers()["content-encoding"], /^(br|gzip)$/, address);
    }
    const loaded = await page.evaluate(() => {
        const entries = ["navigation", "resource"].flatMap((type) => performance.getEntriesByType(type));
        return entries.reduce((sum, { encodedBodySize }) => sum + encodedBodySize, 0);
    });
    assert.ok(loaded > 10_000 && loaded <= total, `${loaded} bytes`);
    assert.deepEqual(errors, []);
    // The browser must not execute inline scripts.
    const violated = page.evaluate(async () => {
        const violation = new Promise((resolve) => {
            document.addEventListener("securitypolicyviolation", resolve, { once: true });
        });
        const script = document.createElement("script");
        script.textContent = "window.ran = true";
        document.body.append(script);
        return window.ran ? "nothing" : (await violation).violatedDirective;
    });
    assert.match(await within(violated, "the violation of the Content Security Policy"), /^script-src/);
    await close();
});
