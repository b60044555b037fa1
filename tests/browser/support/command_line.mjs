// The command line: typing into it, and the names that the server lists.
import { readFileSync } from "node:fs";

export const { commands } = JSON.parse(readFileSync(new URL("../../../protocol/commands.json", import.meta.url), "utf8"));

/** Opens the command line, types a line, and presses Enter. */
export async function type(page, line) {
    await page.keyboard.press(":");
    await page.waitForSelector("#command:focus");
    await page.keyboard.type(line);
    await page.keyboard.press("Enter");
}

/** The names of commands or settings that the server lists when it refuses this line. */
export async function listedBy(script, line) {
    const answer = await script.request({ type: "command", line }).catch(({ message }) => message);
    const [, list] = /; the (?:commands|settings) are (.*)$/.exec(answer);
    return list.split(", ");
}
