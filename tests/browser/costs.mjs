// The cost of showing a stream and of loading the page, as numbers of operations and bytes.
import assert from "node:assert/strict";

import { common, openPage, openWithScript, presented } from "./support/browser.mjs";
import { faceIn, labeled, openTurned } from "./support/pointing.mjs";
import { test } from "./support/suite.mjs";

/** Counts in the page's `counts`: arrays with their own memory, graphics buffers, draw calls, decoded images. */
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
        plain.prototype.constructor = window[name] = counting; // copies use the constructor, too
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
    const viewport = { width: 640, height: 400 }; // small enough to be drawn quickly without a graphics card
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
    await there(); // everything grows to its final size
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

test("costs: the page is compressed, and loads nothing from other sites", async () => {
    const { url } = await common();
    const answers = new Map();
    const { page, errors, close } = await openPage({
        seen: (response) => answers.set(new URL(response.url()).pathname, response),
    });
    let size = 0;
    for (const path of ["/", "/app.js", "/style.css"]) {
        const response = answers.get(path);
        assert.match(response.headers()["content-encoding"], /^(br|gzip)$/, path);
        size += (await response.request().sizes()).responseBodySize;
    }
    assert.ok(size > 10_000 && size < 250 * 1024, `${size} bytes`);
    for (const path of answers.keys()) assert.ok(new URL(path, url).href.startsWith(url));
    assert.deepEqual(errors, []);
    // Inline scripts are not executed.
    const ran = await page.evaluate(() => {
        const script = document.createElement("script");
        script.textContent = "window.ran = true";
        document.body.append(script);
        return window.ran;
    });
    assert.equal(ran, undefined);
    assert.match(errors.join(), /Content Security Policy/);
    await close();
}, { needs: "sizes of responses" });
