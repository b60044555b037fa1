// Converts the slices of a binary message to objects. Such a message has one array (a column) per property, with the
// values of all slices one after another. The vertices, edges and faces of the projection's parts (see
// ObjectProjection) are in columns, too.

import type { Elements, Fill, Fog, Integers, ObjectProjection, ProjectionLook, Slice, Surface } from "./slices.js";
import type { Vector } from "./types.js";

/** One value for each kind of element of a slice: vertices, edges and faces. */
type PerElementKind<T> = Record<"vertices" | "edges" | "faces", T>;

/** The elements of all slices, or of all parts of the projection, one slice or part after another. */
interface ElementColumns {
    /** The number of elements in each slice or part. */
    counts: PerElementKind<Integers>;
    /** x, y, z of each vertex. */
    vertices: Float32Array;
    /** The indices of the two vertices of each edge, counted from the first vertex of the slice or part. */
    edges: Integers;
    /** The number of corners of each face. */
    sides: Integers;
    /** The indices of the vertices of all faces, one face after another. Indices start at 0 for each slice or part. */
    corners: Integers;
    // The interface Elements in slices.ts describes the following members.

    of: PerElementKind<Integers>;
    tints?: Integers;
    seen?: PerElementKind<Integers>;
    balls?: { scale: Float32Array; opacity: Float32Array };
    fill?: {
        counts: Record<"points" | "triangles", Integers>;
        points: Float32Array;
        triangles: Integers;
        tints: Integers;
        seen?: Integers;
    };
}

/** The member `slices` of a message in a binary encoding (protocol/README.md, "Binary encodings"). */
export interface SliceColumns extends ElementColumns {
    index: number[];
    w: Float64Array;
    position: Float32Array;
    label: string[];
    label_at: Float32Array;
    label_size: Float64Array;
    focus: boolean[];
    drawn: boolean[];
    surface?: {
        counts: Record<"points" | "triangles", Integers>;
        /** The color of the surfaces in each slice, 0xRRGGBB. */
        color?: Integers;
        points: Float32Array;
        normals: Float32Array;
        triangles: Integers;
        level: Uint8Array;
        cap: Uint8Array;
        /** The color of each point, 0xRRGGBB. */
        colors?: Integers;
        cap_colors?: Integers;
    };
    fog?: {
        counts: Record<"walls", Integers>;
        size: Integers;
        min: Float32Array;
        step: Float64Array;
        walls: Float32Array;
        values: Uint8Array;
    };
}

/** The member `projection.parts` of a message in a binary encoding. */
export interface ProjectionColumns extends ElementColumns {
    looks: ProjectionLook[];
}

/** A function that returns an array of `count` integers, which may have any values. */
export type IntegerAllocator = (count: number) => Uint32Array;

type IndexRange = [begin: number, end: number];

/**
 * Returns consecutive index ranges with these sizes, starting at index 0. Throws a RangeError if a size is not a whole
 * number from 0 on, or if a range ends beyond `length`.
 */
function rangesOfSizes(sizes: Integers, length: number): IndexRange[] {
    let end = 0;
    const all: IndexRange[] = [];
    for (const size of sizes) {
        if (!Number.isInteger(size) || size < 0 || end + size > length) {
            throw new RangeError(`${size} elements from number ${end} on are not in an array of ${length}`);
        }
        all.push([end, (end += size)]);
    }
    return all;
}

function vectorAt(flat: Float32Array, i: number): Vector {
    return [flat[3 * i]!, flat[3 * i + 1]!, flat[3 * i + 2]!];
}

function makeUint32Converter(allocate: IntegerAllocator): (integers: Integers) => Uint32Array {
    return (integers) => {
        if (integers instanceof Uint32Array) return integers;
        const all = allocate(integers.length);
        all.set(integers);
        return all;
    };
}

/**
 * Splits columns into the elements of each slice or part. The returned arrays are views of the arrays in `columns`, or
 * come from `allocate`.
 */
function elementsOf(columns: ElementColumns, allocate: IntegerAllocator): Elements[] {
    const wide = makeUint32Converter(allocate);
    const wideOfEach = (lists: PerElementKind<Integers>): PerElementKind<Uint32Array> => {
        return { vertices: wide(lists.vertices), edges: wide(lists.edges), faces: wide(lists.faces) };
    };
    const partOfEach = (lists: PerElementKind<Uint32Array>, i: number): PerElementKind<Uint32Array> => ({
        vertices: lists.vertices.subarray(...vertices[i]!),
        edges: lists.edges.subarray(...edges[i]!),
        faces: lists.faces.subarray(...faces[i]!),
    });
    const { counts, sides } = columns;
    const vertices = rangesOfSizes(counts.vertices, columns.vertices.length / 3);
    const edges = rangesOfSizes(counts.edges, columns.edges.length / 2);
    const faces = rangesOfSizes(counts.faces, sides.length);
    const [ends, corners, of] = [wide(columns.edges), wide(columns.corners), wideOfEach(columns.of)];
    const tints = columns.tints && wide(columns.tints);
    const seen = columns.seen && wideOfEach(columns.seen);
    const filled = columns.fill && fillsOf(columns.fill, wide);
    let corner = 0;
    const takeFaces = ([first, last]: IndexRange): Slice["faces"] => {
        const begin = allocate(last - first + 1);
        begin[0] = 0;
        for (let face = first; face < last; ++face) begin[face - first + 1] = begin[face - first]! + sides[face]!;
        return { begin, corners: corners.subarray(corner, (corner += begin[last - first]!)) };
    };
    return vertices.map((range, i) => {
        const elements: Elements = {
            vertices: columns.vertices.subarray(3 * range[0], 3 * range[1]),
            edges: ends.subarray(2 * edges[i]![0], 2 * edges[i]![1]),
            faces: takeFaces(faces[i]!),
            of: partOfEach(of, i),
        };
        const own = tints?.subarray(...faces[i]!);
        if (own?.some((tint, face) => tint !== elements.of.faces[face])) elements.tints = own;
        if (seen) elements.seen = partOfEach(seen, i);
        if (columns.balls) {
            const { scale, opacity } = columns.balls;
            elements.balls = { scale: scale.subarray(...range), opacity: opacity.subarray(...range) };
        }
        if (filled?.[i]!.triangles.length) elements.fill = filled[i];
        return elements;
    });
}

/**
 * Converts the columns of slices to one object per slice. The arrays in the objects are views of the arrays in
 * `columns`, or come from `allocate`.
 */
export function slicesFromColumns(columns: SliceColumns, allocate: IntegerAllocator): Slice[] {
    const elements = elementsOf(columns, allocate);
    const surfaces = columns.surface && surfacesOf(columns.surface, makeUint32Converter(allocate));
    const fogs = columns.fog && fogsOf(columns.fog);
    return columns.index.map((index, i) => {
        const slice: Slice = {
            index,
            w: columns.w[i]!,
            position: vectorAt(columns.position, i),
            label: columns.label[i]!,
            label_at: vectorAt(columns.label_at, i),
            label_size: columns.label_size[i]!,
            focus: columns.focus[i]!,
            drawn: columns.drawn[i]!,
            ...elements[i]!,
        };
        if (surfaces?.[i]!.triangles.length) slice.surface = surfaces[i];
        if (fogs?.[i]!.values.length) slice.fog = fogs[i];
        return slice;
    });
}

/**
 * Converts the columns of the projection's parts to one object per part. The arrays in the objects are views of the
 * arrays in `columns`, or come from `allocate`.
 */
export function partsFromColumns(columns: ProjectionColumns, allocate: IntegerAllocator): ObjectProjection["parts"] {
    return elementsOf(columns, allocate).map((elements, i) => ({ ...columns.looks[i]!, ...elements }));
}

function fillsOf(fill: NonNullable<ElementColumns["fill"]>, wide: (list: Integers) => Uint32Array): Fill[] {
    const points = rangesOfSizes(fill.counts.points, fill.points.length / 3);
    const triangles = rangesOfSizes(fill.counts.triangles, fill.tints.length);
    const [corners, tints, seen] = [wide(fill.triangles), wide(fill.tints), fill.seen && wide(fill.seen)];
    return points.map(([first, last], i) => {
        const [begin, end] = triangles[i]!;
        return {
            points: fill.points.subarray(3 * first, 3 * last),
            triangles: corners.subarray(3 * begin, 3 * end),
            tints: tints.subarray(begin, end),
            ...(seen && { seen: seen.subarray(begin, end) }),
        };
    });
}

function surfacesOf(surface: NonNullable<SliceColumns["surface"]>, wide: (list: Integers) => Uint32Array): Surface[] {
    const points = rangesOfSizes(surface.counts.points, surface.points.length / 3);
    const triangles = rangesOfSizes(surface.counts.triangles, surface.level.length);
    const colors = surface.colors && wide(surface.colors);
    const capColors = surface.cap_colors && wide(surface.cap_colors);
    return points.map(([first, last], i) => {
        const [begin, end] = triangles[i]!;
        return {
            ...(surface.color && { color: surface.color[i]! }),
            points: surface.points.subarray(3 * first, 3 * last),
            normals: surface.normals.subarray(3 * first, 3 * last),
            triangles: surface.triangles.subarray(3 * begin, 3 * end),
            level: surface.level.subarray(begin, end),
            cap: surface.cap.subarray(begin, end),
            ...(colors && { colors: colors.subarray(first, last) }),
            ...(capColors && { cap_colors: capColors.subarray(first, last) }),
        };
    });
}

function fogsOf(fog: NonNullable<SliceColumns["fog"]>): Fog[] {
    const walls = rangesOfSizes(fog.counts.walls, fog.walls.length / 4);
    const sizes = Array.from(fog.step, (_, i): Vector => [fog.size[3 * i]!, fog.size[3 * i + 1]!, fog.size[3 * i + 2]!]);
    const points = rangesOfSizes(Uint32Array.from(sizes, ([x, y, z]) => x * y * z), fog.values.length);
    return sizes.map((size, i) => ({
        size,
        min: vectorAt(fog.min, i),
        step: fog.step[i]!,
        walls: fog.walls.subarray(4 * walls[i]![0], 4 * walls[i]![1]),
        values: fog.values.subarray(...points[i]!),
    }));
}
