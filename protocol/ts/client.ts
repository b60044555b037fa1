// A connection to one session, kept alive: it reconnects by itself, comes back to its session by the token, and says
// at any time how it stands.

import { Arena } from "./arena";
import { decodeCbor, decodeText, isFile, isPng } from "./decode";
import type { Catalogue, Done, Encoding, ErrorMessage, FileWish, Keymap, Message, Request } from "./messages";
import type { Slices, State, Stream, Viewport, Welcome } from "./messages";

/** What opens a session again. */
export interface Credentials {
    session: string;
    token: string;
}

export type Status =
    | { kind: "connecting" }
    | { kind: "open" }
    | { kind: "waiting"; reason: string; seconds: number } // until the next attempt
    | { kind: "closed"; reason: string };

export interface Options {
    /** The service's address, as typed into a browser; a path prefix belongs to it. */
    url: string | URL;
    stream?: Stream;
    encoding?: Encoding;
    viewport?: Viewport;
    /** The session to come back to; else a new one is made. */
    credentials?: Credentials;
    /** The arrays that `onSlices` is given may be used again for the next message: nothing is allocated for them. */
    transient?: boolean;
    /** For runtimes without one of their own. */
    webSocket?: new (url: string, protocols: string) => WebSocket;

    onStatus?(status: Status): void;
    onWelcome?(welcome: Welcome): void;
    onState?(state: State): void;
    /** Pictures, to be answered by `shown` once they are presented. */
    onSlices?(slices: Slices): void;
    onFrame?(png: Uint8Array): unknown;
    /** An error that answers no request of this client. */
    onError?(error: ErrorMessage): void;
    /** The session is gone or not ours; the client goes on with a new one. */
    onLost?(reason: string): void;
}

/** An error message of the server, or a connection that ended before the answer. */
export class RequestError extends Error {
    constructor(
        readonly code: string,
        message: string,
    ) {
        super(message);
        this.name = "RequestError";
    }
}

interface Waiting {
    wants: "frame" | "file" | "slices" | "message";
    resolve(answer: unknown): void;
    reject(error: RequestError): void;
}

const kProtocol = 1;
const kSubprotocol = `oval4d.v${kProtocol}`;
const kAtOnce = 0.1; // seconds: after a connection that was open, another server may be there already
const kFirstDelay = 0.5; // seconds, doubled at each further failure
const kLongestDelay = 15;
const kQuiet = 20; // seconds without a message before the connection is tested
const kPatience = 8; // seconds within which a test is answered
const kFilePatience = 300; // the same where a file is awaited, of which nothing is heard until it is here
const kOpen = 1; // WebSocket.OPEN

export class Client {
    status: Status = { kind: "closed", reason: "not connected yet" };
    credentials: Credentials | undefined;
    welcome: Welcome | undefined;

    private socket: WebSocket | undefined;
    private settings: { stream: Stream; encoding: Encoding; viewport: Viewport | undefined };
    private waiting = new Map<number, Waiting>();
    private lastId = 0;
    private failures = 0;
    private timer: ReturnType<typeof setTimeout> | undefined;
    private readonly arena = new Arena();
    private heldFrame: Uint8Array | undefined;
    private heldFile: Uint8Array | undefined;

    constructor(private readonly options: Options) {
        this.credentials = options.credentials;
        this.settings = {
            stream: options.stream ?? "none",
            encoding: options.encoding ?? "json",
            viewport: options.viewport,
        };
    }

    /** Connects, now rather than after the back-off. */
    connect(): void {
        clearTimeout(this.timer);
        this.drop();
        this.report({ kind: "connecting" });
        const url = new URL(
            this.credentials ? `ws/${encodeURIComponent(this.credentials.session)}` : "ws",
            this.options.url,
        );
        url.protocol = url.protocol.replace("http", "ws");
        url.search = url.hash = "";
        const socket = new (this.options.webSocket ?? WebSocket)(url.href, kSubprotocol);
        socket.binaryType = "arraybuffer";
        socket.onopen = () => this.hello({}).catch(() => {}); // a refusal is followed by a close, which is handled
        socket.onmessage = (event) => this.receive(event.data as string | ArrayBuffer);
        socket.onclose = (event) => this.closed(event.code, event.reason);
        socket.onerror = () => {}; // a close follows
        this.socket = socket;
    }

    /** Ends the connection for good. */
    close(reason = "closed"): void {
        clearTimeout(this.timer);
        this.drop();
        this.report({ kind: "closed", reason });
    }

    /** Changes the stream, the encoding or the size, now and for later connections. */
    hello(change: { stream?: Stream; encoding?: Encoding; viewport?: Viewport }): Promise<Welcome> {
        Object.assign(this.settings, change);
        const { stream, encoding, viewport } = this.settings;
        const token = this.credentials?.token;
        return this.request({ type: "hello", stream, encoding, ...viewport, ...(token !== undefined && { token }) });
    }

    request(message: Extract<Request, { type: "hello" }>): Promise<Welcome>;
    request(message: { type: "get"; what: "state" }): Promise<State>;
    request(message: { type: "get"; what: "slices"; width?: number; height?: number }): Promise<Slices>;
    request(message: { type: "get"; what: "frame"; width?: number; height?: number }): Promise<Uint8Array>;
    request(message: { type: "get"; what: "file" } & FileWish): Promise<Uint8Array>;
    request(message: { type: "get"; what: "catalogue" }): Promise<Catalogue>;
    request(message: { type: "get"; what: "keymap" }): Promise<Keymap>;
    request(message: Exclude<Request, { type: "hello" | "get" | "shown" }>): Promise<Done>;
    request(message: Request): Promise<unknown> {
        const id = ++this.lastId;
        return new Promise((resolve, reject) => {
            if (this.socket?.readyState !== kOpen) {
                reject(new RequestError("not_connected", "there is no connection to the server"));
                return;
            }
            const what = message.type === "get" ? message.what : "message";
            const wants = what === "frame" || what === "file" || what === "slices" ? what : "message";
            this.waiting.set(id, { wants, resolve, reject });
            this.send({ ...message, id });
        });
    }

    /** Bytes that are still to go to the server. */
    get unsent(): number {
        return this.socket?.bufferedAmount ?? 0;
    }

    /** Says that a picture has been presented: the server sends the next one. */
    shown(revision: number): void {
        this.send({ type: "shown", revision });
    }

    private send(message: object): void {
        if (this.socket?.readyState === kOpen) this.socket.send(JSON.stringify(message));
    }

    private receive(data: string | ArrayBuffer): void {
        this.watch();
        if (typeof data === "string") {
            this.handle(decodeText(data));
            return;
        }
        const bytes = new Uint8Array(data);
        if (isFile(bytes)) {
            this.heldFile = bytes; // its `done` follows
        } else if (!isPng(bytes)) {
            const keep = !this.options.transient || this.awaits("slices");
            this.handle(decodeCbor(bytes, keep ? undefined : this.arena));
        } else if (this.awaits("frame")) {
            this.passFrame();
            this.heldFrame = bytes; // whose it is, the next message says
        } else {
            this.options.onFrame?.(bytes);
        }
    }

    private handle(message: Message): void {
        const request = message.id === undefined ? undefined : this.waiting.get(message.id);
        if (message.id !== undefined) this.waiting.delete(message.id);
        if (request?.wants === "frame" && message.type === "done") {
            request.resolve(this.heldFrame);
            this.heldFrame = undefined;
            return;
        }
        if (request?.wants === "file" && message.type === "done") {
            request.resolve(this.heldFile);
            this.heldFile = undefined;
            return;
        }
        this.passFrame();
        if (message.type === "welcome") this.welcomed(message);
        if (request) {
            if (message.type === "error") request.reject(new RequestError(message.code, message.message));
            else request.resolve(message);
        } else if (message.type === "state") {
            this.options.onState?.(message);
        } else if (message.type === "slices") {
            this.options.onSlices?.(message);
        } else if (message.type === "error") {
            this.options.onError?.(message);
        }
    }

    private awaits(what: Waiting["wants"]): boolean {
        return [...this.waiting.values()].some(({ wants }) => wants === what);
    }

    /** A held frame that was not followed by its `done` belongs to the stream. */
    private passFrame(): void {
        const frame = this.heldFrame;
        this.heldFrame = undefined;
        if (frame) this.options.onFrame?.(frame);
    }

    private welcomed(welcome: Welcome): void {
        if (welcome.protocol !== kProtocol) {
            this.close(`the server speaks protocol ${welcome.protocol}, this client ${kProtocol}: load the page anew`);
            return;
        }
        this.failures = 0;
        this.welcome = welcome;
        this.credentials = { session: welcome.session, token: welcome.token };
        if (this.status.kind !== "open") this.report({ kind: "open" });
        this.options.onWelcome?.(welcome);
    }

    /** Tests a connection that has gone quiet: a network that died says nothing. */
    private watch(): void {
        clearTimeout(this.timer);
        this.timer = setTimeout(() => this.test(), kQuiet * 1000);
        (this.timer as { unref?(): void }).unref?.(); // a script may end meanwhile
    }

    /** Asks for a sign of life; without one the connection counts as lost. */
    test(): void {
        if (this.status.kind !== "open") return;
        this.request({ type: "get", what: "state" }).catch(() => {});
        this.await(this.unsent);
    }

    /** The answer cannot come before all is sent: as long as that goes on, there is life. */
    private await(unsent: number): void {
        clearTimeout(this.timer);
        this.timer = setTimeout(
            () => {
                if (this.unsent < unsent) this.await(this.unsent);
                else this.closed(1006, "the server does not answer");
            },
            (this.awaits("file") ? kFilePatience : kPatience) * 1000,
        );
    }

    private closed(code: number, said: string): void {
        this.drop();
        if (code === 4401 || code === 4404) {
            const reason = code === 4401 ? "the token does not open that session" : "the server has no such session";
            this.credentials = undefined;
            this.options.onLost?.(said || reason);
            this.connect();
            return;
        }
        const opened = this.status.kind === "open";
        const reason =
            said || (code === 1012 ? "the server is stopping" : opened ? "the connection broke" : "no answer");
        const delay = opened ? kAtOnce : Math.min(kLongestDelay, kFirstDelay * 2 ** this.failures++);
        const seconds = delay * (0.5 + Math.random()); // not all clients at the same moment
        this.timer = setTimeout(() => this.connect(), seconds * 1000);
        this.report({ kind: "waiting", reason, seconds });
    }

    private drop(): void {
        clearTimeout(this.timer);
        const socket = this.socket;
        this.socket = undefined;
        this.heldFrame = this.heldFile = undefined;
        if (socket) {
            socket.onopen = socket.onmessage = socket.onclose = null;
            socket.close();
        }
        const unanswered = [...this.waiting.values()];
        this.waiting.clear();
        for (const { reject } of unanswered) {
            reject(new RequestError("not_connected", "the connection ended before the answer came"));
        }
    }

    private report(status: Status): void {
        this.status = status;
        this.options.onStatus?.(status);
    }
}
