// Loading files from the user's disk. The user chooses them or drops them on the page.
import assert from "node:assert/strict";
import { mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "./support/suite.mjs";

import { common, named, openWithScript, presented, restart, scriptFor } from "./support/browser.mjs";
import { startReplaceableServer } from "./support/proxy.mjs";
import { startServer } from "./support/server.mjs";
import { startImageStore } from "./support/zarr.mjs";

const file = (name, text) => ({ name, mimeType: "", buffer: Buffer.from(text) });
const kVertices = "1 1 1 -0.447214\n1 -1 -1 -0.447214\n-1 1 -1 -0.447214\n-1 -1 1 -0.447214\n0 0 0 1.788854\n";
const kFaces = "3 0 1 2\n3 0 1 3\n3 0 1 4\n3 0 2 3\n3 0 2 4\n3 0 3 4\n3 1 2 3\n3 1 2 4\n3 1 3 4\n3 2 3 4\n";
const simplex = `# a simplex\n4OFF\n5 10 10 5\n${kVertices}${kFaces}4 0 1 3 6\n4 0 2 4 7\n4 1 2 5 8\n4 3 4 5 9\n4 6 7 8 9\n`;

const report = (page) => page.locator("#loading .report").innerText();

/** Drops files on the drawing. Returns whether the page has shown the drop target. */
async function drop(page, ...files) {
    const transfer = await page.evaluateHandle(
        (all) => {
            const data = new DataTransfer();
            for (const { name, text } of all) data.items.add(new File([text], name));
            return data;
        },
        files.map(({ name, buffer }) => ({ name, text: buffer.toString() })),
    );
    await page.dispatchEvent("#drawing", "dragover", { dataTransfer: transfer });
    const invited = await page.locator("#drop").isVisible();
    await page.dispatchEvent("#drawing", "drop", { dataTransfer: transfer });
    return invited;
}

test("loading: a dropped file is shown under its name", async () => {
    const { page, script, press, errors, close } = await openWithScript();
    assert.ok(await drop(page, file("my simplex.off", simplex)), "the drop target is shown during the drag");
    assert.equal(await page.locator("#drop").isVisible(), false);
    const { polytope } = await script.until((one) => one.polytope.name === "my simplex.off", "the file's polytope");
    assert.deepEqual([polytope.vertices, polytope.edges, polytope.faces, polytope.cells], [5, 10, 10, 5]);
    await named(page, "my simplex.off");
    await page.waitForSelector("#loading", { state: "hidden" });
    await press("4");
    assert.deepEqual(errors, []);
    await close();
});

test("loading: a file that begins with CLOUD is shown as points", async () => {
    const { page, script, errors, close } = await openWithScript();
    await drop(page, file("points.txt", `# measured\nCLOUD\n${kVertices}`));
    const { polytope } = await script.until((one) => one.polytope.name === "points.txt", "the cloud");
    assert.deepEqual([polytope.vertices, polytope.edges, polytope.faces, polytope.cells], [5, 0, 0, 0]);
    await named(page, "points.txt");
    assert.deepEqual(errors, []);
    await close();
});

// The server recognizes the same texts as 4OFF files; see tests/wild/glued.txt.
test("loading: a 4OFF file needs no extension, whatever follows its keyword or ends its lines", async () => {
    const { page, script, errors, close } = await openWithScript();
    const texts = { "glued.txt": simplex.replace("4OFF\n5", "4OFF5"), "returns.txt": simplex.replaceAll("\n", "\r") };
    for (const [name, text] of Object.entries(texts)) {
        await page.setInputFiles("#file", [file(name, text)]);
        const { polytope } = await script.until((one) => one.polytope.name === name, name);
        assert.deepEqual([polytope.vertices, polytope.edges, polytope.faces, polytope.cells], [5, 10, 10, 5], name);
        await page.waitForSelector("#loading", { state: "hidden" });
    }
    assert.deepEqual(errors, []);
    await close();
});

test("loading: an object far from the origin turns about its center, or about the origin", async () => {
    const { page, script, errors, close } = await openWithScript();
    const far = Array.from({ length: 8 }, (_, i) => [0, 0, 0, 5e6].map((c, k) => c + (k === i >> 1 ? 1 - 2 * (i & 1) : 0)));
    await drop(page, file("far.txt", far.map((point) => point.join(" ")).join("\n")));
    const { polytope } = await script.until((one) => one.polytope.name === "far.txt", "the file's polytope");
    assert.deepEqual(polytope.center, [0, 0, 0, 5e6]);
    await page.waitForFunction(() => document.querySelector("[data-state-field=w]").textContent === "5000000.00");
    assert.match(await report(page), /far from the origin/);
    await page.locator("#loading .report button").press("Enter");
    await script.until((one) => one.polytope.center === undefined, "the same about the origin");
    await page.waitForSelector("#loading", { state: "hidden" });
    assert.equal(await page.evaluate(() => document.activeElement.id), "drawing", "the focus is not lost with the button");
    assert.deepEqual(errors, []);
    await close();
});

test("loading: text in UTF-16 is read as in UTF-8", async () => {
    const { page, script, errors, close } = await openWithScript();
    const little = Buffer.from(simplex, "utf16le");
    const encoded = {
        "little.off": Buffer.concat([Buffer.from([0xff, 0xfe]), little]),
        "big.off": Buffer.concat([Buffer.from([0xfe, 0xff]), Buffer.from(little).swap16()]),
        "without a mark.off": little,
    };
    for (const [name, buffer] of Object.entries(encoded)) {
        await page.setInputFiles("#file", [{ name, mimeType: "", buffer }]);
        const { polytope } = await script.until((one) => one.polytope.name === name, name);
        assert.equal(polytope.cells, 5, name);
        await page.waitForSelector("#loading", { state: "hidden" });
    }
    assert.deepEqual(errors, []);
    await close();
});

test("loading: a key and a button open the file chooser", async () => {
    const { page, script, close } = await openWithScript();
    page.on("filechooser", () => {}); // from here on, the browser reports file choosers to the test
    await page.evaluate(() => {});
    const openers = [() => page.keyboard.press("i"), () => page.click("[data-action=open]")];
    for (const [i, open] of openers.entries()) {
        const choosing = page.waitForEvent("filechooser");
        await open();
        await (await choosing).setFiles([file(`chosen-${i}.off`, simplex)]);
        await script.until((one) => one.polytope.name === `chosen-${i}.off`, "the chosen file");
    }
    await close();
});

test("loading: the error of a faulty file names the line, and the line is shown", async () => {
    const { page, script, errors, close } = await openWithScript();
    const { revision } = await script.state();
    await drop(page, file("faulty.off", simplex.replace("3 0 2 4", "3 0 2 17")));
    await page.waitForSelector("#loading[data-outcome=failed]");
    assert.match(await report(page), /line 13.*17/is);
    assert.equal(await page.locator("#loading .faulty").innerText(), "13\n3 0 2 17");
    assert.equal((await script.state()).revision, revision);
    await page.focus("#loading [data-close]");
    await page.keyboard.press("Enter");
    assert.equal(await page.locator("#loading").isVisible(), false);
    assert.equal(await page.evaluate(() => document.activeElement.id), "drawing", "the focus is returned");
    await drop(page, file("faulty.off", simplex.replace("5 10 10 5", "5 ten 10 5")));
    await page.waitForFunction(() => /line 3/i.test(document.querySelector("#loading .report").textContent));
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("#loading").isVisible(), false);
    assert.deepEqual(errors, []);
    await close();
});

/** A NumPy file with 8 × 8 × 8 × 8 samples of 1 − x² − y² − z² − w². Coordinates are from −1 to 1. */
function ballFile(name) {
    const header = "{'descr': '<f4', 'fortran_order': False, 'shape': (8, 8, 8, 8), }".padEnd(117) + "\n";
    const axis = Array.from({ length: 8 }, (_, i) => (2 * i) / 7 - 1);
    const samples = axis.flatMap((w) =>
        axis.flatMap((z) => axis.flatMap((y) => axis.map((x) => 1 - x * x - y * y - z * z - w * w))),
    );
    const start = Buffer.from([0x93, ...Buffer.from("NUMPY"), 1, 0, header.length, 0]);
    const buffer = Buffer.concat([start, Buffer.from(header), Buffer.from(new Float32Array(samples).buffer)]);
    return { name, mimeType: "", buffer };
}

test("loading: an array is uploaded, and shown as a field", async () => {
    const { page, script, errors, close } = await openWithScript();
    await page.setInputFiles("#file", ballFile("ball.npy"));
    const { field, revision } = await script.until((one) => one.polytope.name === "ball.npy", "the array");
    assert.deepEqual(field.shape, [8, 8, 8, 8]);
    await presented(page, revision);
    await named(page, "ball.npy");
    await page.waitForSelector("#loading", { state: "hidden" });
    const cut = ballFile("cut.npy");
    await page.setInputFiles("#file", { ...cut, buffer: cut.buffer.subarray(0, 9000) });
    await page.waitForSelector("#loading[data-outcome=failed]");
    assert.match(await report(page), /bytes|short|incomplete|ends/i);
    assert.equal((await script.state()).polytope.name, "ball.npy");
    await close();
    assert.deepEqual(errors.filter((error) => !/status of 400/.test(error)), []);
});

test("loading: an upload that a proxy refuses is reported in a sentence, not as its page", async () => {
    const { page, close } = await openWithScript();
    const said = async (answer) => {
        await page.route("**/fields/**", (route) => route.fulfill(answer));
        await page.setInputFiles("#file", ballFile("ball.npy"));
        await page.waitForSelector("#loading[data-outcome=failed]");
        const text = await report(page);
        await page.unroute("**/fields/**");
        await page.click("#loading [data-close]");
        return text;
    };
    const html = { contentType: "text/html", body: "<html><h1>nginx</h1></html>" };
    assert.match(await said({ status: 413, ...html }), /^The file was not loaded: [^<]* 413\. .* up to [\d.]+ MiB\.$/);
    assert.match(await said({ status: 502, ...html }), /^The file was not loaded: [^<]* 502\. A proxy [^<]*\.$/);
    const plain = { status: 429, contentType: "text/plain", body: "too many wrong tokens; try again in a minute\n" };
    assert.match(await said(plain), / 429, too many wrong tokens; try again in a minute\.$/);
    assert.match(await said({ status: 403, contentType: "application/json", body: '{"error":"x"}' }), / 403\. A proxy /);
    await close();
});

test("loading: a picture and a state are shown again, and files without a state are refused", async () => {
    const { page, script, errors, close } = await openWithScript();
    const { url } = await common();
    const query = "formula=x^2%2By^2-z^2<w&box=-1,1,-1,1,-1,1,0,2&levels=0.1,0.3&rotate=xw:0.4&slices=5&width=320&height=200";
    const answer = await fetch(new URL(`api/v1/frame.png?${query}`, url));
    const picture = { name: "a picture.png", mimeType: "image/png", buffer: Buffer.from(await answer.arrayBuffer()) };
    await page.setInputFiles("#file", picture);
    const state = await script.until((one) => one.field?.formula !== undefined, "the picture's field");
    assert.equal(state.slices.count, 5);
    assert.deepEqual(state.levels, [0.1, 0.3]);
    await presented(page, state.revision);
    await page.waitForSelector("#loading", { state: "hidden" });

    await script.request({ type: "set", polytope: "24-cell" });
    assert.ok(await drop(page, file("state.json", JSON.stringify(state))));
    const again = await script.until((one) => one.field?.formula !== undefined && one.revision > state.revision, "the state");
    assert.deepEqual({ ...again, revision: 0 }, { ...state, revision: 0 });
    await page.waitForSelector("#loading", { state: "hidden" });

    for (const [name, buffer, expected] of [
        ["cut.png", picture.buffer.subarray(0, 33), /contains no state/],
        ["other.json", Buffer.from('{"a": 1}'), /not a state of oval4d/],
        ["cut.json", Buffer.from('{"type"'), /not valid JSON/],
        ["marked.json", Buffer.from('\ufeff{"a": 1}'), /not a state of oval4d/],
        ["wrong.json", Buffer.from('{"type":"state","zoom":1}'), /zoom/],
        ["utf-16.json", Buffer.from('\ufeff{"a": 1}', "utf16le"), /not a state of oval4d/],
    ]) {
        await page.setInputFiles("#file", { name, mimeType: "", buffer });
        await page.waitForFunction(
            (source) => new RegExp(source).test(document.querySelector("#loading .report").textContent),
            expected.source,
        );
    }
    assert.deepEqual({ ...(await script.state()), id: 0 }, { ...again, id: 0 }, "nothing has changed");
    assert.deepEqual(errors, []);
    await close();
});

/** Runs in the page. Counts the connections that the page opens. */
function countSockets() {
    window.sockets = 0;
    window.WebSocket = class extends WebSocket {
        constructor(...given) {
            super(...given);
            ++window.sockets;
        }
    };
}

test("loading: unreadable files are refused before they are sent", async () => {
    const server = await startServer({ options: ["--max-message", "4096"] });
    const { page, script, close } = await openWithScript({ url: server.url, before: countSockets });
    const cases = [
        [`# ${"x".repeat(5000)}`, /too large: 5 KiB .* up to 4 KiB/],
        ["\n".repeat(3000), /too large/], // twice as long in JSON
        ["", /empty/],
        ["PK\u0003\u0004\0\0", /none of the formats of fields: npy/],
    ];
    for (const [text, expected] of cases) {
        await page.setInputFiles("#file", file("a.off", text));
        await page.waitForFunction(
            (source) => new RegExp(source, "i").test(document.querySelector("#loading .report").textContent),
            expected.source,
        );
        await page.click("#loading [data-close]");
    }
    await page.waitForSelector("#connection[data-kind=open]"); // not "waiting" (lost) or "late" (slow)
    assert.equal(await page.evaluate(() => window.sockets), 1, "the connection is still the first one");
    await page.setInputFiles("#file", file("b.off", simplex));
    await script.until((one) => one.polytope.name === "b.off", "a file within the limit");
    await close();
    await server.stop();
});

test("loading: the progress is shown and announced", async () => {
    const { page, script, close } = await openWithScript();
    await page.evaluate(() => {
        window.seen = [];
        const root = document.getElementById("loading");
        const look = () => {
            if (root.hidden) return;
            const progress = root.querySelector("progress");
            window.seen.push([root.ariaBusy, progress.checkVisibility(), root.querySelector(".report").innerText]);
        };
        new MutationObserver(look).observe(root, { attributes: true, childList: true, subtree: true });
    });
    await page.setInputFiles("#file", file("slow.off", simplex));
    await script.until((one) => one.polytope.name === "slow.off", "the file's polytope");
    await page.waitForSelector("#loading", { state: "hidden" });
    const seen = await page.evaluate(() => window.seen);
    assert.ok(
        seen.some(([busy, visible, said]) => busy === "true" && visible && said === "Reading the file"),
        String(seen),
    );
    assert.equal(await page.getAttribute("#loading", "aria-busy"), null);
    await close();
});

test("loading: after a restart of the server, the file is loaded again", async () => {
    const server = await startReplaceableServer();
    const { page, script, close } = await openWithScript({ url: server.url });
    await page.setInputFiles("#file", file("kept.off", simplex));
    await script.until((one) => one.polytope.name === "kept.off", "the file's polytope");
    await named(page, "kept.off");
    script.leave();
    await restart(server, page);
    const second = await scriptFor(page, server.url);
    await second.until((one) => one.polytope.name === "kept.off", "the file in the new session");
    second.leave();
    await close();
    await server.stop();
});

test("loading: after a restart of the server, a field of its data folder is opened again", async () => {
    const folder = await mkdtemp(join(tmpdir(), "oval4d-data-"));
    const path = `${"a long name of a ".repeat(4)}ball.npy`; // longer than the name of an object may be
    await writeFile(join(folder, path), ballFile(path).buffer);
    const server = await startReplaceableServer({ options: ["--data", folder] });
    const { page, script, close } = await openWithScript({ url: server.url });
    await page.click("#polytope");
    await page.click(`#picker-list [data-name="${path}"]`);
    const { name } = (await script.until(({ field }) => field?.shape, "the field")).polytope;
    assert.ok(path.endsWith(name), name);
    await named(page, name);
    await page.waitForSelector("#picker", { state: "hidden" });
    script.leave();
    await restart(server, page);
    const second = await scriptFor(page, server.url);
    const { field } = await second.until((one) => one.polytope.name === name, "the field in the new session");
    assert.deepEqual(field.shape, [8, 8, 8, 8]);
    second.leave();
    await close();
    await server.stop();
    await rm(folder, { recursive: true });
});

test("loading: while a coarse level of an image is shown, the page says that a finer one follows", async () => {
    const store = await startImageStore();
    const server = await startServer({ options: ["--data", store.url, "--data-timeout", "120", "--first-level-bytes", "4k"] });
    const { page, script, errors, close } = await openWithScript({ url: server.url });
    await script.request({ type: "load", name: "image", path: "image" });
    const refining = page.locator("#refining");
    await page.waitForFunction(() => document.getElementById("refining").textContent !== "");
    assert.equal(await refining.textContent(), "Refining… 4 × 4 × 4 × 4 samples are shown.");
    assert.equal(await refining.isVisible(), true);
    store.releaseFineLevel();
    await page.waitForFunction(() => document.getElementById("refining").textContent === "");
    assert.equal(await refining.isVisible(), false);
    const { field } = await script.until((one) => !one.field?.resolution?.refining, "the fine level");
    assert.deepEqual(field.shape, [8, 8, 8, 8]);
    assert.deepEqual(errors, []);
    await close();
    await server.stop();
    store.stop();
});

test("loading: if a polytope cannot be loaded again, the rest of the view is restored", async () => {
    const server = await startReplaceableServer();
    const { page, script, close } = await openWithScript({ url: server.url });
    const corners = Array.from({ length: 16 }, (_, i) => [1, 2, 4, 8].map((bit) => (i & bit ? 1 : -1)).join(" "));
    const object = { name: "another's", format: "points", data: corners.join("\n") };
    await script.request({ type: "load", ...object }); // another client loads it, not this page
    const highlight = { element: "vertex", number: 15 }; // the object of a new session has no such vertex
    const { revision: turned } = await script.request({ type: "set", alpha: 0.25, highlight });
    await presented(page, turned);
    script.leave();
    await server.stop();
    await page.waitForSelector("#connection[data-kind=waiting]");
    await server.startAnother();
    await page.waitForSelector("#connection[data-kind=open]");
    await page.waitForFunction(() => /another's/.test(document.getElementById("notice").textContent));
    const second = await scriptFor(page, server.url);
    const { revision } = await second.until((one) => one.alpha === 0.25, "the rest of the view");
    await presented(page, revision);
    second.leave();
    await close();
    await server.stop();
});

test("loading: several files are loaded one after the other, and the picker lists all of them", async () => {
    const { page, script, close } = await openWithScript();
    await drop(page, file("one.off", simplex), file("two.off", simplex));
    await script.until((one) => one.polytope.name === "two.off", "the second file");
    await page.keyboard.press("s");
    const found = page.locator('#picker-list [role=group]:has-text("loaded") [data-name]');
    await page.waitForFunction(() => document.querySelector('#picker-list [data-name="two.off"]'));
    assert.deepEqual(await found.evaluateAll((all) => all.map((one) => one.dataset.name)), ["one.off", "two.off"]);
    await page.keyboard.type("one");
    await page.keyboard.press("Enter");
    await script.until((one) => one.polytope.name === "one.off", "the first file again");
    await close();
});
