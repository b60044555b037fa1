// Bundles the page into dist/: `node build.mjs`, or with --watch anew at every change.
import { context } from "esbuild";
import { cp, mkdir, readFile, rm } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const kLargest = 250 * 1024; // bytes of the compressed script

const here = dirname(fileURLToPath(import.meta.url));
const dist = join(here, "dist");

await rm(dist, { recursive: true, force: true });
await mkdir(dist, { recursive: true });
for (const file of ["index.html", "favicon.svg"]) await cp(join(here, "src", file), join(dist, file));

const watch = process.argv.includes("--watch");
const build = await context({
    absWorkingDir: here,
    entryPoints: { app: "src/main.ts", style: "src/style.css" },
    outdir: "dist",
    bundle: true,
    minify: !watch,
    sourcemap: watch,
    format: "esm",
    target: "es2022",
    legalComments: "none",
    alias: { "@oval4d/protocol": "../protocol/ts/index.ts" },
    nodePaths: [join(here, "node_modules")], // protocol/ts has no packages of its own
    logLevel: "info",
});
if (watch) {
    await build.watch();
} else {
    await build.rebuild();
    await build.dispose();
    const size = gzipSync(await readFile(join(dist, "app.js"))).length;
    console.log(`app.js: ${(size / 1024).toFixed(1)} KB compressed`);
    if (size > kLargest) throw new Error(`app.js is larger than ${kLargest / 1024} KB compressed`);
}
