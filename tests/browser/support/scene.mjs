// Projects points of a `slices` message to pixels, as the specification says, independently of the page's code.

const minus = (a, b) => a.map((x, i) => x - b[i]);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
const unit = (a) => a.map((x) => x / Math.hypot(...a));

/** Projects a world position to pixels from the upper left corner of a picture of this size. */
export function project(scene, world, { width, height }) {
    const { eye, target, up, fov, shift } = scene.camera;
    const back = unit(minus(eye, target));
    const right = unit(cross(up, back));
    const seen = minus(world, eye);
    const depth = -dot(seen, back);
    const f = 1 / Math.tan(fov / 2);
    const x = (f * height * dot(seen, right)) / (width * depth) + 2 * shift[0];
    const y = (f * dot(seen, cross(back, right))) / depth + 2 * shift[1];
    return [((x + 1) / 2) * width, ((1 - y) / 2) * height];
}

/** The world positions of a slice's vertices. */
export function worldPoints(scene, slice) {
    const points = [];
    for (let i = 0; i < slice.vertices.length; i += 3) {
        points.push(slice.position.map((at, k) => at + scene.scale * slice.vertices[i + k]));
    }
    return points;
}

/**
 * A point on a vertex's line in the density strip, in pixels from the upper left corner. `along` is 0 on the axis x, 1
 * on y, 2 on z and 3 on w. Between two axes, the line is straight.
 */
export function stripPoint({ coordinates, scene }, vertex, along, height) {
    const { left, zero, line_step: step, line_width: width, amplitude } = scene.coordinates;
    const axis = Math.min(Math.floor(along), 2);
    const [from, to] = [0, 1].map((k) => coordinates[4 * vertex + axis + k] / scene.circumradius);
    const level = from + (along - axis) * (to - from);
    return [(left + width / 2 + along * step) * height, (1 - zero - level * amplitude) * height];
}

export function rgb(color) {
    return [color >> 16, (color >> 8) & 255, color & 255];
}
