// URLs that open a view, and links that share a session.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { common, named, openPage, openWithScript, presented, ready, scriptFor } from "./support/browser.mjs";

test("links: a query opens its view", async () => {
    const { url } = await common();
    const query =
        "?polytope=24-cell&rotate=xw,yz:pi/8,pi/sqrt(3)-pi/8&rotate=xy:0.1+0.1&slices=31&alpha=pi/8&background=white&width=640";
    const { page, errors, close } = await openPage({ url: url + query });
    await ready(page);
    const script = await scriptFor(page);
    const state = await script.state();
    assert.equal(state.polytope.name, "24-cell");
    assert.equal(state.slices.count, 31);
    assert.equal(state.alpha, Math.PI / 8);
    assert.equal(state.background, "white");
    assert.deepEqual(state.last, { planes: ["xy"], angles: [0.2] });
    assert.ok(Math.abs(state.orientation[3][3] - Math.cos(Math.PI / 8)) < 1e-12);
    assert.equal(await page.locator("#notice").textContent(), "");
    await presented(page, state.revision);
    assert.deepEqual(errors, []);

    // A reload does not repeat the rotation. Another query opens another view.
    await page.reload();
    await ready(page);
    assert.equal((await script.state()).revision, state.revision);
    script.leave();
    await page.goto(`${url}?polytope=16-cell`);
    await named(page, "16-cell");
    await close();
});

test("links: Back and Forward return to the sessions of the pages before; a link that is opened again is a new one", async () => {
    const { url } = await common();
    const { page, script, press, errors, close } = await openWithScript();
    await script.request({ type: "set", polytope: "16-cell" });
    const first = await press("y");
    const sessionOf = async (name) => {
        await named(page, name);
        await ready(page);
        const joined = await scriptFor(page);
        joined.leave();
        return joined.client.credentials.session;
    };
    const { session } = script.client.credentials;
    await page.goto(`${url}?polytope=tesseract`);
    const second = await sessionOf("8-cell");
    assert.notEqual(second, session);
    const other = await scriptFor(page);
    await other.request({ type: "set", slices: { count: 5 } });

    await page.goBack();
    assert.equal(await sessionOf("16-cell"), session);
    assert.equal((await script.state()).revision, first.revision, "the session is as it was left");
    await page.goForward();
    assert.equal(await sessionOf("8-cell"), second);
    await page.waitForFunction(() => document.querySelector("[data-state-field=slices]").textContent === "5");
    await page.reload();
    assert.equal(await sessionOf("8-cell"), second);

    await page.goto(`${url}favicon.svg`);
    await page.goto(`${url}?polytope=tesseract`);
    assert.notEqual(await sessionOf("8-cell"), second, "the link opens its view");
    await page.goBack();
    await page.goBack();
    assert.equal(await sessionOf("8-cell"), second);
    assert.equal(await page.locator("#notice").textContent(), "");
    assert.deepEqual(errors, []);
    other.leave();
    script.leave();
    await close();
});

test("links: Back leaves a session that was joined without loading the page again", async () => {
    const { url } = await common();
    const joined = await openWithScript();
    await joined.script.request({ type: "set", polytope: "24-cell" });
    const { session, token } = joined.script.client.credentials;
    const { page, script, close } = await openWithScript();
    await script.request({ type: "set", polytope: "16-cell" });
    await named(page, "16-cell");
    await page.goto(`${url}#session=${session}&token=${token}`);
    await named(page, "24-cell");
    await ready(page);
    await page.goBack();
    await named(page, "16-cell");
    await page.goForward();
    await named(page, "24-cell");
    await close();
    await joined.close();
});

test("links: a query is read as standard clients encode it, without what other sites append", async () => {
    const { url } = await common();
    const sum = new URLSearchParams({ rotate: "xw:0.1 + 0.2", polytope: "truncated 5-cell" });
    const { page, errors, close } = await openPage({ url: `${url}?utm_source=mail&${sum}&amp;fbclid=1&alpha=0.1%252Bpi/8` });
    await named(page, "truncated 5-cell");
    const script = await scriptFor(page);
    const { last, alpha } = await script.until((one) => one.alpha > 0.4, "the view");
    assert.deepEqual([last.planes, alpha], [["xw"], 0.1 + Math.PI / 8]);
    assert.ok(Math.abs(last.angles[0] - 0.3) < 1e-12);
    assert.equal(await page.locator("#notice").textContent(), "");
    assert.deepEqual(errors, []);
    script.leave();
    await close();
});

test("links: a query opens the matrix at a point", async () => {
    const { url } = await common();
    const query = "?view=matrix&polytope=24-cell&point=0.2,-0.1,sqrt(2)/4,0.5";
    const { page, errors, close } = await openPage({ url: url + query });
    await ready(page);
    const script = await scriptFor(page);
    const { view, point, section } = await script.state();
    assert.deepEqual([view, point, section.w], ["matrix", [0.2, -0.1, Math.SQRT2 / 4, 0.5], 0.5]);
    assert.equal(await page.locator("#notice").textContent(), "");
    assert.deepEqual(errors, []);
    script.leave();
    await close();
});

test("links: all errors in a query are reported, and the rest of the query applies", async () => {
    const { url } = await common();
    const { page, errors, close } = await openPage({ url: `${url}?polytope=25-cell&alpha=two&slices=11&sides=3` });
    await page.waitForFunction(() => /“set sides=3”/.test(document.getElementById("notice").textContent));
    const lines = (await page.locator("#notice").textContent()).split("\n");
    assert.equal(lines.length, 3);
    const faults = ["polytope 25-cell", "set alpha=two", "set sides=3"];
    faults.forEach((fault, i) => assert.ok(lines[i].includes(`“${fault}”`), lines[i]));
    await page.waitForFunction(() => document.querySelector("[data-state-field=slices]").textContent === "11");
    assert.deepEqual(errors, []);
    await close();
});

test("links: errors in a query stay while keys are pressed, until the user closes them", async () => {
    const { url } = await common();
    const closings = [(page) => page.click("#notice button"), (page) => page.keyboard.press("Escape")];
    for (const closeNotice of closings) {
        const { page, errors, close } = await openPage({ url: `${url}?field=tigr` });
        await page.waitForFunction(() => /did you mean 'tiger'/.test(document.getElementById("notice").textContent));
        await ready(page);
        const script = await scriptFor(page);
        const { revision } = await script.state();
        await page.keyboard.press("y");
        await script.until((state) => state.revision > revision, "the rotation");
        assert.match(await page.locator("#notice").textContent(), /did you mean 'tiger'/);
        await closeNotice(page);
        assert.equal(await page.locator("#notice").textContent(), "");
        assert.deepEqual(errors, []);
        script.leave();
        await close();
    }
});

test("links: a shared link joins the session, and both see every change", async () => {
    const { url } = await common();
    const first = await openWithScript({ permissions: ["clipboard-read", "clipboard-write"] });
    await first.press("4");
    await first.page.click("#share-button");
    await first.page.waitForFunction(() => /copied/.test(document.getElementById("notice").textContent));
    const link = await first.page.evaluate(() => navigator.clipboard.readText());
    const second = await openPage({ url: link });
    await ready(second.page);
    assert.equal(second.page.url(), url, "the token does not stay in the URL");
    const { revision } = await first.press("y");
    await presented(second.page, revision);
    await second.page.locator("#drawing").focus();
    await second.page.keyboard.press("n");
    const after = await first.script.until((one) => one.polytope.name !== "5-cell", "the other page's key");
    await presented(first.page, after.revision);
    await named(first.page, after.polytope.name);
    await second.close();
    await first.close();
});

test("links: a link pasted into an open tab joins its session", async () => {
    const { url } = await common();
    const { script, close } = await openWithScript();
    await script.request({ type: "set", polytope: "24-cell" });
    const { session, token } = script.client.credentials;
    const { page, errors, close: closeOther } = await openPage();
    await ready(page);
    await page.evaluate(() => void (window.stays = true));
    await page.goto(`${url}#session=${session}&token=${token}`);
    await named(page, "24-cell");
    assert.equal(page.url(), url, "the token does not stay in the URL");
    const { revision } = await script.request({ type: "rotate", planes: ["xy"], angles: [1] });
    await presented(page, revision);

    await page.goto(`${url}#session=${session}&token=wrong`);
    await page.waitForFunction(() => /cannot be opened/.test(document.getElementById("notice").textContent));
    await named(page, "5-cell");
    assert.equal(await page.evaluate(() => window.stays), true, "the page is not loaded again");
    assert.deepEqual(errors, []);
    await closeOther();
    await close();
});

test("links: a link to a session that was damaged on its way is joined or reported", async () => {
    const { url } = await common();
    const { script, close } = await openWithScript();
    await script.request({ type: "set", polytope: "24-cell" });
    const { session, token } = script.client.credentials;
    const { page, close: closeOther } = await openPage({ url: `${url}#session=${session}&amp;token=${token}` });
    await named(page, "24-cell");
    for (const fragment of [`session=${session}`, `session=${session}&tok`, `token=${token}`, "session=&token="]) {
        await page.evaluate(() => (document.getElementById("notice").textContent = ""));
        await page.goto(`${url}#${fragment}`);
        await page.waitForFunction(() => /link .* is damaged/.test(document.getElementById("notice").textContent));
        assert.equal(page.url(), url, "the token does not stay in the URL");
    }
    const other = await openPage({ url: `${url}#session=${session}` });
    await other.page.waitForFunction(() => /link .* is damaged/.test(document.getElementById("notice").textContent));
    await named(other.page, "5-cell");
    await other.close();
    await closeOther();
    await close();
});

test("links: a session that cannot be opened is reported, and a new one begins", async () => {
    const { url } = await common();
    const { script, close } = await openWithScript();
    const { session } = script.client.credentials;
    for (const fragment of ["session=nonesuch&token=x", `session=${session}&token=wrong`]) {
        const { page, close: closeOther } = await openPage({ url: `${url}#${fragment}` });
        await page.waitForFunction(() => /cannot be opened/.test(document.getElementById("notice").textContent));
        await page.waitForSelector("#connection[data-kind=open]");
        const other = await scriptFor(page);
        assert.notEqual(other.client.credentials.session, session);
        other.leave();
        await closeOther();
    }
    await close();
});
