// Writes test results as JUnit XML.
import { mkdirSync, writeFileSync } from "node:fs";
import { dirname } from "node:path";

const kEscapes = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\n": "&#10;" };

/** Escapes a text for XML. Replaces the characters that XML 1.0 does not allow. */
function escaped(text) {
    // eslint-disable-next-line no-control-regex
    return text.replace(/\u001b\[[\d;]*m/g, "").replace(/[^\t\n\r -\ud7ff\ue000-\ufffd]/gu, "\ufffd").replace(/[&<>"\n]/g, (one) => kEscapes[one]);
}

/** Writes the results of all tests to a file. A result is {name, file, seconds, failure, skipped}. */
export function writeJunit(path, results) {
    const cases = results.map(({ name, file, seconds, failure, skipped }) => {
        const attributes = `name="${escaped(name)}" classname="browser"${file ? ` file="${file}"` : ""} time="${seconds.toFixed(3)}"`;
        if (skipped !== undefined) return `  <testcase ${attributes}><skipped message="${escaped(skipped)}"/></testcase>`;
        if (failure === undefined) return `  <testcase ${attributes}/>`;
        const [message] = failure.split("\n    at ");
        return `  <testcase ${attributes}>\n    <failure message="${escaped(message)}">${escaped(failure)}</failure>\n  </testcase>`;
    });
    const failed = results.filter(({ failure }) => failure !== undefined).length;
    const head = `<testsuite name="browser" tests="${results.length}" failures="${failed}">`;
    mkdirSync(dirname(path), { recursive: true });
    writeFileSync(path, ['<?xml version="1.0" encoding="UTF-8"?>', head, ...cases, "</testsuite>", ""].join("\n"));
}
