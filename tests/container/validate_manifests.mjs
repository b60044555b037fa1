// Checks Kubernetes objects, a JSON array on standard input, against the schemas of the Kubernetes API. Prints errors.
import { createRequire } from "node:module";
import { text } from "node:stream/consumers";

const require = createRequire(new URL("../package.json", import.meta.url));
let faults = 0;
for (const object of JSON.parse(await text(process.stdin))) {
    const { apiVersion, kind, metadata } = object;
    try {
        const Model = require(`kubernetes-models/${apiVersion}/${kind}`)[kind];
        new Model(object).validate();
    } catch (fault) {
        faults += 1;
        console.log(`${kind} ${metadata?.name}: ${fault.message}`);
    }
}
process.exit(faults ? 1 : 0);
