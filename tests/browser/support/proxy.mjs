// A reverse proxy that serves oval4d under a path, like the web server of an operator.
import { createHash } from "node:crypto";
import { createServer, request } from "node:http";
import { connect } from "node:net";

import { startServer } from "./server.mjs";
import { atEnd } from "./suite.mjs";

/** A server at a constant address. Another server can take its place at the same address. */
export async function startReplaceableServer(how) {
    let server = await startServer(how);
    const proxy = await startProxy(server.url, "");
    return {
        url: proxy.url,
        /** Stops the server as an operator does. Nothing answers at the address afterward. */
        stop: () => server.stop(),
        async startAnother() {
            server = await startServer(how);
            proxy.target = server.url;
        },
    };
}

export async function startProxy(firstTarget, prefix, extraHeaders = {}) {
    let target = new URL(firstTarget);
    const sockets = new Set();
    let broken = false;
    const outside = []; // requested URLs outside the prefix
    const inner = (url) => {
        if (url.startsWith(`${prefix}/`)) return url.slice(prefix.length);
        outside.push(url);
        return undefined;
    };
    const server = createServer((incoming, outgoing) => {
        const path = inner(incoming.url);
        if (path === undefined) return outgoing.writeHead(404).end();
        const { method, headers } = incoming;
        const { hostname, port } = target;
        const onward = request({ hostname, port, path, method, headers }, (answer) => {
            outgoing.writeHead(answer.statusCode, { ...answer.headers, ...extraHeaders });
            answer.pipe(outgoing);
        });
        onward.on("error", () => outgoing.destroy());
        return incoming.pipe(onward);
    });
    server.on("upgrade", (incoming, socket, head) => {
        const path = inner(incoming.url);
        if (path === undefined || broken) return socket.destroy();
        const onward = connect(Number(target.port), target.hostname, () => {
            const lines = [`${incoming.method} ${path} HTTP/1.1`];
            for (let i = 0; i < incoming.rawHeaders.length; i += 2) {
                lines.push(`${incoming.rawHeaders[i]}: ${incoming.rawHeaders[i + 1]}`);
            }
            onward.write(`${lines.join("\r\n")}\r\n\r\n`);
            onward.write(head);
            socket.pipe(onward).pipe(socket);
        });
        for (const end of [socket, onward]) {
            sockets.add(end);
            end.on("error", () => {});
            end.on("close", () => [socket, onward].forEach((one) => (one.destroy(), sockets.delete(one))));
        }
        return undefined;
    });
    await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
    atEnd(() => server.closeAllConnections());
    atEnd(() => server.close());
    return {
        url: `http://127.0.0.1:${server.address().port}${prefix}/`,
        outside,
        /** Sets the server for later connections. */
        set target(url) {
            target = new URL(url);
        },
        /** Breaks all WebSockets, like a network failure. Refuses new ones until restore() is called. */
        cut() {
            broken = true;
            sockets.forEach((socket) => socket.destroy());
        },
        restore() {
            broken = false;
        },
        /** Answers requests for WebSockets like other requests, as a proxy that does not pass on the header Upgrade. */
        dropUpgrades() {
            server.removeAllListeners("upgrade");
        },
        /** Opens WebSockets, but never answers a message. */
        swallow() {
            server.removeAllListeners("upgrade");
            server.on("upgrade", (incoming, socket) => {
                sockets.add(socket);
                const key = `${incoming.headers["sec-websocket-key"]}258EAFA5-E914-47DA-95CA-C5AB0DC85B11`; // RFC 6455
                const accepts = createHash("sha1").update(key).digest("base64");
                const protocol = incoming.headers["sec-websocket-protocol"];
                const headers = ["Upgrade: websocket", "Connection: Upgrade", `Sec-WebSocket-Accept: ${accepts}`];
                const lines = ["HTTP/1.1 101 Switching Protocols", ...headers, `Sec-WebSocket-Protocol: ${protocol}`];
                socket.write(`${lines.join("\r\n")}\r\n\r\n`);
            });
        },
        /** Never answers requests for WebSockets. */
        holdUpgrades() {
            server.removeAllListeners("upgrade");
            server.on("upgrade", (_, socket) => sockets.add(socket));
        },
        /**
         * Stops forwarding data without closing a connection, as after a pulled cable. Refuses new connections until
         * thaw() is called.
         */
        freeze() {
            broken = true;
            sockets.forEach((socket) => socket.pause());
        },
        thaw() {
            broken = false;
            sockets.forEach((socket) => socket.resume());
        },
        async stop() {
            this.cut();
            server.closeAllConnections();
            await new Promise((resolve) => server.close(resolve));
        },
    };
}
