// Bundles the TypeScript sources that the tests import. This must be done before script.mjs is imported.
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { buildSync } from "esbuild";

const browserTests = join(dirname(fileURLToPath(import.meta.url)), "..");
const top = join(browserTests, "../..");

/** Bundles the TypeScript client, its decoder, the code that reads keys, and the colors for printing. */
export function bundleClient() {
    buildSync({
        entryPoints: {
            client: join(top, "protocol/ts/index.ts"),
            decode: join(top, "protocol/ts/decode.ts"),
            keys: join(top, "web_client/src/keys.ts"),
            on_white: join(top, "web_client/src/picture/on_white.ts"),
        },
        outdir: join(browserTests, "node_modules/.oval4d"),
        outExtension: { ".js": ".mjs" },
        bundle: true,
        platform: "node",
        format: "esm",
        nodePaths: [join(browserTests, "node_modules")],
        banner: { js: 'import { createRequire } from "node:module"; const require = createRequire(import.meta.url);' },
        logLevel: "warning",
    });
}
