// A reverse proxy that mounts the service under a path, as an operator's web server does.
import { createServer, request } from "node:http";
import { connect } from "node:net";

import { atEnd } from "./suite.mjs";

export async function startProxy(target, prefix, extraHeaders = {}) {
    const { hostname, port } = new URL(target);
    const sockets = new Set();
    let broken = false;
    const outside = []; // requested URLs that are not under the prefix
    const inner = (url) => {
        if (url.startsWith(`${prefix}/`)) return url.slice(prefix.length);
        outside.push(url);
        return undefined;
    };
    const server = createServer((incoming, outgoing) => {
        const path = inner(incoming.url);
        if (path === undefined) return outgoing.writeHead(404).end();
        const { method, headers } = incoming;
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
        const onward = connect(Number(port), hostname, () => {
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
        /** Breaks all WebSockets, like a network failure, and refuses new ones until restore(). */
        cut() {
            broken = true;
            sockets.forEach((socket) => socket.destroy());
        },
        restore() {
            broken = false;
        },
        /** Stops forwarding without closing a connection, as when a cable is pulled; refuses new ones until thaw(). */
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
