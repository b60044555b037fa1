// Types of the slices message after decoding. Long arrays of numbers are typed arrays, in every encoding. Angles are in
// radians. Lengths are in the polytope's units, except where world units are stated. In world units, the polytope's
// circumradius is 1, except in an oval that does not have 21 slices: with more slices, the circumradius is less than 1,
// and with fewer, greater.

import type { AxisUnits, Projection, View } from "./messages.js";
import type { Parts, Vector, Viewport } from "./types.js";

/** An array of integers. In binary encodings, it has the narrowest of these types that can hold its largest value. */
export type Integers = Uint8Array | Uint16Array | Uint32Array;

/**
 * How to draw the slices. A client that follows this description draws the same picture as the server, in the size
 * `viewport`.
 */
export interface SceneDescription {
    view: View;
    shown: Parts;
    viewport: Viewport;
    /**
     * Lengths are in world units. `fov` is the vertical field of view. `shift` moves the picture right and up by these
     * fractions of the viewport's width and height.
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
    /** The circumradius of the polytope, in the polytope's units. */
    circumradius: number;
    /** The radii of the balls at vertices and of the bars along edges, in world units. */
    ball: number;
    bar: number;
    /** The opacity of a face, from 0 to 1. It is 1 if faces may cross each other, or if the object is a surface. */
    opacity: number;
    /** The factor by which the opacity of a faded ball, bar or face is multiplied. */
    faded: number;
    /** `direction` points toward the light, in camera coordinates: x to the right, y up, z toward the viewer. */
    light: { direction: Vector; ambient: number; diffuse: number; specular: number; shininess: number };
    /**
     * Colors as 0xRRGGBB: `zero` is for the zero lines of the parallel coordinates, and `cells` has one for each cell.
     * For a surface whose 2-faces the projection shows, it has one for each 2-face, or a single one for all.
     */
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
    /** How to draw the surfaces of a field, from the innermost level to the outermost; absent if none are drawn. */
    surfaces?: SurfaceLevel[];
    /**
     * The color of the fog for each value in Fog.values, 0xAARRGGBB; a plain array in JSON. Absent if there is no fog.
     */
    fog?: { table: Integers };
    /** For a field: the units of the axes after the rotation, as far as they are known; absent if none is known. */
    units?: AxisUnits;
    // The lengths of the next three members are fractions of the viewport's height.

    /**
     * The axes in the upper left corner: `x` and `y` are the distances of their center from the left and top edges of
     * the picture, and `length` is the length of each axis.
     */
    axes: { x: number; y: number; length: number };
    /**
     * The layout of the parallel coordinates, measured from the lower left corner. Vertex i is in row i / per_row (from
     * the top) and column i % per_row. `zero` is the height of the top row's zero line. `row_step`, `column_step` and
     * `line_step` are the distances from each row to the next one below, from each column to the next, and between the
     * four lines of a column. A coordinate c is drawn as a vertical line of the length c · amplitude / circumradius.
     * `named`: whether names are written below the columns.
     */
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
        /** The number of columns of Slices.density; 0 if each coordinate is drawn as a line instead. */
        columns: number;
        /** The width of each of the four panels of a field's histogram; 0 if no histogram is drawn. */
        panel: number;
    };
    /** The font size of a label whose `label_size` is 1. */
    text: number;
}

/**
 * The faces of a slice or of the projected object as triangles. `points` has x, y, z of each point, `triangles` three
 * indices of points for each triangle. For each triangle, `tints` has the index of the cell that determines the
 * triangle's color, and `seen` has the triangle's visibility, a number as in Elements. The triangles of a face form
 * convex polygons: those of a polygon follow one another and have the same first point, and each one begins its second
 * side at the third point of the one before.
 */
export interface Fill {
    points: Float32Array;
    triangles: Uint32Array;
    tints: Uint32Array;
    seen?: Uint32Array;
}

/** The surfaces of a field in one slice. */
export interface Surface {
    /** The color of all surfaces of the slice, instead of the levels' colors; present only with the coloring "w". */
    color?: number;
    /** x, y, z, x, y, z, … in the coordinates of the slice. */
    points: Float32Array;
    /** The outward unit normal of the level set at each point. Caps do not use it, because they are flat. */
    normals: Float32Array;
    /** Three indices of points for each triangle, counterclockwise as seen from outside. */
    triangles: Integers;
    /** For each triangle, the index of its level in the `levels` of the state. */
    level: Uint8Array;
    /** For each triangle: 1 if it belongs to a cap, which closes a surface at the boundary of the box; else 0. */
    cap: Uint8Array;
    /** The color of each point, 0xRRGGBB; present only with the coloring "growth" or "value". */
    colors?: Uint32Array;
    /** For each point, the color that it has in triangles of caps; present only if the caps are colored by value. */
    cap_colors?: Uint32Array;
}

/** The values of a field in one slice, on a lattice whose point (i, j, k) lies at min + step · (i, j, k). */
export interface Fog {
    /** The number of points along x, y and z. */
    size: Vector;
    min: Vector;
    step: number;
    /** The half-spaces n · p ≤ d that contain the fog, with unit vectors n: nx, ny, nz, d, nx, ny, nz, d, … */
    walls: Float32Array;
    /** For each point, with x fastest: 0 where the field has no value, else an index into scene.fog.table. */
    values: Uint8Array;
}

/** How the surface of one level of a field is drawn. */
export interface SurfaceLevel {
    /** The index of the level in the `levels` of the state. */
    level: number;
    /** 0xRRGGBB. */
    color: number;
    /** From 0 to 1. */
    opacity: number;
    /** Whether the caps of the level are drawn. */
    caps: boolean;
}

/** The vertices, edges and faces of a slice, or of a part of the projection. */
export interface Elements {
    /** x, y, z, x, y, z, … */
    vertices: Float32Array;
    /** Two indices of vertices for each edge. */
    edges: Uint32Array;
    /** Face f has the vertices corners[begin[f]] … corners[begin[f + 1] − 1], counterclockwise as seen from outside. */
    faces: { begin: Uint32Array; corners: Uint32Array };
    /**
     * A number for each vertex, edge and face, which says from what element of the 4-D polytope it was cut:
     * - a vertex: e if it was cut from edge e; (number of edges) + v if it is vertex v of the polytope itself;
     * - an edge: f if it was cut from 2-face f; (number of 2-faces) + e if it is edge e of the polytope itself;
     * - a face: c if it was cut from cell c; (number of cells) + f if it is 2-face f of the polytope itself.
     *
     * A slice contains elements of the polytope itself if they lie in its hyperplane. The part of the projection that
     * shows the whole object contains only such elements.
     */
    of: { vertices: Uint32Array; edges: Uint32Array; faces: Uint32Array };
    /** The index of the cell that determines the color of each face; if absent, `of.faces` has these indices. */
    tints?: Uint32Array;
    /** The visibility of each element: 2 full, 1 faded, 0 hidden; absent if all are fully visible. */
    seen?: { vertices: Uint32Array; edges: Uint32Array; faces: Uint32Array };
    /**
     * For each vertex, the radius of its ball, as a multiple of scene.ball or, in the projection, of the part's `ball`;
     * and the opacity of the ball. Absent if all these numbers are 1.
     */
    balls?: { scale: Float32Array; opacity: Float32Array };
    /**
     * The triangles to draw instead of `faces`: present in slices, which then need a depth buffer, if faces may cross
     * each other; and in the whole object of the projection if a 2-face is not convex.
     */
    fill?: Fill;
}

export interface Slice extends Elements {
    /**
     * The slice lies in the hyperplane w = offset + index · spacing, with `offset` and `spacing` from the `slices` of
     * the state. w is measured from the object's center.
     */
    index: number;
    w: number;
    /** The surfaces of a field; absent for other objects, or if the hyperplane meets no surface. */
    surface?: Surface;
    /** The fog of a field; absent for other objects, or if the slice has no fog. */
    fog?: Fog;
    /** The world position of the slice's origin: a vertex p is drawn at position + scene.scale · p. */
    position: Vector;
    label: string;
    /** The label is centered below this world position. */
    label_at: Vector;
    /** The font size of the label, as a multiple of SceneDescription.text; may be larger than 1. */
    label_size: number;
    /** Whether the slice is the focus slice. */
    focus: boolean;
    /** Whether the view shows the slice. */
    drawn: boolean;
}

/**
 * Where the picture shows the highlighted element. A vertex of a slice or of the projection is highlighted if its
 * number in `of.vertices` (see Elements) is in `vertices`; an edge, if its number in `of.edges` is in `edges`.
 * `own_vertices` has the element's own vertices: vertex v of the polytope has the coordinates 4v … 4v + 3 in
 * Slices.coordinates.
 */
export interface Highlight {
    vertices: ArrayLike<number> & Iterable<number>;
    edges: ArrayLike<number> & Iterable<number>;
    own_vertices: ArrayLike<number> & Iterable<number>;
}

/** How a part of the projection is drawn. */
export interface ProjectionLook {
    /** The radii of balls and bars, in world units. With the radius 0, they are not drawn. */
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
    /** The w of the 4-D eye of the perspective projection, in circumradii; without effect on the orthogonal one. */
    eye: number;
    /** The world position of the center of the projection: a vertex p is drawn at position + scale · p. */
    position: Vector;
    scale: number;
    /**
     * For a field whose surfaces are shown: the surface of the focus slice is also drawn in the projection, its point p
     * at position + surface_scale · p. Absent otherwise.
     */
    surface_scale?: number;
    /**
     * Whether the search for what lies behind other cells was given up, because it takes more steps than the server
     * allows, so that without shown.back only the elements of cells turned away from the 4-D eye are left out. Absent
     * otherwise.
     */
    only_turned_away?: boolean;
    /** The whole object; then the section by the focus hyperplane or, if shown.sections is true, by each hyperplane. */
    parts: (Elements & ProjectionLook)[];
}

/** A line along which a field has the value of a level. A closed line ends at its first point. */
export interface Contour {
    /** An index into the `levels` of the state. The entry of scene.surfaces with this `level` has the line's color. */
    level: number;
    /** The points' coordinates along the two axes of the section, in the object's units. */
    points: [number, number][];
}

/** The section of the object by a plane that is parallel to two coordinate axes. */
export interface PlanarSection {
    /** 0 to 3 for x, y, z, w; the smaller number is first. */
    axes: [number, number];
    /** The points' coordinates along the two axes, in the object's units. */
    points: [number, number][];
    /** Two indices of points for each edge. */
    edges: [number, number][];
    /**
     * The indices of the points in their order along the boundary; empty if the edges do not form a single closed
     * polygon.
     */
    boundary: number[];
    /**
     * The element of the polytope that each point and edge was cut from. For a point: f for 2-face f, faces + e for
     * edge e, and faces + edges + v for vertex v. For an edge: c for cell c, and cells + f for 2-face f. Here, `faces`,
     * `edges` and `cells` stand for the polytope's numbers of 2-faces, edges and cells.
     */
    of: { points: number[]; edges: number[] };
    /** The index of the cell that determines the color of each edge. */
    tints: number[];
    /** The visibility of each element: 2 full, 1 faded, 0 hidden; absent if all are fully visible. */
    seen?: { points: number[]; edges: number[] };
    /** The radius of each point, as a multiple of SectionMatrix.ball, and its opacity; absent if all are 1. */
    balls?: { scale: number[]; opacity: number[] };
    /** The contours of a field; absent for other objects, and if surfaces are not shown. */
    contours?: Contour[];
}

/**
 * The matrix of planar sections. The panel in row i and column j, from the upper left, shows the section by the plane
 * through the focus point that is parallel to the axes i and j: axis j to the right, axis i upward. Lengths are
 * fractions of the viewport's height, unless another unit is stated.
 */
export interface SectionMatrix {
    /** The distances of the lower left corner of the matrix from the left and the bottom edge of the viewport. */
    left: number;
    bottom: number;
    /** The side of a panel, and the distance from the left edge of a panel to the left edge of the next. */
    panel: number;
    step: number;
    line_width: number;
    /** The radius of points. */
    ball: number;
    /** The distance from the center of a panel, which shows the origin, to the sides of the panel, in object units. */
    reach: number;
    /** The focus point x, y, z, w, through which all planes pass, in object units from the object's center. */
    point: [number, number, number, number];
    /** The sections by the planes xy, xz, yz, xw, yw and zw, in this order. */
    sections: PlanarSection[];
}

/** The scales of the histogram of a field. */
export interface HistogramScales {
    /** The coordinates at the right edges of the panels of x, y, z and w; those at the left edges are the negatives. */
    reach: [number, number, number, number];
    /** The values of the field at the lower and the upper edge of the panels. */
    range: [number, number];
    /** The levels that are drawn as lines, with colors 0xRRGGBB. */
    levels: { value: number; color: number }[];
    /** What the values measure, such as "temperature, K"; absent if it is not known. */
    quantity?: string;
}

export interface Slices {
    type: "slices";
    id?: number;
    revision: number;
    /** Present if the surfaces of a field are coarser than usual. A finer picture of the same revision follows. */
    draft?: true;
    scene: SceneDescription;
    /** x, y, z, w of each vertex of the rotated polytope; empty for fields, or if the coordinates are not shown. */
    coordinates: Float32Array;
    /**
     * The pixels of the density strip that replaces the parallel coordinates of many vertices, or of a field's
     * histogram: values 0 … 255, row by row from the top (protocol/README.md, "slices"). Empty if neither is drawn.
     */
    density: Uint8Array;
    /** The scales of the histogram of a field; absent if none is drawn. */
    histogram?: HistogramScales;
    /**
     * `name` is the name of the focus slice; `vertices` is the name of the convex hull of those vertices of the
     * polytope that lie in the focus slice. See `section` in State.
     */
    section: { name: string; vertices: string };
    /** Where the picture shows the highlighted element; absent if no element is highlighted. */
    highlight?: Highlight;
    slices: Slice[];
    /** The projection of the whole object; absent if it is not shown. */
    projection?: ObjectProjection;
    /** Present only in the matrix view. */
    matrix?: SectionMatrix;
}
