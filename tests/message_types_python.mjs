// Writes the types of messages as TypedDicts of Python, from what message_types.mjs converts the JSON Schemas to:
// schemas whose titles are names of types.

/** The key of a function that returns the schema of what a "tsType" says. */
export const kMeaning = Symbol("meaning");

const kColumns = 120;
const kIndent = "    ";
const kTypes = { string: "str", number: "float", integer: "int", boolean: "bool", null: "None" };
const kConstants = new Map([[true, "True"], [false, "False"], [null, "None"]]);
/** A dict with these keys cannot be written as a class, whose members have their names. */
const kKeywords = new Set(
    (
        "and as assert async await break class continue def del elif else except finally for from global if import " +
        "in is lambda nonlocal not or pass raise return try while with yield False None True"
    ).split(" "),
);

/** Breaks a text at its blanks into lines, the first of which begins with `first`, and the others with `rest`. */
function wrap(text, first, rest = first) {
    const lines = [first];
    let isEmpty = true;
    for (const word of text.split(/\s+/)) {
        if (!isEmpty && `${lines.at(-1)} ${word}`.length > kColumns) {
            lines.push(rest);
            isEmpty = true;
        }
        lines.push(lines.pop() + (isEmpty ? "" : " ") + word);
        isEmpty = false;
    }
    return lines.map((line) => `${line}\n`).join("");
}

const comment = (text, indent = "") => (text ? wrap(text, `${indent}# `) : "");

/** Returns the description of a type as the first statement of its class. */
function docstring(text) {
    if (!text) return "";
    const escaped = text.replace(/\\/g, "\\\\").replace(/"""|"$/g, (quotes) => quotes.replaceAll('"', '\\"'));
    return wrap(`"""${escaped}"""`, kIndent);
}

/** Returns a statement that begins with `head`, and whose expression ends in brackets if it is long. */
function statement(head, expression, indent = "") {
    const line = `${indent}${head} ${expression}`;
    if (line.length <= kColumns) return `${line}\n`;
    const opening = line.indexOf("[") + 1;
    return wrap(line.slice(indent.length), indent, " ".repeat(opening));
}

const literal = (values) =>
    `Literal[${values.map((value) => kConstants.get(value) ?? JSON.stringify(value)).join(", ")}]`;

class Writer {
    /** The definitions, by name, each after those that it refers to. No message contains itself. */
    definitions = new Map();

    /** The type of arrays: in what a client sends, any sequence, such as a tuple; elsewhere the list of JSON. */
    array = "list";

    constructor(sent, bases) {
        this.sent = sent;
        this.bases = bases;
    }

    /**
     * Returns the expression for a schema, after the definitions that it needs. `name` is that of the class of an
     * object that the schema does not name.
     */
    expression(schema, name) {
        if (schema.title === undefined) return this.unnamed(schema, name);
        if (!this.definitions.has(schema.title)) this.define(schema);
        return schema.title;
    }

    unnamed(schema, name) {
        if (schema[kMeaning]) return this.expression(schema[kMeaning](), name);
        if (schema.anyOf) return `Union[${schema.anyOf.map((each) => this.expression(each, name)).join(", ")}]`;
        if (schema.const !== undefined) return literal([schema.const]);
        if (schema.enum) return literal(schema.enum);
        if (schema.type === undefined) return "Any";
        const types = [schema.type].flat();
        const others = types.filter((type) => type !== "null").map((type) => this.ofOneType(type, schema, name));
        const type = others.length === 1 ? others[0] : `Union[${others.join(", ")}]`;
        return types.includes("null") ? `Optional[${type}]` : type;
    }

    ofOneType(type, schema, name) {
        if (type === "array") return `${this.array}[${this.expression(schema.items, `${name}Item`)}]`;
        if (type !== "object") return kTypes[type];
        if (!schema.properties) return `dict[str, ${this.expression(schema.additionalProperties, `${name}Value`)}]`;
        this.defineClass(name, schema);
        return name;
    }

    define(schema) {
        const { title: name, description } = schema;
        const arrayOfOuter = this.array;
        this.array = this.sent.has(name) ? "Sequence" : "list";
        if (schema.properties && schema.type === "object") {
            this.defineClass(name, schema);
        } else {
            const expression = this.unnamed(schema, `${name}Object`);
            this.add(name, comment(description) + statement(`${name} =`, expression));
        }
        this.array = arrayOfOuter;
    }

    /**
     * Defines a TypedDict. In Python before 3.11, all members of a class are required, or none; so the required ones of
     * an object that has both are in a base class.
     */
    defineClass(name, { properties, required = [], description }) {
        const base = this.bases.get(name);
        const bases = base ? [this.expression(base)] : [];
        const own = { true: "", false: "" }; // the members of the class, by whether they are required
        for (const [member, schema] of Object.entries(properties)) {
            if (base?.properties[member]) continue;
            const type = this.expression(schema, name + pascalCase(member));
            const isRequired = required.includes(member);
            if (kKeywords.has(member)) {
                const single = `_${name}${pascalCase(member)}`;
                const total = isRequired ? "" : ", total=False";
                const dict = `TypedDict("${single}", {"${member}": ${type}}${total})`;
                this.add(single, comment(schema.description) + statement(`${single} =`, dict));
                bases.push(single);
            } else {
                own[isRequired] += comment(schema.description, kIndent) + statement(`${member}:`, type, kIndent);
            }
        }
        const total = own.true ? [] : ["total=False"];
        if (own.true && own.false) {
            this.add(`_${name}`, `class _${name}(TypedDict):\n${own.true}`);
            bases.unshift(`_${name}`);
            total.push("total=False");
        }
        const heading = `class ${name}(${[...(bases.length > 0 ? bases : ["TypedDict"]), ...total].join(", ")}):\n`;
        const members = own.false || (bases.includes(`_${name}`) ? "" : own.true);
        this.add(name, heading + docstring(description) + (members || (description ? "" : `${kIndent}pass\n`)));
    }

    add(name, text) {
        if (this.definitions.has(name)) throw new Error(`two types of Python have the name ${name}`);
        this.definitions.set(name, text);
    }
}

function pascalCase(member) {
    return member.replace(/(?:^|_)(.)/g, (_, letter) => letter.toUpperCase());
}

/**
 * Returns a module that defines these schemas, each of which has a title, and what they refer to. `sent` has the names
 * of those that only a client sends. `bases` has, by the name of a class, the schema of another class, with a title,
 * from which the class is derived.
 */
export function pythonModule(schemas, { sent, bases }) {
    const writer = new Writer(sent, bases);
    for (const schema of schemas) writer.expression(schema);
    const texts = [...writer.definitions.values()];
    const uses = (name) => texts.some((text) => new RegExp(`^[^#"]*\\b${name}\\b`, "m").test(text));
    const imported = ["Any", "Literal", "Optional", "TypedDict", "Union"].filter(uses);
    const isClass = (text) => /^class /m.test(text);
    const spaced = texts.map((text, i) => (isClass(text) || (i > 0 && isClass(texts[i - 1])) ? "\n\n" : "\n") + text);
    return (
        '"""Types for the messages of protocol/README.md: dicts whose members type checkers and editors know.\n' +
        'Generated from the schemas in protocol/schema/ by tests/lint --fix.\n"""\n\n' +
        (uses("Sequence") ? "from collections.abc import Sequence\n" : "") +
        `from typing import ${imported.join(", ")}\n` +
        spaced.join("")
    );
}
