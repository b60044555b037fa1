// Angles as users type and read them. A number without a unit is in degrees, because the page shows degrees.

import { formatDecimal, formatDegrees } from "./format";

const kMaxDenominator = 60; // the largest denominator of a fraction of pi that editableAngle() returns
const kTolerance = 1e-9;

/**
 * Converts an angle to a text for editing. Uses degrees if two decimals express the angle exactly. Otherwise uses a
 * fraction of pi with a denominator up to kMaxDenominator, if such a fraction equals the angle. Otherwise uses degrees
 * with up to ten decimals.
 */
export function editableAngle(radians: number): string {
    const degrees = (radians * 180) / Math.PI;
    if (Math.abs(degrees * 100 - Math.round(degrees * 100)) < kTolerance * 100) return formatDegrees(radians);
    for (let n = 1; n <= kMaxDenominator; ++n) {
        const k = (radians * n) / Math.PI;
        if (Math.abs(k - Math.round(k)) > kTolerance) continue;
        // Gives pi/7 instead of 1*pi/7.
        return `${formatDecimal(Math.round(k), 0)}*pi/${n}`.replace(/^(\u2212?)1\*/, "$1");
    }
    return `${formatDecimal(degrees, 10)}°`;
}

/**
 * Converts an angle such as "10", "10°", "10 deg", "pi/8" or "0.2 rad" to an expression for the command line: "10"
 * becomes "deg(10)". Throws an Error if the text is blank.
 */
export function angleExpression(text: string): string {
    const typed = withoutBlanksAroundOperators(text).toLowerCase();
    if (typed === "") throw new Error("an angle is expected, such as 10° or pi/8");
    const withoutExponents = typed.replace(/(\d)e(?=[-+]?\d)/g, "$1");
    if (!/[\p{L}°]/u.test(withoutExponents)) return `deg(${typed})`;
    return withoutBlanksBeforeUnits(typed);
}

/** Removes the blanks before the units "°", "deg" and "rad". Keeps the blanks before a call of the function deg(). */
export function withoutBlanksBeforeUnits(text: string): string {
    return withDegreeSigns(text).replace(/\s+(?=°|(?:deg|rad)(?![a-z(]))/gi, "");
}

/** Removes the blanks around operators: the command line takes a value without blanks. */
export function withoutBlanksAroundOperators(text: string): string {
    return withDegreeSigns(text.trim()).replace(/\s*([-−+*/^()°])\s*/g, "$1");
}

/**
 * Replaces "º" and "˚", which look like the degree sign, by the degree sign "°". Keyboards of Spain and Portugal type
 * "º". The server's command line also accepts "º" and "˚".
 */
function withDegreeSigns(text: string): string {
    return text.replace(/[º˚]/g, "°");
}
