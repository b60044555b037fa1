// Reads the text of a formula: its named constants, and the position of a mistake.

/** The definition of a named constant after a formula, such as a=pi/2. */
interface FormulaConstantDefinition {
    name: string;
    /** What is written after the equals sign. */
    text: string;
    /** The index in the formula at which `text` begins. */
    from: number;
}

/** A constant such as a=0.7 after the formula. */
export interface FormulaConstant {
    name: string;
    value: number;
}

/** A mistake in a formula, as the server has reported it. */
export interface FormulaMistake {
    what: string;
    /** The index of the wrong character, from 0; the length of the text if something is missing at its end. */
    at: number;
}

// A formula has no "=" within parentheses, so a name and "=" after a comma or a semicolon always define a constant.
const kDefinitions = /[;,]\s*[A-Za-z]\w*\s*=.*$/s;
const kDefinition = /([;,]\s*([A-Za-z]\w*)\s*=\s*)(.*?)(?=\s*(?:[;,]\s*[A-Za-z]\w*\s*=|[;,]?\s*$))/gs;
const kNumber = /^[-+\u2212]?\s*(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?$/;

function definitionsOf(formula: string): FormulaConstantDefinition[] {
    return [...formula.matchAll(kDefinition)].map((match) => {
        const [, before = "", name = "", text = ""] = match;
        return { name, text, from: match.index + before.length };
    });
}

/**
 * The constants of a formula in their order. A value is a number in the formula, or a text such as "pi/2" whose number
 * is in `known`. Constants with other texts are omitted.
 */
export function constantsOf(formula: string, known: ReadonlyMap<string, number> = new Map()): FormulaConstant[] {
    return definitionsOf(formula).flatMap(({ name, text }) => {
        const isNumber = kNumber.test(text);
        const value = isNumber ? Number(text.replace("\u2212", "-").replace(/\s/g, "")) : known.get(text);
        return value === undefined ? [] : [{ name, value }];
    });
}

/**
 * Finds the numbers for the texts of constants, such as "pi/2". `typed` is the formula as the user typed it; `written`
 * is the same formula as the server writes it, with numbers.
 */
export function constantValues(typed: string, written: string): [text: string, value: number][] {
    const values = new Map(constantsOf(written).map(({ name, value }) => [name, value]));
    return definitionsOf(typed).flatMap(({ name, text }): [string, number][] => {
        const value = values.get(name);
        return value === undefined ? [] : [[text, value]];
    });
}

/** Returns the formula with `value` as the value of the constant `name`; unchanged if it has no such constant. */
export function withConstant(formula: string, name: string, value: string): string {
    const definition = definitionsOf(formula).find((one) => one.name === name);
    if (!definition) return formula;
    const { from, text } = definition;
    return formula.slice(0, from) + value + formula.slice(from + text.length);
}

/**
 * The comparison operator in a formula, such as "<"; "" without one. The meaning of the levels depends on this
 * operator.
 */
export function comparisonOperatorIn(formula: string): string {
    return /[<>]=?|=/.exec(formula.replace(kDefinitions, ""))?.[0] ?? "";
}

/** The mistake in a formula that a server's error message describes; undefined if the message names no position. */
export function parseFormulaMistake(message: string): FormulaMistake | undefined {
    const [, position, what = ""] = /^.*, position (\d+): (.*)$/s.exec(message) ?? [];
    return position === undefined ? undefined : { what, at: Number(position) - 1 };
}

/**
 * An excerpt of a text around the character with the index `at`, counted from 0. It has three pieces: up to `reach`
 * characters before the character, the character itself, and up to `reach` characters after it.
 */
export function excerptAround(
    text: string,
    at: number,
    reach: number,
): [before: string, character: string, after: string] {
    const characters = [...text];
    const [from, to] = [Math.max(0, at - reach), at + 1 + reach];
    return [
        (from > 0 ? "…" : "") + characters.slice(from, at).join(""),
        characters[at] ?? "",
        characters.slice(at + 1, to).join("") + (to < characters.length ? "…" : ""),
    ];
}

/**
 * The slider range for a constant: 0 to about twice its value, or −1 to 1 if the value is 0. The step is a power of
 * ten.
 */
export function sliderRangeFor(value: number): { min: number; max: number; step: number } {
    const reach = 2 * Math.abs(value) || 1;
    const step = 10 ** Math.floor(Math.log10(reach / 50));
    const most = Math.ceil(reach / step - 1e-9) * step;
    return value < 0 ? { min: -most, max: 0, step } : value > 0 ? { min: 0, max: most, step } : { min: -1, max: 1, step };
}

/** The value of a slider as a text, with as many decimals as the slider's step has. */
export function textOfSliderValue(value: number, step: number): string {
    return String(Number(value.toFixed(Math.max(0, -Math.floor(Math.log10(step) + 1e-9)))));
}
