// Types for the messages of protocol/README.md. Generated from the schemas in protocol/schema/ by tests/lint --fix.

export type Request =
    | Address
    | CommandRequest
    | GetRequest
    | HelloRequest
    | KeyRequest
    | LoadRequest
    | MeasureRequest
    | PingRequest
    | RandomRequest
    | RedoRequest
    | ResetRequest
    | RotateRequest
    | SetRequest
    | ShownRequest
    | TowardRequest
    | UndoRequest;
/**
 * The kind of element. The points of a point cloud are vertices.
 */
export type ElementKind = "vertex" | "edge" | "face" | "cell";
/**
 * What follows each change: nothing, as if absent, `slices` messages, or frames.
 */
export type Stream = "none" | "geometry" | "frames";
/**
 * The encoding of `slices` messages. `"json"` if absent.
 */
export type Encoding = "json" | "cbor" | "msgpack" | "bjdata";
/**
 * Which pictures this client gets while the `background` of the session is `auto`. `"dark"` if absent.
 */
export type Scheme = "dark" | "light";
export type Plane = "xy" | "xz" | "xw" | "yz" | "yw" | "zw";
/**
 * What is shown: all slices in the oval; only the focus slice (single); the focus slice beside the matrix of planar sections; or all slices at the same size, in a straight row in order of w from the left (strip), in a straight column with the largest w at the top (column), or in as many rows as make them largest, in order of w from left to right and from top to bottom (grid).
 */
export type View = "oval" | "single" | "matrix" | "strip" | "column" | "grid";
/**
 * What the colors of faces show: see the list below this table; for the surfaces of fields, see Fields.
 */
export type Coloring = "cell" | "kind" | "w" | "plain" | "light" | "growth" | "value";
/**
 * The background of pictures; the other colors are chosen for it. See Backgrounds.
 */
export type Background = "auto" | "dark" | "light" | "white" | "transparent";
/**
 * For fields only: the caps of the surfaces, where the boundary of the box cuts through the body: in the color of the surface, colored by value, or not drawn. Exported bodies have caps in any case.
 */
export type Caps = "plain" | "value" | "open";
/**
 * For fields only: whether the bodies are where the function is below a level, or above it. A change of the object sets it to `below` for a formula and `above` for an array.
 */
export type Inside = "below" | "above";
/**
 * The domain. The object's origin is its center.
 */
export type Box = [Interval, Interval, Interval, Interval];
/**
 * The projection of the whole polytope in the middle of the oval: none, from an eye on the positive w axis, or parallel to the w axis.
 */
export type Projection = "off" | "perspective" | "orthogonal";
/**
 * The last rotation, for `.` and the space bar; null changes nothing.
 */
export type Turn = {
    /**
     * Each plane at most once. R_ab turns the +a axis toward the +b axis. In several planes the polytope turns at the same time: two perpendicular planes (xy and zw, xz and yw, xw and yz) give a double rotation, planes with a common axis a rotation in oblique planes.
     */
    planes: Plane[];
    /**
     * One angle for each plane, in radians.
     */
    angles: number[];
} | null;
export type Answer =
    Address | At | Catalogue | Critical | Done | ErrorMessage | Keymap | Measured | Pong | State | Welcome;
/**
 * A request that may change the session. The server answers it with `done`.
 */
export type Command =
    | Address
    | CommandRequest
    | KeyRequest
    | LoadRequest
    | RandomRequest
    | RedoRequest
    | ResetRequest
    | RotateRequest
    | SetRequest
    | TowardRequest
    | UndoRequest;
export type Interval = [number, number];

/**
 * To the server: shows the view that the query of an address describes, as one undo step. From the server: the query that describes the view of the session, as the answer to a get.
 */
export interface Address {
    type: "address";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
    /**
     * The query of an address, without the question mark, percent-encoded, such as `polytope=24-cell&rotate=xw:0.3`. The parameters are those of `frame.png`; `width`, `height` and `token` are ignored.
     */
    query: string;
}
/**
 * A line such as "polytope 24-cell", "set slices=31" or "rotate xw,yz pi/8 pi/sqrt(3)-pi/8".
 */
export interface CommandRequest {
    type: "command";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
    /**
     * The command, with or without the leading `:`.
     */
    line: string;
}
/**
 * Answered by the requested message with the same id; a frame or a file is a binary message followed by done.
 */
export interface GetRequest {
    type: "get";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
    /**
     * What to get.
     */
    what: "state" | "slices" | "frame" | "at" | "file" | "critical" | "catalogue" | "keymap" | "address";
    /**
     * The width of `slices`, of a `frame`, or of the picture for `at`; together with `height`. By default the size in `hello`.
     */
    width?: number;
    /**
     * The height of `slices`, of a `frame`, or of the picture for `at`; together with `width`. By default the size in `hello`.
     */
    height?: number;
    /**
     * The background of `slices` or a `frame`; by default that of the session.
     */
    background?: Background;
    /**
     * The element that is highlighted in `slices` or a `frame`; by default that of the session.
     */
    highlight?: {
        element: ElementKind;
        /**
         * The element, counted from 0 among those of its kind.
         */
        number: number;
    } | null;
    /**
     * A coordinate of the point, for `at`.
     */
    x?: number;
    /**
     * A coordinate of the point, for `at`.
     */
    y?: number;
    /**
     * For `at`, instead of `x` and `y`: a point of a field, whose values are asked, after the rotation and in the coordinates of the object's file, as in `set`.
     */
    point?: [number, number, number, number];
    /**
     * Required for a `file`; see Files.
     */
    format?: string;
    /**
     * What a `file` contains: the focus slice, all slices, the highlighted element alone, the critical w, the whole object in four dimensions, the parallel coordinates or the histogram of a field, the projection of the whole object, or the matrix of planar sections. The first one of the format is the default.
     */
    of?: "focus" | "oval" | "highlight" | "critical" | "object" | "coordinates" | "projection" | "matrix";
    /**
     * For a `file` with bodies: filled, or balls and bars merged into one body. `"frame"` is the former name of `"skeleton"`.
     */
    body?: "solid" | "skeleton" | "frame";
    /**
     * In millimeters: the diameter of the polytope's circumscribed sphere, by default 60; or the width or height of a drawing, whichever is larger, by default 170.
     */
    size?: number;
    /**
     * For a `file` of the oval: the w of its slices, in the coordinates of the object's file, instead of those of the session; at most as many as the limit `slices`. Not together with `fit`.
     */
    at?: number[] | string;
    /**
     * For a `file` of the oval: the number of its slices, spread evenly over the polytope's extent along w, instead of those of the session. Not together with `at`.
     */
    fit?: number;
    /**
     * For a `file` with bodies: whether the polytope's name and w are absent (default), engraved into a face, or on a separate plate.
     */
    label?: "none" | "engraved" | "separate";
    /**
     * For a `file` with the surfaces of a field: whether they are cut exactly, as measured in CSV files. Other files ignore it.
     */
    exact?: boolean;
}
/**
 * The first message of a connection. Sent again, it changes the stream, the encoding, the scheme and the size. Answered by welcome, then by state and a picture.
 */
export interface HelloRequest {
    type: "hello";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
    stream?: Stream;
    encoding?: Encoding;
    scheme?: Scheme;
    /**
     * The width of frames; with geometry, of the window that the picture is laid out for. If absent, 1280, or as near to it as the limits in `welcome` allow.
     */
    width?: number;
    /**
     * The height of frames; with geometry, of the window that the picture is laid out for. If absent, 720, or as near to it as the limits in `welcome` allow.
     */
    height?: number;
    /**
     * The token of the session in the path. Required if the path names a session.
     */
    token?: string;
}
/**
 * A key press. The key table lists the keys and their actions; clients need not know the actions.
 */
export interface KeyRequest {
    type: "key";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
    /**
     * The key as typed, as in `KeyboardEvent.key`: `"y"`, `"K"`, `"2"`, `" "`, `"["`. For a digit key, the digit on the key, even if Shift types another character. An upper-case letter means the letter with Shift.
     */
    key: string;
    /**
     * Whether Shift is held. Ignored for keys other than letters and digits.
     */
    shift?: boolean;
    /**
     * Whether Ctrl is held.
     */
    ctrl?: boolean;
}
/**
 * Loads an object and shows it. A set message can select it again by its name.
 */
export interface LoadRequest {
    type: "load";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
    /**
     * The object's name, which must not be in the catalogue. Replaces an object loaded under the same name.
     */
    name: string;
    /**
     * The format of `data`: `"off"` is 4OFF, `"points"` and `"cloud"` are tables of points, and `"formula"` is a formula, which makes a field as the others do. Required with `data`; with `path`, it may also be `"zarr"`.
     */
    format?: string;
    /**
     * The text of the file, which is in Base64 if it is an array, or the formula. Absent with `path`.
     */
    data?: string;
    /**
     * An array in the server's data folder, as the catalogue lists it, instead of `data`. The format may then be absent.
     */
    path?: string;
    /**
     * Whether the load belongs to the undo step of the previous command, as when a slider changes a constant of a formula. If a field then replaces a field, `levels`, `inside` and `fog` stay the same; if both have the same circumradius, `slices` and `point` stay the same, too. False if absent.
     */
    continues?: boolean;
    /**
     * For a formula: the box on which it is shown, by default −2 to 2 along each axis. For an array: where its first and last samples lie, by default what the file states.
     */
    box?: Box;
    /**
     * The part that is read of an array in a Zarr folder of the [data folder](#the-data-folder), in the coordinates of its box: the samples that cover it. Along an axis where both ends are equal, the nearest sample. The whole array if it is absent.
     */
    region?: Box;
    /**
     * The axes of an array's dimensions, in the order of its indices in Python, such as `"tzyx"`; see Fields. What the file states if it is absent, else `"tzyx"`, or its end if there are fewer dimensions.
     */
    axes?: string;
    /**
     * The variable of a NetCDF file, or the path of an HDF5 dataset. The one with the most dimensions if it is absent.
     */
    variable?: string;
    /**
     * The formula of a second function, whose values color the surfaces of a formula or an array. It may use the names that the first formula defines.
     */
    values?: string;
    /**
     * The variable of the same file that is the second function of an array, with the same numbers of samples.
     */
    values_variable?: string;
    /**
     * For polytopes, surfaces and points: the point of the file's coordinates about which the object turns and around which its slices lie: `"object"`, its center; `"origin"`; or x, y, z, w. If it is absent, the center of an object that is far from the origin, else the origin. See Center.
     */
    center?: string | [number, number, number, number];
    /**
     * Whether the moments in the file are added to the array that is loaded under this name, at the end of w, instead of replacing it; false if absent. See Growing fields.
     */
    append?: boolean;
}
/**
 * Asks for a `measured`, which has the center and the length, area or volume of an element. It changes nothing. Errors: `out_of_range`, also if the object has no such element.
 */
export interface MeasureRequest {
    type: "measure";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
    /**
     * The kind of element. The points of a point cloud are vertices.
     */
    element: ElementKind;
    /**
     * The element, counted from 0 among those of its kind.
     */
    number: number;
    /**
     * Whether the answer also has `highlight` and `range`; false if absent.
     */
    highlight?: boolean;
}
/**
 * Asks for a `pong`, which tells how busy the server is. It changes nothing.
 */
export interface PingRequest {
    type: "ping";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
}
/**
 * The new orientation is random, and all rotations are equally probable (Haar measure), so the slices are sections of random direction. One undo step; it ends a motion toward an element. The same `seed` gives the same orientation on every server, whatever the orientation was.
 */
export interface RandomRequest {
    type: "random";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
    /**
     * Determines the orientation. If absent, the server draws a seed.
     */
    seed?: number;
}
/**
 * Redoes one step that was undone. Fails with nothing_to_undo if there is none.
 */
export interface RedoRequest {
    type: "redo";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
}
/**
 * Restores the initial orientation and focus, and stops continuous turning and playing. All other settings stay the same.
 */
export interface ResetRequest {
    type: "reset";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
}
/**
 * Turns through all angles at the same time. The rotation is extrinsic: it multiplies the orientation from the left.
 */
export interface RotateRequest {
    type: "rotate";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
    /**
     * Each plane at most once. R_ab turns the +a axis toward the +b axis. In several planes the polytope turns at the same time: two perpendicular planes (xy and zw, xz and yw, xw and yz) give a double rotation, planes with a common axis a rotation in oblique planes.
     */
    planes: Plane[];
    /**
     * One angle for each plane, in radians.
     */
    angles: number[];
    /**
     * Whether the rotation belongs to the undo step of the previous command, as the parts of one gesture do; false if absent.
     */
    continues?: boolean;
}
/**
 * Sets every member that is present; the others keep their values. Changing the type of a state makes it a valid set.
 */
export interface SetRequest {
    type: "set";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
    /**
     * Ignored. Allowed so that a state can be sent back as a set.
     */
    revision?: number;
    /**
     * Ignored. Allowed so that a state can be sent back as a set.
     */
    object_serial?: number;
    /**
     * Whether the change belongs to the undo step of the previous command, as the parts of one gesture do.
     */
    continues?: boolean;
    /**
     * Ignored. Allowed so that a state can be sent back as a set.
     */
    draft?: boolean;
    /**
     * Ignored. Allowed so that a state can be sent back as a set.
     */
    moving?: boolean;
    /**
     * Ignored. Allowed so that a state can be sent back as a set.
     */
    section?: {
        /**
         * w of the focus slice.
         */
        w?: number;
        /**
         * What the focus slice is, such as "icosahedron"; empty if it has no name.
         */
        name?: string;
        /**
         * The convex hull of the polytope's vertices in the hyperplane, as in Coxeter's tables of sections; empty if it has no name.
         */
        vertices?: string;
        coordinate?: CommonCoordinate;
    };
    /**
     * The polytope. Another one sets focus and offset to 0, and the spacing keeps its ratio to the circumradius.
     */
    polytope?:
        | string
        | {
              name: string;
              /**
               * The number of vertices.
               */
              vertices?: number;
              /**
               * The number of edges.
               */
              edges?: number;
              /**
               * The number of 2-faces.
               */
              faces?: number;
              /**
               * The number of cells.
               */
              cells?: number;
              /**
               * Ignored. Allowed so that a state can be sent back as a set.
               */
              kinds?: CellKind[];
              /**
               * Ignored.
               */
              center?: [number, number, number, number];
          };
    /**
     * How much space a unit of w is worth, if w is time: the object's w is multiplied by it. See Frames of reference.
     */
    pace?: number;
    /**
     * The velocity with which the observer moves, in units of x, y and z per unit of the object's own w: whatever moves with this velocity appears at rest.
     */
    follow?: [number, number, number];
    /**
     * The velocity of the observer to whose rest frame a Lorentz boost leads, where 1 is the speed of light in units of x, y and z per unit of w, after `pace` has scaled w.
     */
    boost?: [number, number, number];
    /**
     * The matrix M, where v' = M v maps the polytope's own coordinates to the rotated ones: a rotation matrix to within 1e-6, else `not_a_rotation`.
     */
    orientation?: [
        [number, number, number, number],
        [number, number, number, number],
        [number, number, number, number],
        [number, number, number, number]
    ];
    /**
     * α: the angle of the keys 2 … 7, and the first angle of the keys r, t and y.
     */
    alpha?: number;
    /**
     * β: the second angle of the keys r, t and y.
     */
    beta?: number;
    /**
     * The step by which the keys k, j, K and J change α and β.
     */
    step?: number;
    slices?: {
        /**
         * The number of slices; if set alone, the span (count − 1) · spacing stays the same.
         */
        count?: number;
        /**
         * δ, the distance between neighboring hyperplanes, in the polytope's units.
         */
        spacing?: number;
        /**
         * f, the index n of the focus slice, which lies in the hyperplane w = offset + n · spacing.
         */
        focus?: number;
        /**
         * w of the hyperplane n = 0, measured from the center.
         */
        offset?: number;
        /**
         * w of the focus slice, in the coordinates of the object's file: sets `focus` and `offset` such that the offset is at most half of the spacing.
         */
        w?: number;
    };
    /**
     * The focus point, through which the planes of the matrix view pass, in the coordinates of the object's file. Its w moves the focus slice as `slices.w` does, unless `slices` has `focus`, `offset` or `w`.
     */
    point?: [number, number, number, number];
    view?: View;
    /**
     * Continuous turning: in each second the object turns by 6 times the angles of the last rotation, in 60 steps; each step is a revision.
     */
    turning?: boolean;
    /**
     * Whether the focus moves from the lowest w of the object to the highest and back, again and again, in at most 60 steps per second; each step is a revision. Ended by whatever else sets `focus`, `offset`, `w` or `point`, by another object, and by `reset`.
     */
    playing?: boolean;
    /**
     * The speed of `playing`: at 1, the focus moves from one end to the other in 8 seconds, at 2 in 4 seconds.
     */
    speed?: number;
    /**
     * Which parts are drawn.
     */
    shown?: ShownParts;
    /**
     * How the viewer has moved the camera from its initial position. Not part of the undo history.
     */
    camera?: {
        /**
         * The rotation to the right about the vertical axis, in radians.
         */
        azimuth?: number;
        /**
         * The rotation upward, in radians.
         */
        elevation?: number;
        /**
         * The magnification; 1 initially.
         */
        zoom?: number;
    };
    color?: Coloring;
    background?: Background;
    /**
     * The factor by which the radii of all balls and bars are multiplied in slices, in the projection and in drawings. Exported bodies and the matrix of planar sections stay as they are.
     */
    thickness?: number;
    /**
     * The factor by which the opacity of translucent faces is multiplied in slices, in the projection and in drawings; they become at most opaque. Faces in slices of nonconvex polytopes are opaque in any case. The surfaces of fields and the matrix of planar sections stay as they are.
     */
    opacity?: number;
    caps?: Caps;
    /**
     * For fields only: the values at which surfaces are shown. A change of the object sets it to the object's own level.
     */
    levels?: number[];
    inside?: Inside;
    /**
     * For fields only: the transfer function of the fog that fills the slices: the opacity of a layer as thick as the circumradius, and the color, of each value; linear between the points, and constant beyond. An empty array (initially) means no fog. A change of the object empties it.
     */
    fog?: FogControlPoint[];
    field?: FieldDefinition;
    projection?: Projection;
    /**
     * The w of the eye of the perspective projection, in circumradii.
     */
    eye?: number;
    /**
     * Cells of these kinds are not drawn, nor are bars and balls that belong to no other cell. If only one of `hidden` and `faded` is set, its kinds are removed from the other; a kind in both is hidden. A change of the polytope empties both.
     */
    hidden?: number[];
    /**
     * Cells of these kinds are drawn faintly.
     */
    faded?: number[];
    /**
     * The element that is drawn in another color, in slices, projection and parallel coordinates; null if there is none. A change of the polytope sets it to null.
     */
    highlight?: {
        element: ElementKind;
        /**
         * The element, counted from 0 among those of its kind.
         */
        number: number;
    } | null;
    last?: Turn;
}
/**
 * Present for a field if all points of the focus slice have one coordinate in `box` in common, such as the time: unless a rotation or the frame of reference mixes the axes.
 */
export interface CommonCoordinate {
    /**
     * Its axis in `box`.
     */
    axis: "x" | "y" | "z" | "w";
    /**
     * Its value in the focus slice.
     */
    value: number;
    /**
     * Absent if it is not known.
     */
    unit?: string;
}
export interface CellKind {
    name: string;
    /**
     * The number of cells of this kind.
     */
    cells: number;
    /**
     * The color of this kind when the faces are colored by kind.
     */
    color?: number;
}
export interface FogControlPoint {
    value: number;
    opacity: number;
    color?: number;
}
/**
 * If it has a `formula`, the field called `polytope` is loaded first, as by `load`, unless the session has it; otherwise ignored.
 */
export interface FieldDefinition {
    /**
     * The function with the values of its constants. Absent for an array.
     */
    formula?: string;
    /**
     * Absent for a formula.
     */
    shape?: [number, number, number, number];
    /**
     * Absent for a formula.
     */
    range?: [number, number];
    /**
     * Present, and true, if the array is too large to read all of it.
     */
    estimated?: boolean;
    /**
     * The region of the array that was asked for. Present only for a part of an array in the data folder that was loaded with a region.
     */
    region?: Box;
    resolution?: Resolution;
    units?: AxisUnits;
    quantity?: Quantity;
    values?: ColoringValues;
    box: Box;
}
/**
 * Present only for a multiscale image in the data folder of which a region or a coarser level is or was shown.
 */
export interface Resolution {
    /**
     * The level that is shown; 0 is the finest.
     */
    level: number;
    /**
     * How many levels the image has.
     */
    levels: number;
    /**
     * Present, and true, if a finer level is to replace this one, as long as a client is connected.
     */
    refining?: boolean;
}
/**
 * The units of the coordinates in `box`, as the file of an array states them; those that are not known are absent. At most 64 bytes each.
 */
export interface AxisUnits {
    x?: string;
    y?: string;
    z?: string;
    w?: string;
}
/**
 * As the file of an array states it; what is not known is absent. At most 64 bytes each.
 */
export interface Quantity {
    /**
     * Such as "temperature".
     */
    name?: string;
    /**
     * Such as "K".
     */
    unit?: string;
}
/**
 * Present if there is a second function, or if the color or the caps show values.
 */
export interface ColoringValues {
    /**
     * Present if the second function is a formula.
     */
    formula?: string;
    /**
     * Present if the second function is an array.
     */
    variable?: string;
    /**
     * Of the second function, if it is an array.
     */
    quantity?: Quantity;
    /**
     * The range of the values on the box, without rare values far from the others. If 0 is in its middle four fifths, the scale is symmetric to 0.
     */
    range: [number, number];
    /**
     * The colors of nine values, from one end of the scale to the other at equal distances.
     */
    colors: number[];
}
/**
 * Acknowledges a picture of the stream. At any time, at most two pictures are sent but not acknowledged.
 */
export interface ShownRequest {
    type: "shown";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
    /**
     * The revision of the picture. All earlier pictures are acknowledged, too.
     */
    revision: number;
}
/**
 * The polytope moves there by the shortest rotation, at a quarter turn per second, as one undo step. Each step of the motion is a revision. The element ends in one hyperplane w = const.
 */
export interface TowardRequest {
    type: "toward";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
    /**
     * The kind of element. The points of a point cloud are vertices.
     */
    element: ElementKind;
    /**
     * The element, counted from 0. If absent, the one that is closest to +w or, if it is already there, the next one. If an element is highlighted, only those count that contain it or are contained in it, or itself if it is of this kind.
     */
    number?: number;
    /**
     * Whether to jump there instead of moving; false if absent.
     */
    immediately?: boolean;
}
/**
 * Undoes one step of the history. Fails with nothing_to_undo if there is none.
 */
export interface UndoRequest {
    type: "undo";
    /**
     * Chosen by the client; the answer or error has the same id.
     */
    id?: number;
}
/**
 * The answer to get with what: "at". Only type, id, revision, highlight and point are present if there is neither an element nor a surface of a field.
 */
export interface At {
    type: "at";
    /**
     * The id of the request that this message answers; absent if it had none.
     */
    id?: number;
    /**
     * The number of changes of the session's state so far.
     */
    revision: number;
    /**
     * The element at the point that is nearest to the viewer, as set takes it; null if there is none.
     */
    highlight: {
        element: ElementKind;
        /**
         * The element, counted from 0 among those of its kind.
         */
        number: number;
    } | null;
    /**
     * Where the element or the surface is shown.
     */
    in?: "slice" | "projection" | "coordinates" | "matrix";
    /**
     * In a slice: the index n of the hyperplane.
     */
    slice?: number;
    /**
     * In a slice: w of the hyperplane, in the coordinates of the object's file.
     */
    w?: number;
    /**
     * In a panel of the matrix: the point that it shows there, as set takes it.
     */
    point?: [number, number, number, number];
    /**
     * The smallest w of the element's vertices.
     */
    least_w?: number;
    /**
     * The largest w of the element's vertices.
     */
    most_w?: number;
    /**
     * Of a vertex: its coordinates in the object's file, before the rotation; of a field, those of the box. Of a point of a field: its coordinates in the box.
     */
    place?: [number, number, number, number];
    /**
     * On a surface or a contour of a field: the index of its level in levels of the state.
     */
    level?: number;
    /**
     * On a surface or a contour of a field: whether the point is on a cap, where the body of the level ends at the boundary of the box.
     */
    cap?: boolean;
    /**
     * Of a point of a field: the value of the function; on a surface or a contour, but not on a cap, that of the level. Absent if it has none there.
     */
    value?: number;
    /**
     * Of a point of a field: the value of the second function. Absent if there is none, or if it has none there.
     */
    second_value?: number;
    /**
     * Of a vertex, but of no field: its coordinates as the picture shows it, after the rotation, in the coordinates of the object's file.
     */
    coordinates?: [number, number, number, number];
    /**
     * The number of the element's vertices.
     */
    vertices?: number;
    /**
     * Of a cell: the index of its kind in state.polytope.kinds.
     */
    kind?: number;
    /**
     * Of a cell: the name of its kind. Of a 2-face: the name of its polygon, such as square, quadrilateral or pentagram.
     */
    name?: string;
}
/**
 * The polytopes known by name, in the order of the keys n and N. Also available at /api/v1/catalogue.
 */
export interface Catalogue {
    type: "catalogue";
    /**
     * The id of the request that this message answers; absent if it had none.
     */
    id?: number;
    polytopes: CatalogueEntry[];
}
export interface CatalogueEntry {
    name: string;
    /**
     * "regular", "star", "uniform A4", "uniform B4", "uniform F4", "uniform H4", "other", "prism", "antiprism prism" or "duoprism"; "fields" for a field; "loaded" for an object that was loaded into the session; or "data" for an array in the server's data folder, which load opens by its path.
     */
    family: string;
    aliases: string[];
    /**
     * In linear notation, such as "x4x3o3o"; empty if there is none.
     */
    diagram: string;
    /**
     * Empty if there is none.
     */
    schlaefli: string;
    /**
     * The number of vertices.
     */
    vertices: number;
    /**
     * The number of edges.
     */
    edges: number;
    /**
     * The number of 2-faces.
     */
    faces: number;
    /**
     * The number of cells.
     */
    cells: number;
    /**
     * The order of the full symmetry group, including reflections; absent for loaded polytopes.
     */
    symmetry_order?: number;
}
/**
 * The answer to get with what: "critical".
 */
export interface Critical {
    type: "critical";
    /**
     * The id of the request that this message answers; absent if it had none.
     */
    id?: number;
    /**
     * The number of changes of the session's state when the request was received.
     */
    revision: number;
    /**
     * The smallest w of the object, or of the box of a field.
     */
    least_w: number;
    /**
     * The largest w of the object, or of the box of a field.
     */
    most_w: number;
    /**
     * The width in w to which each change has been narrowed down.
     */
    tolerance: number;
    /**
     * Of a field: changes of one level that are closer than this in w count as one; 0 for other objects.
     */
    resolution: number;
    /**
     * In the order of w.
     */
    sections: CriticalSection[];
}
export interface CriticalSection {
    /**
     * w of the hyperplane.
     */
    w: number;
    /**
     * What happens while w increases.
     */
    change: "vertices" | "appears" | "vanishes" | "merge" | "split" | "handle" | "cavity";
    /**
     * Of a polytope, a surface or a point cloud: the number of vertices in the hyperplane.
     */
    vertices?: number;
    /**
     * Of a field: the index in levels of the level whose body changes.
     */
    level?: number;
    /**
     * Of a field: the number of connected components of the body below and above w.
     */
    components?: [number, number];
    /**
     * Of a field: the number of cavities in the body below and above w.
     */
    cavities?: [number, number];
    /**
     * Of a field: the Euler characteristic of the surface of the body below and above w.
     */
    euler?: [number, number];
}
/**
 * Answers a request that has an id and took effect, if no other message answers it.
 */
export interface Done {
    type: "done";
    /**
     * The id of the request that this message answers; absent if it had none.
     */
    id?: number;
    /**
     * The number of changes of the session's state so far.
     */
    revision: number;
    /**
     * The corrections made to a loaded file; or what an exported file lacks, such as slices that are empty. Absent if there were none.
     */
    warnings?: string[];
}
/**
 * A request was refused. The session is unchanged.
 */
export interface ErrorMessage {
    type: "error";
    /**
     * The id of the request that this message answers; absent if it had none.
     */
    id?: number;
    /**
     * errors.json gives the meaning of each code.
     */
    code:
        | "bad_json"
        | "bad_message"
        | "unknown_type"
        | "unknown_key"
        | "unknown_polytope"
        | "unknown_command"
        | "bad_expression"
        | "out_of_range"
        | "not_a_rotation"
        | "bad_polytope"
        | "bad_field"
        | "unsupported_format"
        | "no_body"
        | "nothing_to_undo"
        | "hello_first"
        | "not_found"
        | "bad_token"
        | "too_many"
        | "too_large"
        | "canceled"
        | "later_version"
        | "internal";
    /**
     * A sentence for the user: what was wrong, where, and what is allowed.
     */
    message: string;
}
/**
 * The keys, in the order of the help sheet. Also available at /api/v1/keymap.
 */
export interface Keymap {
    type: "keymap";
    /**
     * The id of the request that this message answers; absent if it had none.
     */
    id?: number;
    groups: {
        name: string;
        title: string;
    }[];
    keys: KeyBinding[];
}
export interface KeyBinding {
    /**
     * Two characters are a sequence of two keys; each is sent in its own message. Three or more are the name of one key, as in KeyboardEvent.key.
     */
    key: string;
    /**
     * If present, the key is recognized by this physical key, whichever character it types.
     */
    code?: string;
    /**
     * Whether Ctrl must be held.
     */
    ctrl?: boolean;
    /**
     * Shift with this key applies the inverse rotation. If absent, the key with Shift is another entry or has no action.
     */
    shift?: "inverse";
    name: string;
    action: string;
    planes?: Plane[];
    group: string;
    text: string;
    label: string;
    /**
     * The quantity that the key decreases. Another key of the group increases it; the page shows the two as one control with this name.
     */
    decreases?: string;
    /**
     * The quantity that the key increases.
     */
    increases?: string;
    /**
     * Whether the action is repeated while the button is held down.
     */
    repeats?: boolean;
    /**
     * The setting that is not off when the key has a visible effect; otherwise its button is disabled.
     */
    needs?: "projection";
    /**
     * The client handles this key itself; the server refuses it.
     */
    client?: boolean;
}
/**
 * Answers a `measure`. Sizes and coordinates are those of the file, for a field those of the box: neither the orientation nor the frame of reference changes them. A region that a star encloses n times counts n times, as in the CSV file.
 */
export interface Measured {
    type: "measured";
    /**
     * The id of the request that this message answers; absent if it had none.
     */
    id?: number;
    /**
     * The number of changes of the session's state so far.
     */
    revision: number;
    /**
     * Of an edge.
     */
    length?: number;
    /**
     * Of a 2-face.
     */
    area?: number;
    /**
     * Of a cell.
     */
    volume?: number;
    /**
     * The mean of the element's vertices; the place of a vertex.
     */
    center: [number, number, number, number];
    /**
     * Of a cell: the index of its kind in `polytope.kinds` of the `state`.
     */
    kind?: number;
    /**
     * Of the size of an element of a field's box, such as "m² s", if the units of the axes along which it extends are known.
     */
    unit?: string;
    /**
     * Of a 2-face: the name of its polygon, such as square, quadrilateral or pentagram.
     */
    name?: string;
    /**
     * If the request asks for it: what every picture draws in the color of the highlight if this element is highlighted, as in `slices`. It depends only on the object.
     */
    highlight?: {
        /**
         * The values of `of.vertices` with which vertices are drawn in the color of the highlight, in slices and projection.
         */
        vertices: number[];
        /**
         * The values of `of.edges` with which edges are drawn in the color of the highlight.
         */
        edges: number[];
        /**
         * The element's vertices, which are marked in the parallel coordinates.
         */
        own_vertices: number[];
    };
    /**
     * Together with `highlight`: the least and the greatest w of the element's vertices in the present orientation and frame of reference.
     */
    range?: [number, number];
}
/**
 * Answers a `ping`. Between two pongs, the threads were busy for the fraction Δ`busy` / (`workers` · Δ`time`) of the time.
 */
export interface Pong {
    type: "pong";
    /**
     * The id of the request that this message answers; absent if it had none.
     */
    id?: number;
    /**
     * The threads that slice and draw pictures.
     */
    workers: number;
    /**
     * The pictures of all clients that wait for one of these threads.
     */
    waiting: number;
    /**
     * The running time of all pictures that have ended, in seconds, added over all threads.
     */
    busy: number;
    /**
     * The time of a clock that never goes back, in seconds from an arbitrary start.
     */
    time: number;
}
/**
 * Everything that determines a picture except its size. Sent back as a set, it restores the picture. Each frame contains it in the iTXt chunk "oval4d".
 */
export interface State {
    type: "state";
    /**
     * The id of the request that this message answers; absent if it had none.
     */
    id?: number;
    /**
     * The number of changes of the session's state so far.
     */
    revision: number;
    /**
     * The serial number of the object that is shown, as it was built or loaded: states with equal numbers show the same object, only with other settings. Absent in pictures that belong to no session.
     */
    object_serial?: number;
    /**
     * Present if the surfaces of a field are coarser than usual, because it turns or changes quickly. A picture of the same revision without it follows once the field rests.
     */
    draft?: true;
    /**
     * The object that is shown.
     */
    polytope: {
        /**
         * The kinds of cells, the rarest first; a kind is numbered by its index here.
         */
        kinds: Required<CellKind>[];
        /**
         * The point of the file's coordinates about which the object turns, in the frame of reference. Absent if it is the origin.
         */
        center?: [number, number, number, number];
        name: string;
        /**
         * The number of vertices.
         */
        vertices: number;
        /**
         * The number of edges.
         */
        edges: number;
        /**
         * The number of 2-faces.
         */
        faces: number;
        /**
         * The number of cells.
         */
        cells: number;
    };
    slices: {
        /**
         * The number of slices; if set alone, the span (count − 1) · spacing stays the same.
         */
        count: number;
        /**
         * δ, the distance between neighboring hyperplanes, in the polytope's units.
         */
        spacing: number;
        /**
         * f, the index n of the focus slice, which lies in the hyperplane w = offset + n · spacing.
         */
        focus: number;
        /**
         * w of the hyperplane n = 0, measured from the center.
         */
        offset: number;
        /**
         * w of the focus slice, in the coordinates of the object's file: sets `focus` and `offset` such that the offset is at most half of the spacing.
         */
        w?: number;
    };
    /**
     * The focus point, through which the planes of the matrix view pass, in the coordinates of the object's file. Its w is that of the focus slice.
     */
    point: [number, number, number, number];
    /**
     * Whether something moves without further commands: the polytope turns continuously, an element is on its way to +w, or the focus plays.
     */
    moving: boolean;
    /**
     * Which parts are drawn.
     */
    shown: Required<ShownParts>;
    /**
     * How the viewer has moved the camera from its initial position. Not part of the undo history.
     */
    camera: {
        /**
         * The rotation to the right about the vertical axis, in radians.
         */
        azimuth: number;
        /**
         * The rotation upward, in radians.
         */
        elevation: number;
        /**
         * The magnification; 1 initially.
         */
        zoom: number;
    };
    /**
     * Present for fields only.
     */
    field?: FieldDefinition;
    /**
     * The section of the focus hyperplane. Names are those of regular polygons, Platonic, Archimedean, Catalan and Kepler–Poinsot solids, cuboids, and right prisms, antiprisms, pyramids and bipyramids over regular polygons.
     */
    section: {
        /**
         * w of the focus slice.
         */
        w: number;
        /**
         * What the focus slice is, such as "icosahedron"; empty if it has no name.
         */
        name: string;
        /**
         * The convex hull of the polytope's vertices in the hyperplane, as in Coxeter's tables of sections; empty if it has no name.
         */
        vertices: string;
        coordinate?: CommonCoordinate;
    };
    /**
     * How much space a unit of w is worth, if w is time: the object's w is multiplied by it. See Frames of reference.
     */
    pace: number;
    /**
     * The velocity with which the observer moves, in units of x, y and z per unit of the object's own w: whatever moves with this velocity appears at rest.
     */
    follow: [number, number, number];
    /**
     * The velocity of the observer to whose rest frame a Lorentz boost leads, where 1 is the speed of light in units of x, y and z per unit of w, after `pace` has scaled w.
     */
    boost: [number, number, number];
    /**
     * The matrix M, where v' = M v maps the polytope's own coordinates to the rotated ones: a rotation matrix to within 1e-6, else `not_a_rotation`.
     */
    orientation: [
        [number, number, number, number],
        [number, number, number, number],
        [number, number, number, number],
        [number, number, number, number]
    ];
    /**
     * α: the angle of the keys 2 … 7, and the first angle of the keys r, t and y.
     */
    alpha: number;
    /**
     * β: the second angle of the keys r, t and y.
     */
    beta: number;
    /**
     * The step by which the keys k, j, K and J change α and β.
     */
    step: number;
    view: View;
    /**
     * Continuous turning: in each second the object turns by 6 times the angles of the last rotation, in 60 steps; each step is a revision.
     */
    turning: boolean;
    /**
     * Whether the focus moves from the lowest w of the object to the highest and back, again and again, in at most 60 steps per second; each step is a revision. Ended by whatever else sets `focus`, `offset`, `w` or `point`, by another object, and by `reset`.
     */
    playing: boolean;
    /**
     * The speed of `playing`: at 1, the focus moves from one end to the other in 8 seconds, at 2 in 4 seconds.
     */
    speed: number;
    color: Coloring;
    background: Background;
    /**
     * The factor by which the radii of all balls and bars are multiplied in slices, in the projection and in drawings. Exported bodies and the matrix of planar sections stay as they are.
     */
    thickness: number;
    /**
     * The factor by which the opacity of translucent faces is multiplied in slices, in the projection and in drawings; they become at most opaque. Faces in slices of nonconvex polytopes are opaque in any case. The surfaces of fields and the matrix of planar sections stay as they are.
     */
    opacity: number;
    caps?: Caps;
    /**
     * For fields only: the values at which surfaces are shown. A change of the object sets it to the object's own level.
     */
    levels?: number[];
    inside?: Inside;
    /**
     * For fields only: the transfer function of the fog that fills the slices: the opacity of a layer as thick as the circumradius, and the color, of each value; linear between the points, and constant beyond. An empty array (initially) means no fog. A change of the object empties it.
     */
    fog?: FogControlPoint[];
    projection: Projection;
    /**
     * The w of the eye of the perspective projection, in circumradii.
     */
    eye: number;
    /**
     * Cells of these kinds are not drawn, nor are bars and balls that belong to no other cell. If only one of `hidden` and `faded` is set, its kinds are removed from the other; a kind in both is hidden. A change of the polytope empties both.
     */
    hidden: number[];
    /**
     * Cells of these kinds are drawn faintly.
     */
    faded: number[];
    /**
     * The element that is drawn in another color, in slices, projection and parallel coordinates; null if there is none. A change of the polytope sets it to null.
     */
    highlight: {
        element: ElementKind;
        /**
         * The element, counted from 0 among those of its kind.
         */
        number: number;
    } | null;
    last: Turn;
}
/**
 * Answers hello with the session and the limits of the server.
 */
export interface Welcome {
    type: "welcome";
    /**
     * The id of the request that this message answers; absent if it had none.
     */
    id?: number;
    /**
     * The name of the session, for the path /ws/{session}.
     */
    session: string;
    /**
     * Gives access to the session; keep it secret.
     */
    token: string;
    /**
     * The protocol version.
     */
    protocol: number;
    server: string;
    limits: Limits;
}
/**
 * The limits of the server, as the section on limits of README.md explains them.
 */
export interface Limits {
    message: number;
    request_bytes: number;
    upload: number;
    field_bytes: number;
    depth: number;
    requests_per_second: number;
    min_side: number;
    max_width: number;
    max_height: number;
    max_pixels: number;
    slice_edges: number;
    file_triangles: number;
    file_bytes: number;
    file_time: number;
    slices: number;
    shown_timeout: number;
}
/**
 * The messages that answer requests, by the types of the requests; without `get`, whose answer depends on `what`.
 */
export interface RequestAnswers {
    address: Done;
    command: Done;
    hello: Welcome;
    key: Done;
    load: Done;
    measure: Measured;
    ping: Pong;
    random: Done;
    redo: Done;
    reset: Done;
    rotate: Done;
    set: Done;
    shown: Done;
    toward: Done;
    undo: Done;
}
/**
 * The parts of a picture that can be shown or hidden: the object "shown" in set, state and slices.
 */
export interface ShownParts {
    /**
     * Whether faces are drawn.
     */
    faces?: boolean;
    /**
     * Whether bars are drawn at edges.
     */
    bars?: boolean;
    /**
     * Whether balls are drawn at vertices.
     */
    balls?: boolean;
    /**
     * Whether the parallel coordinates are drawn.
     */
    coordinates?: boolean;
    /**
     * Whether the w of each slice is written under it.
     */
    labels?: boolean;
    /**
     * Whether the projection of the whole polytope shows the 2-faces that bound its cells, or those of a surface.
     */
    cells?: boolean;
    /**
     * Whether the projection shows what the 4-D eye cannot see: elements that belong only to cells turned away from it and, of a polytope that is not convex, vertices, parts of edges and whole 2-faces behind other cells. Hidden kinds of cells hide nothing: the eye sees what is behind them.
     */
    back?: boolean;
    /**
     * Whether the projection shows the sections of all hyperplanes, not only that of the focus slice.
     */
    sections?: boolean;
}
