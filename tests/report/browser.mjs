// A browser without a network, and what the tests ask of a page.
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

// Limits are for hangs, also on a slow machine that does other things besides.
const PATIENCE_MS = 120000;

export async function startBrowser() {
    const profile = mkdtempSync(join(tmpdir(), "kiln-page-"));
    const context = await chromium.launchPersistentContext(profile, {
        executablePath: process.env.KILN_CHROMIUM,
        args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
            "--disable-background-networking", "--disable-component-update", "--disable-sync"],
        offline: true,
        timeout: PATIENCE_MS,
        viewport: { width: 1440, height: 900 },
    });
    context.setDefaultTimeout(PATIENCE_MS);
    const faults = []; // of every page: nothing may be asked for but the page and its links
    let allowed = () => true;
    context.on("request", (request) => {
        const url = request.url();
        if (!url.startsWith("data:") && !allowed(url)) faults.push(`request: ${url}`);
    });
    context.on("console", (message) => {
        if (message.type() === "error" || message.type() === "warning") faults.push(`console: ${message.text()}`);
    });
    context.on("weberror", (error) => faults.push(`error: ${error.error().stack}`));
    context.on("requestfailed", (request) => faults.push(`failed: ${request.url().slice(0, 200)}`));
    return {
        faults,
        // Opens a report in a page of its own; other files are requests that fail the test.
        async open(file, { hash = "", allow = [], ...emulated } = {}) {
            const url = pathToFileURL(file).href;
            allowed = (asked) => asked.split("#")[0] === url || allow.some((part) => asked.includes(part));
            const page = await context.newPage();
            if (Object.keys(emulated).length) await page.emulateMedia(emulated);
            await page.goto(url + hash);
            return page;
        },
        async close() {
            await context.close();
            rmSync(profile, { recursive: true, force: true });
        },
    };
}

// Waits until the pictures of a frame are on the stage.
export async function shown(page, frame) {
    await page.waitForSelector(`#stage[data-frame="${frame}"]`);
    await settle(page);
}

// Until what was asked for is drawn.
export const settle = (page) => page.evaluate(() =>
    new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));

// The colour that a pane shows for a pixel of the picture.
export const drawn = (page, pane, x, y) => page.evaluate(([index, px, py]) => {
    const { canvas } = viewer.panes[index];
    const scale = viewer.scale(), [left, top] = viewer.origin();
    const at = [left + (px + 0.5) * scale, top + (py + 0.5) * scale].map(Math.round);
    return [...canvas.getContext("2d").getImageData(...at, 1, 1).data.slice(0, 3)];
}, [pane, x, y]);

// The colours of a pixel in the pictures themselves.
export const source = (page, kind, x, y) => page.evaluate(([name, px, py]) =>
    pixelOf(viewer.shown[name], px, py), [kind, x, y]);

// Texts whose contrast with what is behind them is below WCAG's AA: 4.5, 3 for large ones.
export const faint = (page) => page.evaluate(() => {
    const parse = (color) => {
        const [r, g, b, a = 1] = color.match(/[\d.]+/g).map(Number);
        return { rgb: [r, g, b], a };
    };
    const over = (top, below) => top.rgb.map((v, i) => v * top.a + below[i] * (1 - top.a));
    const behind = (element) => {
        if (!element) return [255, 255, 255];
        const color = parse(getComputedStyle(element).backgroundColor);
        return color.a === 1 ? color.rgb : over(color, behind(element.parentElement));
    };
    const luminance = (rgb) => {
        const [r, g, b] = rgb.map((v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const found = [];
    let seen = 0;
    for (const element of document.querySelectorAll("body *")) {
        const text = [...element.childNodes].some((node) => node.nodeType === 3 && node.data.trim());
        const disabled = element.closest(":disabled");
        if (!text || disabled || !element.checkVisibility() || element.closest("script, option, .sr")) continue;
        const style = getComputedStyle(element), size = parseFloat(style.fontSize);
        const ground = behind(element);
        const [a, b] = [luminance(over(parse(style.color), ground)), luminance(ground)];
        const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
        const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
        seen++;
        if (contrast < (large ? 3 : 4.5))
            found.push(`${element.tagName}.${element.className} "${element.textContent.slice(0, 30)}": ${contrast.toFixed(2)}`);
    }
    return { seen, found };
});

// Controls that a screen reader could not name, and ids that are there twice.
export const unnamed = (page) => page.evaluate(() => {
    const found = [];
    const named = (element) => element.getAttribute("aria-label") || element.textContent.trim() || element.title ||
        (element.getAttribute("aria-labelledby") && document.getElementById(element.getAttribute("aria-labelledby"))) ||
        (element.labels && element.labels.length > 0);
    for (const element of document.querySelectorAll("button, input, select, [role], canvas, nav, main, section"))
        if (!named(element) && element.checkVisibility() && element.getAttribute("role") !== "status")
            found.push(element.outerHTML.slice(0, 120));
    const ids = [...document.querySelectorAll("[id]")].map((element) => element.id);
    for (const id of new Set(ids.filter((id, i) => ids.indexOf(id) !== i))) found.push(`id ${id} twice`);
    return found;
});
