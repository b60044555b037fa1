// The names of the encodings of `slices` messages.
import { readFileSync } from "node:fs";

const schema = JSON.parse(readFileSync(new URL("../../../protocol/schema/hello.schema.json", import.meta.url), "utf8"));

export const kEncodings = schema.properties.encoding.enum;
export const kBinaryEncodings = kEncodings.filter((encoding) => encoding !== "json");
