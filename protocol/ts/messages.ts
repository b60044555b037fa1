// Types for the messages of protocol/README.md. Angles are in radians. Lengths are in the polytope's units, except for
// world lengths (circumradius = 1), which are marked as such.

export type Plane = "xy" | "xz" | "xw" | "yz" | "yw" | "zw";
export type Stream = "none" | "geometry" | "frames";
export type Encoding = "json" | "cbor";
export type View = "oval" | "single";
/** What the face colors show: the cell, the kind of cell, the w of the cell's center after the rotation, or nothing. */
export type Coloring = "cell" | "kind" | "w" | "plain";
export type Vector = [number, number, number];

/** Which parts of the picture are drawn. */
export type Parts = Record<keyof (typeof import("../schema/parts.schema.json"))["properties"], boolean>;

/** The camera's orbit angles around its target, and the magnification. */
export interface Orbit {
    azimuth: number;
    elevation: number;
    zoom: number;
}

export interface SliceSettings {
    count: number;
    spacing: number;
    focus: number;
}

export interface Viewport {
    width: number;
    height: number;
}

// To the server

/** The members of `set`: any of the settings in a state. */
export interface Settings {
    polytope?: string | { name: string };
    orientation?: number[][];
    alpha?: number;
    beta?: number;
    step?: number;
    slices?: Partial<SliceSettings>;
    view?: View;
    turning?: boolean;
    shown?: Partial<Parts>;
    camera?: Partial<Orbit>;
    color?: Coloring;
    /** Kinds of cells, as indices into the polytope's kinds. */
    hidden?: number[];
    faded?: number[];
}

/** The options of an exported file. All but the format apply only to files with bodies. */
export interface FileOptions {
    /** A name that export_formats.json lists. */
    format: string;
    of?: "focus" | "oval";
    body?: "solid" | "frame";
    /** The diameter of the polytope's circumscribed sphere, in millimeters. */
    size?: number;
    label?: "none" | "engraved" | "separate";
}

export type Request =
    | { type: "hello"; stream: Stream; encoding?: Encoding; token?: string; width?: number; height?: number }
    | { type: "key"; key: string; shift?: boolean; ctrl?: boolean }
    | { type: "rotate"; planes: Plane[]; angles: number[] }
    | ({ type: "set" } & Settings)
    | { type: "load"; name: string; format: string; data: string }
    | { type: "undo" }
    | { type: "redo" }
    | { type: "reset" }
    | { type: "command"; line: string }
    | { type: "get"; what: "state" | "slices" | "frame" | "catalogue" | "keymap"; width?: number; height?: number }
    | ({ type: "get"; what: "file" } & FileOptions)
    | { type: "shown"; revision: number };

// To the client

export interface Welcome {
    type: "welcome";
    id?: number;
    session: string;
    token: string;
    protocol: number;
    server: string;
    limits: Record<string, number>;
}

/** Cells that the polytope's symmetries map to each other. */
export interface CellKind {
    name: string;
    /** The number of cells of this kind. */
    cells: number;
    /** The color of the kind when faces are colored by kind, 0xRRGGBB. */
    color?: number;
}

export interface State {
    type: "state";
    id?: number;
    revision: number;
    polytope: { name: string; vertices: number; edges: number; faces: number; cells: number; kinds?: CellKind[] };
    /** 4 × 4, by rows; v' = M v. */
    orientation: number[][];
    alpha: number;
    beta: number;
    step: number;
    slices: SliceSettings;
    view: View;
    turning: boolean;
    shown: Parts;
    camera: Orbit;
    color: Coloring;
    /** Kinds of cells, as indices into the polytope's kinds. */
    hidden: number[];
    faded: number[];
    last: { planes: Plane[]; angles: number[] } | null;
}

export interface Done {
    type: "done";
    id: number;
    revision: number;
    /** The corrections made to a loaded file. */
    warnings?: string[];
}

export interface ErrorMessage {
    type: "error";
    id?: number;
    code: string;
    message: string;
}

/** A polytope of the catalogue. */
export interface CatalogueEntry {
    name: string;
    aliases: string[];
    /** Schläfli symbol, and Coxeter–Dynkin diagram in linear notation; empty if there is none. */
    schlaefli: string;
    diagram?: string;
    /** The family under which it is listed: "regular", "uniform H4", "duoprism" … */
    family?: string;
    vertices: number;
    edges: number;
    faces: number;
    cells: number;
    /** Order of the full symmetry group, including reflections. */
    symmetry_order?: number;
}

export interface Catalogue {
    type: "catalogue";
    id?: number;
    polytopes: CatalogueEntry[];
}

/** One entry of the key table, protocol/keymap.json. */
export interface KeyBinding {
    /** As in KeyboardEvent.key; in a sequence such as "gg", the keys are typed one after the other. */
    key: string;
    /** KeyboardEvent.code, if the key is recognized by its physical position. */
    code?: string;
    ctrl?: boolean;
    /** "inverse" if Shift applies the inverse rotation. */
    shift?: "inverse";
    /** The key's display name. */
    name: string;
    action: string;
    planes?: Plane[];
    group: string;
    /** A description of the action, for the help sheet. */
    text: string;
    /** A button label for the action. */
    label: string;
    /** Whether the client handles this key itself; the server refuses it. */
    client?: boolean;
}

export interface Keymap {
    type: "keymap";
    id?: number;
    groups: { name: string; title: string }[];
    keys: KeyBinding[];
}

/** How to draw the slices, such that every client draws the same picture as a frame. */
export interface SceneDescription {
    view: View;
    shown: Parts;
    viewport: Viewport;
    /** In world lengths. `fov` is vertical; `shift` moves the picture by fractions of the viewport, x right, y up. */
    camera: {
        eye: Vector;
        target: Vector;
        up: Vector;
        fov: number;
        near: number;
        far: number;
        shift: [number, number];
    };
    /** World units per polytope unit. */
    scale: number;
    circumradius: number;
    /** Radii in world units. */
    ball: number;
    bar: number;
    opacity: number;
    /** The factor for the opacity of faded elements. */
    faded: number;
    light: { direction: Vector; ambient: number; diffuse: number; specular: number; shininess: number };
    /** 0xRRGGBB. */
    colors: {
        background: number;
        text: number;
        focus: number;
        ball: number;
        bar: number;
        zero: number;
        axes: [number, number, number, number];
        cells: Uint32Array;
    };
    // All members below are in fractions of the viewport's height.

    /** The axes; their center is measured from the upper left corner. */
    axes: { x: number; y: number; length: number };
    /** The parallel coordinates, measured from the lower left corner. */
    coordinates: {
        rows: number;
        per_row: number;
        left: number;
        zero: number;
        row_step: number;
        column_step: number;
        line_step: number;
        line_width: number;
        amplitude: number;
        named: boolean;
        /** The number of columns of the density strip; 0 if lines are drawn. */
        columns: number;
    };
    /** The height of the labels' text. */
    text: number;
}

/** Triangles, which may cross; `tints` and `seen` (1 faded, 2 full) have one value per triangle. */
export interface Fill {
    points: Float32Array;
    triangles: Uint32Array;
    tints: Uint32Array;
    seen?: Uint32Array;
}

/** One slice, in flat arrays for either encoding. */
export interface Slice {
    index: number;
    w: number;
    /** x, y, z, x, y, z, … */
    vertices: Float32Array;
    /** Pairs of vertices. */
    edges: Uint32Array;
    /** Face f is the loop corners[begin[f]] … corners[begin[f + 1] − 1], counterclockwise as seen from outside. */
    faces: { begin: Uint32Array; corners: Uint32Array };
    /** The 4-D edge, 2-face or cell that each element was cut from. */
    of: { vertices: Uint32Array; edges: Uint32Array; faces: Uint32Array };
    /** The cell that colors each face; absent if it is the same as `of.faces`. */
    tints?: Uint32Array;
    /** The visibility of each element: 2 full, 1 faded, 0 hidden; absent if all are fully visible. */
    seen?: { vertices: Uint32Array; edges: Uint32Array; faces: Uint32Array };
    /** The radius of the ball at each vertex, relative to scene.ball, and its opacity; absent if all are 1. */
    balls?: { scale: Float32Array; opacity: Float32Array };
    /** What to draw instead of the faces, with a depth buffer; present only if the faces may cross. */
    fill?: Fill;
    /** The world position of the slice's origin: a vertex p is drawn at position + scale · p. */
    position: Vector;
    label: string;
    /** The label is centered below this world position. */
    label_at: Vector;
    /** The size of the label, as a fraction of the scene's `text`. */
    label_size: number;
    focus: boolean;
    drawn: boolean;
}

export interface Slices {
    type: "slices";
    id?: number;
    revision: number;
    scene: SceneDescription;
    /** x, y, z, w of each vertex of the rotated polytope; empty if the parallel coordinates are not shown. */
    coordinates: Float32Array;
    /** The density of the coordinate lines, 0 … 255, row by row from the top; empty if single lines are drawn. */
    density: Uint8Array;
    slices: Slice[];
}

export type Message = Welcome | State | Done | ErrorMessage | Catalogue | Keymap | Slices;
