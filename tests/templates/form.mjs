// The form of examples/templates, used as a person would use it: form.mjs SOURCE OUT, where OUT has
// the files that form.sh made.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { startBrowser } from "../report/browser.mjs";

const [source, out] = process.argv.slice(2);
const browser = await startBrowser();
after(() => browser.close());

async function open(file) {
    const page = await browser.open(join(out, "form.html"), { allow: ["data:"] });
    await page.setInputFiles("#file", join(out, file));
    await page.waitForSelector("#form:not([hidden]), #problem:not(:empty)");
    return page;
}

const values = async (page) => page.locator("#values").innerText();
const field = (page, name) => page.getByLabel(name, { exact: true });

async function fill(page, name, value) {
    const input = field(page, name);
    if (typeof value === "boolean") await input.setChecked(value);
    else await input.fill(String(value));
}

for (const name of ["lower_third", "logo_sting", "counter"]) {
    test(`makes ${name}.json`, async () => {
        const wanted = JSON.parse(readFileSync(join(source, "examples/templates", name + ".json"), "utf8"));
        const page = await open("params.json");
        for (const [param, value] of Object.entries(wanted)) await fill(page, param, value);
        const made = JSON.parse(await values(page));
        // The form leaves out what is as the scene declares it.
        for (const param of JSON.parse(readFileSync(join(out, "params.json"), "utf8")).params) {
            const value = wanted[param.name] ?? param.default;
            assert.deepEqual(made[param.name], value === param.default ? undefined : value, param.name);
        }
        const link = await page.locator("#save").getAttribute("href");
        writeFileSync(join(out, `made_${name}.json`), decodeURIComponent(link.split(",").slice(1).join(",")));
        await page.screenshot({ path: join(out, `form_${name}.png`), fullPage: true });
    });
}

test("has a field for every kind", async () => {
    const page = await open("all.json");
    assert.equal(await values(page), "{}");
    await fill(page, "tilt", 30);
    await fill(page, "place y", 2.5);
    await fill(page, "shade", "orange");
    await field(page, "style").selectOption("wild");
    await fill(page, "title", "$place");
    const made = await values(page);
    assert.deepEqual(JSON.parse(made), { tilt: "30 deg", place: [0, 2.5, 2], shade: "orange", style: "wild", title: "$place" });
    writeFileSync(join(out, "made_all.json"), made);
    assert.equal(await page.evaluate(() => window.harmed), undefined);
});

test("refuses values out of their range", async () => {
    const page = await open("params.json");
    await fill(page, "length", 40);
    assert.equal(await values(page), "a value is not allowed");
    assert.equal(await page.locator("#save").getAttribute("href"), null);
    await fill(page, "length", 5);
    assert.deepEqual(JSON.parse(await values(page)), { length: 5 });
});

test("says what it cannot read", async () => {
    const page = await open("title.yaml");
    assert.match(await page.locator("#problem").innerText(), /^This is not the output of kiln params --json/);
    assert.deepEqual(browser.faults, []);
});
