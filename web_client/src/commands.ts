// The commands and settings of the command line, from the data of the protocol.

import table from "../../protocol/commands.json";
import parts from "../../protocol/schema/parts.schema.json";
import planes from "../../protocol/schema/planes.schema.json";
import settings from "../../protocol/schema/settings.schema.json";

/** A command of the command line; protocol/commands.json describes the members. */
export interface CommandRow {
    name: string;
    arguments?: string;
    completes?: string;
    text: string;
    example: string;
    client?: boolean;
}

export const kCommands: CommandRow[] = table.commands;

/** The part of a JSON schema that names a setting and its values. */
interface SettingSchema {
    $ref?: string;
    type?: unknown;
    enum?: unknown[];
    properties?: Record<string, SettingSchema>;
}

// The settings that messages can change, but the command line cannot.
const kNotOnTheLine = ["orientation", "field", "last"];

/**
 * The settings of the command `set`, each with a list of its values. The list is empty for a setting whose value is a
 * number or a name.
 */
export const kSettings = new Map<string, string[]>(settingsInSchema(settings.properties as Record<string, SettingSchema>));

/**
 * The planes of single and double rotations, as the command `rotate` names them: "xy", "xw,yz". In the schema, the
 * first plane is perpendicular to the last one, the second to the last but one, and so on; a double rotation turns in
 * two such planes.
 */
export const kPlanes = planes.items.enum.flatMap((plane, i, all) => [plane, `${plane},${all[all.length - 1 - i]}`]);

/** The kinds of elements of a polytope. */
export const kElementKinds = settings.properties.highlight.properties.element.enum;

/**
 * The settings in the schema `properties`, each with a list of its values. `properties` belongs to the message `set`
 * or, if `parent` is given, to the object `parent` in this message. On the command line, `slices.count` is called
 * `slices`. Every other nested setting has its own name: `slices.spacing` is called `spacing`.
 */
function settingsInSchema(properties: Record<string, SettingSchema>, parent = ""): [string, string[]][] {
    return Object.entries(properties).flatMap(([name, schema]): [string, string[]][] => {
        if (kNotOnTheLine.includes(name)) return [];
        if (schema.$ref === "parts.schema.json") return settingsInSchema(parts.properties);
        if (schema.type === "object") return settingsInSchema(schema.properties!, name);
        const values = schema.type === "boolean" ? ["on", "off"] : (schema.enum ?? []).map(String);
        return [[name === "count" ? parent : name, values]];
    });
}
