// Builds glTF documents for make.mjs: it collects numbers in one buffer, and writes a .gltf with a data URI, or a .glb.
import { writeFileSync } from 'node:fs';

export const BYTE = 5120, UBYTE = 5121, SHORT = 5122, USHORT = 5123, UINT = 5125, FLOAT = 5126;
const arrays = {
    [BYTE]: Int8Array, [UBYTE]: Uint8Array, [SHORT]: Int16Array, [USHORT]: Uint16Array, [UINT]: Uint32Array,
    [FLOAT]: Float32Array,
};
const widths = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };

export class Builder {
    constructor() {
        this.chunks = [];
        this.size = 0;
        this.json = { asset: { version: '2.0', generator: 'kiln tests/gltf/make.mjs' }, accessors: [],
            bufferViews: [], meshes: [], nodes: [], scenes: [{ nodes: [] }], scene: 0 };
    }

    // Adds bytes at a multiple of four, and returns their offset.
    bytes(bytes) {
        const pad = (4 - this.size % 4) % 4;
        this.chunks.push(Buffer.alloc(pad), Buffer.from(bytes.buffer, bytes.byteOffset, bytes.byteLength));
        const offset = this.size + pad;
        this.size = offset + bytes.byteLength;
        return offset;
    }

    view(bytes, more = {}) {
        this.json.bufferViews.push({ buffer: 0, byteOffset: this.bytes(bytes), byteLength: bytes.byteLength, ...more });
        return this.json.bufferViews.length - 1;
    }

    // Adds an accessor of rows of numbers. Rows of vertices are padded to multiples of four bytes.
    accessor(type, component, rows, { normalized = false, vertices = false, ...more } = {}) {
        const width = widths[type], one = new arrays[component](1).BYTES_PER_ELEMENT;
        const stride = vertices ? Math.ceil(width * one / 4) * 4 : width * one;
        const bytes = new Uint8Array(stride * rows.length);
        const stored = rows.map((row, i) => {
            const values = new arrays[component]([row].flat());
            bytes.set(new Uint8Array(values.buffer), i * stride);
            return [...values];
        });
        const view = this.view(bytes, vertices ? { byteStride: stride, target: 34962 } : {});
        return this.plain(type, component, stored.length, { bufferView: view, ...(normalized && { normalized }),
            ...bounds(stored), ...more });
    }

    plain(type, component, count, more = {}) {
        this.json.accessors.push({ type, componentType: component, count, ...more });
        return this.json.accessors.length - 1;
    }

    // Makes an accessor sparse: rows at places replace those that it has.
    sparse(accessor, type, component, index, places, rows) {
        const one = new arrays[component]([rows].flat(2)), indices = new arrays[index](places);
        this.json.accessors[accessor].sparse = { count: places.length,
            indices: { bufferView: this.view(indices), componentType: index }, values: { bufferView: this.view(one) } };
    }

    indices(component, list) {
        return this.accessor('SCALAR', component, list);
    }

    mesh(...primitives) {
        this.json.meshes.push({ primitives });
        return this.json.meshes.length - 1;
    }

    node(node = {}, isRoot = true) {
        this.json.nodes.push(node);
        if (isRoot)
            this.json.scenes[0].nodes.push(this.json.nodes.length - 1);
        return this.json.nodes.length - 1;
    }

    // Adds a clip. tracks: [node, path, times, accessor of values, interpolation].
    clip(name, tracks) {
        const clip = { name, channels: [], samplers: [] };
        for (const [node, path, times, output, interpolation] of tracks) {
            clip.channels.push({ sampler: clip.samplers.length, target: { node, path } });
            clip.samplers.push({ input: this.accessor('SCALAR', FLOAT, times), output,
                ...(interpolation && { interpolation }) });
        }
        (this.json.animations ??= []).push(clip);
    }

    uses(extension, isRequired = true) {
        (this.json.extensionsUsed ??= []).push(extension);
        if (isRequired)
            (this.json.extensionsRequired ??= []).push(extension);
    }

    buffer() {
        return Buffer.concat([...this.chunks, Buffer.alloc((4 - this.size % 4) % 4)]);
    }

    document(buffer) {
        const json = { ...this.json };
        json.buffers = [buffer, ...(this.json.buffers ?? [])];
        for (const key of Object.keys(json))
            if (Array.isArray(json[key]) && json[key].length === 0)
                delete json[key];
        return json;
    }

    writeText(path) {
        const bytes = this.buffer();
        const uri = 'data:application/octet-stream;base64,' + bytes.toString('base64');
        writeFileSync(path, JSON.stringify(this.document({ byteLength: bytes.length, uri })) + '\n');
    }

    writeBinary(path, uri) {
        const bytes = this.buffer();
        const json = Buffer.from(JSON.stringify(this.document({ byteLength: bytes.length, ...(uri && { uri }) })));
        const text = Buffer.concat([json, Buffer.alloc((4 - json.length % 4) % 4, ' ')]);
        const head = (size, kind) => Buffer.concat([word(size), Buffer.from(kind)]);
        const parts = [head(text.length, 'JSON'), text, ...(uri ? [] : [head(bytes.length, 'BIN\0'), bytes])];
        const body = Buffer.concat(parts);
        writeFileSync(path, Buffer.concat([Buffer.from('glTF'), word(2), word(12 + body.length), body]));
        return bytes;
    }
}

function word(number) {
    const bytes = Buffer.alloc(4);
    bytes.writeUInt32LE(number);
    return bytes;
}

function bounds(rows) {
    if (rows.length === 0)
        return {};
    const columns = rows[0].map((_, c) => rows.map((row) => row[c]));
    return { min: columns.map((c) => Math.min(...c)), max: columns.map((c) => Math.max(...c)) };
}
