/* Shows the pictures of one frame in panes, which zoom and pan together. */

const MODES = [
    { id: "side", name: "Side by side", needs: 0, amount: "gain" },
    { id: "slider", name: "Slider", needs: 2, amount: "split" },
    { id: "blend", name: "Blend", needs: 2, amount: "opacity" },
    { id: "flicker", name: "Flicker", needs: 2, amount: "rate" },
    { id: "difference", name: "Difference", needs: 2, amount: "gain" },
    { id: "reference", name: "Reference", needs: "reference" },
    { id: "result", name: "Result", needs: "result" },
    { id: "error", name: "Error map", needs: "error" },
];

/* The values that a mode's slider sets. Flicker starts below three changes a second; only a
 * person's choice makes it faster. */
const AMOUNTS = {
    split: { name: "Position", min: 0, max: 100, step: 1, start: 50, format: (v) => v + " %" },
    opacity: { name: "Result", min: 0, max: 100, step: 5, start: 50, format: (v) => v + " %" },
    rate: { name: "Rate", min: 0.5, max: 10, step: 0.5, start: 2, format: (v) => v + " / s" },
    gain: { name: "Gain", min: 0, max: 7, step: 1, start: 3, format: (v) => "\u00d7" + 2 ** v },
};

const TITLES = { reference: "Reference", result: "Result", error: "Error map" };
const MAX_ZOOM = 64;

const viewer = {
    mode: "side",
    amounts: Object.fromEntries(Object.entries(AMOUNTS).map(([key, a]) => [key, a.start])),
    shown: { reference: null, result: null, error: null }, /* bitmaps */
    problems: {},
    panes: [],   /* {figure, canvas, caption, kind} */
    zoom: null,  /* CSS pixels per picture pixel; null: fit */
    center: [0, 0],
    cursor: null, /* the pixel that is read out */
    marks: false,
    places: null, /* {worst, window} of the frame */
    flicker: { on: false, side: "result", timer: 0 },
    difference: { key: "", canvas: null },
    drag: null,
    queued: false,
    onMode: () => {},

    size() {
        const all = Object.values(this.shown).filter(Boolean);
        return [Math.max(1, ...all.map((p) => p.width)), Math.max(1, ...all.map((p) => p.height))];
    },

    /* Shows the pictures of a frame; the view stays unless their size changes. */
    show(shown, problems, places, placeholder) {
        const [width, height] = this.size();
        this.shown = shown;
        this.problems = problems;
        this.places = places;
        this.placeholder = placeholder;
        this.difference.key = "";
        const [newWidth, newHeight] = this.size();
        if (width !== newWidth || height !== newHeight) this.fit();
        this.build();
    },

    can(mode) {
        const { reference, result } = this.shown;
        if (mode.needs === 0) return true;
        return mode.needs === 2 ? Boolean(reference && result) : Boolean(this.shown[mode.needs]);
    },

    effective() {
        const mode = MODES.find((m) => m.id === this.mode);
        return this.can(mode) ? mode : MODES[0];
    },

    setMode(id) {
        const mode = MODES.find((m) => m.id === id);
        if (!mode || !this.can(mode)) return false;
        const entered = this.mode !== id;
        this.mode = id;
        if (id === "flicker" && entered)
            this.flicker.on = !matchMedia("(prefers-reduced-motion: reduce)").matches;
        this.build();
        this.onMode();
        return true;
    },

    /* ---- Panes --------------------------------------------------------------------------- */

    kinds() {
        const mode = this.effective();
        if (mode.id !== "side") return [mode.id];
        const { reference, result, error } = this.shown;
        const known = (kind) => this.shown[kind] || this.problems[kind];
        const kinds = ["reference", "result", "error"].filter(known);
        if (reference && result && error) kinds.push("difference");
        return kinds;
    },

    build() {
        const stage = byId("stage");
        const kinds = this.kinds();
        if (kinds.join() !== this.panes.map((pane) => pane.kind).join()) {
            this.panes = kinds.map((kind) => {
                const name = TITLES[kind] || MODES.find((mode) => mode.id === kind).name;
                const canvas = make("canvas", { role: "img", "aria-label": name }); /* the label until it is drawn */
                const figure = make("figure", { class: "pane" }, canvas);
                const caption = make("figcaption", {});
                const right = make("figcaption", { class: "right", hidden: true });
                const problem = make("p", { class: "problem", hidden: true });
                figure.append(caption, right, problem);
                return { kind, canvas, figure, caption, right, problem };
            });
            stage.replaceChildren(...this.panes.map((pane) => pane.figure));
        }
        this.updateTools();
        this.layout();
        this.run();
    },

    updateTools() {
        const mode = this.effective();
        for (const tab of byId("modes").children) {
            const own = MODES.find((m) => m.id === tab.dataset.mode);
            const selected = own === mode;
            tab.disabled = !this.can(own);
            tab.setAttribute("aria-selected", selected);
            tab.tabIndex = selected ? 0 : -1;
            if (selected) byId("stage").setAttribute("aria-labelledby", tab.id);
        }
        const both = this.shown.reference && this.shown.result;
        const amount = mode.amount && both && this.panes.some((p) => p.kind !== "error" &&
            (mode.id !== "side" || p.kind === "difference")) ? mode.amount : null;
        byId("tool").hidden = !amount;
        byId("stage").classList.toggle("wiping", mode.id === "slider");
        if (!amount) return;
        const about = AMOUNTS[amount], input = byId("amount");
        byId("amount-name").textContent = about.name;
        Object.assign(input, { min: about.min, max: about.max, step: about.step });
        input.value = this.amounts[amount];
        const text = about.format(this.amounts[amount]);
        input.setAttribute("aria-valuetext", text);
        byId("amount-text").textContent = text;
        const play = byId("play");
        play.hidden = amount !== "rate";
        play.setAttribute("aria-pressed", this.flicker.on);
        play.textContent = this.flicker.on ? "Pause" : "Play";
    },

    setAmount(value) {
        const key = this.effective().amount, about = AMOUNTS[key];
        if (!about || byId("tool").hidden) return;
        this.amounts[key] = Math.min(about.max, Math.max(about.min, value));
        this.updateTools();
        this.run();
        this.draw();
    },

    step(direction) {
        const key = this.effective().amount;
        if (key) this.setAmount(this.amounts[key] + direction * (key === "split" ? 5 : AMOUNTS[key].step));
    },

    /* Chooses the lowest of the arrangements in which pictures are nearly as large as possible. The
     * stage gets no higher than they need. */
    layout() {
        const stage = byId("stage"), count = Math.max(1, this.panes.length);
        const [width, height] = this.size();
        const room = stage.clientWidth || 1;
        const highest = Math.max(220, Math.min(innerHeight * 0.56, innerHeight - 425));
        const ways = [];
        for (let columns = 1; columns <= count; columns++) {
            const rows = Math.ceil(count / columns);
            const scale = Math.min(room / columns / width, highest / rows / height);
            ways.push({ columns, rows, scale, height: (room / columns) * (height / width) * rows });
        }
        const largest = Math.max(...ways.map((way) => way.scale));
        const best = ways.filter((way) => way.scale >= 0.87 * largest)
            .reduce((a, b) => (b.height < a.height ? b : a));
        stage.style.gridTemplateColumns = `repeat(${best.columns}, 1fr)`;
        stage.style.height = Math.max(120, Math.min(highest, best.height)) + "px";
        stage.style.gridAutoRows = "1fr";
        this.draw();
    },

    /* ---- Drawing ------------------------------------------------------------------------- */

    draw() {
        if (this.queued) return;
        this.queued = true;
        requestAnimationFrame(() => {
            this.queued = false;
            for (const pane of this.panes) this.drawPane(pane);
            byId("zoom-text").textContent = Math.round(this.scale() * 100) + " %";
        });
    },

    paneSize() {
        const figure = this.panes[0] && this.panes[0].figure;
        return figure ? [figure.clientWidth || 1, figure.clientHeight || 1] : [1, 1];
    },

    scale() {
        if (this.zoom !== null) return this.zoom;
        const [width, height] = this.size(), [w, h] = this.paneSize();
        return Math.min(w / width, h / height);
    },

    /* Returns the upper left corner of the pictures in a pane, in CSS pixels. */
    origin() {
        const [width, height] = this.size(), [w, h] = this.paneSize(), scale = this.scale();
        const [x, y] = this.zoom === null ? [width / 2, height / 2] : this.center;
        return [w / 2 - x * scale, h / 2 - y * scale];
    },

    differencePicture() {
        const { reference, result } = this.shown;
        if (!reference || !result) return null;
        const key = String(this.amounts.gain);
        if (this.difference.key !== key)
            this.difference = { key, canvas: differenceOf(reference, result, 2 ** this.amounts.gain) };
        return this.difference.canvas;
    },

    drawPane(pane) {
        const ratio = devicePixelRatio || 1;
        const w = pane.figure.clientWidth, h = pane.figure.clientHeight;
        const { canvas } = pane;
        const width = Math.max(1, Math.round(w * ratio)), height = Math.max(1, Math.round(h * ratio));
        if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
        const context = canvas.getContext("2d", { alpha: false, willReadFrequently: true });
        const scale = this.scale() * ratio;
        const [x, y] = this.origin().map((v) => Math.round(v * ratio));
        const put = (picture) => {
            if (picture)
                context.drawImage(picture, x, y, Math.round(picture.width * scale), Math.round(picture.height * scale));
        };
        context.fillStyle = getComputedStyle(pane.figure).backgroundColor;
        context.fillRect(0, 0, width, height);
        /* Pixels are enlarged by nearest neighbour, and averaged when they are shrunk. */
        context.imageSmoothingEnabled = scale < 1;
        context.imageSmoothingQuality = "high";
        this.drawKind(pane, context, put, x, scale);
        this.drawMarks(context, x, y, scale, ratio);
        this.describe(pane);
    },

    drawKind(pane, context, put, x, scale) {
        const { reference, result } = this.shown;
        if (pane.kind === "slider") {
            const split = Math.round(x + (this.size()[0] * scale * this.amounts.split) / 100);
            put(reference);
            context.save();
            context.beginPath();
            context.rect(split, 0, context.canvas.width - split, context.canvas.height);
            context.clip();
            context.fillRect(split, 0, context.canvas.width, context.canvas.height);
            put(result);
            context.restore();
            context.fillStyle = "#fff";
            context.fillRect(split - 1, 0, 2, context.canvas.height);
        } else if (pane.kind === "blend") {
            put(reference);
            context.globalAlpha = this.amounts.opacity / 100;
            put(result);
            context.globalAlpha = 1;
        } else if (pane.kind === "flicker") {
            put(this.shown[this.flicker.side]);
        } else if (pane.kind === "difference") {
            put(this.differencePicture());
        } else {
            put(this.shown[pane.kind]);
        }
    },

    drawMarks(context, x, y, scale, ratio) {
        const outline = (left, top, width, height, color) => {
            context.lineWidth = 4 * ratio;
            context.strokeStyle = "#000b";
            context.strokeRect(x + left * scale, y + top * scale, width * scale, height * scale);
            context.lineWidth = 1.6 * ratio;
            context.strokeStyle = color;
            context.strokeRect(x + left * scale, y + top * scale, width * scale, height * scale);
        };
        const pixel = (px, py, color) => {
            const grow = Math.max(0, (7 * ratio) / scale - 1) / 2;
            outline(px - grow, py - grow, 1 + 2 * grow, 1 + 2 * grow, color);
        };
        if (this.marks && this.places) {
            const [left, top, width, height] = this.places.window;
            if (width > 0) outline(left, top, width, height, "#ffd24d");
            pixel(...this.places.worst, "#5fe0ff");
        }
        if (this.cursor) pixel(...this.cursor, "#fff");
    },

    describe(pane) {
        const names = {
            slider: "Reference",
            blend: `Reference ${100 - this.amounts.opacity} %, result ${this.amounts.opacity} %`,
            flicker: TITLES[this.flicker.side],
            difference: "Difference \u00d7" + 2 ** this.amounts.gain,
        };
        const name = names[pane.kind] || TITLES[pane.kind];
        pane.caption.textContent = name;
        pane.right.hidden = pane.kind !== "slider";
        pane.right.textContent = "Result";
        const problem = this.problems[pane.kind];
        pane.problem.hidden = !problem;
        pane.problem.textContent = problem || "";
        const label = pane.kind === "slider" ? "Reference on the left, result on the right of the divider" : name;
        pane.canvas.setAttribute("aria-label", label);
    },

    /* Starts or stops the timer of flicker. */
    run() {
        clearInterval(this.flicker.timer);
        this.flicker.timer = 0;
        if (this.effective().id !== "flicker" || !this.flicker.on) return;
        this.flicker.timer = setInterval(() => this.flip(), 1000 / this.amounts.rate);
    },

    flip() {
        this.flicker.side = this.flicker.side === "result" ? "reference" : "result";
        this.draw();
    },

    play(on) {
        this.flicker.on = on;
        this.updateTools();
        this.run();
    },

    /* ---- Zoom, pan and the pixel ---------------------------------------------------------- */

    /* Returns the position in the pictures under a place of a pane, in pixels, not rounded. */
    toPixel(x, y) {
        const [left, top] = this.origin(), scale = this.scale();
        return [(x - left) / scale, (y - top) / scale];
    },

    zoomTo(zoom, x, y) {
        const [w, h] = this.paneSize();
        const at = x === undefined ? [w / 2, h / 2] : [x, y];
        const [px, py] = this.toPixel(...at);
        this.zoom = Math.min(MAX_ZOOM, Math.max(0.05, zoom));
        this.center = [px - (at[0] - w / 2) / this.zoom, py - (at[1] - h / 2) / this.zoom];
        this.draw();
    },

    /* Zooms to the next whole power of two, from any scale. */
    zoomBy(direction, x, y) {
        const now = Math.log2(this.scale());
        const next = direction > 0 ? Math.floor(now + 1.001) : Math.ceil(now - 1.001);
        this.zoomTo(2 ** next, x, y);
    },

    fit() {
        this.zoom = null;
        this.draw();
    },

    pan(dx, dy) {
        const scale = this.scale();
        if (this.zoom === null) {
            this.zoom = scale;
            this.center = this.size().map((v) => v / 2);
        }
        this.center = [this.center[0] - dx / scale, this.center[1] - dy / scale];
        this.draw();
    },

    goTo(x, y) {
        this.zoom = Math.max(8, this.scale());
        this.center = [x + 0.5, y + 0.5];
        this.setCursor(x, y, true);
    },

    setCursor(x, y, say) {
        const [width, height] = this.size();
        const inside = x >= 0 && y >= 0 && x < width && y < height;
        this.cursor = inside ? [x, y] : null;
        const spoken = showReadout(this.shown, this.cursor);
        if (say) byId("spoken").textContent = spoken;
        this.draw();
    },

    /* Moves the cursor by pixels, and keeps it in sight. */
    moveCursor(dx, dy) {
        const [width, height] = this.size();
        const [x, y] = this.cursor || this.center.map((v, i) => Math.floor(v || this.size()[i] / 2));
        const clamp = (v, most) => Math.min(most - 1, Math.max(0, v));
        const next = [clamp(x + dx, width), clamp(y + dy, height)];
        if (this.zoom !== null) {
            const [w, h] = this.paneSize(), scale = this.scale(), [left, top] = this.origin();
            const place = [left + (next[0] + 0.5) * scale, top + (next[1] + 0.5) * scale];
            if (place[0] < 0 || place[1] < 0 || place[0] > w || place[1] > h)
                this.center = [next[0] + 0.5, next[1] + 0.5];
        }
        this.setCursor(...next, true);
    },

    /* ---- Pointers ------------------------------------------------------------------------- */

    locate(event) {
        const figure = event.target.closest(".pane") || (this.panes[0] && this.panes[0].figure);
        const box = figure.getBoundingClientRect();
        return [event.clientX - box.left, event.clientY - box.top];
    },

    wipeTo(x) {
        this.setAmount(Math.round((this.toPixel(x, 0)[0] / this.size()[0]) * 1000) / 10);
    },

    listen() {
        const stage = byId("stage"), fingers = new Map();
        stage.addEventListener("pointerdown", (event) => {
            const [x, y] = this.locate(event);
            fingers.set(event.pointerId, [x, y]);
            stage.setPointerCapture(event.pointerId);
            const wiping = this.effective().id === "slider" && !event.shiftKey && event.button === 0;
            this.drag = { x, y, box: event.target.closest(".pane"), wiping, spread: 0 };
            if (wiping) this.wipeTo(x);
            else stage.classList.add("panning");
        });
        stage.addEventListener("pointermove", (event) => {
            if (!this.drag) {
                const [px, py] = this.toPixel(...this.locate(event)).map(Math.floor);
                this.setCursor(px, py, false);
                return;
            }
            const box = (this.drag.box || stage).getBoundingClientRect();
            const [x, y] = [event.clientX - box.left, event.clientY - box.top];
            fingers.set(event.pointerId, [x, y]);
            if (fingers.size > 1) {
                const [a, b] = fingers.values();
                const spread = Math.hypot(a[0] - b[0], a[1] - b[1]);
                if (this.drag.spread) this.zoomTo((this.scale() * spread) / this.drag.spread, (a[0] + b[0]) / 2, (a[1] + b[1]) / 2);
                this.drag.spread = spread;
            } else if (this.drag.wiping) {
                this.wipeTo(x);
            } else {
                this.pan(x - this.drag.x, y - this.drag.y);
            }
            Object.assign(this.drag, { x, y });
        });
        const end = (event) => {
            fingers.delete(event.pointerId);
            if (fingers.size === 0) this.drag = null;
            stage.classList.remove("panning");
        };
        stage.addEventListener("pointerup", end);
        stage.addEventListener("pointercancel", end);
        stage.addEventListener("pointerleave", () => {
            if (!this.drag) this.setCursor(-1, -1, false);
        });
        stage.addEventListener("wheel", (event) => {
            event.preventDefault();
            const factor = 2 ** (-event.deltaY / (event.deltaMode ? 6 : 240));
            this.zoomTo(this.scale() * factor, ...this.locate(event));
        }, { passive: false });
        stage.addEventListener("dblclick", (event) => {
            if (this.zoom === null) this.zoomTo(8, ...this.locate(event));
            else this.fit();
        });
        new ResizeObserver(() => this.layout()).observe(stage);
        addEventListener("resize", () => this.layout());
    },
};

/* ---- The read-out ------------------------------------------------------------------------- */

const hexOf = (rgb) => "#" + rgb.map((v) => v.toString(16).padStart(2, "0")).join("");

/* Shows both colours of a pixel and their difference; returns the same as a text to be spoken. */
function showReadout(shown, cursor) {
    const out = byId("readout");
    if (!cursor) {
        out.replaceChildren(make("span", { class: "key" }, "Point at a pixel, or move with the arrow keys."));
        return "";
    }
    const colors = ["reference", "result"].map((kind) => [kind, pixelOf(shown[kind], ...cursor)]);
    const parts = [make("span", {}, `x ${cursor[0]}  y ${cursor[1]}`)];
    const spoken = [`${cursor[0]}, ${cursor[1]}`];
    for (const [kind, rgb] of colors) {
        if (rgb === null) continue;
        if (rgb === undefined) {
            parts.push(make("span", { class: "key" }, "Colours of linked files are kept from a page that is a file itself."));
            break;
        }
        const swatch = make("i", { class: "swatch" });
        swatch.style.background = hexOf(rgb);
        const text = `${hexOf(rgb)}  ${rgb.map((v) => String(v).padStart(3)).join(" ")}`;
        parts.push(make("span", {}, make("span", { class: "key" }, TITLES[kind]), swatch, text));
        spoken.push(`${TITLES[kind]} ${rgb.join(" ")}`);
    }
    const [a, b] = colors.map(([, rgb]) => rgb);
    if (a && b) {
        const signed = b.map((v, i) => v - a[i]);
        const text = signed.map((v) => (v > 0 ? "+" : v < 0 ? "\u2212" : "") + Math.abs(v));
        const hex = hexOf(signed.map(Math.abs));
        const off = signed.some((v) => v !== 0);
        parts.push(make("span", { class: off ? "off" : "" }, make("span", { class: "key" }, "Difference "), `${hex}  ${text.map((t) => t.padStart(4)).join(" ")}`));
        spoken.push(off ? `difference ${text.join(" ")}` : "equal");
    }
    out.replaceChildren(...parts);
    return spoken.join("; ");
}
