// A small client of oval4d for web pages and scripts.
//
//     import WebSocket from "ws"; // for Node before 22; newer versions and browsers have a built-in WebSocket
//     const client = new Client({
//         url: "http://localhost:8080/",
//         webSocket: WebSocket,
//         stream: "geometry",
//         onSlices: (picture) => { console.log(picture.slices.length); client.shown(picture.revision); },
//         onStatus: ({ kind }) => kind === "open" && client.request({ type: "key", key: "y" }),
//     });
//     client.connect();
//
// Needs cbor-x from npm, and a bundler or a runtime that supports TypeScript.

export * from "./messages";
export { Client, RequestError } from "./client";
export type { Credentials, Options, Status } from "./client";
export { pngText } from "./decode";
