// Types for the messages of protocol/README.md. Angles are in radians. Lengths are in the polytope's units, except
// where world units are stated (in which the polytope's circumradius is 1 if there are 21 slices).

export type Plane = "xy" | "xz" | "xw" | "yz" | "yw" | "zw";
export type Stream = "none" | "geometry" | "frames";
export type Encoding = "json" | "cbor";
export type View = "oval" | "single" | "matrix" | "strip";
/**
 * What face colors show: the cell, its kind, the w of its center after the rotation, nothing, or how it faces a light in
 * four dimensions. What the surfaces of a field show: the level, the w of the slice, nothing, or how fast they move
 * outward along w, or the value of the second function or of the field itself.
 */
export type Coloring = "cell" | "kind" | "w" | "plain" | "light" | "growth" | "value";
/**
 * The background of pictures, for which the other colors are chosen. `auto`: dark, or light for clients whose `hello` has
 * the scheme `light`. `transparent`: none in PNG files, otherwise white.
 */
export type Background = "auto" | "dark" | "light" | "white" | "transparent";
/** What colors are chosen for: a dark or a light background. */
export type Scheme = "dark" | "light";
export type Vector = [number, number, number];
/** The side of a level that belongs to the body: where the field's value is smaller, or larger. */
export type Inside = "below" | "above";
/** The caps of a field's surfaces: in the color of the surface, colored by value, or not drawn. */
export type Caps = "plain" | "value" | "open";
/** The ranges of x, y, z and w. */
export type Box = [Interval, Interval, Interval, Interval];
export type Interval = [least: number, most: number];
/** An array of integers. With CBOR, its width is the least that the largest value fits into. */
export type Integers = Uint8Array | Uint16Array | Uint32Array;

/** Which parts of the picture are drawn. */
export type Parts = Record<keyof (typeof import("../schema/parts.schema.json"))["properties"], boolean>;

/** The projection of the whole polytope. */
export type Projection = "off" | "perspective" | "orthogonal";

/** How the viewer has moved the camera: the angles of its rotation about its target, and the magnification. */
export interface Orbit {
    azimuth: number;
    elevation: number;
    zoom: number;
}

export interface SliceSettings {
    count: number;
    spacing: number;
    focus: number;
    /** w of the hyperplane n = 0, measured from the center of the object. */
    offset: number;
}

/** The kinds of elements of a polytope, by dimension. */
export type ElementKind = "vertex" | "edge" | "face" | "cell";

/** An element of a polytope, numbered from 0 among those of its kind. */
export interface PolytopeElement {
    element: ElementKind;
    number: number;
}

export interface Viewport {
    width: number;
    height: number;
}

/**
 * A control point of the transfer function of fog: the opacity, from 0 to 1, of a layer as thick as the circumradius, and
 * the color 0xRRGGBB, which may be absent.
 */
export interface FogPoint {
    value: number;
    opacity: number;
    color?: number;
}

// To the server

/** The members of `set`. Absent settings keep their values. */
export interface Settings {
    polytope?: string | { name: string };
    /** How much space a unit of w is worth, if w is time. */
    pace?: number;
    /** The velocity in units of x, y and z per unit of the object's own w with which the observer moves. */
    follow?: Vector;
    /** The velocity of a Lorentz boost; 1 is the speed of light. */
    boost?: Vector;
    orientation?: number[][];
    alpha?: number;
    beta?: number;
    step?: number;
    /** `w` sets focus and offset; it is in the coordinates of the object's file. */
    slices?: Partial<SliceSettings> & { w?: number };
    /** The focus point x, y, z, w of the matrix view, in the file's coordinates; its w moves the focus slice. */
    point?: [number, number, number, number];
    view?: View;
    turning?: boolean;
    shown?: Partial<Parts>;
    camera?: Partial<Orbit>;
    color?: Coloring;
    background?: Background;
    /** For fields only. */
    caps?: Caps;
    /** 1 to 4 different numbers; for fields only. */
    levels?: number[];
    /** For fields only. */
    inside?: Inside;
    /** The transfer function of fog: no points, or 2 to 8 in the order of their values; for fields only. */
    fog?: FogPoint[];
    /** For fields only. */
    field?: FieldDefinition;
    projection?: Projection;
    /** The w of the 4-D eye, in circumradii. */
    eye?: number;
    /** Kinds of cells, as indices into the polytope's kinds. */
    hidden?: number[];
    faded?: number[];
    highlight?: PolytopeElement | null;
}

/** What defines a field: its formula, or the shape and the range of its array; and its domain. */
export interface FieldDefinition {
    formula?: string;
    shape?: number[];
    range?: [number, number];
    /** Present if the range is that of a selection of the samples, because there are too many to read all of them. */
    estimated?: boolean;
    values?: ColoringValues;
    box: Box;
}

/** What the colors of values show: the second function of a field, or without one its own values. */
export interface ColoringValues {
    formula?: string;
    variable?: string;
    /** The values at the ends of the color scale. */
    range: [number, number];
    /** 0xRRGGBB, from one end of the scale to the other. */
    colors: number[];
}

/** The options of an exported file. `body` and `label` apply only to formats with bodies, `size` to these and to drawings. */
export interface FileOptions {
    /** A name that export_formats.json lists. */
    format: string;
    /** What the file contains: one of those that export_formats.json lists for the format, the first by default. */
    of?: "focus" | "oval" | "highlight" | "critical" | "object" | "coordinates" | "projection" | "matrix";
    /** Filled, or balls and bars merged into one body; "frame" is the former name of "skeleton". */
    body?: "solid" | "skeleton" | "frame";
    /** In millimeters: the diameter of the polytope's circumscribed sphere, or the largest side of a drawing. */
    size?: number;
    label?: "none" | "engraved" | "separate";
    /** The w of the slices, instead of those of the session: numbers, or a text such as "-1,0,1/3". */
    at?: number[] | string;
    /** The number of slices, which are spread evenly over the polytope's extent along w. */
    fit?: number;
}

/** An exported file. */
export interface ExportedFile {
    bytes: Uint8Array;
    /** What the file lacks, such as slices that are empty. */
    warnings: string[];
}

export type Request =
    | {
          type: "hello";
          stream: Stream;
          encoding?: Encoding;
          scheme?: Scheme;
          token?: string;
          width?: number;
          height?: number;
      }
    | { type: "key"; key: string; shift?: boolean; ctrl?: boolean }
    | { type: "rotate"; planes: Plane[]; angles: number[]; continues?: boolean }
    | { type: "toward"; element: ElementKind; number?: number; immediately?: boolean }
    | ({ type: "set"; continues?: boolean } & Settings)
    | {
          type: "load";
          name: string;
          format?: string;
          data?: string;
          path?: string;
          box?: Box;
          axes?: string;
          variable?: string;
          values?: string;
          values_variable?: string;
          append?: boolean;
          /** The point of the file about which the object turns. */
          center?: "object" | "origin" | [number, number, number, number];
      }
    | { type: "undo" }
    | { type: "redo" }
    | { type: "reset" }
    | { type: "command"; line: string }
    | { type: "address"; query: string }
    | { type: "get"; what: "state" | "critical" | "catalogue" | "keymap" | "address" }
    | { type: "get"; what: "slices" | "frame"; width?: number; height?: number; background?: Background }
    | { type: "get"; what: "at"; x: number; y: number; width?: number; height?: number }
    | ({ type: "get"; what: "file" } & FileOptions)
    | { type: "ping" }
    | { type: "shown"; revision: number };

// From the server

export interface Welcome {
    type: "welcome";
    id?: number;
    session: string;
    token: string;
    protocol: number;
    server: string;
    limits: Record<string, number>;
}

/** A kind of cells: in general, cells that the polytope's symmetries map to each other. */
export interface CellKind {
    name: string;
    /** The number of cells of this kind. */
    cells: number;
    /** The color of this kind, 0xRRGGBB, when faces are colored by kind. */
    color?: number;
}

export interface State {
    type: "state";
    id?: number;
    revision: number;
    polytope: {
        name: string;
        vertices: number;
        edges: number;
        faces: number;
        cells: number;
        kinds?: CellKind[];
        /** The point x, y, z, w of the file about which the object turns; absent if it is the file's origin. */
        center?: [number, number, number, number];
    };
    /** The frame of reference, which applies before the orientation. */
    pace: number;
    follow: Vector;
    boost: Vector;
    /** The matrix M, 4 × 4, by rows; v' = M v maps the polytope's own coordinates to the rotated ones. */
    orientation: number[][];
    alpha: number;
    beta: number;
    step: number;
    slices: SliceSettings;
    /** The focus point x, y, z, w, in the file's coordinates, through which the planes of the matrix view pass. */
    point: [number, number, number, number];
    view: View;
    turning: boolean;
    /** Whether the polytope turns, or an element is on its way to +w. */
    moving: boolean;
    /** Present if the surfaces of a field are coarser than usual; a finer picture of the same revision follows. */
    draft?: true;
    shown: Parts;
    camera: Orbit;
    color: Coloring;
    background: Background;
    /** The values at which the surfaces of a field are shown, and the side that is inside; absent for other objects. */
    levels?: number[];
    inside?: Inside;
    /** The transfer function of fog: no points, or 2 to 8 in the order of their values; for fields only. */
    fog?: FogPoint[];
    caps?: Caps;
    /** For fields only. */
    field?: FieldDefinition;
    projection: Projection;
    /** The w of the 4-D eye, in circumradii. */
    eye: number;
    /** Kinds of cells, as indices into the polytope's kinds. */
    hidden: number[];
    faded: number[];
    /** The element that is drawn in another color. */
    highlight: PolytopeElement | null;
    /** The focus slice: the polyhedron that it is, and the hull of the polytope's vertices in it; "" without a name. */
    section: { w: number; name: string; vertices: string };
    last: { planes: Plane[]; angles: number[] } | null;
}

export interface Done {
    type: "done";
    id: number;
    revision: number;
    /** The corrections made to a loaded file, or what an exported file lacks. */
    warnings?: string[];
}

/** How busy the server's threads are that slice and draw pictures. */
export interface Pong {
    type: "pong";
    id?: number;
    workers: number;
    /** The pictures that wait for one of them. */
    waiting: number;
    /** The running time of all pictures that have ended, in seconds, added over all threads. */
    busy: number;
    /** The time of a clock that never goes back, in seconds. */
    time: number;
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
    /** The family in which the polytope is listed: "regular", "uniform H4", "duoprism", … */
    family?: string;
    vertices: number;
    edges: number;
    faces: number;
    cells: number;
    /** The order of the full symmetry group, including reflections; absent for loaded polytopes. */
    symmetry_order?: number;
}

export interface Catalogue {
    type: "catalogue";
    id?: number;
    polytopes: CatalogueEntry[];
}

/** One entry of the key table, protocol/keymap.json. */
export interface KeyBinding {
    /** The value of KeyboardEvent.key, or a sequence of keys such as "gg", which are typed one after the other. */
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
    /** Whether the client must handle this key itself, because the server refuses it. */
    client?: boolean;
}

export interface Keymap {
    type: "keymap";
    id?: number;
    groups: { name: string; title: string }[];
    keys: KeyBinding[];
}

/** The query of an address that opens the view of the session. */
export interface Address {
    type: "address";
    id?: number;
    query: string;
}

/** How to draw the slices, so that the picture of every client is the same as a frame. */
export interface SceneDescription {
    view: View;
    shown: Parts;
    viewport: Viewport;
    /**
     * Lengths are in world units. `fov` is vertical; `shift` moves the picture right and up by these fractions of the
     * viewport's width and height.
     */
    camera: {
        eye: Vector;
        target: Vector;
        up: Vector;
        fov: number;
        near: number;
        far: number;
        shift: [number, number];
    };
    /** World units per unit of the polytope. */
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
        highlight: number;
        axes: [number, number, number, number];
        cells: Uint32Array;
    };
    /** How the surfaces of a field are drawn, from the innermost level to the outermost; absent for other objects. */
    surfaces?: SurfaceLevel[];
    /** How fog is drawn: for each value of Fog.values, 0xAARRGGBB; absent without fog. */
    fog?: { table: Integers };
    // All lengths below are fractions of the viewport's height.

    /** The axes in the upper left corner: the distances of their center from the left and top edges; their length. */
    axes: { x: number; y: number; length: number };
    /** The layout of the parallel coordinates, measured from the lower left corner. */
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
        /** The number of columns of `density`; 0 if lines are drawn. */
        columns: number;
        /** The width of each of the four panels of a field's histogram; 0 if none is drawn. */
        panel: number;
    };
    /** The height of labels. */
    text: number;
}

/**
 * Triangles, which may cross each other, as triples of points. `tints` (the cell that colors the triangle) and `seen`
 * (1 faded, 2 full) have one value per triangle.
 */
export interface Fill {
    points: Float32Array;
    triangles: Uint32Array;
    tints: Uint32Array;
    seen?: Uint32Array;
}

/** The surfaces of a field in one slice. The arrays are flat. */
export interface Surface {
    /** The color of the surfaces in place of those of the levels; present only if the color is "w". */
    color?: number;
    points: Float32Array;
    /** The unit normal of the level set at each point, outward. Caps are flat. */
    normals: Float32Array;
    /** Triples of points, counterclockwise as seen from outside. */
    triangles: Integers;
    /** For each triangle: the index of its level, and 1 if it belongs to a cap. */
    level: Uint8Array;
    cap: Uint8Array;
    /** The color of each point, 0xRRGGBB; present only if the color is "growth" or "value". */
    colors?: Uint32Array;
    /** The color of each point as the corner of a cap; present only if the caps are colored by value. */
    cap_colors?: Uint32Array;
}

/** The values of a field on a lattice in one slice: at min + step · (i, j, k). */
export interface Fog {
    /** The number of points along x, y and z. */
    size: Vector;
    min: Vector;
    step: number;
    /** Planes n · p ≤ d at which the fog ends, as nx, ny, nz, d. */
    walls: Float32Array;
    /** For each point, x fastest: 0 where the field has no value, else an entry of the scene's table. */
    values: Uint8Array;
}

/** How the surface of one level of a field is drawn. */
export interface SurfaceLevel {
    level: number;
    color: number;
    opacity: number;
    caps: boolean;
}

/** The elements of a slice, or of a part of the projection. The arrays are flat, whichever encoding the message has. */
export interface Elements {
    /** x, y, z, x, y, z, … */
    vertices: Float32Array;
    /** Pairs of vertices. */
    edges: Uint32Array;
    /** Face f is the loop corners[begin[f]] … corners[begin[f + 1] − 1], counterclockwise as seen from outside. */
    faces: { begin: Uint32Array; corners: Uint32Array };
    /** The index of the 4-D edge, 2-face or cell that each vertex, edge or face was cut from. */
    of: { vertices: Uint32Array; edges: Uint32Array; faces: Uint32Array };
    /** The cell that determines the color of each face; absent if that is `of.faces`. */
    tints?: Uint32Array;
    /** The visibility of each element: 2 full, 1 faded, 0 hidden; absent if all are fully visible. */
    seen?: { vertices: Uint32Array; edges: Uint32Array; faces: Uint32Array };
    /** The radius of each vertex's ball, relative to scene.ball, and the ball's opacity; absent if all are 1. */
    balls?: { scale: Float32Array; opacity: Float32Array };
}

export interface Slice extends Elements {
    index: number;
    w: number;
    /** What to draw instead of the faces, with a depth buffer; present only if the faces may cross. */
    fill?: Fill;
    /** The surfaces of a field; absent if the hyperplane meets none, and for other objects. */
    surface?: Surface;
    /** The fog of a field; absent if there is none. */
    fog?: Fog;
    /** The world position of the slice's origin: a vertex p is drawn at position + scene.scale · p. */
    position: Vector;
    label: string;
    /** The label is centered below this world position. */
    label_at: Vector;
    /** The size of the label, as a fraction of the scene's `text`. */
    label_size: number;
    focus: boolean;
    drawn: boolean;
}

/**
 * What shows the highlighted element: values of `of.vertices` and `of.edges`, in slices and in the projection; and its
 * vertices, as indices into `coordinates`.
 */
export interface Highlight {
    vertices: ArrayLike<number> & Iterable<number>;
    edges: ArrayLike<number> & Iterable<number>;
    own_vertices: ArrayLike<number> & Iterable<number>;
}

/** How a part of the projection is drawn. */
export interface ProjectionLook {
    /** The radii of balls and bars in world units; those with the radius 0 are not drawn. */
    ball: number;
    bar: number;
    ball_color: number;
    bar_color: number;
    /** The opacity of faces, from 0 to 1. */
    opacity: number;
}

/** The projection of the whole object from four to three dimensions. */
export interface ObjectProjection {
    kind: Exclude<Projection, "off">;
    /** The w of the 4-D eye, in circumradii. */
    eye: number;
    /** The world position of its center: a vertex p is drawn at position + scale · p. */
    position: Vector;
    scale: number;
    /** The whole object, then the sections of hyperplanes. */
    parts: (Elements & ProjectionLook)[];
}

/** The section of the object by a plane that is parallel to two coordinate axes. */
export interface PlanarSection {
    /** 0 to 3 for x, y, z, w; the first is the smaller. */
    axes: [number, number];
    /** The points' coordinates along the two axes, in the polytope's units. */
    points: [number, number][];
    edges: [number, number][];
    /** The points in the order in which they bound the section; empty if the edges do not form one closed polygon. */
    boundary: number[];
    /**
     * What each element was cut from. A point: the 2-face; or faces + e, if edge e was cut; or faces + edges + v, if
     * vertex v lies in the plane. An edge: the cell; or cells + f, if 2-face f was cut along the plane.
     */
    of: { points: number[]; edges: number[] };
    /** The cell that determines the color of each edge. */
    tints: number[];
    /** The visibility of each element: 2 full, 1 faded, 0 hidden; absent if all are fully visible. */
    seen?: { points: number[]; edges: number[] };
    balls?: { scale: number[]; opacity: number[] };
}

/**
 * The matrix of planar sections. The panel in row i and column j, from the upper left, shows the section by the plane of
 * the axes i and j: axis j to the right, axis i upward. Lengths are fractions of the viewport's height, measured from its
 * lower left corner.
 */
export interface SectionMatrix {
    left: number;
    bottom: number;
    /** The side of a panel, and the distance from a panel to the next. */
    panel: number;
    step: number;
    line_width: number;
    /** The radius of points. */
    ball: number;
    /** From the center of a panel, which is the origin, to its sides, in the polytope's units. */
    reach: number;
    /** The focus point x, y, z, w, through which all planes pass. */
    point: [number, number, number, number];
    /** By the planes xy, xz, yz, xw, yw and zw. */
    sections: PlanarSection[];
}

/** The scales of the histogram of a field. */
export interface Histogram {
    /** How far the panels of x, y, z and w reach on both sides of their middles, in the object's units. */
    reach: [number, number, number, number];
    /** The values at the lower and the upper edge. */
    range: [number, number];
    /** The levels that are drawn as lines. */
    levels: { value: number; color: number }[];
}

export interface Slices {
    type: "slices";
    id?: number;
    revision: number;
    /** Present if the surfaces of a field are coarser than usual; a finer picture of the same revision follows. */
    draft?: true;
    scene: SceneDescription;
    /** x, y, z, w of each vertex of the rotated polytope; empty if they are not shown, and for fields. */
    coordinates: Float32Array;
    /** The density of the lines (0 … 255), row by row from the top, or the histogram of a field; else empty. */
    density: Uint8Array;
    /** The scales of the histogram of a field; absent if none is drawn. */
    histogram?: Histogram;
    /** The names of the focus slice; see State. */
    section: { name: string; vertices: string };
    /** What shows the highlighted element; absent if there is none. */
    highlight?: Highlight;
    slices: Slice[];
    /** Absent if it is not shown. */
    projection?: ObjectProjection;
    /** Present only in the matrix view. */
    matrix?: SectionMatrix;
}

/** What the picture shows at a point; only `highlight`, which is null, if that is nothing. */
export interface At {
    type: "at";
    id?: number;
    revision: number;
    highlight: PolytopeElement | null;
    in?: "slice" | "projection" | "coordinates" | "matrix";
    /** In a panel of the matrix: the point x, y, z, w that it shows there. */
    point?: [number, number, number, number];
    slice?: number;
    w?: number;
    least_w?: number;
    most_w?: number;
    /** Of a vertex: its coordinates in the file, before the rotation. */
    place?: [number, number, number, number];
    vertices?: number;
    kind?: number;
    name?: string;
}

/** A w at which the section of the object changes its type. */
export interface CriticalSection {
    w: number;
    change: "vertices" | "appears" | "vanishes" | "merge" | "split" | "handle" | "cavity";
    /** Of a polytope or a point cloud: how many vertices lie there. */
    vertices?: number;
    /** Of a field: the index of the level, and the topology of its body below and above w. */
    level?: number;
    components?: [number, number];
    cavities?: [number, number];
    euler?: [number, number];
}

/** All critical w of the object in its orientation, in ascending order. */
export interface Critical {
    type: "critical";
    id?: number;
    revision: number;
    least_w: number;
    most_w: number;
    tolerance: number;
    resolution: number;
    sections: CriticalSection[];
}

export type Message =
    | Welcome
    | State
    | At
    | Critical
    | Done
    | Pong
    | ErrorMessage
    | Catalogue
    | Keymap
    | Address
    | Slices;
