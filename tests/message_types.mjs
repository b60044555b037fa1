// Generates the types of messages and of the answers to requests, in TypeScript (protocol/ts/messages.ts) and in Python
// (protocol/python/oval4d_messages/), from the JSON Schemas of messages; with --check, only compares. The slices message
// is not among them: protocol/ts/slices.ts has its types as they are after decoding, which slices_types.mjs compares.
import { readFile, readdir, writeFile } from "node:fs/promises";
import { compile } from "json-schema-to-typescript";
import { kMeaning, pythonModule } from "./message_types_python.mjs";

const kSchemas = new URL("../protocol/schema/", import.meta.url);
const kProtocol = new URL("../protocol/", import.meta.url);
const kLongestTuple = 4;
const kNotGenerated = ["slices"];
const kNames = { error: "ErrorMessage" }; // "Error" is a class of JavaScript

const read = async (file) => JSON.parse(await readFile(new URL(file, kSchemas), "utf8"));
const files = (await readdir(kSchemas)).filter((name) => name.endsWith(".schema.json")).sort();
const schemas = new Map(await Promise.all(files.map(async (name) => [name, await read(name)])));

// From each part of a schema to what json-schema-to-typescript and pythonModule read. Only the former reads "tsType".
const converted = new Map();
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
    const { "x-choices": table, $ref, $anchor, title, minItems, maxItems, unevaluatedProperties, ...described } = schema;
    const { default: initially, ...keywords } = described;
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
        const meaning = { type: types, items: keywords.items };
        const { description } = keywords;
        return { tsType: allowed.join(" | "), description, [kMeaning]: () => convert(meaning), ...name };
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
    const meant = required ? { ...part, $anchor: undefined, required: [...(part.required ?? []), ...required] } : part;
    return { tsType: required ? `Required<${name}>` : name, description, [kMeaning]: () => convert(meant) };
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
const answerName = (message) => {
    const type = answerOf(message) ?? "done";
    return nameOfMessage(messages.find((each) => each.type === type));
};
const request = union("Request", requests);
const answer = union("Answer", answers);
const command = union(
    "Command",
    withOneAnswer.filter((message) => answerOf(message) === undefined),
    "A request that may change the session. The server answers it with `done`.",
);
const requestAnswers = {
    title: "RequestAnswers",
    description: "The messages that answer requests, by the types of the requests; without `get`, whose answer depends on `what`.",
    type: "object",
    properties: Object.fromEntries(withOneAnswer.map((message) => [message.type, { tsType: answerName(message) }])),
    required: withOneAnswer.map(({ type }) => type),
};

/**
 * Returns a setting as Python can send it: also as a part of a state, in which more members are required. To type
 * checkers, the part is not of the type in a set, because what takes that type might remove the members.
 */
function sentByPython(name, setting) {
    if (!schemas.get("state.schema.json").properties[name]?.required) return setting;
    const partOfState = { title: `State${name[0].toUpperCase()}${name.slice(1)}` };
    return { description: setting.description, anyOf: [setting, partOfState] };
}

const setMembers = convert(schemas.get("set.schema.json")).properties;
const settingNames = [...Object.keys(schemas.get("settings.schema.json").properties), "continues"];
const settings = {
    title: "Settings",
    description: "The settings that set() of the client changes. Absent settings keep their values.",
    type: "object",
    properties: Object.fromEntries(settingNames.map((name) => [name, sentByPython(name, setMembers[name])])),
};
const answeredByDone = {
    title: "AnsweredByDone",
    description: "The types of those messages that `done` answers.",
    enum: withOneAnswer.filter((message) => answerName(message) === "Done").map(({ type }) => type),
};

// json-schema-to-typescript generates the types that one type needs, so one, which is then removed, needs all of them.
const everything = { anyOf: [request, answer, command, requestAnswers, ...Object.values(namedParts).map(convert)] };
const generated = await compile(everything, "Everything", {
    additionalProperties: false,
    bannerComment: "// Types for the messages of protocol/README.md. Generated from the schemas in protocol/schema/ by tests/lint --fix.",
    style: { printWidth: 120, tabWidth: 4 },
    unknownAny: true,
});
const outputs = {
    "ts/messages.ts": generated.replace(/export type Everything =[^;]*;\n/, ""),
    "python/oval4d_messages/__init__.py": pythonModule([answer, request, command, answeredByDone], {
        sent: new Set([settings.title, ...requests.map(nameOfMessage)]),
        bases: new Map([["SetRequest", settings]]),
    }),
};

for (const [file, text] of Object.entries(outputs)) {
    const path = new URL(file, kProtocol);
    if (!process.argv.includes("--check")) {
        await writeFile(path, text);
    } else if ((await readFile(path, "utf8")) !== text) {
        console.error(`protocol/${file} differs from the schemas; run tests/lint --fix`);
        process.exitCode = 1;
    }
}
