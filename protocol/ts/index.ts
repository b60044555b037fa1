// A small client of oval4d for web pages and scripts.
//
//     import { Client } from "oval4d-client";
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
// `npm install PATH/protocol/ts` builds and installs it as the package oval4d-client, with its types.

export * from "./messages.js";
export * from "./slices.js";
export * from "./types.js";
export { Client, RequestError } from "./client.js";
export type { Credentials, Options, Status } from "./client.js";
export { pngText } from "./decode.js";
