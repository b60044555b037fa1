// A client of one session. If the connection breaks, the client reconnects automatically, and joins the session again
// with the session's token. It reports the status of the connection.

import { Arena } from "./arena.js";
import { decodeBinary, decodeText } from "./decode.js";
import type { Encoding, ErrorMessage, GetRequest, Request, RequestAnswers } from "./messages.js";
import type { Scheme, State, Stream, Welcome } from "./messages.js";
import type { Slices } from "./slices.js";
import type { ExportedFile, Message, Viewport } from "./types.js";

/** The name and the token of a session. Together, they give access to it. */
export interface Credentials {
    session: string;
    token: string;
}

export type Status =
    | { kind: "connecting"; isBlocked?: true } // `isBlocked`: HTTP works, but no WebSocket opens
    | { kind: "open" }
    // `seconds` remain until the next attempt. `refusal` is the error code with which the server has refused the
    // session. After "later_version" and "internal", the session exists, and the client tries again to open it.
    | { kind: "waiting"; reason: string; seconds: number; isBlocked?: true; refusal?: string }
    | { kind: "closed"; reason: string };

export interface Options {
    /** The address of the service, as typed into a browser, including its path prefix if there is one. */
    url: string | URL;
    /** What pictures the server sends; "none" if absent. */
    stream?: Stream;
    /** The encoding of `slices` messages; "json" if absent. */
    encoding?: Encoding;
    /** The size of pictures; the server's default if absent. */
    viewport?: Viewport;
    /** The color scheme of pictures whose background is `auto`; "dark" if absent. */
    scheme?: Scheme;
    /** The session to open. If absent, the client creates a new session. */
    credentials?: Credentials;
    /** If true, the arrays passed to `onSlices` are valid only until the next message, which overwrites them. */
    transient?: boolean;
    /** The WebSocket class, for runtimes that have no built-in one. */
    webSocket?: new (url: string, protocols: string) => WebSocket;

    onStatus?(status: Status): void;
    onWelcome?(welcome: Welcome): void;
    onState?(state: State): void;
    /** Called with each picture of a geometry stream. Call `shown` after presenting the picture. */
    onSlices?(slices: Slices): void;
    /** Called with each picture of a frame stream, which is a PNG file. Call `shown` after presenting the picture. */
    onFrame?(png: Uint8Array): unknown;
    /** Called for each request, also for those of the client itself. `answer` is a promise of the answer. */
    onRequest?(answer: Promise<unknown>): void;
    /** Called with an error message that does not answer a request of this client. */
    onError?(error: ErrorMessage): void;
    /**
     * Called if the server refuses the first message `hello` of a connection. If a size of pictures is returned, the
     * client sends another `hello` with this size; "default" means the server's default size. If undefined is returned,
     * the client reports the refusal as the `reason` of its status, and connects again later.
     */
    onRefused?(error: RequestError): Viewport | "default" | undefined;
    /** Called if the session no longer exists or its token is wrong. The client then opens a new session. */
    onLost?(reason: string): void;
}

/** The error of a failed request. `code` is the code in the server's error message, or "not_connected". */
export class RequestError extends Error {
    constructor(
        readonly code: string,
        message: string,
    ) {
        super(message);
        this.name = "RequestError";
    }
}

/**
 * The answer to a request of type "get". For a frame or a file, it is the contents of a binary message; otherwise, the
 * message of the type `What`.
 */
type GetAnswer<What> = What extends "frame"
    ? Uint8Array
    : What extends "file"
      ? ExportedFile
      : Extract<Message, { type: What }>;

interface PendingRequest {
    /**
     * What answers the request. A frame or a file comes as a binary message without an id, followed by the message
     * `done` with the request's id.
     */
    wants: "frame" | "file" | "slices" | "message";
    /** Whether the answer may take long. The server answers later requests only after it. */
    mayTakeLong: boolean;
    resolve(answer: unknown): void;
    reject(error: RequestError): void;
}

const kProtocol = 1;
const kSubprotocol = `oval4d.v${kProtocol}`;
// The next three constants are in seconds, and are multiplied by a random factor from 0.5 to 1.5.
const kReconnectDelay = 0.1; // after an open connection has ended; short, as another server may have taken over
const kFirstRetryDelay = 0.5; // after the first failed attempt to connect; doubled after each further failure
const kMaxRetryDelay = 15; // the limit of the doubled delay
const kOpeningTimeout = 5; // seconds within which a WebSocket must open
const kWelcomeTimeout = 30; // seconds within which the server, which may have to read a session, answers the first hello
const kProbeTimeout = 3; // seconds within which the server must answer over HTTP if no WebSocket opens
const kIdleBeforeTest = 20; // seconds without a message after which the connection is tested
const kTestTimeout = 8; // seconds within which the server must answer a test
const kLongTestTimeout = 300; // seconds; replaces kTestTimeout while a slow request is unanswered
const kOpen = 1; // WebSocket.OPEN
const kUnauthorized = 401; // the HTTP status for a missing or wrong token
const kNoAnswer = "no answer";
const kTokenRequired = "the server requires its token: open the address that it printed at startup";

export class Client {
    status: Status = { kind: "closed", reason: "not connected yet" };
    credentials: Credentials | undefined;
    welcome: Welcome | undefined;

    private socket: WebSocket | undefined;
    private settings: { stream: Stream; encoding: Encoding; viewport: Viewport | undefined; scheme: Scheme };
    private pending = new Map<number, PendingRequest>();
    private lastId = 0;
    private failures = 0;
    private blocked: { isBlocked?: true } = {};
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
            scheme: options.scheme ?? "dark",
        };
    }

    /** Connects at once, without the usual delay before reconnecting. Ends an existing connection. */
    connect(): void {
        clearTimeout(this.timer);
        this.drop();
        this.changeStatus({ kind: "connecting", ...this.blocked });
        const url = new URL(
            this.credentials ? `ws/${encodeURIComponent(this.credentials.session)}` : "ws",
            this.options.url,
        );
        url.protocol = url.protocol.replace("http", "ws");
        url.search = url.hash = "";
        const socket = new (this.options.webSocket ?? WebSocket)(url.href, kSubprotocol);
        socket.binaryType = "arraybuffer";
        socket.onopen = () => void this.sayHello();
        socket.onmessage = (event) => this.receive(event.data as string | ArrayBuffer);
        socket.onclose = (event) => this.closed(event.code, event.reason);
        socket.onerror = () => {}; // the event `close` follows each `error`
        this.socket = socket;
        this.timer = setTimeout(() => this.closed(1006, ""), kOpeningTimeout * 1000);
    }

    /**
     * Says hello on a new connection. If the server refuses and onRefused() returns a size of pictures, says hello
     * again with this size.
     */
    private async sayHello(): Promise<void> {
        let refusal = await this.tryHello({});
        if (refusal?.code === "not_connected") return; // the connection has ended
        const size = refusal && this.options.onRefused?.(refusal);
        if (size) refusal = await this.tryHello({ viewport: size === "default" ? undefined : size });
        // After not_found and bad_token, the server closes the connection. After other refusals, the client must close
        // it.
        if (!refusal || ["not_connected", "not_found", "bad_token"].includes(refusal.code)) return;
        this.closed(1006, refusal.message, refusal.code);
    }

    /**
     * Says hello. Resolves to the error if the server refuses, otherwise to undefined. If the server does not answer in
     * time, the connection counts as lost.
     */
    private tryHello(change: { viewport?: Viewport | undefined }): Promise<RequestError | undefined> {
        clearTimeout(this.timer);
        this.timer = setTimeout(() => this.closed(1006, "the server does not answer"), kWelcomeTimeout * 1000);
        return this.hello(change).then(
            () => undefined,
            (error: RequestError) => error,
        );
    }

    /** Closes the connection and does not reconnect. */
    close(reason = "closed"): void {
        clearTimeout(this.timer);
        this.drop();
        this.changeStatus({ kind: "closed", reason });
    }

    /**
     * Changes the stream, the encoding, the size or the color scheme of pictures. The change applies to this connection
     * and all later ones. If the viewport is undefined, the server chooses the size.
     */
    hello(change: {
        stream?: Stream;
        encoding?: Encoding;
        viewport?: Viewport | undefined;
        scheme?: Scheme;
    }): Promise<Welcome> {
        Object.assign(this.settings, change);
        const { stream, encoding, viewport, scheme } = this.settings;
        const token = this.credentials?.token;
        // The scheme is sent only if it is "light". Servers of earlier versions do not know this member, and draw only
        // dark pictures.
        const own = { ...viewport, ...(scheme === "light" && { scheme }), ...(token !== undefined && { token }) };
        return this.request({ type: "hello", stream, encoding, ...own });
    }

    /**
     * Sends a request, and resolves to its answer. Rejects with a RequestError if the server refuses the request, or if
     * there is no connection or it ends before the answer.
     */
    request<What extends GetRequest["what"]>(message: GetRequest & { what: What }): Promise<GetAnswer<What>>;
    request<Type extends keyof RequestAnswers>(message: Request & { type: Type }): Promise<RequestAnswers[Type]>;
    request(message: Request): Promise<unknown> {
        const id = ++this.lastId;
        const answer = new Promise((resolve, reject) => {
            if (this.socket?.readyState !== kOpen) {
                reject(new RequestError("not_connected", "there is no connection to the server"));
                return;
            }
            const what = message.type === "get" ? message.what : "message";
            const wants = what === "frame" || what === "file" || what === "slices" ? what : "message";
            this.pending.set(id, { wants, mayTakeLong: mayTakeLong(message), resolve, reject });
            this.send({ ...message, id });
        });
        this.options.onRequest?.(answer);
        return answer;
    }

    /** The number of bytes that have not been sent to the server yet. */
    get unsentBytes(): number {
        return this.socket?.bufferedAmount ?? 0;
    }

    /** Tells the server that a picture has been presented. The server then sends the next one. */
    shown(revision: number): void {
        this.send({ type: "shown", revision });
    }

    private send(message: object): void {
        if (this.socket?.readyState === kOpen) this.socket.send(JSON.stringify(message));
    }

    private receive(data: string | ArrayBuffer): void {
        this.scheduleTest();
        if (typeof data === "string") {
            this.handle(decodeText(data));
            return;
        }
        const bytes = new Uint8Array(data);
        const keep = !this.options.transient || this.isAwaiting("slices");
        const message = decodeBinary(bytes, keep ? undefined : this.arena);
        if (message === "file") {
            this.heldFile = bytes; // kept until the message `done` of the request arrives
        } else if (message !== "frame") {
            this.handle(message);
        } else if (this.isAwaiting("frame")) {
            this.passHeldFrame();
            this.heldFrame = bytes; // the next message shows whether the frame answers a request
        } else {
            this.options.onFrame?.(bytes);
        }
    }

    private handle(message: Message): void {
        const request = message.id === undefined ? undefined : this.pending.get(message.id);
        if (message.id !== undefined) this.pending.delete(message.id);
        if (request?.wants === "frame" && message.type === "done") {
            request.resolve(this.heldFrame);
            this.heldFrame = undefined;
            return;
        }
        if (request?.wants === "file" && message.type === "done") {
            request.resolve({ bytes: this.heldFile, warnings: message.warnings ?? [] });
            this.heldFile = undefined;
            return;
        }
        this.passHeldFrame();
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

    private isAwaiting(what: PendingRequest["wants"]): boolean {
        return [...this.pending.values()].some(({ wants }) => wants === what);
    }

    /** Passes the held frame, if any, to `onFrame`. No `done` has followed the frame, so it belongs to the stream. */
    private passHeldFrame(): void {
        const frame = this.heldFrame;
        this.heldFrame = undefined;
        if (frame) this.options.onFrame?.(frame);
    }

    private welcomed(welcome: Welcome): void {
        if (welcome.protocol !== kProtocol) {
            this.close(`the server uses protocol ${welcome.protocol}, this client ${kProtocol}: reload the page`);
            return;
        }
        this.failures = 0;
        this.blocked = {};
        this.welcome = welcome;
        this.credentials = { session: welcome.session, token: welcome.token };
        if (this.status.kind !== "open") this.changeStatus({ kind: "open" });
        this.options.onWelcome?.(welcome);
    }

    /**
     * Schedules a test of the connection after kIdleBeforeTest seconds without messages. No event reports a broken
     * network.
     */
    private scheduleTest(): void {
        clearTimeout(this.timer);
        this.timer = setTimeout(() => this.test(), kIdleBeforeTest * 1000);
        (this.timer as { unref?(): void }).unref?.(); // in Node, the timer must not keep a script running
    }

    /** Tests the connection with a request. If the server does not answer in time, the connection counts as lost. */
    test(): void {
        if (this.status.kind !== "open") return;
        const { unsentBytes } = this; // before the test's own bytes, which may leave the buffer but never arrive
        this.request({ type: "get", what: "state" }).catch(() => {});
        this.awaitTestAnswer(unsentBytes);
    }

    /**
     * Waits for the answer to a test. `unsentBytes` is the number of unsent bytes at the start. If fewer bytes are
     * unsent when the time is over, the connection is slow but works, and the client waits again. Otherwise the
     * connection counts as lost.
     */
    private awaitTestAnswer(unsentBytes: number): void {
        const isLong = [...this.pending.values()].some((request) => request.mayTakeLong);
        clearTimeout(this.timer);
        this.timer = setTimeout(
            () => {
                if (this.unsentBytes < unsentBytes) this.awaitTestAnswer(this.unsentBytes);
                else this.closed(1006, "the server does not answer");
            },
            (isLong ? kLongTestTimeout : kTestTimeout) * 1000,
        );
    }

    private closed(code: number, closeReason: string, refusal?: string): void {
        this.drop();
        if (code === 4401 || code === 4404) {
            const reason = code === 4401 ? "the token does not open that session" : "the server has no such session";
            this.credentials = undefined;
            this.options.onLost?.(closeReason || reason);
            this.connect();
            return;
        }
        const opened = this.status.kind === "open";
        const otherwise = opened ? "the connection was lost" : kNoAnswer;
        const reason = closeReason || (code === 1012 ? "the server is stopping" : otherwise);
        const delay = opened ? kReconnectDelay : Math.min(kMaxRetryDelay, kFirstRetryDelay * 2 ** this.failures++);
        const seconds = delay * (0.5 + Math.random()); // random, so that clients do not all reconnect at the same time
        this.timer = setTimeout(() => this.connect(), seconds * 1000);
        this.changeStatus({ kind: "waiting", reason, seconds, ...this.blocked, ...(refusal && { refusal }) });
        if (!opened && closeReason === "") void this.findWhetherBlocked();
    }

    /**
     * Finds out whether the server answers over HTTP although no WebSocket opens, and reports this. The reason may be a
     * proxy that does not pass on the headers of WebSocket requests. If the server answers kUnauthorized (missing or
     * wrong token), stops connecting, because the server counts each attempt and would soon refuse all clients at this
     * IP address.
     */
    private async findWhetherBlocked(): Promise<void> {
        const begin = Date.now();
        const signal = AbortSignal.timeout(kProbeTimeout * 1000);
        const answer = await fetch(this.options.url, { method: "HEAD", signal }).catch(() => undefined);
        const { status } = this;
        if (status.kind !== "waiting" && status.kind !== "connecting") return;
        if (answer?.status === kUnauthorized) {
            this.close(kTokenRequired);
            return;
        }
        this.blocked = answer?.ok ? { isBlocked: true } : {};
        if (status.isBlocked === this.blocked.isBlocked) return;
        if (status.kind === "connecting") {
            this.changeStatus({ kind: "connecting", ...this.blocked });
            return;
        }
        const seconds = Math.max(0, status.seconds - (Date.now() - begin) / 1000);
        this.changeStatus({ kind: "waiting", reason: status.reason, seconds, ...this.blocked });
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
        const unanswered = [...this.pending.values()];
        this.pending.clear();
        for (const { reject } of unanswered) {
            reject(new RequestError("not_connected", "the connection ended before the answer arrived"));
        }
    }

    private changeStatus(status: Status): void {
        this.status = status;
        this.options.onStatus?.(status);
    }
}

/** Whether the server may have to read, build, search or draw something before it can answer this request. */
function mayTakeLong(message: Request): boolean {
    switch (message.type) {
        case "load":
        case "command":
            return true;
        case "set":
            return message.polytope !== undefined || message.field !== undefined;
        case "key":
            return message.key === ")" || message.key === "("; // these keys search for the next critical w of a field
        case "get":
            return ["frame", "slices", "at", "file"].includes(message.what);
        default:
            return false;
    }
}
