// Runs the browser tests; options are passed to node's test runner. OVAL4D names the server's binary, OVAL4D_WEB_ROOT
// the built page, OVAL4D_CHROMIUM and OVAL4D_FIREFOX the browsers.
import { spawnSync } from "node:child_process";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { buildSync } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));

// Bundles the TypeScript client for the tests.
buildSync({
    entryPoints: [join(here, "../../protocol/ts/index.ts")],
    outfile: join(here, "node_modules/.oval4d/client.mjs"),
    bundle: true,
    platform: "node",
    format: "esm",
    nodePaths: [join(here, "node_modules")],
    banner: { js: 'import { createRequire } from "node:module"; const require = createRequire(import.meta.url);' },
    logLevel: "warning",
});
const options = process.argv.slice(2);
const { status } = spawnSync(process.execPath, ["--test", ...options, join(here, "all.test.mjs")], {
    stdio: "inherit",
});
process.exit(status ?? 1);
