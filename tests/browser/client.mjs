// The TypeScript client in protocol/ts, used by a script without a page.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { readFileSync } from "node:fs";
import { cp, mkdir, mkdtemp, rm, symlink, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";

import WebSocket, { WebSocketServer } from "ws";

import { Client, pngText, RequestError } from "./node_modules/.oval4d/client.mjs";
import { decodeBinary, kBinaryKinds } from "./node_modules/.oval4d/decode.mjs";
import { common, named, openPage, scriptFor } from "./support/browser.mjs";
import { kBinaryEncodings, kEncodings } from "./support/encodings.mjs";
import { decode } from "./support/pixels.mjs";
import { startProxy } from "./support/proxy.mjs";
import { joinSession } from "./support/script.mjs";
import { afterTest, atEnd, test } from "./support/suite.mjs";
import { within } from "./support/hang_limit.mjs";

/** Returns a client, and a function that returns a promise of the client's next event. */
async function listen(options) {
    const { url } = await common();
    const waiting = {};
    const told = (event) => (value) => waiting[event]?.(value);
    const client = new Client({
        url,
        webSocket: WebSocket,
        onStatus: ({ kind }) => told(kind)(),
        onSlices: told("slices"),
        onFrame: told("frame"),
        onState: told("state"),
        ...options,
    });
    atEnd(() => client.close());
    return { client, next: (event) => within(new Promise((resolve) => (waiting[event] = resolve)), event) };
}

test("client: slices are the same in all encodings", async () => {
    const pictures = {};
    for (const encoding of kEncodings) {
        const { client, next } = await listen({ stream: "geometry", encoding, viewport: { width: 640, height: 480 } });
        const slices = next("slices");
        client.connect();
        pictures[encoding] = await slices;
        client.close();
    }
    const { json } = pictures;
    assert.ok(json.slices.some(({ faces }) => faces.corners.length > 0));
    const compare = (a, b, path) => {
        if (typeof a === "number") assert.ok(Math.abs(a - b) <= 1e-6 * Math.max(1, Math.abs(a)), `${path}: ${a}, ${b}`);
        else if (typeof a !== "object") assert.equal(a, b, path);
        else for (const key of Object.keys(a)) compare(a[key], b[key], `${path}.${key}`);
        if (ArrayBuffer.isView(a)) assert.ok(b instanceof a.constructor && a.length === b.length, path);
    };
    for (const encoding of kBinaryEncodings) {
        compare(json, pictures[encoding], encoding);
        compare(pictures[encoding], json, encoding);
    }
});

test("client: it knows the binary messages that protocol/README.md lists, and refuses others", () => {
    const readme = readFileSync(new URL("../../protocol/README.md", import.meta.url), "utf8");
    const [, section] = /### Binary messages\n(.*?)\n### /s.exec(readme);
    const known = Object.entries(kBinaryKinds);
    for (const [name, { firstByte, secondByte }] of known) {
        const row = new RegExp(`^\\| 0x(..)(?:–0x(..))?(?: 0x(..))? \\|.*\\[${name}\\]`, "m").exec(section);
        const [least, greatest = least, second] = row.slice(1);
        assert.deepEqual(firstByte, [parseInt(least, 16), parseInt(greatest, 16)], name);
        assert.equal(secondByte, second && parseInt(second, 16), name);
    }
    assert.deepEqual(Object.keys(kBinaryKinds).sort(), ["file", "frame", ...kBinaryEncodings].sort());
    for (let first = 0; first < 256; ++first) {
        if (known.some(([, { firstByte }]) => firstByte[0] <= first && first <= firstByte[1])) continue;
        const says = `begins with the byte 0x${first.toString(16)}: this client knows no such message`;
        assert.throws(() => decodeBinary(Uint8Array.of(first, 0x61)), ({ message }) => message.endsWith(says));
    }
    assert.throws(() => decodeBinary(new Uint8Array(0)), /is empty/);
});

test("client: a message that begins with the two bytes of a kind is not of the kind with the first byte", () => {
    const read = () => ({ type: "other" });
    kBinaryKinds.other = { firstByte: [0x7e, 0x7e], secondByte: 0x55, read };
    try {
        for (const others of ["~U", "~U~"]) assert.deepEqual(decodeBinary(Buffer.from(others)), read(), others);
        for (const files of ["~", "~~U", "U~"]) assert.equal(decodeBinary(Buffer.from(files)), "file", files);
    } finally {
        delete kBinaryKinds.other;
    }
});

test("client: a file may be JSON, which does not begin as BJData does", () => {
    for (const text of ['{"type":"Scene"}', '{ "a":1}', "{\n}", "{}", "{"]) {
        assert.equal(decodeBinary(Buffer.from(text)), "file", text);
    }
});

test("client: lengths and markers that are wrong in BJData are refused", () => {
    const read = (value) => decodeBinary(Buffer.from(`{U\x01a${value}}`, "latin1"));
    assert.deepEqual(read("[TSU\x02bci\xfd]"), { a: [true, "bc", -3] });
    const faults = {
        "is cut off": ["SU\x05abc", `SM${"\xff".repeat(8)}`, `[$D#m${"\xff".repeat(4)}`, "[$d#U\x02abcde"],
        "is not a whole number": ["[Si\xfd", `[$U#l${"\xff".repeat(4)}`, "[$U#d\0\0\xc0\x7f"],
        "unknown marker": ["N", "[N]"],
        "no such optimized array": ["[$S#U\0", "[$UU\0"],
        "bytes after the end": ["T}"],
    };
    for (const [says, values] of Object.entries(faults)) {
        for (const value of values) assert.throws(() => read(value), ({ message }) => message.includes(says), value);
    }
    assert.throws(() => read("[".repeat(100_000)), RangeError);
});

test("client: a requested frame is not mistaken for one of the stream", async () => {
    const { client, next } = await listen({ stream: "frames", viewport: { width: 320, height: 200 } });
    const first = next("frame");
    client.connect();
    assert.equal(decode(await first).width, 320);
    client.shown(0);
    const streamed = next("frame");
    const [asked] = await Promise.all([
        client.request({ type: "get", what: "frame", width: 200, height: 100 }),
        client.request({ type: "key", key: "4" }),
    ]);
    assert.equal(decode(asked).width, 200);
    const frame = await streamed;
    assert.equal(decode(frame).width, 320);
    assert.equal(JSON.parse(pngText(frame)).revision, 1);
    client.close();
});

test("client: errors are RequestErrors with their code", async () => {
    const script = await joinSession((await common()).url);
    await assert.rejects(script.request({ type: "set", polytope: "25-cell" }), (error) => {
        assert.ok(error instanceof RequestError);
        assert.equal(error.code, "unknown_polytope");
        assert.match(error.message, /25-cell/);
        return true;
    });
    script.leave();
    await assert.rejects(script.state(), { code: "not_connected" });
});

test("client: the client reconnects to its session automatically", async () => {
    const proxy = await startProxy((await common()).url, "/under");
    const { client, next } = await listen({ url: proxy.url });
    const opened = next("open");
    client.connect();
    await opened;
    const { session } = client.credentials;
    await client.request({ type: "set", polytope: "16-cell" });
    const [waiting, again] = [next("waiting"), next("open")];
    const unanswered = assert.rejects(client.request({ type: "get", what: "frame" }), { code: "not_connected" });
    proxy.cut();
    await unanswered;
    await waiting;
    proxy.restore();
    await again;
    assert.equal(client.credentials.session, session);
    assert.equal((await client.request({ type: "get", what: "state" })).polytope.name, "16-cell");
    client.close();
    await proxy.stop();
});

test("client: it keeps a session that a server cannot open, and tries again", async () => {
    const credentials = { session: "kept", token: "secret" };
    const refusal = { type: "error", code: "later_version", message: "a later version has stored it" };
    const hellos = [];
    const server = new WebSocketServer({ host: "127.0.0.1", port: 0 });
    afterTest(() => void server.close());
    server.on("connection", (socket, { url }) => {
        socket.on("message", (text) => {
            const { type, id, token } = JSON.parse(text);
            if (type !== "hello") return;
            hellos.push({ url, token });
            if (hellos.length > 1) {
                socket.send(JSON.stringify({ type: "welcome", id, protocol: 1, ...credentials }));
                return;
            }
            socket.send(JSON.stringify({ ...refusal, id }));
            socket.close(1013, "try again later");
        });
    });
    await within(new Promise((resolve) => server.on("listening", resolve)), "the server");
    const statuses = [];
    const lost = [];
    let opened;
    const open = new Promise((resolve) => (opened = resolve));
    const { client } = await listen({
        url: `http://127.0.0.1:${server.address().port}/`,
        credentials,
        onLost: (reason) => lost.push(reason),
        onStatus: (status) => {
            statuses.push(status);
            if (status.kind === "waiting") client.connect(); // instead of waiting for the delay
            if (status.kind === "open") opened();
        },
    });
    client.connect();
    await within(open, "the session to open");
    const { reason, refusal: code } = statuses.find(({ kind }) => kind === "waiting");
    assert.deepEqual([reason, code], [refusal.message, "later_version"]);
    assert.deepEqual(hellos, Array(2).fill({ url: "/ws/kept", token: "secret" }));
    assert.deepEqual(lost, []);
    assert.deepEqual(client.credentials, credentials);
    client.close();
});

test("client: a script and a page in one session see each other's changes", async () => {
    const { page, close } = await openPage();
    const script = await scriptFor(page);
    await script.request({ type: "command", line: "polytope 600-cell" });
    await named(page, "600-cell");
    script.leave();
    await close();
});

test("client: the npm package works in a script, and has types", async () => {
    const root = fileURLToPath(new URL("../../", import.meta.url));
    const folder = await mkdtemp(join(tmpdir(), "oval4d-"));
    afterTest(() => rm(folder, { recursive: true }));
    const [library, user] = [join(folder, "protocol/ts"), join(folder, "user")];
    const isSource = (path) => !/\/(node_modules|dist)$/.test(path);
    await cp(join(root, "protocol"), join(folder, "protocol"), { recursive: true, filter: isSource });
    // These packages are already on the disk, so npm need not download them.
    await mkdir(join(library, "node_modules"));
    const packages = { esbuild: "tests/browser", "cbor-x": "tests/browser", typescript: "web_client" };
    for (const [name, from] of Object.entries(packages)) {
        await symlink(join(root, from, "node_modules", name), join(library, "node_modules", name));
    }
    await mkdir(user);
    const run = (program, ...given) => promisify(execFile)(program, given, { cwd: user });
    await writeFile(join(user, "package.json"), '{ "private": true, "type": "module" }');
    await run("npm", "install", "--offline", "--no-audit", "--no-fund", library);
    await symlink(join(root, "tests/browser/node_modules/ws"), join(user, "node_modules/ws"));

    const script = `
        import { Client } from "oval4d-client";
        import WebSocket from "ws";
        const client = new Client({ url: process.argv[2], webSocket: WebSocket, stream: "geometry", onStatus, onSlices });
        async function onStatus({ kind }) {
            if (kind === "open") await client.request({ type: "set", polytope: "16-cell", slices: { count: 7 } });
        }
        function onSlices({ revision, slices }) {
            client.shown(revision);
            if (revision === 0) return;
            console.log(slices.length);
            client.close();
        }
        client.connect();
    `;
    await writeFile(join(user, "script.js"), script);
    const { stdout } = await run("node", "script.js", (await common()).url);
    assert.equal(stdout, "7\n");

    const typed = `
        import { Client, type Command, type Done, type Measured, type Pong, type State } from "oval4d-client";
        const client = new Client({ url: "http://localhost:8080/" });
        const { shown }: State = await client.request({ type: "get", what: "state" });
        export const part: keyof typeof shown = "balls";
        export const pong: Pong = await client.request({ type: "ping" });
        export const measured: Measured = await client.request({ type: "measure", element: "cell", number: 3 });
        export const send = (command: Command): Promise<Done> => client.request(command);
        // @ts-expect-error because no part has this name
        export const none: keyof typeof shown = "corners";
        // @ts-expect-error because a ping changes nothing
        export const command: Command = { type: "ping" };
    `;
    await writeFile(join(user, "typed.ts"), typed);
    const tsc = join(root, "web_client/node_modules/typescript/bin/tsc");
    await run("node", tsc, "--noEmit", "--strict", "--module", "nodenext", "--target", "es2022", "--lib", "es2022,dom", "typed.ts");
});
