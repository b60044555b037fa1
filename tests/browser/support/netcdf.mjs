// Writes NetCDF files whose variables have units.

const [kDimension, kVariable, kAttribute] = [10, 11, 12]; // tags of the classic NetCDF format
const [kText, kFloat, kDouble] = [2, 5, 6]; // types of the classic NetCDF format

function numbers(...values) {
    const bytes = Buffer.alloc(4 * values.length);
    values.forEach((value, i) => bytes.writeInt32BE(value, 4 * i));
    return bytes;
}

function text(word) {
    const bytes = Buffer.from(word);
    return Buffer.concat([numbers(bytes.length), bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4)]);
}

const attributes = (texts) =>
    Buffer.concat([
        numbers(kAttribute, Object.keys(texts).length),
        ...Object.entries(texts).flatMap(([name, value]) => [text(name), numbers(kText), text(value)]),
    ]);

/**
 * Returns a NetCDF file in Base64. It has a variable v with `side`⁴ samples valueAt(x, y, z, t), at coordinates from −1
 * to 1. `quantity` is the variable's name, `unit` its unit, and `units` are the units of t, z, y and x.
 */
export function netcdfWithUnits({ side, valueAt, quantity, unit, units }) {
    const at = Array.from({ length: side }, (_, i) => (2 * i) / (side - 1) - 1);
    const coordinates = Buffer.alloc(8 * side);
    at.forEach((value, i) => coordinates.writeDoubleBE(value, 8 * i));
    const samples = Buffer.alloc(4 * side ** 4);
    let written = 0;
    for (const t of at) for (const z of at) for (const y of at) for (const x of at) {
        written = samples.writeFloatBE(valueAt(x, y, z, t), written);
    }
    const axes = ["t", "z", "y", "x"];
    const variables = [
        ...axes.map((name, i) => ({ name, dimensions: [i], about: { units: units[i] }, type: kDouble, data: coordinates })),
        { name: "v", dimensions: [0, 1, 2, 3], about: { long_name: quantity, units: unit }, type: kFloat, data: samples },
    ];
    const header = (begin) => {
        const parts = [Buffer.from("CDF\x01"), numbers(0, kDimension, axes.length)];
        for (const name of axes) parts.push(text(name), numbers(side));
        parts.push(numbers(0, 0, kVariable, variables.length));
        for (const { name, dimensions, about, type, data } of variables) {
            parts.push(text(name), numbers(dimensions.length, ...dimensions), attributes(about));
            parts.push(numbers(type, data.length, begin));
            begin += data.length;
        }
        return Buffer.concat(parts);
    };
    const file = [header(header(0).length), ...variables.map(({ data }) => data)];
    return Buffer.concat(file).toString("base64");
}
