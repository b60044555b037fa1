// The messages of protocol/README.md as types. Angles are in radians, lengths in the polytope's units unless they
// are called world lengths (circumradius = 1).

export type Plane = "xy" | "xz" | "xw" | "yz" | "yw" | "zw";
export type Stream = "none" | "geometry" | "frames";
export type Encoding = "json" | "cbor";
export type View = "oval" | "single";
/** What a face's colour tells: its cell, the kind of its cell, the w of its cell's centre as turned, or nothing. */
export type Coloring = "cell" | "kind" | "w" | "plain";
export type Vector = [number, number, number];

export interface Parts {
    faces: boolean;
    bars: boolean;
    balls: boolean;
    coordinates: boolean;
}

/** Orbit angles about the point looked at, and magnification. */
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

/** What `set` takes: any of the settings in a state. */
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
    /** Kinds of cells, numbers into the polytope's kinds. */
    hidden?: number[];
    faded?: number[];
}

/** What a file is to hold; all but the format only where it holds bodies. */
export interface FileWish {
    format: "stl" | "3mf" | "obj" | "ply" | "glb" | "off" | "csv" | "svg";
    of?: "focus" | "oval";
    body?: "solid" | "frame";
    /** Millimetres: the diameter of the polytope's circumscribed sphere. */
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
    | ({ type: "get"; what: "file" } & FileWish)
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

/** Cells that the polytope's symmetries take to each other. */
export interface CellKind {
    name: string;
    /** How many there are. */
    cells: number;
    /** 0xRRGGBB, where colours tell the kind. */
    color?: number;
}

export interface State {
    type: "state";
    id?: number;
    revision: number;
    polytope: { name: string; vertices: number; edges: number; faces: number; cells: number; kinds?: CellKind[] };
    /** 4×4, rows; v' = M v. */
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
    /** Kinds of cells, numbers into the polytope's kinds. */
    hidden: number[];
    faded: number[];
    last: { planes: Plane[]; angles: number[] } | null;
}

export interface Done {
    type: "done";
    id: number;
    revision: number;
    /** What was repaired in a loaded file. */
    warnings?: string[];
}

export interface ErrorMessage {
    type: "error";
    id?: number;
    code: string;
    message: string;
}

/** A polytope that is known by name. */
export interface CatalogueEntry {
    name: string;
    aliases: string[];
    /** Schläfli symbol, and Coxeter–Dynkin diagram in linear notation; empty where it has none. */
    schlaefli: string;
    diagram?: string;
    /** The heading under which it stands: "regular", "uniform H4", "duoprism" … */
    family?: string;
    vertices: number;
    edges: number;
    faces: number;
    cells: number;
    /** Order of the full symmetry group, reflections included. */
    symmetry_order?: number;
}

export interface Catalogue {
    type: "catalogue";
    id?: number;
    polytopes: CatalogueEntry[];
}

/** One line of the key table, protocol/keymap.json. */
export interface KeyBinding {
    /** As KeyboardEvent.key has it; a sequence such as "gg" is typed one after the other. */
    key: string;
    /** KeyboardEvent.code, where the physical key decides. */
    code?: string;
    ctrl?: boolean;
    /** Whether Shift gives the inverse. */
    shift?: "inverse";
    /** How the key is written. */
    name: string;
    action: string;
    planes?: Plane[];
    group: string;
    /** What it does, in a line, and in a word. */
    text: string;
    label: string;
    /** For the client alone: the server is not asked. */
    client?: boolean;
}

export interface Keymap {
    type: "keymap";
    id?: number;
    groups: { name: string; title: string }[];
    keys: KeyBinding[];
}

/** How the slices are to be shown, so that every client draws the picture that a frame shows. */
export interface SceneDescription {
    view: View;
    shown: Parts;
    viewport: Viewport;
    /** World lengths; `fov` is vertical, `shift` moves the picture by parts of the viewport, x right, y up. */
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
    /** By this the opacity of what is faded is multiplied. */
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
    /** The rest in parts of the viewport's height. The axes' centre from the upper left corner. */
    axes: { x: number; y: number; length: number };
    /** The parallel coordinates, from the lower left corner. */
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
        /** Of the density strip; 0 where lines are drawn. */
        columns: number;
    };
    /** Height of the labels' text. */
    text: number;
}

/** Triangles, which may cross; tint and presence (1 faded, 2 full) are those of each. */
export interface Fill {
    points: Float32Array;
    triangles: Uint32Array;
    tints: Uint32Array;
    seen?: Uint32Array;
}

/** One slice, in flat arrays whichever encoding it came in. */
export interface Slice {
    index: number;
    w: number;
    /** x, y, z, x, y, z, … */
    vertices: Float32Array;
    /** Pairs of vertices. */
    edges: Uint32Array;
    /** Face f is the loop corners[begin[f]] … corners[begin[f + 1] − 1], counter-clockwise seen from outside. */
    faces: { begin: Uint32Array; corners: Uint32Array };
    /** The 4-D edge, 2-face, cell that each was cut from. */
    of: { vertices: Uint32Array; edges: Uint32Array; faces: Uint32Array };
    /** The cell that colours each face; absent where it is `of.faces`. */
    tints?: Uint32Array;
    /** 2 where an element is seen, 1 where it is faded, 0 where it is hidden; absent where all are seen. */
    seen?: { vertices: Uint32Array; edges: Uint32Array; faces: Uint32Array };
    /** What to draw instead of the faces, with a depth buffer; only where they may cross. */
    fill?: Fill;
    /** Where the slice's origin stands in the world: a vertex p is seen at position + scale · p. */
    position: Vector;
    label: string;
    /** The label is centred under this point of the world. */
    label_at: Vector;
    /** Size of the label, as a part of the scene's `text`. */
    label_size: number;
    focus: boolean;
    drawn: boolean;
}

export interface Slices {
    type: "slices";
    id?: number;
    revision: number;
    scene: SceneDescription;
    /** x, y, z, w of each vertex of the polytope as turned; empty where they are not shown. */
    coordinates: Float32Array;
    /** How many of the coordinates' lines pass where, 0 … 255, row by row from the top; empty where lines are drawn. */
    density: Uint8Array;
    slices: Slice[];
}

export type Message = Welcome | State | Done | ErrorMessage | Catalogue | Keymap | Slices;
