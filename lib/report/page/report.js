/* Handles the page as a whole: the test, frame and view that the address names, the theme, the
 * buttons and the keys. */

const page = { test: null, frame: 0, tests: new Map(), shown: 0 };

function testOf(row) {
    const index = row.dataset.test;
    if (!page.tests.has(index)) page.tests.set(index, JSON.parse(byId("t" + index).textContent));
    return page.tests.get(index);
}

/* Reads the address, #test=NAME&frame=NUMBER&mode=ID. Each part is optional. */
function readAddress() {
    const address = {};
    for (const part of location.hash.slice(1).split("&")) {
        const equals = part.indexOf("=");
        try {
            if (equals > 0) address[part.slice(0, equals)] = decodeURIComponent(part.slice(equals + 1));
        } catch {
            /* a part that this page did not write is skipped */
        }
    }
    return address;
}

function writeAddress() {
    if (!page.test) return;
    const parts = ["test=" + encodeURIComponent(page.test.name).replaceAll("%2F", "/")];
    const frame = page.test.frames[page.frame];
    if (frame) parts.push("frame=" + frame.number);
    if (frame && viewer.mode !== "side") parts.push("mode=" + viewer.mode);
    history.replaceState(null, "", "#" + parts.join("&"));
}

function showReason(test, frame) {
    const reason = byId("reason");
    const worst = frame && test.frames[test.first] === frame;
    const text = frame && !worst && frame.message ? frame.message : frame && !worst ? "" : test.message || (frame ? frame.message : "");
    const texts = {
        pass: "Passed.", warn: "Passed, but beyond the warn level.", skip: "Skipped.",
        change: "Within the limits, but other pixels than were accepted.",
        new: "Nothing was accepted yet.", fail: "Failed.", error: "It could not be judged.",
    };
    const status = frame && !worst ? frame.status : test.status;
    reason.className = "reason " + status;
    reason.replaceChildren(text || texts[status]);
    const about = [];
    if (frame && test.frames.length > 1)
        about.push(`Frame ${frame.number}${worst ? ", the worst of " + test.frames.length : ""}`);
    if (status === "new" && frame && frame.golden && !text.includes(frame.golden)) about.push("Golden: " + frame.golden);
    if (test.status === "error" && test.log) about.push(`Log: ${test.folder}/${test.log}`);
    if (about.length) reason.append(make("small", {}, about.join(". ")));
}

/* Shows the pictures of a frame once they are loaded, unless another call was made meanwhile. */
async function showPictures(test, frame) {
    const request = ++page.shown;
    const kinds = ["reference", "result", "error"];
    const any = frame && frame.pictures.some((place) => place !== null);
    byId("viewer").hidden = !any && test.frames.length < 2;
    if (!frame) return;
    const shown = {}, problems = {};
    await Promise.all(kinds.map(async (kind, i) => {
        shown[kind] = null;
        try {
            shown[kind] = await pictures.load(frame.pictures[i]);
        } catch (error) {
            problems[kind] = error.message;
        }
    }));
    if (request !== page.shown) return;
    const places = {
        worst: [frame.worstX, frame.worstY],
        window: [frame.windowX, frame.windowY, frame.windowWidth, frame.windowHeight],
    };
    viewer.show(shown, problems, frame.measured ? places : null);
    byId("zoom-worst").disabled = byId("marks").disabled = !frame.measured;
    showReadout(shown, viewer.cursor);
    byId("stage").dataset.frame = frame.number; /* says that it is there */
    for (const step of [1, -1]) {
        const near = test.frames[page.frame + step];
        if (near) near.pictures.slice(0, 2).forEach((place) => pictures.load(place).catch(() => {}));
    }
}

function showFrame(index) {
    const { test } = page;
    page.frame = index;
    const frame = test.frames[index];
    showReason(test, frame);
    showDetails(test, frame);
    timeline.mark(index);
    showPictures(test, frame);
}

function showTest(row, frameNumber) {
    const test = testOf(row);
    const fresh = page.test !== test;
    page.test = test;
    list.select(row);
    byId("test").hidden = false;
    byId("detail").setAttribute("aria-label", "Test " + test.name);
    byId("name").textContent = test.name;
    byId("badge").className = "badge " + test.status;
    byId("badge").replaceChildren(make("i", { class: "mark" }), test.status);
    byId("about").textContent = test.about;
    byId("about").hidden = !test.about;
    byId("test-before").disabled = !list.neighbor(-1);
    byId("test-next").disabled = !list.neighbor(1);
    if (fresh) {
        byId("spoken").textContent = `${test.name}: ${test.status}`;
        viewer.cursor = null;
        viewer.fit();
        byId("detail").scrollTop = 0;
    }
    timeline.show(test);
    const wanted = test.frames.findIndex((frame) => String(frame.number) === frameNumber);
    showFrame(wanted >= 0 ? wanted : test.first);
}

/* Opens the test, frame and view that the address names; without a test, the first of the list. */
function route() {
    const address = readAddress();
    const named = address.test !== undefined &&
        list.rows.find((row) => testName(row) === address.test);
    if (address.test !== undefined && !named)
        byId("spoken").textContent = "The report has no test " + address.test;
    const row = named || (page.test ? null : list.visible()[0]);
    document.body.dataset.view = named ? "test" : "list";
    if (MODES.some((mode) => mode.id === address.mode)) viewer.mode = address.mode;
    if (row) showTest(row, address.frame);
}

function testName(row) {
    return row.querySelector(".name").textContent;
}

/* Opens a test by its link, which adds an entry to the browser's history. */
function open(row) {
    if (row) row.firstChild.click();
}

function setFrame(index) {
    if (index === page.frame || !page.test.frames[index]) return;
    showFrame(index);
    writeAddress();
    byId("spoken").textContent = timeline.now.textContent;
}

/* ---- Theme -------------------------------------------------------------------------------- */

function setTheme(theme) {
    if (theme === "auto") delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = theme;
    byId("theme").lastElementChild.textContent = theme;
    byId("theme").dataset.theme = theme;
    try {
        localStorage.setItem("kiln-report-theme", theme);
    } catch {
        /* without storage, the next visit follows the system */
    }
}

function nextTheme() {
    const order = ["auto", "light", "dark"];
    setTheme(order[(order.indexOf(byId("theme").dataset.theme) + 1) % order.length]);
}

function startTheme() {
    let theme = "auto";
    try {
        theme = localStorage.getItem("kiln-report-theme") || "auto";
    } catch {
        /* without storage, the theme follows the system */
    }
    setTheme(["auto", "light", "dark"].includes(theme) ? theme : "auto");
}

/* ---- Keys --------------------------------------------------------------------------------- */

const click = (id) => () => {
    const element = byId(id);
    if (element && !element.disabled) element.click();
};

const KEYS = [
    { name: "Tests" },
    { keys: ["j"], label: "next test", act: () => open(list.neighbor(1)) },
    { keys: ["k"], label: "test before", act: () => open(list.neighbor(-1)) },
    { keys: ["/"], label: "search", act: () => byId("search").focus() },
    { keys: ["r"], label: "copy the command to run it again", act: click("copy-rerun") },
    { keys: ["a"], label: "copy the command to approve it", act: click("copy-approve") },
    { name: "Frames" },
    { keys: [","], label: "frame before", act: () => setFrame(page.frame - 1) },
    { keys: ["."], label: "next frame", act: () => setFrame(page.frame + 1) },
    { keys: ["w"], label: "worst frame", act: () => setFrame(page.test.first) },
    { name: "View" },
    ...MODES.map((mode, i) => ({ keys: [String(i + 1)], label: mode.name.toLowerCase(), act: () => viewer.setMode(mode.id) })),
    { keys: ["["], label: "less: position, opacity, rate, gain", act: () => viewer.step(-1) },
    { keys: ["]"], label: "more of it", act: () => viewer.step(1) },
    { keys: ["Space", "p"], label: "play or pause flicker; swap by hand with x", act: () => viewer.effective().id === "flicker" && viewer.play(!viewer.flicker.on) },
    { keys: ["x"], label: "swap the pictures of flicker", act: () => viewer.effective().id === "flicker" && viewer.flip() },
    { name: "Zoom" },
    { keys: ["+", "="], label: "larger", act: () => viewer.zoomBy(1) },
    { keys: ["-"], label: "smaller", act: () => viewer.zoomBy(-1) },
    { keys: ["0"], label: "fit", act: () => viewer.fit() },
    { keys: ["9"], label: "one pixel to one", act: () => viewer.zoomTo(1 / (devicePixelRatio || 1)) },
    { keys: ["z"], label: "go to the largest difference", act: click("zoom-worst") },
    { keys: ["m"], label: "marks of the densest window and worst pixel", act: click("marks") },
    { keys: ["Arrows"], label: "in the picture: move the pixel; Alt: by ten" },
    { keys: ["Shift+Arrows"], label: "in the picture: move the picture" },
    { name: "Page" },
    { keys: ["t"], label: "theme: auto, light, dark", act: nextTheme },
    { keys: ["?"], label: "these keys", act: click("help-open") },
    { keys: ["Esc"], label: "close these keys" },
];

function showKeys() {
    const out = byId("keys");
    for (const entry of KEYS) {
        if (entry.name) {
            out.append(make("h3", {}, entry.name));
            continue;
        }
        const keys = entry.keys.flatMap((key, i) => [i ? " " : "", make("kbd", {}, key)]);
        out.append(make("span", {}, ...keys), make("span", {}, entry.label));
    }
}

function onStageKey(event) {
    const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const step = steps[event.key];
    if (!step || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    const [dx, dy] = step.map((v) => (event.altKey ? 10 * v : v));
    if (event.shiftKey) viewer.pan(-40 * dx, -40 * dy);
    else viewer.moveCursor(dx, dy);
}

function onKey(event) {
    const { target, key } = event;
    if (event.ctrlKey || event.metaKey || event.altKey || byId("help").open) return;
    if (target.closest("input:not([type=range]), select, textarea")) {
        if (key === "Escape") target.blur();
        return;
    }
    if (key === " " && (target.closest("button, a, select") || viewer.effective().id !== "flicker")) return;
    const name = key === " " ? "Space" : key;
    const entry = KEYS.find((row) => row.act && row.keys.includes(name));
    if (!entry || (!page.test && !"/t?".includes(key))) return;
    event.preventDefault();
    entry.act();
}

/* Makes the tabs of the modes. Arrow keys go to the next tab that is enabled. */
function startModes() {
    byId("modes").append(...MODES.map((mode, i) => {
        const tab = make("button", {
            type: "button", role: "tab", id: "mode-" + mode.id, title: `${mode.name} (${i + 1})`, "aria-controls": "stage",
        }, mode.name);
        tab.dataset.mode = mode.id;
        tab.addEventListener("click", () => viewer.setMode(mode.id));
        return tab;
    }));
    byId("modes").addEventListener("keydown", (event) => {
        const tabs = [...byId("modes").children].filter((tab) => !tab.disabled);
        const at = tabs.indexOf(event.target);
        const places = { ArrowRight: at + 1, ArrowLeft: at - 1 + tabs.length, Home: 0, End: tabs.length - 1 };
        if (!(event.key in places) || at < 0) return;
        event.preventDefault();
        const tab = tabs[places[event.key] % tabs.length];
        tab.click();
        tab.focus();
    });
}

function startButtons() {
    const acts = {
        "zoom-in": () => viewer.zoomBy(1),
        "zoom-out": () => viewer.zoomBy(-1),
        "zoom-fit": () => viewer.fit(),
        "zoom-one": () => viewer.zoomTo(1 / (devicePixelRatio || 1)),
        "zoom-worst": () => viewer.places && viewer.goTo(...viewer.places.worst),
        "play": () => viewer.play(!viewer.flicker.on),
        "test-before": () => open(list.neighbor(-1)),
        "test-next": () => open(list.neighbor(1)),
        "theme": nextTheme,
        "help-open": () => byId("help").showModal(),
        "marks": () => {
            viewer.marks = !viewer.marks;
            byId("marks").setAttribute("aria-pressed", viewer.marks);
            viewer.draw();
        },
        "back": () => {
            document.body.dataset.view = "list";
            list.current.scrollIntoView({ block: "center" });
            list.current.firstChild.focus();
        },
    };
    for (const [id, act] of Object.entries(acts)) byId(id).addEventListener("click", act);
    if (byId("approve-all")) {
        const all = byId("approve-all");
        all.replaceWith(command("copy-approve-all", "approve all pictures", all.querySelector("code").textContent));
    }
    byId("amount").addEventListener("input", (event) => viewer.setAmount(Number(event.target.value)));
    byId("jump").addEventListener("click", (event) => {
        event.preventDefault();
        byId("detail").focus();
    });
    byId("stage").addEventListener("keydown", onStageKey);
    document.addEventListener("keydown", onKey);
}

startTheme();
startModes();
startButtons();
showKeys();
list.start();
viewer.listen();
viewer.onMode = writeAddress;
timeline.onPick = setFrame;
addEventListener("hashchange", route);
route();
performance.mark("kiln-ready"); /* the list and the first test are shown */
