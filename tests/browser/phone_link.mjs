// The dialog that shows the session's link as a QR code. A phone that scans the code becomes a remote control.
import assert from "node:assert/strict";

import jsQR from "jsqr";

import { named, openPage, openWithScript, presented, ready, startBrowser } from "./support/browser.mjs";
import { type } from "./support/command_line.mjs";
import { decode, pixelAt } from "./support/pixels.mjs";
import { startServer } from "./support/server.mjs";
import { test } from "./support/suite.mjs";

/**
 * Reads the QR code in the dialog. Also checks its background. Like some readers, finds only dark modules on light
 * ground.
 */
async function read(page) {
    const code = page.locator("#phone-code");
    const picture = decode(await code.screenshot({ animations: "disabled" }));
    const { width, height, data } = picture;
    const found = jsQR(new Uint8ClampedArray(data), width, height, { inversionAttempts: "dontInvert" });
    assert.ok(found, `a code in a picture of ${width} × ${height}`);
    const { topLeftCorner: first, bottomRightCorner: last } = found.location;
    const module = (last.x - first.x) / (17 + 4 * found.version);
    assert.ok(module >= 4, `modules of ${module} pixels`);
    for (const margin of [first.x, first.y, width - last.x, height - last.y]) {
        assert.ok(margin > 3.7 * module, `a quiet zone of ${margin / module} modules`);
    }
    for (const at of [2, first.x / 2]) assert.deepEqual(pixelAt(picture, at, at), [255, 255, 255]);
    assert.deepEqual(pixelAt(picture, first.x + module / 2, first.y + module / 2), [0, 0, 0]);
    return found.data;
}

async function openDialog(page) {
    await type(page, "share");
    await page.waitForSelector("#phone[open]");
}

test("phone link: a page that opens the link of the QR code controls the session", async () => {
    const { page, script, errors, close } = await openWithScript();
    await openDialog(page);
    const link = await read(page);
    assert.equal(await page.inputValue("#phone-link"), link, "the link is beside the code");
    await page.keyboard.press("Escape");
    await page.waitForSelector("#drawing:focus");

    const phone = await openPage({ url: link });
    await ready(phone.page);
    const { revision } = await script.state();
    await phone.page.locator("#drawing").focus();
    await phone.page.keyboard.press("y");
    const turned = await script.until((one) => one.revision > revision, "the key that is pressed on the phone");
    assert.deepEqual(turned.last.planes, ["xy", "zw"]);
    await presented(page, turned.revision);
    assert.deepEqual([errors, phone.errors], [[], []]);
    await phone.close();
    await close();
});

test("phone link: the QR code is dark on white in every color scheme and in forced colors", async () => {
    const { page, close } = await openWithScript();
    await openDialog(page);
    const link = await read(page);
    for (const media of [{ colorScheme: "light" }, { colorScheme: "dark", forcedColors: "active" }]) {
        await page.emulateMedia(media);
        assert.equal(await read(page), link);
    }
    await close();
});

test("phone link: the QR code fits on small screens", async () => {
    for (const [width, height] of [[1024, 400], [375, 667], [320, 480]]) {
        const { page, close } = await openWithScript({ viewport: { width, height } });
        await openDialog(page);
        assert.equal(await read(page), await page.inputValue("#phone-link"));
        const { x, y, width: side } = await page.locator("#phone-code").boundingBox();
        assert.ok(x >= 0 && y >= 0 && x + side <= width && y + side <= height, `${x}, ${y}, ${side}`);
        await close();
    }
});

test("phone link: a button opens the dialog, which copies the link and says if phones cannot reach it", async () => {
    const permissions = ["clipboard-read", "clipboard-write"];
    const { page, errors, close } = await openWithScript({ permissions });
    const button = page.locator("[data-page-tool=phone]");
    await button.focus();
    await page.keyboard.press("Enter");
    await page.waitForSelector("#phone-copy:focus");
    const host = new URL(page.url()).hostname;
    const warning = await page.locator("#phone-loopback").textContent();
    assert.match(warning, new RegExp(`cannot reach ${host},.* --host`, "s"));
    assert.equal(await page.locator("#phone-loopback").isVisible(), true);
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => /copied/.test(document.getElementById("phone-status").textContent));
    const link = await page.inputValue("#phone-link");
    assert.match(link, /#session=.+&token=.+/);
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), link);
    await page.keyboard.press("Shift+Tab");
    await page.waitForSelector("#phone-link:focus");
    const selected = await page.evaluate(() => {
        const { value, selectionStart, selectionEnd } = document.activeElement;
        return value.slice(selectionStart, selectionEnd);
    });
    assert.equal(selected, link);
    await page.keyboard.press("Escape");
    await page.waitForSelector("[data-page-tool=phone]:focus");
    assert.deepEqual(errors, []);
    await close();
});

test("phone link: the server's own token is added to the link only if the user wants it", async () => {
    const server = await startServer({ options: ["--token", "let+in"] });
    const { page, close } = await openPage({ url: server.url, colorScheme: "dark" }); // has cookies of its own
    await ready(page);
    await openDialog(page);
    await page.waitForSelector("#phone-key");
    const link = await read(page);
    assert.equal(new URL(link).search, "");
    await page.click("#phone-adds-token");
    await page.waitForFunction((before) => document.getElementById("phone-link").value !== before, link);
    const open = await read(page);
    assert.equal(new URL(open).searchParams.get("token"), "let+in");
    const phone = await openPage({ url: open, colorScheme: "light" }); // does not have the cookies of the other page
    await ready(phone.page);
    await phone.page.locator("#drawing").focus();
    await phone.page.keyboard.press("n");
    await named(page, "8-cell");
    await phone.close(); // in Firefox, this page has the focus

    await page.keyboard.press("Escape");
    await page.waitForSelector("#drawing:focus");
    await openDialog(page);
    assert.equal(await page.inputValue("#phone-link"), link, "each time is a choice");
    // The browser has the token as a cookie, which the page cannot read.
    await page.goto(server.url.replace(/\?.*/, ""));
    await ready(page);
    await openDialog(page);
    await page.waitForSelector("#phone-locked");
    assert.equal(await page.locator("#phone-key").isVisible(), false);
    await close();
    await server.stop();
});

test("phone link: a link that is too long for a QR code is shown and copied without one", async () => {
    const server = await startServer({ options: ["--token", "long".repeat(600)] });
    const { page, close } = await openPage({ url: server.url, colorScheme: "dark" }); // has cookies of its own
    await ready(page);
    await openDialog(page);
    await page.waitForSelector("#phone-key");
    const link = await read(page);
    assert.equal(await page.locator("#phone-too-long").isVisible(), false);
    await page.click("#phone-adds-token");
    await page.waitForSelector("#phone-too-long");
    assert.match(await page.locator("#phone-too-long").textContent(), /too long for a QR code.*[Cc]opy it.*leave out/);
    assert.equal(await page.locator("#phone-code").isVisible(), false);
    assert.ok((await page.inputValue("#phone-link")).length > 2400, "the link is shown");
    await page.click("#phone-adds-token");
    await page.waitForSelector("#phone-code");
    assert.equal(await read(page), link);
    assert.equal(await page.locator("#phone-too-long").isVisible(), false);
    await close();
    await server.stop();
});

test("phone link: an address that phones can reach is shown without a warning", async () => {
    const host = "oval.test"; // stands for the computer's name in a network
    const server = await startServer({ options: ["--allow-host", host] });
    const preferences = { "network.dns.localDomains": host, "dom.security.https_first": false };
    const browser = await startBrowser([`--host-resolver-rules=MAP ${host} 127.0.0.1`], preferences);
    const url = new URL(server.url);
    url.hostname = host;
    const { page, close } = await openPage({ url: url.href, browser });
    await ready(page);
    await openDialog(page);
    assert.equal(await page.locator("#phone-loopback").isVisible(), false);
    assert.ok((await read(page)).startsWith(`${url.href}#session=`));
    await page.click("#phone-copy"); // without HTTPS, the page cannot write to the clipboard
    await page.waitForSelector("#phone-link:focus");
    assert.match(await page.locator("#phone-status").textContent(), /Ctrl-C/);
    await close();
    await browser.close();
    await server.stop();
});
