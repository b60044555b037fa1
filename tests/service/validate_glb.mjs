// Prints the report of the Khronos glTF validator on a file as JSON: node validate_glb.mjs <file>
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const { validateBytes } = createRequire(new URL("../package.json", import.meta.url))("gltf-validator");
const report = await validateBytes(new Uint8Array(readFileSync(process.argv[2])), { maxIssues: 0 });
console.log(JSON.stringify(report));
