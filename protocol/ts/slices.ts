// The types of a decoded `slices` message. Long arrays of numbers are typed arrays, whatever the encoding. Angles are
// in radians. Lengths are in the polytope's units unless world units are stated. In an oval of 21 slices, the
// polytope's circumradius is 1 in world units; it is smaller with more slices, and larger with fewer.

import type { AxisUnits, Projection, View } from "./messages.js";
import type { Parts, Vector, Viewport } from "./types.js";

/** An array of integers. In binary encodings, it has the narrowest of these types that holds its largest value. */
export type Integers = Uint8Array | Uint16Array | Uint32Array;

/**
 * A description of how to draw the slices. A client that follows it draws the same picture as the server, in the size
 * `viewport`.
 */
export interface SceneDescription {
    view: View;
    shown: Parts;
    viewport: Viewport;
    /**
     * The camera. Lengths are in world units. `fov` is the vertical field of view. `shift` moves the picture right and
     * up, in fractions of the viewport's width and height.
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
    /** The number of world units per unit of the polytope. */
    scale: number;
    /** The circumradius of the polytope, in the polytope's units. */
    circumradius: number;
    /** The radii of the balls at vertices and of the bars along edges, in world units. */
    ball: number;
    bar: number;
    /** The opacity of a face, from 0 to 1. It is 1 if faces may cross each other or if the object is a surface. */
    opacity: number;
    /** The opacity of faded balls, bars and faces (see `seen` in Elements) is multiplied by this number. */
    faded: number;
    /**
     * The light. `direction` points toward the light, in camera coordinates: x to the right, y up, z toward the viewer.
     */
    light: { direction: Vector; ambient: number; diffuse: number; specular: number; shininess: number };
    /**
     * Colors as 0xRRGGBB. `zero` is for the zero lines of the parallel coordinates. `cells` has a color for each cell.
     * If the object is a surface whose 2-faces the projection shows, `cells` has a color for each 2-face, or a single
     * one for all.
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
    /**
     * How to draw the surfaces of a field, from the innermost to the outermost level. Absent if no surfaces are drawn.
     */
    surfaces?: SurfaceLevel[];
    /**
     * `table` has the color of the fog, 0xAARRGGBB, for each value in Fog.values. In JSON, `table` is a plain array.
     * Absent without fog.
     */
    fog?: { table: Integers };
    /** For a field: the known units of the axes after the rotation. Absent if no unit is known. */
    units?: AxisUnits;
    // The lengths in `axes`, `coordinates` and `text` are fractions of the viewport's height.

    /**
     * The axes in the upper left corner. `x` and `y` are the distances of their center from the left and top edges of
     * the picture. `length` is the length of each axis.
     */
    axes: { x: number; y: number; length: number };
    /**
     * The layout of the parallel coordinates, measured from the lower left corner. Vertex i is in row i / per_row (from
     * the top) and column i % per_row. `left` is the left edge of the first column, and `zero` the height of the zero
     * line of the top row. `row_step`, `column_step` and `line_step` are the distances between rows, between columns,
     * and between the four lines of a column. A coordinate c is drawn as a vertical line of length
     * c · amplitude / circumradius from the zero line. `named` tells whether names are written below the columns.
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
        /** The number of pixels in each row of Slices.density; 0 if each coordinate is drawn as a line. */
        columns: number;
        /** The width of each of the four panels of a field's histogram; 0 without a histogram. */
        panel: number;
    };
    /** The font size of a label whose `label_size` is 1. */
    text: number;
}

/**
 * Triangles that fill the faces of a slice or of the projected object. `points` has x, y, z of each point. `triangles`
 * has three indices of points for each triangle. `tints` has the index of the cell that determines each triangle's
 * color. `seen` has each triangle's visibility, as in Elements. The triangles of a face form convex polygons. The
 * triangles of a polygon are consecutive and have the same first point; the second point of each is the third point of
 * the one before.
 */
export interface Fill {
    points: Float32Array;
    triangles: Uint32Array;
    tints: Uint32Array;
    seen?: Uint32Array;
}

/** The surfaces of a field in one slice. */
export interface Surface {
    /** The color of all surfaces in the slice, in place of the levels' colors. Present only with the coloring "w". */
    color?: number;
    /** The coordinates x, y, z, x, y, z, … of the points, in the coordinate system of the slice. */
    points: Float32Array;
    /** The outward unit normal of the level set at each point. Caps are drawn with their own normals: they are flat. */
    normals: Float32Array;
    /** Three indices of points for each triangle, counterclockwise as seen from outside. */
    triangles: Integers;
    /** The level of each triangle, as an index into the `levels` of the state. */
    level: Uint8Array;
    /**
     * For each triangle: 1 if it belongs to a cap, 0 if not. Caps are flat, and close a body at the boundary of the
     * box.
     */
    cap: Uint8Array;
    /** The color of each point, 0xRRGGBB. Present only with the coloring "growth" or "value". */
    colors?: Uint32Array;
    /** The color of each point within caps. Present only if the caps are colored by value. */
    cap_colors?: Uint32Array;
}

/** The values of a field in one slice, on a lattice of points. Point (i, j, k) lies at min + step · (i, j, k). */
export interface Fog {
    /** The number of points along x, y and z. */
    size: Vector;
    min: Vector;
    step: number;
    /**
     * The half-spaces n · p ≤ d that contain the fog, with unit vectors n, as numbers nx, ny, nz, d, nx, ny, nz, d, …
     */
    walls: Float32Array;
    /**
     * For each lattice point, with x varying fastest: 0 where the field has no value, else an index into
     * scene.fog.table.
     */
    values: Uint8Array;
}

/** How the surface of one level of a field is drawn. */
export interface SurfaceLevel {
    /** The index of the level in the `levels` of the state. */
    level: number;
    /** The color of the surface, 0xRRGGBB. */
    color: number;
    /** The opacity of the surface, from 0 to 1. */
    opacity: number;
    /** Whether the caps of the level are drawn. */
    caps: boolean;
}

/** The vertices, edges and faces of a slice, or of a part of the projection. */
export interface Elements {
    /** The coordinates x, y, z, x, y, z, … of the vertices. */
    vertices: Float32Array;
    /** The indices of the two vertices of each edge. */
    edges: Uint32Array;
    /** Face f has the vertices corners[begin[f]] … corners[begin[f + 1] − 1], counterclockwise as seen from outside. */
    faces: { begin: Uint32Array; corners: Uint32Array };
    /**
     * A number for each vertex, edge and face. The number identifies the element of the 4-D polytope from which it was
     * cut:
     * - a vertex: e if it was cut from edge e; (number of edges) + v if it is vertex v of the polytope itself;
     * - an edge: f if it was cut from 2-face f; (number of 2-faces) + e if it is edge e of the polytope itself;
     * - a face: c if it was cut from cell c; (number of cells) + f if it is 2-face f of the polytope itself.
     *
     * A slice contains elements of the polytope itself if they lie in its hyperplane. The part of the projection that
     * shows the whole object contains only such elements, with one exception: where an edge ends because the rest of it
     * is hidden, the vertex at this end has the number of a vertex that was cut from the edge.
     */
    of: { vertices: Uint32Array; edges: Uint32Array; faces: Uint32Array };
    /** The index of the cell that determines the color of each face. If absent, `of.faces` has these indices. */
    tints?: Uint32Array;
    /** The visibility of each element: 2 is full, 1 is faded, 0 is hidden. Absent if all are fully visible. */
    seen?: { vertices: Uint32Array; edges: Uint32Array; faces: Uint32Array };
    /**
     * For each vertex, the radius of its ball, as a multiple of scene.ball or, in the projection, of the part's `ball`;
     * and the opacity of the ball. Absent if all these numbers are 1. In the projection without shown.back, the opacity
     * is 0 at hidden vertices, and where an edge ends because the rest of it is hidden.
     */
    balls?: { scale: Float32Array; opacity: Float32Array };
    /**
     * Triangles to draw instead of `faces`. Slices have them if faces may cross each other; they then need a depth
     * buffer. The whole object in the projection has them if a 2-face is not convex.
     */
    fill?: Fill;
}

export interface Slice extends Elements {
    /**
     * The number of the slice, which lies in the hyperplane w = offset + index · spacing, with `offset` and `spacing`
     * from the `slices` of the state. w is measured from the object's center.
     */
    index: number;
    w: number;
    /** The surfaces of a field in this slice. Absent for other objects, or if the hyperplane meets no surface. */
    surface?: Surface;
    /** The fog of a field in this slice. Absent for other objects, or without fog. */
    fog?: Fog;
    /** The world position of the slice's origin. A vertex p is drawn at position + scene.scale · p. */
    position: Vector;
    label: string;
    /** The point in world coordinates below which the label is centered. */
    label_at: Vector;
    /** The font size of the label, as a multiple of SceneDescription.text. It may exceed 1. */
    label_size: number;
    /** Whether the slice is the focus slice. */
    focus: boolean;
    /** Whether the view shows the slice. */
    drawn: boolean;
}

/**
 * Where the picture shows the highlighted element. A vertex of a slice or of the projection is highlighted if
 * `vertices` contains its number in `of.vertices` (see Elements); an edge, if `edges` contains its number in
 * `of.edges`. `own_vertices` are the element's own vertices. Vertex v of the polytope has the coordinates 4v … 4v + 3
 * in Slices.coordinates.
 */
export interface Highlight {
    vertices: ArrayLike<number> & Iterable<number>;
    edges: ArrayLike<number> & Iterable<number>;
    own_vertices: ArrayLike<number> & Iterable<number>;
}

/** How one part of the projection is drawn. */
export interface ProjectionLook {
    /** The radii of balls and bars, in world units. With the radius 0, balls or bars are not drawn. */
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
    /**
     * The w of the 4-D eye in the perspective projection, in circumradii. It does not affect the orthogonal projection.
     */
    eye: number;
    /** The world position of the projection's center. A vertex p is drawn at position + scale · p. */
    position: Vector;
    scale: number;
    /**
     * The scale of the focus slice's surface, which is also drawn in the projection: point p is at position +
     * surface_scale · p. Present only for a field whose surfaces are shown.
     */
    surface_scale?: number;
    /**
     * Present if the server has given up the search for what lies behind other cells, because it takes too many steps.
     * Then, without shown.back, only the elements of cells turned away from the 4-D eye are omitted.
     */
    only_turned_away?: boolean;
    /**
     * The parts of the projection. The first is the whole object; then follows its section by the focus hyperplane or,
     * if shown.sections is true, by each hyperplane.
     */
    parts: (Elements & ProjectionLook)[];
}

/** A line in a planar section along which a field has the value of a level. A closed line ends at its first point. */
export interface Contour {
    /**
     * An index into the `levels` of the state. The entry of scene.surfaces with the same `level` has the color of the
     * line.
     */
    level: number;
    /** The coordinates of the points along the two axes of the section, in the object's units. */
    points: [number, number][];
}

/** The section of the object by a plane that is parallel to two coordinate axes. */
export interface PlanarSection {
    /** The two axes, 0 to 3 for x, y, z, w, the smaller number first. */
    axes: [number, number];
    /** The coordinates of the points along the two axes, in the object's units. */
    points: [number, number][];
    /** The indices of the two points of each edge. */
    edges: [number, number][];
    /** The indices of the points in their order along the boundary. Empty unless the edges form one closed polygon. */
    boundary: number[];
    /**
     * The elements of the polytope from which the points and edges were cut. A point has the number f for 2-face f,
     * faces + e for edge e, and faces + edges + v for vertex v. An edge has the number c for cell c, and cells + f for
     * 2-face f. Here, `faces`, `edges` and `cells` are the polytope's numbers of 2-faces, edges and cells.
     */
    of: { points: number[]; edges: number[] };
    /** The index of the cell that determines the color of each edge. */
    tints: number[];
    /** The visibility of each point and edge: 2 is full, 1 is faded, 0 is hidden. Absent if all are fully visible. */
    seen?: { points: number[]; edges: number[] };
    /**
     * The radius of each point, as a multiple of SectionMatrix.ball, and its opacity. Absent if all these numbers are
     * 1.
     */
    balls?: { scale: number[]; opacity: number[] };
    /** The contours of a field. Absent for other objects, or if surfaces are not shown. */
    contours?: Contour[];
}

/**
 * The matrix of planar sections. Each panel shows the section by a plane through the focus point. In row i and column
 * j, counted from the upper left, the plane is parallel to axis j (to the right) and axis i (upward). Lengths are
 * fractions of the viewport's height unless another unit is stated.
 */
export interface SectionMatrix {
    /** The distances of the matrix's lower left corner from the left and bottom edges of the viewport. */
    left: number;
    bottom: number;
    /** `panel` is the side of a panel; `step` is the distance between the left edges of neighboring panels. */
    panel: number;
    step: number;
    line_width: number;
    /** The radius of points in the panels. */
    ball: number;
    /** The distance from the center of a panel, where the origin is, to its sides, in object units. */
    reach: number;
    /** The focus point x, y, z, w, in object units from the object's center. All planes pass through it. */
    point: [number, number, number, number];
    /** The sections by the planes xy, xz, yz, xw, yw and zw, in this order. */
    sections: PlanarSection[];
}

/** The scales of the histogram of a field. */
export interface HistogramScales {
    /**
     * The coordinates at the right edges of the panels of x, y, z and w. The left edges have the negative coordinates.
     */
    reach: [number, number, number, number];
    /** The values of the field at the lower and upper edges of the panels. */
    range: [number, number];
    /** The levels that are drawn as lines. Their colors are 0xRRGGBB. */
    levels: { value: number; color: number }[];
    /** The quantity that the values measure, such as "temperature, K". Absent if it is not known. */
    quantity?: string;
}

export interface Slices {
    type: "slices";
    id?: number;
    revision: number;
    /** Present if the surfaces of a field are coarser than usual. A finer picture of the same revision follows. */
    draft?: true;
    scene: SceneDescription;
    /**
     * The coordinates x, y, z, w of each vertex of the rotated polytope. Empty for fields, or if coordinates are not
     * shown.
     */
    coordinates: Float32Array;
    /**
     * The pixels of the density strip or of a field's histogram: values from 0 to 255, row by row from the top (see
     * "slices" in protocol/README.md). The strip replaces the parallel coordinates of many vertices. Empty if neither
     * is drawn.
     */
    density: Uint8Array;
    /** The scales of the histogram of a field. Absent without a histogram. */
    histogram?: HistogramScales;
    /**
     * `name` is the name of the focus slice. `vertices` is the name of the convex hull of the polytope's vertices that
     * lie in the focus slice. See `section` in State.
     */
    section: { name: string; vertices: string };
    /** Where the picture shows the highlighted element. Absent if no element is highlighted. */
    highlight?: Highlight;
    slices: Slice[];
    /** The projection of the whole object. Absent if it is not shown. */
    projection?: ObjectProjection;
    /** The matrix of planar sections. Present only in the matrix view. */
    matrix?: SectionMatrix;
}
