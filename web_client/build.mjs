// Bundles the page into dist/. `node build.mjs --watch` bundles it again after every change.
import { context } from "esbuild";
import { cp, mkdir, readdir, readFile, rm, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";

// Bytes: the maximum total size of all files, also of those that the page loads later, compressed with gzip. Browsers
// that accept brotli, as most do over HTTPS, load less.
const kMaxTotalSize = 250 * 1024;

const here = dirname(fileURLToPath(import.meta.url));
const dist = join(here, "dist");

await rm(dist, { recursive: true, force: true });
await mkdir(dist, { recursive: true });
for (const file of ["index.html", "favicon.svg"]) await cp(join(here, "src", file), join(dist, file));

const watch = process.argv.includes("--watch");
const build = await context({
    absWorkingDir: here,
    entryPoints: { app: "src/main.ts", decode_worker: "src/picture/decode_worker.ts", style: "src/style.css" },
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
    await compress();
}

/** Compresses each file with gzip and brotli, for clients that accept these encodings; checks the total size. */
async function compress() {
    const sizes = [];
    const total = { gzip: 0, brotli: 0 };
    const inKilobytes = (size) => `${(size / 1024).toFixed(1)} KB`;
    for (const file of await readdir(dist)) {
        const content = await readFile(join(dist, file));
        const zipped = gzipSync(content, { level: constants.Z_BEST_COMPRESSION });
        const brotli = brotliCompressSync(content);
        await writeFile(join(dist, `${file}.gz`), zipped);
        await writeFile(join(dist, `${file}.br`), brotli);
        total.gzip += zipped.length;
        total.brotli += brotli.length;
        sizes.push(`${file} ${inKilobytes(zipped.length)}`);
    }
    const sums = `${inKilobytes(total.gzip)} compressed with gzip, ${inKilobytes(total.brotli)} with brotli`;
    console.log(`the page: ${sums}; with gzip: ${sizes.join(", ")}`);
    if (total.gzip > kMaxTotalSize) throw new Error(`the page is larger than ${inKilobytes(kMaxTotalSize)} compressed`);
}
