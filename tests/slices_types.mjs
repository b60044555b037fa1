// Compares the types of the slices message in protocol/ts/slices.ts, which are written by hand because they describe
// the message after decoding, with its JSON Schema: both have the same members, and the same ones may be absent.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

const ts = createRequire(new URL("../web_client/package.json", import.meta.url))("typescript");

const kSchemas = new URL("../protocol/schema/", import.meta.url);
const kTypes = fileURLToPath(new URL("../protocol/ts/", import.meta.url));
// What decoding changes: it divides loops into two arrays, and makes an empty array of what is absent.
const kMadeByDecoding = /\/faces\/(begin|corners)$/;
const kEmptyIfAbsent = ["/coordinates", "/density"];

const schemas = new Map();
function schemaOf(file) {
    if (!schemas.has(file)) schemas.set(file, JSON.parse(readFileSync(new URL(file, kSchemas), "utf8")));
    return schemas.get(file);
}

/**
 * Adds the members that a schema in this file describes to `found`, a map from their paths to whether they may be absent.
 * The items of an array have the path of the array. Where a reference to a part with a name requires members, all members
 * of the part are present, as in the types that message_types.mjs generates.
 */
function addDescribed(schema, file, found, path = "", required = []) {
    const isWhole = schema.$anchor !== undefined && required.length > 0;
    const present = isWhole ? Object.keys(schema.properties) : [...required, ...(schema.required ?? [])];
    if (schema.$ref !== undefined) {
        const [name, pointer = ""] = schema.$ref.split("#");
        const part = pointer.split("/").slice(1).reduce((each, key) => each[key], schemaOf(name || file));
        addDescribed(part, name || file, found, path, present);
    }
    for (const [name, member] of Object.entries(schema.properties ?? {})) {
        found.set(`${path}/${name}`, !present.includes(name));
        addDescribed(member, file, found, `${path}/${name}`);
    }
    if (schema.items) addDescribed(schema.items, file, found, path);
    return found;
}

const program = ts.createProgram([`${kTypes}slices.ts`], { strict: true, noEmit: true, skipLibCheck: true, types: [] });
const checker = program.getTypeChecker();
const isOurs = (declaration) => declaration.getSourceFile().fileName.startsWith(kTypes);

/** Adds the members of a type in the same way, but not those of classes of JavaScript, such as Float32Array. */
function addTyped(type, found, path = "") {
    if (checker.isArrayType(type) || checker.isTupleType(type)) {
        const [item] = checker.getTypeArguments(type);
        return item ? addTyped(item, found, path) : found;
    }
    for (const member of checker.getPropertiesOfType(type)) {
        const name = `${path}/${member.name}`;
        if (!member.declarations?.some(isOurs)) continue;
        found.set(name, (member.flags & ts.SymbolFlags.Optional) !== 0);
        addTyped(checker.getNonNullableType(checker.getTypeOfSymbol(member)), found, name);
    }
    return found;
}

const source = program.getSourceFile(`${kTypes}slices.ts`);
const slices = checker.getExportsOfModule(checker.getSymbolAtLocation(source)).find(({ name }) => name === "Slices");
const typed = addTyped(checker.getDeclaredTypeOfSymbol(slices), new Map());
const described = addDescribed(schemaOf("slices.schema.json"), "slices.schema.json", new Map());

const faults = [];
for (const path of described.keys()) if (!typed.has(path)) faults.push(`${path} is only in the schema`);
for (const [path, mayBeAbsent] of typed) {
    if (kMadeByDecoding.test(path)) continue;
    const expected = described.get(path) && !kEmptyIfAbsent.includes(path);
    if (!described.has(path)) faults.push(`${path} is only in slices.ts`);
    else if (mayBeAbsent !== expected) faults.push(`${path} ${expected ? "may be absent" : "is always present"} in the schema`);
}
for (const fault of faults) console.error(`protocol/ts/slices.ts: ${fault}`);
if (faults.length > 0) process.exitCode = 1;
