// Names for parts of messages, and for arguments and results of the client's functions.

import type { Answer, GetRequest, SetRequest, State } from "./messages.js";
import type { Slices } from "./slices.js";

/** Any message from the server. */
export type Message = Answer | Slices;

/** A point or vector with the coordinates x, y and z. */
export type Vector = [number, number, number];
/** A size of pictures in pixels. */
export interface Viewport {
    width: number;
    height: number;
}

/** The settings that a message `set` can change. Settings that a message lacks keep their values. */
export type Settings = Omit<
    SetRequest,
    "type" | "id" | "continues" | "revision" | "object_serial" | "draft" | "moving" | "section"
>;
/** Which parts of the picture are drawn. */
export type Parts = State["shown"];
/** The viewer's orbit: the angles by which the camera was turned about its target, and the magnification. */
export type Orbit = State["camera"];
/** The hyperplanes of the slices: their number, the distance between them, and their position along w. */
export type HyperplaneSettings = State["slices"];
/** An element of a polytope: its kind, and its number among the elements of this kind, counted from 0. */
export type PolytopeElement = NonNullable<State["highlight"]>;

/** The options of an exported file: the members of the message `get` that only exports use, such as `body`. */
export type FileOptions = Omit<
    GetRequest,
    "type" | "id" | "what" | "width" | "height" | "background" | "highlight" | "x" | "y" | "point" | "format"
> & {
    format: string;
};
/** An exported file: its bytes, and warnings about it. */
export interface ExportedFile {
    bytes: Uint8Array;
    /** Texts for the user about what the file lacks: for example, which slices are left out because they are empty. */
    warnings: string[];
}
