// Writes draco.glb: a triangle that Draco compresses, whose vertices have colours of bytes, without alpha, and two sets of
// texture coordinates. tests/unit/test_materials.c has the same numbers.
//     npm install draco3dgltf@1.5.7 && node make_draco.mjs
import { writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';

const draco = await createRequire(import.meta.url)('draco3dgltf').createEncoderModule({});
const builder = new draco.MeshBuilder(), mesh = new draco.Mesh(), encoder = new draco.Encoder();
builder.AddFacesToMesh(mesh, 1, new Uint32Array([0, 1, 2]));
const ids = {
    POSITION: builder.AddFloatAttributeToMesh(mesh, draco.POSITION, 3, 3, new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0])),
    COLOR_0: builder.AddUInt8Attribute(mesh, draco.COLOR, 3, 3, new Uint8Array([255, 51, 0, 0, 102, 255, 204, 0, 153])),
    TEXCOORD_0: builder.AddFloatAttributeToMesh(mesh, draco.TEX_COORD, 3, 2, new Float32Array([0, 0, 1, 0, 0, 1])),
    TEXCOORD_1: builder.AddFloatAttributeToMesh(mesh, draco.TEX_COORD, 3, 2, new Float32Array([0.5, 0, 0, 0.25, 0.125, 1])),
};
encoder.SetEncodingMethod(draco.MESH_SEQUENTIAL_ENCODING);
const out = new draco.DracoInt8Array(), size = encoder.EncodeMeshToDracoBuffer(mesh, out);
const stream = Buffer.from(Array.from({ length: size }, (_, i) => out.GetValue(i) & 255));
const types = { POSITION: [5126, 'VEC3'], COLOR_0: [5121, 'VEC3'], TEXCOORD_0: [5126, 'VEC2'], TEXCOORD_1: [5126, 'VEC2'] };
const names = Object.keys(types), accessors = names.map((name) => ({
    componentType: types[name][0], type: types[name][1], count: 3, ...(name === 'COLOR_0' ? { normalized: true } : {}) }));
Object.assign(accessors[0], { min: [0, 0, 0], max: [1, 1, 0] });
const json = { asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
    extensionsUsed: ['KHR_draco_mesh_compression'], extensionsRequired: ['KHR_draco_mesh_compression'],
    meshes: [{ primitives: [{ attributes: Object.fromEntries(names.map((name, i) => [name, i])), indices: 4,
        extensions: { KHR_draco_mesh_compression: { bufferView: 0, attributes: ids } } }] }],
    accessors: [...accessors, { componentType: 5121, type: 'SCALAR', count: 3 }],
    bufferViews: [{ buffer: 0, byteLength: size }], buffers: [{ byteLength: size }] };
let text = Buffer.from(JSON.stringify(json));
text = Buffer.concat([text, Buffer.alloc(-text.length & 3, ' ')]);
const data = Buffer.concat([stream, Buffer.alloc(-size & 3)]);
const words = (...numbers) => Buffer.from(Uint32Array.from(numbers).buffer);
writeFileSync(path.join(path.resolve(process.argv[2] ?? '.'), 'draco.glb'), Buffer.concat([
    words(0x46546c67, 2, 28 + text.length + data.length), words(text.length, 0x4e4f534a), text, words(data.length, 0x4e4942), data]));
