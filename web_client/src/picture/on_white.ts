// Converts a picture to colors with enough contrast on white paper, for printing. The page converts its own picture,
// because printing cannot wait for another picture from the server.

import type { Slices } from "@oval4d/protocol";

import table from "../../../protocol/colors.json";

const kLeastContrast = 3.6; // the least contrast to white, as in server/scene/color.cpp
// The greatest luminance whose contrast to white is at least kLeastContrast (WCAG 2.2).
const kMostLuminance = 1.05 / kLeastContrast - 0.05;

const numberOf = (color: string): number => parseInt(color.slice(1), 16);
const { dark, light } = table.schemes;
/**
 * The greatest opacity of translucent faces. The value 1 has another meaning: faces may cross each other, or the object
 * is a surface (see protocol/README.md).
 */
const kMostTranslucent = 0.999;

function fixedColors({ text, focus, ball, bar, zero, highlight, axes }: typeof dark): number[] {
    return [text, focus, ball, bar, zero, highlight, ...axes].map(numberOf);
}

/** Maps each fixed color of pictures on dark ground to the corresponding color on light ground. */
const kReplaced = new Map(
    fixedColors(dark).map((color, i): [number, number] => [color, fixedColors(light)[i]!]),
);

/**
 * Returns the picture with colors for a white background. The result shares with `picture` most data other than colors.
 */
export function recolorForWhite(picture: Slices): Slices {
    const { scene, slices, projection, histogram } = picture;
    const background = numberOf(table.grounds.white);
    if (scene.colors.text === numberOf(light.text)) {
        return { ...picture, scene: { ...scene, colors: { ...scene.colors, background } } };
    }
    const known = new Map(kReplaced);
    const convert = (color: number): number => {
        const found = known.get(color);
        if (found !== undefined) return found;
        const made = darkened(color);
        known.set(color, made);
        return made;
    };
    const { text, focus, ball, bar, zero, highlight, axes, cells } = scene.colors;
    const colors = {
        ...{ background, text: convert(text), focus: convert(focus), ball: convert(ball), bar: convert(bar) },
        ...{ zero: convert(zero), highlight: convert(highlight), cells: cells.map(convert) },
        axes: axes.map(convert) as typeof axes,
    };
    const opaque = 0xff000000;
    return {
        ...picture,
        density: picture.density.slice(), // copied, because DensityImage repaints only for a new array
        scene: {
            ...scene,
            colors,
            opacity: faceOpacityOnLightGround(scene.opacity),
            ...(scene.surfaces && { surfaces: scene.surfaces.map((one) => ({ ...one, color: convert(one.color) })) }),
            ...(scene.fog && {
                fog: { table: Uint32Array.from(scene.fog.table, (entry) => (entry & opaque) | convert(entry & ~opaque)) },
            }),
        },
        ...(histogram && {
            histogram: {
                ...histogram,
                levels: histogram.levels.map(({ value, color }) => ({ value, color: convert(color) })),
            },
        }),
        ...(projection && {
            projection: {
                ...projection,
                parts: projection.parts.map((part) => {
                    return { ...part, ball_color: convert(part.ball_color), bar_color: convert(part.bar_color) };
                }),
            },
        }),
        slices: slices.map((slice) => {
            if (!slice.surface) return slice;
            const { color, colors: ofPoints, cap_colors: ofCaps } = slice.surface;
            const surface = {
                ...slice.surface,
                ...(color !== undefined && { color: convert(color) }),
                ...(ofPoints && { colors: ofPoints.map(convert) }),
                ...(ofCaps && { cap_colors: ofCaps.map(convert) }),
            };
            return { ...slice, surface };
        }),
    };
}

/** Converts the opacity of faces from dark to light ground. Translucent faces stay translucent. */
function faceOpacityOnLightGround(opacity: number): number {
    return opacity < 1 ? Math.min((opacity * light.faces) / dark.faces, kMostTranslucent) : opacity;
}

/** Returns a color with enough contrast to white: the color itself, or a darker color of the same hue. */
function darkened(color: number): number {
    const channels = [16, 8, 0].map((shift) => {
        const value = ((color >> shift) & 255) / 255;
        return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
    });
    const luminance = 0.2126 * channels[0]! + 0.7152 * channels[1]! + 0.0722 * channels[2]!;
    if (luminance <= kMostLuminance) return color;
    return channels.reduce((sum, channel) => {
        const value = (channel * kMostLuminance) / luminance;
        const encoded = value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055;
        return (sum << 8) | Math.floor(255 * encoded);
    }, 0);
}
