// Pictures as arrays of pixels.
import pngjs from "pngjs";

export function decode(png) {
    return pngjs.PNG.sync.read(Buffer.from(png));
}

/** The red, green and blue values at a point, measured from the upper left corner. */
export function pixelAt({ width, data }, x, y) {
    const at = 4 * (Math.round(y) * width + Math.round(x));
    return [...data.subarray(at, at + 3)];
}

/** The difference of two colors: the largest difference in any channel. */
export function distance(a, b) {
    return Math.max(...a.map((value, i) => Math.abs(value - b[i])));
}

/**
 * Compares two pictures of the same size. Returns their mean difference, and the fraction of pixels that differ by more
 * than 64 of 255 in a channel.
 */
export function compare(a, b) {
    if (a.width !== b.width || a.height !== b.height) throw new Error("the pictures differ in size");
    let sum = 0;
    let far = 0;
    for (let i = 0; i < a.data.length; i += 4) {
        let most = 0;
        for (let k = 0; k < 3; ++k) {
            const difference = Math.abs(a.data[i + k] - b.data[i + k]);
            sum += difference;
            most = Math.max(most, difference);
        }
        if (most > 64) ++far;
    }
    const pixels = a.width * a.height;
    return { mean: sum / (3 * pixels), far: far / pixels };
}

/**
 * The fraction of the picture that is not background: pixels that differ from it by more than 24 of 255 in a channel.
 */
export function covered(picture, background) {
    let count = 0;
    for (let i = 0; i < picture.data.length; i += 4) {
        if (distance([...picture.data.subarray(i, i + 3)], background) > 24) ++count;
    }
    return count / (picture.width * picture.height);
}

/** The lower part of a picture, from the row `top` on. */
export function below({ width, height, data }, top) {
    return { width, height: height - top, data: data.subarray(4 * width * top) };
}
