/* Handles the list of tests: search, filters, order and arrow keys. */

const list = {
    rows: [],
    statuses: new Set(), /* the statuses that are shown; empty: all */
    current: null,

    visible() {
        return [...byId("rows").children].filter((row) => !row.hidden);
    },

    /* Returns the text of a row that a search goes through. The first call takes it from the page.
     */
    textOf(row) {
        if (row.searched === undefined) row.searched = row.textContent.toLowerCase();
        return row.searched;
    },

    filter() {
        const words = byId("search").value.toLowerCase().split(/\s+/).filter(Boolean);
        let count = 0;
        /* The list is hidden meanwhile: Chromium takes 60 times as long to hide a thousand rows one
         * by one in a visible list. */
        byId("rows").hidden = true;
        void byId("rows").offsetHeight;
        for (const row of this.rows) {
            const wanted = this.statuses.size === 0 || this.statuses.has(row.classList[0]);
            row.hidden = !wanted || !words.every((word) => this.textOf(row).includes(word));
            count += !row.hidden;
        }
        byId("rows").hidden = false;
        byId("found").textContent = count === this.rows.length
            ? `${count} ${count === 1 ? "test" : "tests"}` : `${count} of ${this.rows.length} tests`;
        byId("none").hidden = count > 0 || this.rows.length === 0;
        this.updateTabIndex();
    },

    sort() {
        const number = (row, key) => (row.dataset[key] === "inf" ? Infinity : Number(row.dataset[key]));
        const by = (key) => (a, b) => (number(b, key) === number(a, key) ? 0 : number(b, key) - number(a, key));
        const name = (a, b) => Number(a.dataset.test) - Number(b.dataset.test);
        const orders = {
            status: (a, b) => by("rank")(a, b) || by("score")(a, b) || name(a, b),
            score: (a, b) => by("score")(a, b) || name(a, b),
            time: (a, b) => by("time")(a, b) || name(a, b),
            name,
        };
        byId("rows").append(...this.rows.sort(orders[byId("sort").value]));
    },

    /* Makes one row reachable by the Tab key; arrow keys reach the others. */
    updateTabIndex() {
        const visible = this.visible();
        const at = visible.includes(this.current) ? this.current : visible[0];
        for (const row of this.rows) row.firstChild.tabIndex = row === at ? 0 : -1;
    },

    select(row) {
        if (this.current) this.current.firstChild.removeAttribute("aria-current");
        this.current = row;
        row.firstChild.setAttribute("aria-current", "true");
        row.scrollIntoView({ block: "nearest" });
        this.updateTabIndex();
    },

    /* Returns the visible row that is `step` places after the current one, or null. */
    neighbor(step) {
        const visible = this.visible(), at = visible.indexOf(this.current);
        if (at < 0) return visible[0] || null;
        return visible[at + step] || null;
    },

    walk(event) {
        const link = event.target.closest("#rows a");
        if (!link) return;
        const visible = this.visible(), at = visible.indexOf(link.parentElement);
        const places = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: visible.length - 1 };
        const next = visible[places[event.key]];
        if (!(event.key in places)) return;
        event.preventDefault();
        event.stopPropagation();
        if (!next) return;
        for (const row of this.rows) row.firstChild.tabIndex = row === next ? 0 : -1;
        next.firstChild.focus();
    },

    toggle(button) {
        const { status } = button.dataset;
        const on = !this.statuses.has(status);
        if (on) this.statuses.add(status);
        else this.statuses.delete(status);
        button.setAttribute("aria-pressed", on);
        this.filter();
    },

    clear() {
        byId("search").value = "";
        this.statuses.clear();
        for (const button of document.querySelectorAll(".count")) button.setAttribute("aria-pressed", "false");
        this.filter();
    },

    start() {
        this.rows = [...byId("rows").children];
        byId("search").addEventListener("input", () => this.filter());
        byId("search").addEventListener("keydown", (event) => {
            if (event.key !== "Enter" && event.key !== "ArrowDown") return;
            const first = this.visible()[0];
            if (first) first.firstChild.focus();
            if (first && event.key === "Enter") first.firstChild.click();
            event.preventDefault();
        });
        byId("sort").addEventListener("change", () => this.sort());
        byId("rows").addEventListener("keydown", (event) => this.walk(event));
        byId("clear").addEventListener("click", () => this.clear());
        for (const button of document.querySelectorAll(".count"))
            button.addEventListener("click", () => this.toggle(button));
        byId("sort").value = "status"; /* browsers keep the last choice over a reload */
        byId("search").value = "";
        this.filter();
    },
};
