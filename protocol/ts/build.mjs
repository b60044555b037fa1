// Builds the npm package: dist/index.js and its types. npm runs this script when it installs the folder, but does not
// install the packages that only the build needs. Therefore the script first installs these packages.
import { execFileSync } from "node:child_process";
import { existsSync } from "node:fs";
import { rm } from "node:fs/promises";
import { fileURLToPath } from "node:url";

const here = fileURLToPath(new URL(".", import.meta.url));
const run = (program, ...given) => execFileSync(program, given, { cwd: here, stdio: "inherit" });

if (!existsSync(new URL("node_modules/typescript", import.meta.url))) {
    run("npm", "ci", "--prefix", here, "--ignore-scripts", "--no-audit", "--no-fund");
}
await rm(new URL("dist", import.meta.url), { recursive: true, force: true });
const { build } = await import("esbuild");
await build({
    absWorkingDir: here,
    entryPoints: ["index.ts"],
    outdir: "dist",
    bundle: true,
    packages: "external",
    format: "esm",
    target: "es2022",
    logLevel: "warning",
});
run(process.execPath, "node_modules/typescript/bin/tsc", "-p", ".");
