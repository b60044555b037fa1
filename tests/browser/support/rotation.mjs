// Rotations of four-dimensional space as matrices, computed independently of the page and the server.
import assert from "node:assert/strict";

const kAxes = "xyzw";

/** The product R · M of a matrix M with rotations R by these angles in these planes. */
export function turned(matrix, planes, angles) {
    const out = matrix.map((row) => [...row]);
    planes.forEach((plane, i) => {
        const [a, b] = [...plane].map((axis) => kAxes.indexOf(axis));
        const [cos, sin] = [Math.cos(angles[i]), Math.sin(angles[i])];
        for (let k = 0; k < 4; ++k) {
            [out[a][k], out[b][k]] = [out[a][k] * cos - out[b][k] * sin, out[a][k] * sin + out[b][k] * cos];
        }
    });
    return out;
}

/** Whether no elements of two matrices differ by more than the tolerance. */
export function isNear(actual, expected, tolerance = 1e-9) {
    return actual.flat().every((value, i) => Math.abs(value - expected.flat()[i]) <= tolerance);
}

export function assertMatrix(actual, expected) {
    assert.ok(isNear(actual, expected), `${actual} is not ${expected}`);
}
