/* Decodes pictures when they are first shown, and keeps them in a cache of limited size. */

const CACHE_PIXELS = 32 << 20;

/* Returns an element with properties and children. Texts become text nodes, never markup. */
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

/* Returns a canvas for pictures. It is opaque, so transparent parts are shown on black. */
function makeCanvas(width, height) {
    const canvas = make("canvas", { width, height });
    return { canvas, context: canvas.getContext("2d", { alpha: false, willReadFrequently: true }) };
}

/* Returns a promise of an element, which is kept once the element is complete. While the page
 * loads, an element is complete when another node follows it. */
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

/* Returns a bitmap with the colours of the file, without a conversion to the screen's profile. */
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
    cache: new Map(), /* key -> promise of an ImageBitmap; the least recently used first */
    pixels: 0,

    /* Returns a promise of a picture, or of null if there is none. */
    load(place) {
        if (place === null || place === undefined) return Promise.resolve(null);
        const key = typeof place === "number" ? place : place.url || place.problem;
        const known = this.cache.get(key);
        if (known) this.cache.delete(key);
        const promise = known || decode(place).then((bitmap) => {
            this.pixels += bitmap.width * bitmap.height;
            this.shrink();
            return bitmap;
        });
        this.cache.set(key, promise);
        return promise;
    },

    /* Drops the least recently used pictures. Those of the shown frame were used last, so they
     * stay. */
    shrink() {
        for (const [key, promise] of this.cache) {
            if (this.pixels <= CACHE_PIXELS || this.cache.size <= 6) break;
            this.cache.delete(key);
            promise.then((bitmap) => {
                this.pixels -= bitmap.width * bitmap.height;
            }, () => {});
        }
    },
};

const reader = makeCanvas(1, 1);

/* Returns the colour of a pixel, 0 to 255; null outside the picture; undefined if the browser
 * refuses to tell it, as for a picture that is linked from a page that is a file. */
function pixelOf(picture, x, y) {
    if (!picture || x < 0 || y < 0 || x >= picture.width || y >= picture.height) return null;
    reader.context.fillRect(0, 0, 1, 1);
    reader.context.drawImage(picture, x, y, 1, 1, 0, 0, 1, 1);
    try {
        return [...reader.context.getImageData(0, 0, 1, 1).data.slice(0, 3)];
    } catch {
        const fresh = makeCanvas(1, 1); /* the refused canvas can never be read again */
        reader.canvas = fresh.canvas;
        reader.context = fresh.context;
        return undefined;
    }
}

/* Returns a canvas with |a - b| * gain, where gain is a power of two. Blending computes it, so no
 * pixel has to be read. */
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
