// Types for the slices message, as they are after decoding: arrays of numbers are typed arrays, whichever encoding the
// message has. Angles are in radians. Lengths are in the polytope's units, except where world units are stated (in which
// the polytope's circumradius is 1 if there are 21 slices).

import type { Projection, View } from "./messages.js";
import type { Parts, Vector, Viewport } from "./types.js";

/** An array of integers. With CBOR, its width is the least that the largest value fits into. */
export type Integers = Uint8Array | Uint16Array | Uint32Array;

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
