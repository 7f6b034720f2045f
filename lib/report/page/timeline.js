/* Shows the frames of a test as bars of their scores, and marks the frame that is shown. */

const timeline = {
    test: null,
    index: 0,
    onPick: () => {},

    /* Returns the height of a bar. It grows with the square root, so that small errors stay
     * visible. */
    heightOf(score) {
        return 100 * Math.sqrt(score / this.top);
    },

    show(test) {
        this.test = test;
        const out = byId("timeline");
        out.hidden = test.frames.length < 2;
        if (out.hidden) {
            out.replaceChildren();
            return;
        }
        const scores = test.frames.map((frame) => (typeof frame.score === "number" ? frame.score : 0));
        this.top = Math.max(1.15, ...scores);
        const button = (text, title, act) => {
            const element = make("button", { type: "button", title }, text);
            element.addEventListener("click", act);
            return element;
        };
        this.now = make("span", { class: "now" });
        this.track = make("div", {
            class: "track", role: "slider", tabIndex: 0, "aria-label": "Frame",
            "aria-valuemin": 0, "aria-valuemax": test.frames.length - 1,
        }, this.draw(scores));
        this.listen();
        const last = test.frames.length - 1;
        const red = test.frames.filter((frame) => !["pass", "warn", "change", "skip"].includes(frame.status)).length;
        const middle = red ? `${red} of ${last + 1} frames did not pass` : `${last + 1} frames`;
        out.replaceChildren(
            make("div", { class: "line" },
                button("\u2039", "Frame before (,)", () => this.pick(this.index - 1)),
                button("\u203a", "Next frame (.)", () => this.pick(this.index + 1)),
                button("Worst frame", "Worst frame (w)", () => this.pick(test.first)), this.now),
            this.track,
            make("div", { class: "ends" }, make("span", {}, String(test.frames[0].number)),
                make("span", {}, middle), make("span", {}, String(test.frames[last].number))));
    },

    draw(scores) {
        const count = scores.length, gap = count > 200 ? 0 : 0.12;
        const svg = makeSvg("svg", { viewBox: `0 0 ${count} 100`, preserveAspectRatio: "none", "aria-hidden": "true" });
        this.marker = makeSvg("rect", { class: "at", x: 0, y: 0, width: 1, height: 100 });
        scores.forEach((score, i) => {
            const { status, score: own } = this.test.frames[i];
            const unmeasured = typeof own !== "number" && status !== "pass";
            const height = unmeasured ? 100 : Math.max(3, this.heightOf(score));
            svg.append(makeSvg("rect", { class: status, x: i + gap, y: 100 - height, width: 1 - 2 * gap, height }));
        });
        const limit = 100 - this.heightOf(1);
        svg.append(makeSvg("line", { class: "limit", x1: 0, x2: count, y1: limit, y2: limit }));
        svg.append(this.marker);
        return svg;
    },

    /* Marks the frame that is shown. */
    mark(index) {
        this.index = index;
        if (byId("timeline").hidden) return;
        const frame = this.test.frames[index];
        const score = frame.score === undefined ? "" : `, score ${formatNumber(frame.score)}`;
        const text = `Frame ${frame.number}: ${frame.status}${score}`;
        this.marker.setAttribute("x", index);
        this.track.setAttribute("aria-valuenow", index);
        this.track.setAttribute("aria-valuetext", text);
        this.now.textContent = text;
    },

    pick(index) {
        const last = this.test.frames.length - 1;
        this.onPick(Math.min(last, Math.max(0, index)));
    },

    listen() {
        const { track } = this;
        const at = (event) => {
            const box = track.getBoundingClientRect();
            this.pick(Math.floor(((event.clientX - box.left) / box.width) * this.test.frames.length));
        };
        track.addEventListener("pointerdown", (event) => {
            track.setPointerCapture(event.pointerId);
            at(event);
        });
        track.addEventListener("pointermove", (event) => {
            if (track.hasPointerCapture(event.pointerId)) at(event);
        });
        track.addEventListener("keydown", (event) => {
            const steps = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageUp: 10, PageDown: -10 };
            if (event.key in steps) this.pick(this.index + steps[event.key]);
            else if (event.key === "Home") this.pick(0);
            else if (event.key === "End") this.pick(Infinity);
            else return;
            event.preventDefault();
            event.stopPropagation();
        });
    },
};
