// Generates protocol/ts/messages.ts, the types of messages and of the answers to requests, from the JSON Schemas of
// messages; with --check, only compares. The slices message is not among them: slices.ts beside it has its types as they
// are after decoding.
import { readFile, readdir, writeFile } from "node:fs/promises";
import { compile } from "json-schema-to-typescript";

const kSchemas = new URL("../protocol/schema/", import.meta.url);
const kOutput = new URL("../protocol/ts/messages.ts", import.meta.url);
const kLongestTuple = 4;
const kNotGenerated = ["slices"];
const kNames = { error: "ErrorMessage" }; // "Error" is a class of JavaScript

const read = async (file) => JSON.parse(await readFile(new URL(file, kSchemas), "utf8"));
const files = (await readdir(kSchemas)).filter((name) => name.endsWith(".schema.json")).sort();
const schemas = new Map(await Promise.all(files.map(async (name) => [name, await read(name)])));

const converted = new Map(); // from each part of a schema to what json-schema-to-typescript reads
const namedParts = {}; // by name, the parts that are referred to by their names

/** Returns the part of a schema that a reference names, such as "settings.schema.json#/properties/view", or is. */
function find(reference) {
    if (typeof reference === "object") return reference;
    const [file, pointer = ""] = reference.split("#");
    return pointer.split("/").slice(1).reduce((part, key) => part[key], schemas.get(file));
}

/**
 * Converts a schema: an "$anchor" names its type. Titles, which say what a value must be, are left out, as are limits of
 * lengths; arrays of one length are tuples.
 */
function convert(schema) {
    if (Array.isArray(schema) || typeof schema !== "object") return schema;
    if (!converted.has(schema)) {
        const result = {};
        converted.set(schema, result);
        Object.assign(result, convertKeywords(schema));
    }
    return converted.get(schema);
}

function convertKeywords({ "x-values": values, "x-fields-only": fieldsOnly, "x-answer": answer, examples, ...schema }) {
    const { $ref, $anchor, title, minItems, maxItems, unevaluatedProperties, default: initially, ...keywords } = schema;
    if ($ref !== undefined) return refer(find($ref), { ...schema, $ref: undefined });
    // Links of the documents lead nowhere in a comment.
    if (keywords.description) keywords.description = keywords.description.replace(/\[([^\]]*)\]\([^)]*\)/g, "$1");
    if (keywords.properties) {
        const members = Object.entries(keywords.properties).map(([name, member]) => [name, convert(member)]);
        keywords.properties = Object.fromEntries(members);
    }
    const types = [keywords.type].flat();
    const name = $anchor && { title: $anchor };
    if (types.includes("array") && minItems === maxItems && minItems <= kLongestTuple) {
        const allowed = types.map((type) => (type === "array" ? tuple(keywords.items, minItems) : type));
        return { tsType: allowed.join(" | "), description: keywords.description, ...name };
    }
    if (keywords.items) keywords.items = convert(keywords.items);
    return { ...keywords, ...name };
}

/** Returns the type of an array of `length` items, which are numbers, tuples, or have a name. */
function tuple(items, length) {
    const item = items.$anchor ? nameOf(items) : items.items ? tuple(items.items, items.minItems) : "number";
    return `[${Array(length).fill(item).join(", ")}]`;
}

/**
 * Converts a reference to a part, with the keywords beside it. Where these are no more than a description and what is
 * required, it is the name of the part, if there is one.
 */
function refer(part, { $ref, ...beside }) {
    if (part.$ref !== undefined) return refer(find(part.$ref), merge({ ...part, $ref: undefined }, beside));
    const { required, description = part.description, title, ...others } = beside;
    if (part.$anchor === undefined || Object.keys(others).length > 0) return convertKeywords(merge(part, beside));
    const name = nameOf(part);
    return { tsType: required ? `Required<${name}>` : name, description };
}

/** Adds keywords to a schema. Properties and items that both have are merged in the same way. */
function merge(schema, more) {
    if (schema.$ref !== undefined) return { ...schema, ...more };
    if (schema.$anchor !== undefined) return { $ref: schema, ...more };
    const result = { ...schema };
    for (const [keyword, value] of Object.entries(more)) {
        if (value === undefined) continue;
        const own = result[keyword];
        if (keyword === "properties" && own) {
            const names = new Set([...Object.keys(value), ...Object.keys(own)]);
            const both = (name) => (own[name] && value[name] ? merge(own[name], value[name]) : (value[name] ?? own[name]));
            result.properties = Object.fromEntries([...names].map((name) => [name, both(name)]));
        } else if (keyword === "items" && own) result.items = merge(own, value);
        else if (keyword === "required" && own) result.required = [...new Set([...own, ...value])];
        else result[keyword] = value;
    }
    return result;
}

function nameOf(part) {
    namedParts[part.$anchor] = part;
    return part.$anchor;
}

const messages = files
    .map((file) => ({ file, type: schemas.get(file).properties?.type?.const }))
    .filter(({ type }) => type !== undefined && !kNotGenerated.includes(type));
const kRequestId = find("hello.schema.json#/properties/id");
/** Returns whether the client sends it, so that its id is one that the client has chosen. */
const isRequest = ({ file }) => {
    const { id } = schemas.get(file).properties;
    return (id.$ref ? find(id.$ref) : id) === kRequestId;
};
/** Returns the name of the type of a message. */
const nameOfMessage = (message) => {
    const { type } = message;
    const name = kNames[type] ?? type[0].toUpperCase() + type.slice(1);
    return isRequest(message) && type !== "address" ? `${name}Request` : name;
};
/** Returns the type of a message, which has a name. */
const named = (message) => Object.assign(convert(schemas.get(message.file)), { title: nameOfMessage(message) });
const union = (title, members, description) => ({ title, description, anyOf: members.map(named) });
const requests = messages.filter(isRequest);
const answers = messages.filter((message) => !isRequest(message) || message.type === "address");

// The answer to a get has the type of what it asks for. Any other request without "x-answer" is a command.
const withOneAnswer = requests.filter(({ type }) => type !== "get");
const answerOf = ({ file }) => schemas.get(file)["x-answer"];
const answerName = (request) => {
    const type = answerOf(request) ?? "done";
    return nameOfMessage(messages.find((message) => message.type === type));
};
const unions = [
    union("Request", requests),
    union("Answer", answers),
    union(
        "Command",
        withOneAnswer.filter((request) => answerOf(request) === undefined),
        "A request that may change the session. The server answers it with `done`.",
    ),
];
const requestAnswers = {
    title: "RequestAnswers",
    description: "The messages that answer requests, by the types of the requests; without `get`, whose answer depends on `what`.",
    type: "object",
    properties: Object.fromEntries(withOneAnswer.map((request) => [request.type, { tsType: answerName(request) }])),
    required: withOneAnswer.map(({ type }) => type),
};

// json-schema-to-typescript generates the types that one type needs, so one, which is then removed, needs all of them.
const everything = { anyOf: [...unions, requestAnswers, ...Object.values(namedParts).map(convert)] };
const generated = await compile(everything, "Everything", {
    additionalProperties: false,
    bannerComment: "// Types for the messages of protocol/README.md. Generated from the schemas in protocol/schema/ by tests/lint --fix.",
    style: { printWidth: 120, tabWidth: 4 },
    unknownAny: true,
});
const text = generated.replace(/export type Everything =[^;]*;\n/, "");

if (process.argv.includes("--check")) {
    if ((await readFile(kOutput, "utf8")) !== text) {
        console.error("protocol/ts/messages.ts differs from the schemas; run tests/lint --fix");
        process.exitCode = 1;
    }
} else {
    await writeFile(kOutput, text);
}
