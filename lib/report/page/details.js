/* Shows the details of a test and a frame as cards: metrics, commands, changes, notes, run, hashes.
 */

/* Returns a number to four significant digits. Numbers that JSON lacks, such as infinity, are
 * texts. */
function formatNumber(value) {
    if (value === "inf") return "\u221e";
    if (value === "-inf") return "\u2212\u221e";
    if (typeof value !== "number") return "not a number";
    if (value === 0) return "0";
    const size = Math.abs(value);
    if (size >= 1e6 || size < 1e-4) return value.toExponential(2);
    return size >= 1000 ? value.toFixed(0) : String(Number(value.toPrecision(4)));
}

function card(name, small, ...children) {
    return make("section", { class: "card", "aria-label": name },
        make("h3", {}, name, small ? make("small", {}, small) : null), ...children);
}

/* Returns the share of its limit that a value takes up: 1 is at the limit. */
function shareOf(column, value) {
    const number = (v) => (v === "inf" ? Infinity : typeof v === "number" ? v : NaN);
    const over = column.higherIsBetter ? column.limit : number(value);
    const under = column.higherIsBetter ? number(value) : column.limit;
    if (Number.isNaN(over) || Number.isNaN(under)) return Infinity;
    if (under === Infinity) return 0;
    return under > 0 ? over / under : over > under ? Infinity : 0;
}

/* Returns a bar for a share of the limit. The limit is in the middle. */
function barOf(share) {
    const width = Math.min(100, share * 50);
    return makeSvg("svg", { viewBox: "0 0 100 10", preserveAspectRatio: "none", "aria-hidden": "true" },
        makeSvg("rect", { class: "ground", width: 100, height: 10 }),
        makeSvg("rect", { class: "value", y: 2, width, height: 6 }),
        makeSvg("rect", { class: "mark-limit", x: 49.6, width: 0.8, height: 10 }));
}

function metricRow(column, value, beyond) {
    const { limited } = column;
    const share = limited ? shareOf(column, value) : 0;
    const times = share >= 100 ? "> 100" : formatNumber(Number(share.toPrecision(3)));
    const verdict = !limited ? "" : beyond ? `${times}\u00d7, beyond` : `${times}\u00d7`;
    return make("tr", { class: beyond ? "beyond" : limited ? "within" : "free" },
        make("th", { scope: "row" }, column.name),
        make("td", { class: "number" }, formatNumber(value) + (column.unit ? " " + column.unit : "")),
        make("td", { class: "number" }, limited ? (column.higherIsBetter ? "\u2265 " : "\u2264 ") + formatNumber(column.limit) : "\u2013"),
        make("td", { class: "bar" }, limited ? barOf(share) : null),
        make("td", { class: "number" }, verdict));
}

function metricsCard(test, frame) {
    const judgements = {
        nothing: "nothing was compared",
        state: "judged by the state hash: the simulation changed",
        pixels: "judged by its pixels, which are known",
        metrics: "judged by the metrics",
    };
    const small = judgements[frame.judgedBy] || "";
    if (!frame.measured) return card("Metrics", small, make("p", { class: "command muted" }, "This frame was not measured."));
    const rows = test.columns.map((column, i) => ({ column, value: frame.values[i], beyond: Boolean(frame.beyond[i]) }));
    rows.sort((a, b) => b.column.limited - a.column.limited);
    const head = ["Metric", "Value", "Limit", "", "Of limit"].map((text, i) =>
        make("th", { scope: "col", class: i && i !== 3 ? "number" : "" }, text || make("span", { class: "sr" }, "Bar")));
    const window = `${frame.windowWidth}\u00d7${frame.windowHeight} at ${frame.windowX}, ${frame.windowY}`;
    const where = frame.windowWidth ? `Largest difference at ${frame.worstX}, ${frame.worstY}; densest window ${window}: ${frame.windowDiffering} pixels.` : "";
    return card("Metrics", small,
        make("div", { class: "scroll" }, make("table", {}, make("thead", {}, make("tr", {}, ...head)),
            make("tbody", {}, ...rows.map((row) => metricRow(row.column, row.value, row.beyond))))),
        where ? make("p", { class: "command muted" }, where) : null);
}

/* Returns an element with a value and, beside it, the accepted value. */
function compared(now, accepted, name) {
    if (!now && !accepted) return make("span", { class: "muted" }, "not known");
    const value = make("span", { class: name }, now || "none");
    if (!accepted) return make("span", {}, value, make("span", { class: "muted" }, " nothing accepted"));
    if (now === accepted) return make("span", {}, value, make("span", { class: "same" }, " as accepted"));
    return make("span", {}, value, make("span", { class: "other" }, " accepted: "), make("span", { class: name }, accepted));
}

function pairsCard(name, pairs) {
    const list = make("dl", { class: "pairs" });
    for (const [key, value] of pairs)
        if (value !== "" && value !== null) list.append(make("dt", {}, key), make("dd", {}, value));
    return card(name, "", list);
}

function runCard(test) {
    const log = test.log ? `${test.folder}/${test.log}` : "";
    return pairsCard("Run", [
        ["Device", test.device],
        ["Driver", test.driver],
        ["Platform", test.platform],
        ["Techniques", test.techniques || test.techniquesExpected ? compared(test.techniques, test.techniquesExpected, "") : ""],
        ["Picture", test.width ? `${test.width} \u00d7 ${test.height}${test.hdr ? ", linear; shown tone-mapped" : ""}` : ""],
        ["Seed", test.width ? String(test.seed) : ""],
        ["Threads", test.threads ? `${test.threads}${test.repeat > 1 ? `, rendered ${test.repeat} times` : ""}` : ""],
        ["Scene", test.scene],
        ["Test", test.test === test.scene ? "" : test.test],
        ["Goldens", test.golden],
        ["Log", log ? make("span", { class: "mono" }, log) : ""],
        ["Started", test.started ? `${test.started}, took ${test.totalS.toFixed(2)} s` : ""],
        ["kiln", test.version],
    ]);
}

function hashesCard(test, frame) {
    const pairs = [];
    if (frame)
        pairs.push(["State", compared(frame.state, frame.stateExpected, "hash")],
            ["Pixels", compared(frame.pixels, frame.pixelsExpected, "hash")]);
    if (test.sceneHash || test.sceneHashExpected)
        pairs.push(["Scene", compared(test.sceneHash, test.sceneHashExpected, "hash")]);
    if (test.deviceName) pairs.push(["Known as", make("span", { class: "hash" }, test.deviceName)]);
    if (frame && frame.kilnExpected) pairs.push(["Accepted", make("span", {}, "of kiln " + frame.kilnExpected)]);
    if (frame && frame.golden) pairs.push(["Golden", make("span", { class: "mono" }, frame.golden)]);
    return pairs.length ? pairsCard("Hashes", pairs) : null;
}

function changesCard(test) {
    const count = test.changes.length;
    const rows = test.changes.map(([key, before, after, place]) => make("tr", {},
        make("th", { scope: "row", class: "mono" }, key),
        make("td", { class: "before" }, before || "\u2013"), make("td", { class: "after" }, after || "\u2013"),
        make("td", { class: "mono" }, place)));
    const head = ["Key", "Accepted", "Now", "From"].map((text) => make("th", { scope: "col" }, text));
    return card("Scene", `${count} ${count === 1 ? "key differs" : "keys differ"} from the accepted one`,
        make("div", { class: "scroll" }, make("table", {}, make("thead", {}, make("tr", {}, ...head)), make("tbody", {}, ...rows))));
}

async function copy(text, name) {
    let done = false;
    try {
        await navigator.clipboard.writeText(text);
        done = true;
    } catch {
        const area = make("textarea", { value: text });
        document.body.append(area);
        area.select();
        done = document.execCommand("copy");
        area.remove();
    }
    byId("spoken").textContent = done ? `${name}: copied` : "The browser does not let the page copy.";
    return done;
}

function command(id, name, text) {
    const button = make("button", { type: "button", id }, "Copy", make("span", { class: "sr" }, ` the command to ${name}`));
    button.addEventListener("click", async () => {
        const done = await copy(text, "The command to " + name);
        button.firstChild.textContent = done ? "Copied" : "Not copied";
        setTimeout(() => { button.firstChild.textContent = "Copy"; }, 1500);
    });
    return make("div", { class: "command" }, make("div", {}, make("span", {}, `To ${name}`), make("code", {}, text)), button);
}

function showDetails(test, frame) {
    const cards = [];
    if (frame) cards.push(metricsCard(test, frame));
    const commands = [];
    if (test.rerun) commands.push(command("copy-rerun", "run it again", test.rerun));
    if (test.approve) commands.push(command("copy-approve", "approve the pictures", test.approve));
    if (commands.length) cards.push(card("Commands", "", ...commands));
    if (test.changes.length) cards.push(changesCard(test));
    if (test.notes.length)
        cards.push(card("Notes", "", make("ul", { class: "notes" }, ...test.notes.map((note) => make("li", {}, note)))));
    cards.push(runCard(test), hashesCard(test, frame));
    byId("facts").replaceChildren(...cards.filter(Boolean));
}
