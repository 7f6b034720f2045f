// The report page, used as a person would use it: page.mjs OUT, where OUT has the reports that
// page.sh made. Each view is asserted by what is on the page, and photographed into OUT.
import assert from "node:assert/strict";
import { readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { drawn, faint, settle, shown, source, startBrowser, unnamed } from "./browser.mjs";

const out = process.argv[2];
const cases = join(out, "out/test/report.html"), many = join(out, "many/report.html");
const browser = await startBrowser();
after(() => browser.close());

const BEAM = "#test=effects/fire_beam", WORST = 89;
const PIXEL = [63, 46]; // where the sides differ much

const text = (page, selector) => page.locator(selector).innerText();
const photograph = (page, name) => page.screenshot({ path: join(out, name + ".png") });
const near = (a, b, slack, what) => a.forEach((v, i) =>
    assert.ok(Math.abs(v - b[i]) <= slack, `${what}: ${a} is not ${b}`));

async function openBeam(options = {}) {
    const page = await browser.open(cases, { hash: BEAM, ...options });
    await shown(page, WORST);
    return page;
}

test("opens with the worst test and its reason", async () => {
    const page = await browser.open(cases);
    assert.match(await page.title(), /^4 of 7 tests did not pass/);
    assert.equal(await text(page, "#name"), "weather/storm");
    assert.match(await text(page, "#reason"), /there is no key '<img src'/);
    assert.match(await text(page, "#about"), /<\/script><script>window.harmed=1/);
    assert.equal(await page.locator("#viewer").isVisible(), false);
    const order = await page.$$eval("#rows li", (rows) => rows.map((row) => row.classList[0]));
    assert.deepEqual(order, ["error", "fail", "fail", "new", "change", "skip", "pass"]);
    assert.deepEqual(await page.$$eval(".count", (all) => all.map((b) => b.textContent.trim())),
        ["1 error", "2 fail", "1 new", "1 change", "1 skip", "1 pass"]);
    await photograph(page, "error-light");
    await page.close();
});

test("does not scroll behind its columns", async () => {
    for (const [path, hash] of [[cases, BEAM], [cases, ""], [many, "#test=effects/case_0000"]]) {
        const page = await browser.open(path, { hash });
        await page.waitForSelector("#name:not(:empty)");
        const [height, room] = await page.evaluate(() =>
            [document.documentElement.scrollHeight, document.documentElement.clientHeight]);
        assert.ok(height <= room, `${path}${hash}: a page of ${height} pixels in a window of ${room}`);
        await page.close();
    }
});

test("copies one command that approves all pictures", async () => {
    const page = await browser.open(cases);
    assert.equal(await text(page, ".command:has(#copy-approve-all) code"), "kiln test approve --all");
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
    await page.locator("#copy-approve-all").click();
    await page.waitForFunction(() => document.querySelector("#copy-approve-all").textContent.startsWith("Copied"));
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), "kiln test approve --all");
    assert.match(await text(page, ".run"), /\d+ frames: \d+ by pixels, \d+ by metrics/);
    await photograph(page, "approve-all");
    await page.close();
});

test("runs nothing that a test has in its texts", async () => {
    const page = await browser.open(many, { hash: "#test=effects/case_0000" });
    await shown(page, 24);
    for (const selector of ["#reason", "#about", ".notes", "td.before", "dd", "#facts code", "li .why"])
        assert.ok((await page.locator(selector).first().innerText()).includes("</script><script>window.harmed=1"), selector);
    assert.equal(await page.evaluate(() => window.harmed), undefined);
    assert.equal(await page.locator("img").count(), 0);
    // Should an escape ever be forgotten, the policy still stops what came of it.
    await page.evaluate(() => {
        const script = document.createElement("script");
        script.textContent = "window.harmed = 3";
        document.body.append(script);
    });
    assert.equal(await page.evaluate(() => window.harmed), undefined);
    const refused = browser.faults.splice(0);
    assert.ok(refused.length > 0 && refused.every((fault) => fault.includes("Content Security Policy")), refused.join("\n"));
    await page.close();
});

test("searches, filters and sorts", async () => {
    const page = await browser.open(cases);
    const names = () => page.$$eval("#rows li:not([hidden]) .name", (all) => all.map((e) => e.textContent));
    await page.keyboard.press("/");
    await page.keyboard.type("FLIP.p99 beyond");
    assert.deepEqual(await names(), ["effects/linear", "effects/fire_beam"]);
    assert.equal(await text(page, "#found"), "2 of 7 tests");
    await page.keyboard.type(" nowhere");
    assert.equal(await page.locator("#none").isVisible(), true);
    await page.click("#clear");
    assert.equal(await text(page, "#found"), "7 tests");
    await page.click(".count.new");
    await page.click(".count.pass");
    assert.equal(await page.getAttribute(".count.new", "aria-pressed"), "true");
    assert.deepEqual(await names(), ["post/sparks", "post/tonemap"]);
    await photograph(page, "filtered-light");
    await page.click(".count.new");
    await page.click(".count.pass");
    await page.selectOption("#sort", "name");
    assert.equal((await names())[0], "effects/fire_beam");
    await page.selectOption("#sort", "time");
    const seconds = await page.$$eval("#rows li", (rows) => rows.map((row) => Number(row.dataset.time)));
    assert.deepEqual(seconds, [...seconds].sort((a, b) => b - a));
    await page.selectOption("#sort", "score");
    assert.equal((await names())[0], "effects/linear");
    await page.close();
});

test("shows both sides, the error map and the difference", async () => {
    const page = await openBeam();
    assert.deepEqual(await page.$$eval(".pane figcaption:first-of-type", (all) => all.map((e) => e.textContent)),
        ["Reference", "Result", "Error map", "Difference \u00d78"]);
    const [a, b] = [await source(page, "reference", ...PIXEL), await source(page, "result", ...PIXEL)];
    assert.notDeepEqual(a, b);
    near(await drawn(page, 0, ...PIXEL), a, 0, "reference");
    near(await drawn(page, 1, ...PIXEL), b, 0, "result");
    near(await drawn(page, 2, ...PIXEL), await source(page, "error", ...PIXEL), 0, "error map");
    near(await drawn(page, 3, ...PIXEL), a.map((v, i) => Math.min(255, 8 * Math.abs(v - b[i]))), 0, "difference");
    assert.match(await text(page, "#reason"), /^the simulation changed: the state is \w+ at frame 89, .*flip.mean is 0\.\d+, beyond 0.01.*\nFrame 89, the worst of 24/);
    await photograph(page, "side-light");
    await page.emulateMedia({ colorScheme: "dark" });
    await settle(page);
    await photograph(page, "side-dark");
    await page.setViewportSize({ width: 1920, height: 1080 });
    await settle(page);
    await photograph(page, "side-wide");
    await page.setViewportSize({ width: 1440, height: 900 });
    await page.close();
});

test("slides", async () => {
    const page = await openBeam();
    await page.keyboard.press("2");
    await settle(page);
    assert.equal(await page.getAttribute("#mode-slider", "aria-selected"), "true");
    const [x, y] = PIXEL;
    near(await drawn(page, 0, x, y), await source(page, "reference", x, y), 0, "left of the divider");
    near(await drawn(page, 0, 120, y), await source(page, "result", 120, y), 0, "right of it");
    // By the pointer, beyond the pixel.
    const box = await page.locator("#stage").boundingBox();
    const [left] = await page.evaluate(() => viewer.origin()), scale = await page.evaluate(() => viewer.scale());
    await page.mouse.move(box.x + left + 120 * scale, box.y + 100);
    await page.mouse.down();
    await page.mouse.move(box.x + left + 32 * scale, box.y + 120, { steps: 3 });
    await page.mouse.up();
    await settle(page);
    assert.equal(await page.getAttribute("#amount", "aria-valuetext"), "20 %");
    near(await drawn(page, 0, x, y), await source(page, "result", x, y), 0, "after the drag");
    await page.keyboard.press("]");
    assert.equal(await text(page, "#amount-text"), "25 %");
    await photograph(page, "slider-light");
    await page.close();
});

test("blends", async () => {
    const page = await openBeam({ colorScheme: "dark" });
    await page.click("#mode-blend");
    await settle(page);
    const [a, b] = [await source(page, "reference", ...PIXEL), await source(page, "result", ...PIXEL)];
    near(await drawn(page, 0, ...PIXEL), a.map((v, i) => (v + b[i]) / 2), 1, "half and half");
    await page.locator("#amount").fill("100");
    await settle(page);
    near(await drawn(page, 0, ...PIXEL), b, 0, "the result alone");
    await page.locator("#amount").fill("30");
    await settle(page);
    await photograph(page, "blend-dark");
    await page.close();
});

test("flickers, unless motion is to be reduced", async () => {
    const page = await openBeam({ reducedMotion: "no-preference" });
    const caption = () => text(page, ".pane figcaption >> nth=0");
    await page.keyboard.press("4");
    assert.equal(await page.getAttribute("#play", "aria-pressed"), "true");
    await page.locator("#amount").fill("10");
    assert.equal(await text(page, "#amount-text"), "10 / s");
    await page.waitForFunction((before) => document.querySelector(".pane figcaption").textContent !== before, await caption());
    await page.keyboard.press("p");
    await settle(page);
    const held = await caption();
    await page.waitForTimeout(350);
    assert.equal(await caption(), held);
    const kind = held.toLowerCase();
    near(await drawn(page, 0, ...PIXEL), await source(page, kind, ...PIXEL), 0, held);
    await page.keyboard.press("x");
    await settle(page);
    assert.notEqual(await caption(), held);
    await photograph(page, "flicker-light");
    await page.close();

    const still = await openBeam({ reducedMotion: "reduce" });
    await still.keyboard.press("4");
    assert.equal(await still.getAttribute("#play", "aria-pressed"), "false");
    assert.equal(await still.evaluate(() => viewer.flicker.timer), 0);
    await still.click("#play");
    assert.notEqual(await still.evaluate(() => viewer.flicker.timer), 0);
    await still.close();
});

test("amplifies the difference", async () => {
    const page = await openBeam();
    await page.keyboard.press("5");
    const at = [100, 40];
    const [a, b] = [await source(page, "reference", ...at), await source(page, "result", ...at)];
    for (const [steps, gain] of [["0", 1], ["2", 4], ["7", 128]]) {
        await page.locator("#amount").fill(steps);
        await settle(page);
        near(await drawn(page, 0, ...at), a.map((v, i) => Math.min(255, gain * Math.abs(v - b[i]))), 0, `gain ${gain}`);
    }
    await page.locator("#amount").fill("3");
    await settle(page);
    await photograph(page, "difference-light");
    for (const [key, kind] of [["6", "reference"], ["7", "result"], ["8", "error"]]) {
        await page.keyboard.press(key);
        await settle(page);
        near(await drawn(page, 0, ...at), await source(page, kind, ...at), 0, kind);
    }
    await photograph(page, "map-light");
    await page.close();
});

test("zooms and pans in step, with hard pixels, and reads them out", async () => {
    const page = await openBeam();
    const box = await page.locator(".pane >> nth=1").boundingBox();
    await page.keyboard.press("z");
    await settle(page);
    assert.equal(await text(page, "#zoom-text"), "800 %");
    assert.equal(await page.locator(".swatch").count(), 2);
    // Every dot of an enlarged pixel has its colour, in each pane.
    for (const pane of [0, 1]) {
        const kind = ["reference", "result"][pane], [x, y] = [PIXEL[0] + 3, PIXEL[1] + 2];
        const color = await source(page, kind, x, y);
        const dots = await page.evaluate(([index, px, py]) => {
            const [left, top] = viewer.origin().map(Math.round);
            const { data } = viewer.panes[index].canvas.getContext("2d").getImageData(left + px * 8, top + py * 8, 8, 8);
            return [...Array(64).keys()].map((i) => [...data.slice(4 * i, 4 * i + 3)]);
        }, [pane, x, y]);
        assert.ok(dots.every((dot) => dot.join() === color.join()), `${kind} is smeared`);
    }
    await page.focus("#stage");
    await page.keyboard.press("Shift+ArrowRight");
    const center = await page.evaluate(() => viewer.center[0]);
    assert.ok(center > PIXEL[0], "panned");
    await page.mouse.move(box.x + 50, box.y + 50);
    await page.mouse.down();
    await page.mouse.move(box.x + 90, box.y + 50);
    await page.mouse.up();
    assert.equal(await page.evaluate(() => viewer.center[0]), center - 5);
    await page.mouse.wheel(0, -240);
    await settle(page);
    assert.equal(await text(page, "#zoom-text"), "1600 %");
    await page.keyboard.press("-");
    await page.keyboard.press("-");
    await settle(page);
    assert.equal(await text(page, "#zoom-text"), "400 %");
    await page.evaluate((at) => viewer.setCursor(...at, false), PIXEL);
    await page.focus("#stage");
    await page.keyboard.press("ArrowRight");
    const x = PIXEL[0] + 1;
    const [a, b] = [await source(page, "reference", x, PIXEL[1]), await source(page, "result", x, PIXEL[1])];
    const hex = (rgb) => "#" + rgb.map((v) => v.toString(16).padStart(2, "0")).join("");
    const signed = b.map((v, i) => (v > a[i] ? "+" : v < a[i] ? "\u2212" : "") + Math.abs(v - a[i])).join(" ");
    const read = (await text(page, "#readout")).replace(/\s+/g, " ");
    for (const part of [`x ${x} y ${PIXEL[1]}`, hex(a), hex(b), a.join(" "), b.join(" "), signed])
        assert.ok(read.includes(part), `${part} is not in ${read}`);
    assert.equal(await text(page, "#spoken"), `${x}, ${PIXEL[1]}; Reference ${a.join(" ")}; Result ${b.join(" ")}; difference ${signed}`);
    await page.keyboard.press("m");
    await settle(page);
    assert.equal(await page.getAttribute("#marks", "aria-pressed"), "true");
    await photograph(page, "zoom-light");
    await page.keyboard.press("0");
    assert.equal(await page.evaluate(() => viewer.zoom), null);
    await page.close();
});

test("goes through the frames of a sequence", async () => {
    const page = await openBeam();
    const track = page.getByRole("slider", { name: "Frame" });
    assert.match(await track.getAttribute("aria-valuetext"), /^Frame 89: fail, score /);
    assert.equal(await page.locator(".track rect.pass").count() > 0, true);
    assert.equal(await page.locator(".track rect.fail").count() > 10, true);
    await page.keyboard.press(",");
    await shown(page, 88);
    assert.match(await text(page, "#spoken"), /^Frame 88: fail/);
    assert.match(page.url(), /frame=88/);
    await track.focus();
    await page.keyboard.press("Home");
    await shown(page, 66);
    assert.equal(await track.getAttribute("aria-valuenow"), "0");
    assert.equal(await text(page, "#reason"), "Passed.\nFrame 66");
    const box = await track.boundingBox();
    await page.mouse.move(box.x + (box.width * 5.5) / 24, box.y + 20);
    await page.mouse.down();
    await page.mouse.move(box.x + (box.width * 10.5) / 24, box.y + 20, { steps: 4 });
    await page.mouse.up();
    await shown(page, 76);
    await photograph(page, "frames-light");
    await page.keyboard.press("w");
    await shown(page, WORST);
    await page.close();
});

test("says what is known of a test", async () => {
    const page = await openBeam();
    const facts = await text(page, "#facts");
    for (const part of ["flip.mean", "\u2264 0.01", "beyond", "psnr", "dB", "judged by the state hash", "Seed",
        "as accepted", "accepted: ", "log.txt", "Mesa", "golden/effects/fire_beam/frame_0089.png",
        "systems.fire.emit.rate", "380 1/s", "kiln test approve tests/effects/fire_beam.test.yaml"])
        assert.ok(facts.includes(part), `${part} is not in ${facts}`);
    assert.match(facts, /State\n[0-9a-f]{16} accepted: [0-9a-f]{16}/);
    assert.equal(await page.locator("tr.beyond").count(), 3);
    // What is copied, by a key and by a button.
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
    await page.keyboard.press("a");
    await page.waitForFunction(() => document.querySelector("#spoken").textContent.includes("copied"));
    const said = JSON.parse(readFileSync(join(out, "out/test/effects/fire_beam/result.json"), "utf8"));
    assert.match(said.approve, /^kiln test approve .*effects\/fire_beam/);
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), said.approve);
    await page.click("#copy-rerun");
    await page.waitForFunction(() => document.querySelector("#copy-rerun").textContent.startsWith("Copied"));
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), said.rerun);
    await page.locator("#facts").scrollIntoViewIfNeeded();
    await page.evaluate(() => document.querySelector("main").scrollTo(0, 1e5));
    await photograph(page, "facts-light");
    await page.emulateMedia({ colorScheme: "dark" });
    await photograph(page, "facts-dark");
    await page.close();
});

test("shows what has no golden, floats, and what passed by its pixels", async () => {
    const page = await browser.open(cases, { hash: "#test=post/sparks" });
    await shown(page, 66);
    assert.match(await text(page, "#reason"), /frame 66 has no golden/);
    assert.equal(await page.isDisabled("#mode-slider"), true);
    assert.equal(await page.locator(".pane").count(), 1);
    await photograph(page, "new-light");
    await page.goto(page.url().split("#")[0] + "#test=effects/linear");
    await shown(page, 66);
    await page.waitForFunction(() => viewer.shown.reference);
    assert.match(await text(page, "#facts"), /linear; shown tone-mapped/);
    const colors = await page.evaluate(() => new Set(Array.from({ length: 90 }, (_, y) => String(pixelOf(viewer.shown.reference, 80, y)))).size);
    assert.ok(colors > 30, "the preview has a picture in it");
    await photograph(page, "linear-light");
    await page.goto(page.url().split("#")[0] + "#test=post/tonemap&frame=67");
    await shown(page, 67);
    assert.match(await text(page, "#facts"), /judged by its pixels/);
    // Both sides are one picture, which is in the page once.
    assert.ok(await page.evaluate(() => page.test.frames[1].pictures[0] === page.test.frames[1].pictures[1]));
    await photograph(page, "pass-light");
    await page.close();
});

test("has an address for every view", async () => {
    const page = await browser.open(cases, { hash: BEAM + "&frame=70&mode=blend" });
    await shown(page, 70);
    assert.equal(await page.getAttribute("#mode-blend", "aria-selected"), "true");
    await page.keyboard.press("2");
    assert.match(page.url(), /#test=effects\/fire_beam&frame=70&mode=slider$/);
    await page.keyboard.press("j");
    await shown(page, 66);
    assert.equal(await text(page, "#name"), "post/sparks");
    await page.goBack();
    await shown(page, 70);
    assert.equal(await text(page, "#name"), "effects/fire_beam");
    await page.goto(page.url().split("#")[0] + "#test=no%20such&frame=%zz");
    assert.match(await text(page, "#spoken"), /The report has no test no such/);
    await page.close();
});

test("can be used with keys alone", async () => {
    const page = await browser.open(cases);
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement.id), "jump");
    await page.keyboard.press("Enter");
    assert.equal(await page.evaluate(() => document.activeElement.id), "detail");
    // One row alone is in the order of Tab, and arrows reach the others.
    assert.equal(await page.locator("#rows a[tabindex='0']").count(), 1);
    await page.locator("#rows a[tabindex='0']").focus();
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("Enter");
    await shown(page, WORST);
    assert.equal(await text(page, "#rows a[aria-current] .name"), "effects/fire_beam");
    await page.focus("#mode-side");
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.evaluate(() => document.activeElement.id), "mode-slider");
    assert.equal(await page.getAttribute("#mode-slider", "aria-selected"), "true");
    const outline = await page.evaluate(() => getComputedStyle(document.activeElement).outlineWidth);
    assert.equal(outline, "2px");
    await page.keyboard.press("?");
    assert.equal(await page.locator("#help").isVisible(), true);
    await photograph(page, "help-light");
    await page.keyboard.press("5"); // does nothing behind the help
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("#help").isVisible(), false);
    assert.equal(await page.getAttribute("#mode-slider", "aria-selected"), "true");
    // The theme goes around.
    const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    for (const [theme, color] of [["light", "rgb(243, 244, 245)"], ["dark", "rgb(23, 25, 27)"], ["auto", "rgb(243, 244, 245)"]]) {
        await page.keyboard.press("t");
        assert.equal(await text(page, "#theme"), `Theme: ${theme}`);
        assert.equal(await ground(), color);
    }
    await page.emulateMedia({ colorScheme: "dark" });
    assert.equal(await ground(), "rgb(23, 25, 27)");
    await page.close();
});

test("can be read: contrast and names", async () => {
    for (const colorScheme of ["light", "dark"]) {
        for (const hash of [BEAM, "#test=weather/storm", "#test=post/sparks", "#test=post/bloom"]) {
            const page = await browser.open(cases, { hash, colorScheme });
            await page.evaluate(() => viewer.setCursor(63, 46, false));
            const { seen, found } = await faint(page);
            assert.ok(seen > 40, "texts were looked at");
            assert.deepEqual(found, [], `${colorScheme} ${hash}`);
            assert.deepEqual(await unnamed(page), []);
            await page.keyboard.press("?");
            assert.deepEqual((await faint(page)).found, [], "help");
            await page.close();
        }
    }
});

test("fits a narrow screen", async () => {
    const page = await browser.open(cases);
    await page.setViewportSize({ width: 400, height: 800 });
    await page.reload();
    assert.equal(await page.locator("main").isVisible(), false);
    await photograph(page, "list-narrow");
    await page.click("text=fire_beam");
    await shown(page, WORST);
    assert.equal(await page.locator(".tests").isVisible(), false);
    const [inner, outer] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
    assert.equal(inner, outer);
    await photograph(page, "side-narrow");
    await page.emulateMedia({ colorScheme: "dark" });
    await page.screenshot({ path: join(out, "whole-narrow.png"), fullPage: true });
    await page.click("#back");
    assert.equal(await page.locator(".tests").isVisible(), true);
    assert.equal(await page.evaluate(() => document.activeElement.querySelector(".name").textContent), "effects/fire_beam");
    await page.close();
});

test("links its pictures", async () => {
    const file = join(out, "linked.html");
    assert.ok(statSync(file).size < 250000 && statSync(cases).size > 1000000);
    const page = await browser.open(file, { hash: BEAM, allow: ["/out/test/"] });
    await shown(page, WORST);
    assert.equal(await page.locator(".problem:visible").count(), 0);
    assert.ok(await page.evaluate(() => viewer.shown.result.width === 160));
    // A file may not read other files, but can still show them, and their difference.
    await page.evaluate(() => viewer.setCursor(63, 46, false));
    assert.match(await text(page, "#readout"), /are kept from a page that is a file/);
    await page.keyboard.press("5");
    await settle(page);
    await photograph(page, "linked-light");
    await page.goto(page.url().split("#")[0] + "#test=effects/linear");
    await shown(page, 66);
    await page.waitForFunction(() => viewer.shown.reference && viewer.shown.reference.width === 160);
    await page.close();
});

test("is quick with a thousand tests", async () => {
    const page = await browser.open(many);
    await page.waitForFunction(() => document.querySelector("#stage[data-frame]"));
    const times = await page.evaluate(() => {
        const [navigation] = performance.getEntriesByType("navigation");
        const paint = performance.getEntriesByName("first-contentful-paint")[0];
        return { paint: paint.startTime, reason: performance.getEntriesByName("kiln-ready")[0].startTime, whole: navigation.domComplete };
    });
    const filter = await page.evaluate(() => {
        const start = performance.now();
        document.querySelector("#search").value = "case_05 sim";
        list.filter();
        return document.body.offsetHeight && performance.now() - start;
    });
    const sort = await page.evaluate(() => {
        list.clear();
        document.querySelector("#sort").value = "name";
        const start = performance.now();
        list.sort();
        return document.body.offsetHeight && performance.now() - start;
    });
    const open = await page.evaluate(async () => {
        const start = performance.now();
        await pictures.load(JSON.parse(document.querySelector("#t500").textContent).frames[0].pictures[0]);
        return performance.now() - start;
    });
    const size = (statSync(many).size / 2 ** 20).toFixed(1);
    const ms = (value) => Math.round(value) + " ms";
    console.log(`1,000 tests, ${size} MiB: first paint ${ms(times.paint)}, reason ${ms(times.reason)}, ` +
        `all loaded ${ms(times.whole)}; search ${ms(filter)}, sort ${ms(sort)}, a picture ${ms(open)}`);
    assert.ok(times.paint < 3000 && times.reason < 3000, "first paint and reason");
    assert.ok(times.whole < 15000, "all loaded");
    assert.ok(filter < 2000 && sort < 2000 && open < 2000, "answers");
    assert.ok(await page.evaluate(() => pictures.cache.size) < 12, "pictures are decoded when they are shown");
    await photograph(page, "many-light");
    await page.close();
});

test("asked for nothing and complained of nothing", async () => {
    assert.deepEqual(browser.faults, []);
});
