// Names for parts of messages, and for what the functions of the client take and return.

import type { Answer, GetRequest, SetRequest, State } from "./messages.js";
import type { Slices } from "./slices.js";

/** A message from the server. */
export type Message = Answer | Slices;

/** x, y and z. */
export type Vector = [number, number, number];
/** A size in pixels. */
export interface Viewport {
    width: number;
    height: number;
}

/** The settings that a message `set` changes. Settings that it lacks keep their values. */
export type Settings = Omit<
    SetRequest,
    "type" | "id" | "continues" | "revision" | "object_serial" | "draft" | "moving" | "section"
>;
/** Which parts of the picture are drawn. */
export type Parts = State["shown"];
/** How the viewer has moved the camera: the angles by which it was turned about its target, and the magnification. */
export type Orbit = State["camera"];
/** The number of slices, the distance between them, and their position along w. */
export type HyperplaneSettings = State["slices"];
/** An element of a polytope: its kind, and its number among the elements of this kind, from 0. */
export type PolytopeElement = NonNullable<State["highlight"]>;

/** The options of an exported file: those members of the message `get` that are not for anything else. */
export type FileOptions = Omit<
    GetRequest,
    "type" | "id" | "what" | "width" | "height" | "background" | "highlight" | "x" | "y" | "point" | "format"
> & {
    format: string;
};
/** An exported file. */
export interface ExportedFile {
    bytes: Uint8Array;
    /** Texts for the user about what the file does not contain: for example, which slices are left out as empty. */
    warnings: string[];
}
