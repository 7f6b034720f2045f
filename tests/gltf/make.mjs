// Writes the files of tests/gltf/set: one for each kind of thing that glTF 2 allows and that changes where a surface
// is. Run it as `node make.mjs FOLDER`; expect.mjs then writes what three.js reads of them.
import { mkdirSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { MeshoptEncoder } from 'meshoptimizer';
import { BYTE, Builder, FLOAT, SHORT, UBYTE, UINT, USHORT } from './builder.mjs';

const folder = process.argv[2];
mkdirSync(folder, { recursive: true });
const draco3d = createRequire(import.meta.url)('draco3dgltf');
const encoders = await draco3d.createEncoderModule({});
await MeshoptEncoder.ready;

// An open box without symmetry, so that no rotation or mirror of it looks like another.
const positions = [[-1, 0, -0.6], [1, 0, -0.6], [1, 0, 0.6], [-1, 0, 0.6], [-0.4, 1.6, -0.5], [0.7, 1.2, -0.4],
    [0.2, 0.9, 0.3]];
const triangles = [0, 2, 1, 0, 3, 2, 0, 1, 4, 1, 6, 4, 1, 2, 6, 2, 5, 6, 2, 3, 5, 3, 4, 5, 3, 0, 4, 4, 6, 5];
const uvs = positions.map(([x, , z]) => [(x + 1) / 2, (z + 0.6) / 1.2]);
const normals = positions.map((p) => unit([p[0] + 0.1, p[1] - 0.6, p[2] - 0.05]));

function unit(v) {
    const length = Math.hypot(...v);
    return v.map((x) => x / length);
}

function turn(axis, degrees) {
    const half = degrees * Math.PI / 360;
    return [...unit(axis).map((x) => x * Math.sin(half)), Math.cos(half)];
}

function scaled(rows, factor) {
    return rows.map((row) => row.map((x) => Math.round(x * factor)));
}

// Adds the attributes of the box. with: what besides positions.
function box(b, { normal = false, uv = false, index = USHORT } = {}) {
    const attributes = { POSITION: b.accessor('VEC3', FLOAT, positions, { vertices: true }) };
    if (normal)
        attributes.NORMAL = b.accessor('VEC3', FLOAT, normals, { vertices: true });
    if (uv)
        attributes.TEXCOORD_0 = b.accessor('VEC2', FLOAT, uvs, { vertices: true });
    return { attributes, indices: b.indices(index, triangles) };
}

const files = {};
// how: as a text, as a binary file, or as one whose buffer is outside. verdict: what cases.txt says of it.
const add = (name, build, how = 'text', verdict = 'same') => { files[name] = { build, how, verdict }; };

// ---- numbers ---------------------------------------------------------------------------------------------------

for (const [name, component, normalized, factor] of [['byte', BYTE, false, 60], ['ubyte', UBYTE, false, 60],
    ['short', SHORT, false, 1000], ['ushort', USHORT, false, 1000], ['byte-normalized', BYTE, true, 70],
    ['ubyte-normalized', UBYTE, true, 140], ['short-normalized', SHORT, true, 18000],
    ['ushort-normalized', USHORT, true, 36000]]) {
    add(`positions-${name}`, (b) => {
        const unsigned = component === UBYTE || component === USHORT;
        const rows = unsigned ? positions.map((p) => [p[0] + 1, p[1], p[2] + 0.6].map((x) => x * 0.9)) : positions;
        b.uses('KHR_mesh_quantization');
        const primitive = { attributes: { POSITION: b.accessor('VEC3', component, scaled(rows, factor),
            { vertices: true, normalized }) }, indices: b.indices(UBYTE, triangles) };
        b.node({ mesh: b.mesh(primitive), scale: [0.01, 0.01, 0.01] });
    });
}
for (const [name, normal, normalFactor, uv, uvFactor] of [['bytes', BYTE, 127, UBYTE, 255],
    ['shorts', SHORT, 32767, USHORT, 65535]]) {
    add(`attributes-${name}`, (b) => {
        b.uses('KHR_mesh_quantization');
        const primitive = box(b);
        primitive.attributes.NORMAL = b.accessor('VEC3', normal, scaled(normals, normalFactor),
            { vertices: true, normalized: true });
        primitive.attributes.TEXCOORD_0 = b.accessor('VEC2', uv, scaled(uvs, uvFactor),
            { vertices: true, normalized: true });
        b.node({ mesh: b.mesh(primitive) });
    });
}
for (const [name, index] of [['ubyte', UBYTE], ['ushort', USHORT], ['uint', UINT]]) {
    add(`indices-${name}`, (b) => b.node({ mesh: b.mesh(box(b, { normal: true, uv: true, index })) }));
    add(`sparse-${name}`, (b) => {
        const primitive = box(b);
        b.sparse(primitive.attributes.POSITION, 'VEC3', FLOAT, index, [1, 4, 6], [[1.5, 0.1, -0.7], [-0.4, 2, -0.5],
            [0.3, 1, 0.4]]);
        Object.assign(b.json.accessors[primitive.attributes.POSITION], { min: [-1, 0, -0.7], max: [1.5, 2, 0.6] });
        b.node({ mesh: b.mesh(primitive) });
    });
}
add('sparse-of-zeros', (b) => {
    const primitive = box(b);
    primitive.attributes.POSITION = b.plain('VEC3', FLOAT, 7, { min: [0, 0, -0.6], max: [1, 0.9, 0.3] });
    b.sparse(primitive.attributes.POSITION, 'VEC3', FLOAT, USHORT, [1, 6], [positions[1], positions[6]]);
    b.node({ mesh: b.mesh(primitive) });
});
add('accessor-of-zeros', (b) => {
    const primitive = box(b);
    b.plain('VEC3', FLOAT, 7, { min: [0, 0, 0], max: [0, 0, 0] });
    primitive.targets = [{ POSITION: b.json.accessors.length - 1 }];
    b.node({ mesh: b.mesh(primitive) });
});
add('interleaved', (b) => {
    const rows = new Float32Array(positions.flatMap((p, i) => [...p, ...normals[i], ...uvs[i]]));
    const view = b.view(rows, { byteStride: 32, target: 34962 });
    const at = (byteOffset, type, more) => b.plain(type, FLOAT, 7, { bufferView: view, byteOffset, ...more });
    b.node({ mesh: b.mesh({ attributes: { POSITION: at(0, 'VEC3', { min: [-1, 0, -0.6].map(Math.fround),
        max: [1, 1.6, 0.6].map(Math.fround) }), NORMAL: at(12, 'VEC3'), TEXCOORD_0: at(24, 'VEC2') },
        indices: b.indices(USHORT, triangles) }) });
}, 'binary');

// ---- primitives ------------------------------------------------------------------------------------------------

add('triangles-unindexed', (b) => {
    const list = triangles.map((i) => positions[i]);
    b.node({ mesh: b.mesh({ attributes: { POSITION: b.accessor('VEC3', FLOAT, list, { vertices: true }) } }) });
});
for (const [name, mode, order] of [['strip', 5, [0, 1, 4, 5, 6, 2, 3]], ['fan', 6, [4, 0, 1, 2, 6, 5]]]) {
    add(name, (b) => b.node({ mesh: b.mesh({ ...box(b), mode, indices: b.indices(UBYTE, order) }) }));
    add(`${name}-unindexed`, (b) => b.node({ mesh: b.mesh({ mode, attributes: { POSITION: b.accessor('VEC3', FLOAT,
        order.map((i) => positions[i]), { vertices: true }) } }) }));
}
add('beside-points-and-lines', (b) => {
    const primitive = box(b);
    const others = [0, 1, 2, 3].map((mode) => ({ attributes: primitive.attributes, mode }));
    b.node({ mesh: b.mesh(others[0], others[1], primitive, others[2], others[3]) });
});
add('materials-in-another-order', (b) => {
    b.json.materials = [{ name: 'one' }, { name: 'two' }];
    const primitive = (material, list) => ({ ...box(b), indices: b.indices(USHORT, list),
        ...(material !== undefined && { material }) });
    b.node({ mesh: b.mesh(primitive(undefined, triangles.slice(0, 9)), primitive(1, triangles.slice(9, 18)),
        primitive(0, triangles.slice(18))) });
});
add('materials-of-children', (b) => {
    b.json.materials = [{ name: 'one' }, { name: 'two' }];
    const meshes = [0, 1].map((material) => b.mesh({ ...box(b), material }));
    const child = b.node({ mesh: meshes[1], translation: [0, 3, 0] }, false);
    b.node({ mesh: meshes[0], children: [child] });
});
add('texture-transform', (b) => {
    b.uses('KHR_texture_transform');
    b.json.images = [{ uri: 'data:image/png;base64,' + 'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNg' +
        'AAAAAgABSK+kcQAAAABJRU5ErkJggg==' }];
    b.json.textures = [{ source: 0 }];
    b.json.materials = [{ pbrMetallicRoughness: { baseColorTexture: { index: 0, extensions: {
        KHR_texture_transform: { offset: [0.1, 0.3], rotation: 0.7, scale: [0.4, 0.3] } } } } }];
    b.node({ mesh: b.mesh({ ...box(b, { uv: true }), material: 0 }) });
});
add('texture-quantized', (b) => {
    b.uses('KHR_texture_transform');
    b.uses('KHR_mesh_quantization');
    b.json.images = [{ uri: 'data:image/png;base64,' + 'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNg' +
        'AAAAAgABSK+kcQAAAABJRU5ErkJggg==' }];
    b.json.textures = [{ source: 0 }];
    b.json.materials = [{ pbrMetallicRoughness: { baseColorTexture: { index: 0, extensions: {
        KHR_texture_transform: { offset: [0.02, 0.01], scale: [1 / 4200, 1 / 4200] } } } } }];
    const primitive = box(b);
    primitive.attributes.TEXCOORD_0 = b.accessor('VEC2', USHORT, scaled(uvs, 4095), { vertices: true });
    b.node({ mesh: b.mesh({ ...primitive, material: 0 }) });
});

// ---- nodes -----------------------------------------------------------------------------------------------------

const placed = { translation: [0.3, -1, 2], rotation: turn([1, 2, 3], 70), scale: [2, 0.5, 1.25] };
add('nodes-composed', (b) => {
    const mesh = b.mesh(box(b, { normal: true }));
    const leaf = b.node({ mesh, rotation: turn([0, 1, 1], 40), scale: [0.5, 1, 3] }, false);
    const middle = b.node({ mesh, children: [leaf], ...placed }, false);
    b.node({ rotation: turn([1, 0, 0], -25), translation: [4, 0, 1], children: [middle] });
});
add('nodes-matrix', (b) => b.node({ mesh: b.mesh(box(b, { normal: true })),
    matrix: [0, 2, 0, 0, -1, 0, 0, 0, 0, 0, 0.5, 0, 3, 4, 5, 1] }));
add('nodes-mirrored', (b) => {
    const mesh = b.mesh(box(b, { normal: true }));
    b.node({ mesh, scale: [-1, 1, 1] });
    b.node({ mesh, scale: [-1, -1, -1], translation: [5, 0, 0] });
    b.node({ mesh, scale: [-1, -1, 1], translation: [0, 5, 0] });
    b.node({ mesh, matrix: [0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1] });
});
add('nodes-many', (b) => {
    const mesh = b.mesh({ ...box(b), indices: b.indices(USHORT, triangles.slice(0, 3)) });
    let below = [];
    for (let i = 0; i < 600; i++)
        below = [b.node({ mesh, translation: [0.01, 0.02, 0.005], rotation: turn([i % 3, 1, 2], 1),
            ...(below.length && { children: below }) }, i === 599)];
    b.clip('bend', [[300, 'rotation', [0, 1], b.accessor('VEC4', FLOAT, [turn([0, 0, 1], 0), turn([0, 0, 1], 60)])]]);
}, 'binary');
add('scene-missing', (b) => {
    const mesh = b.mesh(box(b));
    b.node({ mesh });
    delete b.json.scene;
});
add('scene-second', (b) => {
    const mesh = b.mesh(box(b));
    b.node({ mesh });
    const other = b.node({ mesh, translation: [0, 3, 0] }, false);
    b.json.scenes.push({ nodes: [other] });
    b.json.scene = 1;
});
add('buffer-outside', (b) => b.node({ mesh: b.mesh(box(b)) }), 'outside');

// ---- instances -------------------------------------------------------------------------------------------------

function instanced(b, attributes) {
    b.uses('EXT_mesh_gpu_instancing');
    return { EXT_mesh_gpu_instancing: { attributes } };
}
const places = [[0, 0, 0], [3, 0, 1], [0, -2, 4]], turns = [turn([0, 1, 0], 30), turn([1, 1, 0], 90), turn([3, 1, 2], 200)];
add('instances-moved', (b) => b.node({ mesh: b.mesh(box(b, { normal: true })),
    extensions: instanced(b, { TRANSLATION: b.accessor('VEC3', FLOAT, places) }) }));
add('instances-turned', (b) => {
    const mesh = b.mesh(box(b, { normal: true }));
    const child = b.node({ mesh, translation: [0, 9, 0] }, false);
    b.node({ mesh, children: [child], ...placed, extensions: instanced(b, {
        TRANSLATION: b.accessor('VEC3', FLOAT, places), ROTATION: b.accessor('VEC4', FLOAT, turns),
        SCALE: b.accessor('VEC3', FLOAT, [[1, 2, 1], [0.5, 0.5, 0.5], [1, 1, -2]]) }) });
});
add('instances-shorts', (b) => b.node({ mesh: b.mesh(box(b)), extensions: instanced(b, {
    ROTATION: b.accessor('VEC4', SHORT, scaled(turns, 32767), { normalized: true }) }) }));
add('instances-that-move', (b) => {
    const node = b.node({ mesh: b.mesh(box(b, { normal: true })), extensions: instanced(b, {
        TRANSLATION: b.accessor('VEC3', FLOAT, places), ROTATION: b.accessor('VEC4', FLOAT, turns) }) });
    b.clip('turn', [[node, 'rotation', [0, 1, 2.5], b.accessor('VEC4', FLOAT, turns)]]);
});

// ---- skins -----------------------------------------------------------------------------------------------------

const inverse = (x, y, z) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -z, 1];
// Fifths, which bytes and shorts can tell.
const plainWeights = positions.map((p, i) => [(5 - i % 6) / 5, i % 6 / 5, 0, 0]);

// Adds two joints, the second above the first, and a skinned mesh below a node of its own.
function skinned(b, { weights = plainWeights, weightType = FLOAT, factor = 1, joint = UBYTE, binds = true, normal = true,
    node = { translation: [0, 5, 0] }, more = () => ({}) } = {}) {
    const elbow = b.node({ name: 'elbow', translation: [0, 1, 0], rotation: turn([1, 0, 0.3], 35) }, false);
    const shoulder = b.node({ name: 'shoulder', translation: [0.2, 0.4, 0], scale: [1, 1.2, 1], children: [elbow] });
    const primitive = box(b, { normal });
    primitive.attributes.JOINTS_0 = b.accessor('VEC4', joint, positions.map(() => [0, 1, 0, 0]), { vertices: true });
    primitive.attributes.WEIGHTS_0 = b.accessor('VEC4', weightType, factor === 1 ? weights : scaled(weights, factor),
        { vertices: true, normalized: weightType !== FLOAT });
    Object.assign(primitive, more(primitive));
    b.json.skins = [{ joints: [shoulder, elbow], ...(binds && { inverseBindMatrices: b.accessor('MAT4', FLOAT,
        [inverse(0, 0.2, 0), inverse(0, 1.1, 0)]) }) }];
    const body = b.node({ name: 'body', mesh: b.mesh(primitive), skin: 0, ...node });
    return { shoulder, elbow, body };
}
function wave(b, rig, interpolation) {
    b.clip('wave', [[rig.elbow, 'rotation', [0.25, 0.75, 1.5], b.accessor('VEC4', FLOAT, [turn([0, 0, 1], 0),
        turn([1, 0, 1], 80), turn([0, 1, 1], -60)]), interpolation],
    [rig.shoulder, 'translation', [0, 1.5], b.accessor('VEC3', FLOAT, [[0.2, 0.4, 0], [1, 0, 2]])]]);
}
add('skin-still', (b) => skinned(b));
add('skin-without-binds', (b) => skinned(b, { binds: false }));
add('skin-ushort-joints', (b) => skinned(b, { joint: USHORT, weightType: USHORT, factor: 65535 }));
add('skin-ubyte-weights', (b) => skinned(b, { weightType: UBYTE, factor: 255 }));
add('skin-waves', (b) => wave(b, skinned(b)));
add('skin-waves-without-normals', (b) => wave(b, skinned(b, { normal: false })));
add('skin-mirrored', (b) => {
    const rig = skinned(b);
    b.json.nodes[rig.shoulder].scale = [-1, 1.2, 1];
    wave(b, rig);
});
add('skin-twice', (b) => {
    const rig = skinned(b);
    b.node({ mesh: 0, skin: 0, name: 'body' });
    b.json.nodes[rig.elbow].name = 'shoulder';
    wave(b, rig);
});
add('skin-and-morph', (b) => {
    const rig = skinned(b, { more: () => ({ targets: [{ POSITION: b.accessor('VEC3', FLOAT,
        positions.map((p) => [p[1] * 0.3, 0.2, -p[0] * 0.4]), { vertices: true }) }] }) });
    wave(b, rig);
    b.json.animations[0].channels.push({ sampler: 2, target: { node: rig.body, path: 'weights' } });
    b.json.animations[0].samplers.push({ input: b.accessor('SCALAR', FLOAT, [0, 1]), output: b.accessor('SCALAR', FLOAT,
        [0.2, 1.3]) });
});

// ---- clips -----------------------------------------------------------------------------------------------------

const times = [0.2, 0.5, 1.1, 1.6];
const moves = [[0, 0, 0], [1, 0, 2], [0, 3, 1], [-1, 0, 0]], sizes = [[1, 1, 1], [2, 1, 1], [1, 0.5, 2], [0.5, 1, 1]];
const rolls = [turn([0, 0, 1], 0), turn([1, 0, 0], 100), turn([0, 1, 1], 220), turn([1, 1, 1], 30)];
// Puts tangents before and after each value.
const splined = (rows, factor) => rows.flatMap((row, i) => [row.map((x, c) => factor * Math.sin(i + c)), row,
    row.map((x, c) => factor * Math.cos(2 * i + c))]);
function moving(b, interpolation) {
    const splines = interpolation === 'CUBICSPLINE';
    const values = (type, rows) => b.accessor(type, FLOAT, splines ? splined(rows, 1.5) : rows);
    const node = b.node({ mesh: b.mesh(box(b, { normal: true })), rotation: turn([1, 0, 0], 10) });
    return [[node, 'translation', times, values('VEC3', moves), interpolation],
        [node, 'rotation', times, values('VEC4', rolls), interpolation],
        [node, 'scale', times, values('VEC3', sizes), interpolation]];
}
for (const interpolation of ['LINEAR', 'STEP', 'CUBICSPLINE'])
    add(`clip-${interpolation.toLowerCase()}`, (b) => b.clip('move', moving(b, interpolation)));
add('clips-of-all-kinds', (b) => {
    const tracks = moving(b, 'LINEAR');
    b.clip('first', tracks.slice(0, 2));
    b.clip('second', [[0, 'translation', [0, 1, 2], b.accessor('VEC3', FLOAT, splined(moves.slice(0, 3), 2)),
        'CUBICSPLINE']]);
    b.clip('third', [[0, 'rotation', [0, 1], b.accessor('VEC4', FLOAT, rolls.slice(0, 2)), 'STEP']]);
});
add('clip-of-one-track', (b) => {
    const node = b.node({ mesh: b.mesh(box(b, { normal: true })), ...placed });
    b.clip('turn', [[node, 'rotation', [0, 1], b.accessor('VEC4', FLOAT, rolls.slice(0, 2))]]);
});
for (const [name, component, factor] of [['bytes', BYTE, 127], ['shorts', SHORT, 32767]])
    add(`clip-of-${name}`, (b) => {
        const node = b.node({ mesh: b.mesh(box(b)) });
        b.clip('turn', [[node, 'rotation', times, b.accessor('VEC4', component, scaled(rolls, factor),
            { normalized: true })]]);
    });
add('clip-of-two-nodes-of-one-name', (b) => {
    const mesh = b.mesh(box(b));
    const inner = b.node({ name: 'part', mesh, translation: [0, 2, 0] }, false);
    const outer = b.node({ name: 'part', mesh, children: [inner] });
    b.node({ name: 'part', mesh, translation: [4, 0, 0] });
    b.clip('turn', [[inner, 'rotation', [0, 1], b.accessor('VEC4', FLOAT, rolls.slice(0, 2))],
        [outer, 'translation', [0, 2], b.accessor('VEC3', FLOAT, moves.slice(1, 3))]]);
});

// ---- morph targets ---------------------------------------------------------------------------------------------

const offsets = [(p) => [p[1] * 0.4, -p[0] * 0.2, 0.1], (p) => [0, p[0] * p[2], 0.5]];
function morphed(b, normal = true) {
    const primitive = box(b, { normal });
    primitive.targets = offsets.map((offset) => ({ POSITION: b.accessor('VEC3', FLOAT, positions.map(offset),
        { vertices: true }), ...(normal && { NORMAL: b.accessor('VEC3', FLOAT, normals.map((n) => [n[2] * 0.3, 0.1, 0]),
        { vertices: true }) }) }));
    return primitive;
}
add('morph-by-mesh', (b) => {
    const mesh = b.mesh(morphed(b));
    b.json.meshes[mesh].weights = [0.5, 1];
    b.node({ mesh });
});
add('morph-by-node', (b) => {
    const mesh = b.mesh(morphed(b));
    b.json.meshes[mesh].weights = [0.5, 1];
    b.node({ mesh, weights: [-0.25, 0.75] });
    b.node({ mesh, translation: [4, 0, 0] });
});
add('morph-sparse', (b) => {
    const primitive = box(b);
    primitive.targets = [{ POSITION: b.plain('VEC3', FLOAT, 7, { min: [0, 0, 0], max: [0.3, 0.4, 0.5] }) }];
    b.sparse(primitive.targets[0].POSITION, 'VEC3', FLOAT, USHORT, [5], [[0.3, 0.4, 0.5]]);
    const mesh = b.mesh(primitive);
    b.json.meshes[mesh].weights = [1];
    b.node({ mesh });
});
for (const interpolation of ['LINEAR', 'STEP', 'CUBICSPLINE'])
    add(`morph-${interpolation.toLowerCase()}`, (b) => {
        const mesh = b.mesh(morphed(b), { ...morphed(b), indices: b.indices(USHORT, [0, 1, 4]) });
        const node = b.node({ mesh, rotation: turn([0, 1, 0], 50) });
        b.node({ mesh: b.mesh(box(b, { normal: true })), translation: [5, 0, 0] });
        const rows = [[0, 1], [1, 0], [0.5, -0.5]].flatMap((row, i) => interpolation === 'CUBICSPLINE'
            ? [...row.map((x) => x + i), ...row, ...row.map((x) => 1 - x)] : row);
        b.clip('morph', [[node, 'weights', [0, 0.6, 2], b.accessor('SCALAR', FLOAT, rows), interpolation]]);
    });
add('morph-beside-a-clip', (b) => {
    const mesh = b.mesh(morphed(b, false));
    b.json.meshes[mesh].weights = [0.5, 0.25];
    b.node({ mesh });
    const other = b.node({ mesh: b.mesh(box(b)), translation: [5, 0, 0] });
    b.clip('turn', [[other, 'rotation', [0, 1], b.accessor('VEC4', FLOAT, rolls.slice(0, 2))]]);
});

// ---- Draco -----------------------------------------------------------------------------------------------------

// Compresses the box, with a hole so that the corners of some triangles are points of their own.
function compressed(b, { bits, sequential = false, joints = false, count }) {
    const encoder = new encoders.Encoder(), builder = new encoders.MeshBuilder(), mesh = new encoders.Mesh();
    builder.AddFacesToMesh(mesh, triangles.length / 3, new Uint32Array(triangles));
    const floats = (rows) => new Float32Array(rows.flat());
    const ids = { POSITION: builder.AddFloatAttributeToMesh(mesh, encoders.POSITION, 7, 3, floats(positions)),
        NORMAL: builder.AddFloatAttributeToMesh(mesh, encoders.NORMAL, 7, 3, floats(normals)),
        TEXCOORD_0: builder.AddFloatAttributeToMesh(mesh, encoders.TEX_COORD, 7, 2, floats(uvs)) };
    if (joints) {
        ids.JOINTS_0 = builder.AddUInt8Attribute(mesh, encoders.GENERIC, 7, 4,
            new Uint8Array(positions.flatMap(() => [0, 1, 0, 0])));
        ids.WEIGHTS_0 = builder.AddFloatAttributeToMesh(mesh, encoders.GENERIC, 7, 4, floats(plainWeights));
    }
    encoder.SetEncodingMethod(sequential ? encoders.MESH_SEQUENTIAL_ENCODING : encoders.MESH_EDGEBREAKER_ENCODING);
    for (const [kind, quantization] of Object.entries(bits))
        encoder.SetAttributeQuantization(encoders[kind], quantization);
    const out = new encoders.DracoInt8Array(), size = encoder.EncodeMeshToDracoBuffer(mesh, out);
    const bytes = Int8Array.from({ length: size }, (_, i) => out.GetValue(i));
    const points = count ?? positions.length;
    b.uses('KHR_draco_mesh_compression');
    const attributes = { POSITION: b.plain('VEC3', FLOAT, points, { min: [-1, 0, -0.6], max: [1, 1.6, 0.6] }),
        NORMAL: b.plain('VEC3', FLOAT, points), TEXCOORD_0: b.plain('VEC2', FLOAT, points) };
    if (joints)
        Object.assign(attributes, { JOINTS_0: b.plain('VEC4', UBYTE, points), WEIGHTS_0: b.plain('VEC4', FLOAT, points) });
    return { attributes, indices: b.plain('SCALAR', UINT, triangles.length),
        extensions: { KHR_draco_mesh_compression: { bufferView: b.view(bytes), attributes: ids } } };
}
const bits = { POSITION: 14, NORMAL: 10, TEX_COORD: 12 };
add('draco', (b) => b.node({ mesh: b.mesh(compressed(b, { bits })) }), 'binary');
add('draco-coarse', (b) => b.node({ mesh: b.mesh(compressed(b, { bits: { POSITION: 6, NORMAL: 5, TEX_COORD: 5 } })) }));
add('draco-sequential', (b) => b.node({ mesh: b.mesh(compressed(b, { bits, sequential: true })), ...placed }));
// An accessor that has fewer vertices than the stream: some programs write such files.
add('draco-with-more-points', (b) => b.node({ mesh: b.mesh(compressed(b, { bits, count: 5 })) }));
add('draco-not-quantized', (b) => b.node({ mesh: b.mesh(compressed(b, { bits: {}, sequential: true })) }));
add('draco-skin', (b) => wave(b, skinned(b, { more: () => compressed(b, { bits: { ...bits, GENERIC: 12 }, joints: true }) })),
    'binary');

// ---- meshopt ---------------------------------------------------------------------------------------------------

// Adds a view that meshopt compresses, whose own buffer has no data.
function packed(b, bytes, count, stride, mode, { filter, version, name = 'EXT_meshopt_compression' } = {}) {
    const encoded = MeshoptEncoder.encodeGltfBuffer(bytes, count, stride, mode, version);
    if (!b.json.extensionsUsed?.includes(name)) {
        b.uses(name);
        b.json.buffers = [{ byteLength: 0, extensions: { [name]: { fallback: true } } }];
    }
    const fallback = b.json.buffers[0], byteOffset = fallback.byteLength;
    fallback.byteLength += Math.ceil(count * stride / 4) * 4;
    b.json.bufferViews.push({ buffer: 1, byteOffset, byteLength: count * stride,
        ...(mode === 'ATTRIBUTES' && filter !== 'QUATERNION' && { byteStride: stride }), extensions: { [name]: { buffer: 0, byteOffset: b.bytes(encoded),
            byteLength: encoded.byteLength, byteStride: stride, count, mode, ...(filter && { filter }) } } });
    return b.json.bufferViews.length - 1;
}
// A sphere of many vertices, so that streams have several blocks.
function sphere() {
    const rings = 12, sides = 20, rows = [], list = [];
    for (let i = 0; i <= rings; i++)
        for (let k = 0; k < sides; k++) {
            const up = Math.PI * i / rings, around = 2 * Math.PI * k / sides;
            rows.push([Math.sin(up) * Math.cos(around) * (1 + 0.1 * Math.sin(7 * around)), Math.cos(up),
                Math.sin(up) * Math.sin(around)]);
        }
    for (let i = 0; i < rings; i++)
        for (let k = 0; k < sides; k++) {
            const a = i * sides + k, c = i * sides + (k + 1) % sides;
            list.push(a, c, a + sides, c, c + sides, a + sides);
        }
    return { rows, list };
}
const bytesOf = (array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
for (const [name, extension, version] of [['meshopt', 'EXT_meshopt_compression', 0],
    ['meshopt-khr', 'KHR_meshopt_compression', 1]]) {
    add(`${name}-floats`, (b) => {
        const { rows, list } = sphere(), of = { version, name: extension };
        const plain = new Float32Array(rows.flat());
        const position = packed(b, bytesOf(plain), rows.length, 12, 'ATTRIBUTES', of);
        const index = packed(b, bytesOf(new Uint32Array(list)), list.length, 4, 'TRIANGLES', of);
        b.node({ mesh: b.mesh({ attributes: { POSITION: b.plain('VEC3', FLOAT, rows.length, { bufferView: position,
            min: [0, 1, 2].map((c) => Math.min(...rows.map((r) => Math.fround(r[c])))),
            max: [0, 1, 2].map((c) => Math.max(...rows.map((r) => Math.fround(r[c])))) }) },
        indices: b.plain('SCALAR', UINT, list.length, { bufferView: index }) }) });
    }, 'binary');
    add(`${name}-filters`, (b) => {
        const { rows, list: all } = sphere(), of = { version, name: extension }, list = [...all.slice(0, 90), ...all.slice(-90)];
        b.uses('KHR_mesh_quantization');
        const four = (list4) => new Float32Array(list4.flatMap((r) => [...r, 0]));
        const near = MeshoptEncoder.encodeFilterExp(new Float32Array(rows.flat()), rows.length, 12, 15, 'SharedVector');
        const ways = MeshoptEncoder.encodeFilterOct(four(rows.map(unit)), rows.length, 4, 8);
        const rolled = MeshoptEncoder.encodeFilterQuat(new Float32Array(rolls.flat()), rolls.length, 8, 16);
        const far = MeshoptEncoder.encodeFilterOct(four(rows.map(unit)), rows.length, 8, 12);
        const exp = packed(b, near, rows.length, 12, 'ATTRIBUTES', { ...of, filter: 'EXPONENTIAL' });
        const oct = packed(b, ways, rows.length, 4, 'ATTRIBUTES', { ...of, filter: 'OCTAHEDRAL' });
        const wide = packed(b, far, rows.length, 8, 'ATTRIBUTES', { ...of, filter: 'OCTAHEDRAL' });
        const index = packed(b, bytesOf(new Uint16Array(list)), list.length, 2, 'INDICES', of);
        const quat = packed(b, rolled, rolls.length, 8, 'ATTRIBUTES', { ...of, filter: 'QUATERNION' });
        const attributes = { POSITION: b.plain('VEC3', FLOAT, rows.length, { bufferView: exp, min: [-1.2, -1.2, -1.2],
            max: [1.2, 1.2, 1.2] }), NORMAL: b.plain('VEC3', BYTE, rows.length, { bufferView: oct, normalized: true }) };
        const indices = b.plain('SCALAR', USHORT, list.length, { bufferView: index });
        const other = { ...attributes, NORMAL: b.plain('VEC3', SHORT, rows.length, { bufferView: wide, normalized: true }) };
        const node = b.node({ mesh: b.mesh({ attributes, indices }) });
        b.node({ mesh: b.mesh({ attributes: other, indices }), translation: [3, 0, 0] });
        b.clip('turn', [[node, 'rotation', times, b.plain('VEC4', SHORT, rolls.length, { bufferView: quat,
            normalized: true })]]);
    }, 'binary');
}

// ---- what is told to the user, or refused ----------------------------------------------------------------------

const fitted = 'noted the weights of some vertices do not sum to 1, and are scaled so that they do';
add('weights-that-do-not-fit', (b) => skinned(b, { weights: positions.map((p, i) => [0.2 * i, 0.7, 0, 0]) }), 'text', fitted);
add('weights-of-more-joints', (b) => {
    skinned(b, { binds: false, weights: positions.map(() => [0.4, 0.3, 0.15, 0.1]), more: (primitive) => {
        const list = (rows) => positions.map(() => rows);
        primitive.attributes.JOINTS_0 = b.accessor('VEC4', UBYTE, list([3, 1, 2, 0]), { vertices: true });
        primitive.attributes.JOINTS_1 = b.accessor('VEC4', UBYTE, list([4, 0, 0, 0]), { vertices: true });
        primitive.attributes.WEIGHTS_1 = b.accessor('VEC4', FLOAT, list([0.05, 0, 0, 0]), { vertices: true });
        return primitive;
    } });
    for (let i = 0; i < 3; i++)
        b.json.skins[0].joints.push(b.node({ translation: [i, 2, 1], rotation: turn([i, 1, 0], 20) }, false));
    b.json.nodes[1].children = [0, ...b.json.skins[0].joints.slice(2)];
}, 'text', 'noted more than 4 joints move some vertices: those with the largest weights do');
add('extension-of-materials', (b) => {
    b.uses('KHR_materials_unlit');
    b.node({ mesh: b.mesh(box(b)) });
}, 'text', "noted the file requires the extension 'KHR_materials_unlit', which kiln does not read: the mesh has its shape, " +
    'and may look different');
add('extension-of-nodes', (b) => {
    b.uses('KHR_node_visibility');
    b.node({ mesh: b.mesh(box(b)), extensions: { KHR_node_visibility: { visible: false } } });
}, 'text', "refused the file requires the extension 'KHR_node_visibility', which kiln does not read");
add('points-alone', (b) => b.node({ mesh: b.mesh({ ...box(b), mode: 0 }) }), 'text', 'refused the mesh has no triangles');
add('buffer-short', (b) => {
    b.node({ mesh: b.mesh(box(b)) });
    b.json.bufferViews[0].byteLength = 80;
}, 'text', 'refused accessor 0 ends at byte 84 of a buffer view of 80');
add('index-beyond', (b) => b.node({ mesh: b.mesh({ ...box(b), indices: b.indices(UBYTE, [0, 1, 7]) }) }), 'text',
    'refused accessor 2 has the index 7, and the mesh has 7 vertices');
add('node-below-itself', (b) => {
    b.node({ mesh: b.mesh(box(b)), children: [1] });
    b.node({ children: [0] }, false);
}, 'text', 'refused node 0 is twice in the scene, as a root and below one');

// ---- writing ---------------------------------------------------------------------------------------------------

// Files of others beside those that are written here.
const given = ['a_noibm.gltf', 'instancing.gltf', 'morph.gltf', 'pct.gltf', 'quant_short.gltf', 'skin_node.gltf'];
const cases = ['# What compare.c expects of these files; make.mjs writes this list.', ...given.map((file) => `${file} same`)];
for (const [name, { build, how, verdict }] of Object.entries(files)) {
    const b = new Builder(), file = how === 'text' ? `${name}.gltf` : `${name}.glb`, path = `${folder}/${file}`;
    build(b);
    if (how === 'text')
        b.writeText(path);
    else if (how === 'binary')
        b.writeBinary(path);
    else
        writeFileSync(`${folder}/its buffer ü.bin`, b.writeBinary(path, 'its%20buffer%20%C3%BC.bin'));
    cases.push(`${file} ${verdict}`);
}
writeFileSync(`${folder}/cases.txt`, cases.join('\n') + '\n');
console.log(`${Object.keys(files).length} files`);
