// The panels of the matrix of planar sections, computed from the specification, independently of the page's code.

const kPlanes = ["xy", "xz", "yz", "xw", "yw", "zw"];

/**
 * The matrix panel with these axes upward and to the right, such as "yx". Has its section, a function from coordinates
 * (to the right and upward) to pixels, and a function from points of the section to pixels.
 */
export function panelOf({ left, bottom, panel, step, reach, sections }, [up, right], { height }) {
    const [row, column] = [up, right].map((axis) => "xyzw".indexOf(axis));
    const x = (left + column * step + panel / 2) * height;
    const y = height - (bottom + (3 - row) * step + panel / 2) * height;
    const unit = ((panel / 2) * height) / reach;
    const at = (across, above) => [x + across * unit, y - above * unit];
    const section = sections[kPlanes.findIndex((plane) => plane.includes(up) && plane.includes(right))];
    const place = ([first, second]) => (column < row ? at(first, second) : at(second, first));
    return { section, row, column, at, place, half: (panel / 2) * height };
}

/** The names of all matrix panels. */
export const kPanels = kPlanes.flatMap((plane) => [plane, [...plane].reverse().join("")]);
