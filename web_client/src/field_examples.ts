// The example fields that have names. A user can start from their formulas.

import type { Box } from "@oval4d/protocol";

import table from "../../protocol/fields.json";
import type { FormulaWithBox } from "./fields";

const kTable: { name: string; formula: string; box: number[][]; values?: string }[] = table.fields;

export const kExamples: (FormulaWithBox & { title: string })[] = kTable.map(({ name, formula, box, values }) => ({
    title: name.charAt(0).toUpperCase() + name.slice(1),
    formula,
    box: box as Box,
    ...(values && { values }),
}));
