/* Pictures: taken out of the page when they are first shown, and kept while there is room. */

const KEPT_PIXELS = 32 << 20;

/* An element with properties and children; texts become text nodes, never markup. */
function make(tag, properties, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(properties || {})) {
        if (name === "class") element.className = value;
        else if (name.includes("-") || name === "role" || name === "for") element.setAttribute(name, value);
        else element[name] = value;
    }
    element.append(...children.filter((child) => child !== null && child !== undefined));
    return element;
}

function makeSvg(tag, attributes, ...children) {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes || {})) element.setAttribute(name, value);
    element.append(...children);
    return element;
}

const byId = (id) => document.getElementById(id);

/* A canvas of pictures is opaque: alpha is shown on black. */
function makeCanvas(width, height) {
    const canvas = make("canvas", { width, height });
    return { canvas, context: canvas.getContext("2d", { alpha: false, willReadFrequently: true }) };
}

/* While the page is still arriving, an element may be there in part: it is whole when something
 * follows it. */
function arrived(id) {
    return new Promise((resolve) => {
        const look = () => {
            const element = byId(id);
            if (document.readyState !== "loading" || (element && element.nextSibling)) resolve(element);
            else setTimeout(look, 40);
        };
        look();
    });
}

async function sourceOf(place) {
    if (place.problem) throw new Error(place.problem);
    if (place.url) return place.url;
    const element = await arrived("p" + place);
    if (!element) throw new Error("The page was cut short: this picture is missing from it.");
    if (element.dataset.problem) throw new Error(element.dataset.problem);
    return "data:image/png;base64," + element.textContent;
}

/* The colours are those of the file: nothing is converted to the screen's profile. */
async function decode(place) {
    const image = new Image();
    image.src = await sourceOf(place);
    try {
        await image.decode();
    } catch {
        throw new Error(place.url ? "The linked picture cannot be loaded: " + decodeURI(place.url)
            : "The picture cannot be decoded.");
    }
    return createImageBitmap(image, { colorSpaceConversion: "none" });
}

const pictures = {
    kept: new Map(), /* key -> promise of an ImageBitmap; the least recently used first */
    pixels: 0,

    /* A promise of a picture, or of null where there is none. */
    load(place) {
        if (place === null || place === undefined) return Promise.resolve(null);
        const key = typeof place === "number" ? place : place.url || place.problem;
        const known = this.kept.get(key);
        if (known) this.kept.delete(key);
        const promise = known || decode(place).then((bitmap) => {
            this.pixels += bitmap.width * bitmap.height;
            this.shrink();
            return bitmap;
        });
        this.kept.set(key, promise);
        return promise;
    },

    /* Those of the frame that is shown were used last, and stay. */
    shrink() {
        for (const [key, promise] of this.kept) {
            if (this.pixels <= KEPT_PIXELS || this.kept.size <= 6) break;
            this.kept.delete(key);
            promise.then((bitmap) => {
                this.pixels -= bitmap.width * bitmap.height;
            }, () => {});
        }
    },
};

const reader = makeCanvas(1, 1);

/* The colour of a pixel, 0 to 255; null outside; undefined when the browser does not tell, as it
 * does for files that are linked from a page that is a file. */
function pixelOf(picture, x, y) {
    if (!picture || x < 0 || y < 0 || x >= picture.width || y >= picture.height) return null;
    reader.context.fillRect(0, 0, 1, 1);
    reader.context.drawImage(picture, x, y, 1, 1, 0, 0, 1, 1);
    try {
        return [...reader.context.getImageData(0, 0, 1, 1).data.slice(0, 3)];
    } catch {
        const fresh = makeCanvas(1, 1); /* that one will never tell again */
        reader.canvas = fresh.canvas;
        reader.context = fresh.context;
        return undefined;
    }
}

/* |a - b| * gain, a power of two: blending does it, which needs no pixel to be read. */
function differenceOf(a, b, gain) {
    const width = Math.max(a.width, b.width), height = Math.max(a.height, b.height);
    const { canvas, context } = makeCanvas(width, height);
    context.drawImage(a, 0, 0);
    context.globalCompositeOperation = "difference";
    context.drawImage(b, 0, 0);
    context.globalCompositeOperation = "lighter";
    for (let g = 1; g < gain; g *= 2) context.drawImage(canvas, 0, 0);
    return canvas;
}
