// Writes glTF files of nodes that move, and where three.js finds them: `node nodes.mjs FOLDER` writes the files and
// FOLDER/expect.txt, which nodes.c compares with kiln's poses. A line of that is a file, a clip (-1: none), a time, the
// number of a node, and its frame in the file's space: its place, its z axis, its y axis made perpendicular to that, both
// of length 1, and the length of its z axis.
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { Builder, FLOAT } from './builder.mjs';

globalThis.self = globalThis;
globalThis.ProgressEvent ??= class extends Event {};
const THREE = await import('three');
const { GLTFLoader } = await import('three/addons/loaders/GLTFLoader.js');

const folder = process.argv[2];
const lines = [];

// ---- the files -----------------------------------------------------------------------------------------------

function turn(axis, degrees) {
    const length = Math.hypot(...axis), half = degrees * Math.PI / 360;
    return [...axis.map((x) => x / length * Math.sin(half)), Math.cos(half)];
}

// The keys of a cubic spline: a tangent before and one behind each value, of differing lengths.
function splined(values, by) {
    return values.flatMap((value, i) => [value.map((x, c) => by * Math.sin(1 + i + c)), value,
        value.map((x, c) => by * Math.cos(2 * i - c))]);
}

const rolls = [turn([1, 2, 3], 10), turn([0, 1, 0.5], 130), turn([-1, 0.2, 0.3], 200), turn([1, 1, -2], 320)];
const moves = [[0, 0, 0], [1, -2, 3], [4, 0.5, -1], [-2, 2, 2]];
const scales = [1, 2, 0.5, 1.5];
const times = [0.25, 0.75, 1.5, 2.75];

function matrix(axis, degrees, scale, move) {
    return new THREE.Matrix4().compose(new THREE.Vector3(...move), new THREE.Quaternion(...turn(axis, degrees)),
        new THREE.Vector3(...scale)).toArray();
}

function camera(b, camera) {
    (b.json.cameras ??= []).push(camera);
    return b.json.cameras.length - 1;
}

function tracks(b, node, interpolation, grow) {
    const is = (rows, by) => interpolation === 'CUBICSPLINE' ? splined(rows, by) : rows;
    return [
        [node, 'translation', times, b.accessor('VEC3', FLOAT, is(moves, 0.8)), interpolation],
        [node, 'rotation', times, b.accessor('VEC4', FLOAT, is(rolls, 0.4)), interpolation],
        ...(grow ? [[node, 'scale', times, b.accessor('VEC3', FLOAT, scales.flatMap((s, i) =>
            interpolation === 'CUBICSPLINE' ? [[0.1 * i, 0.1 * i, 0.1 * i], [s, s, s], [-0.2, -0.2, -0.2]]
                : [[s, s, s]])), interpolation]] : []),
    ];
}

// A camera on an arm: a rotation and a scale, a matrix, and an own place; two of them move.
function shot(b, interpolation, grow) {
    b.node({ name: 'Stage', children: [1], rotation: turn([1, 0, 2], 40), scale: [2, 2, 2], translation: [1, 0, -3] });
    b.node({ name: 'Dolly', children: [2, 4] }, false);
    b.node({ name: 'Crane', children: [3], matrix: matrix([0, 1, 1], 70, [0.5, 0.5, 0.5], [0, 2, 1]) }, false);
    b.node({ name: 'Camera', camera: camera(b, { type: 'perspective', name: 'lens',
        perspective: { yfov: 0.7, znear: 0.1, aspectRatio: 1.5 } }), translation: [0, 0.5, 4],
    rotation: turn([0, 1, 0], 25) }, false);
    b.node({ name: 'Flat', camera: camera(b, { type: 'orthographic',
        orthographic: { xmag: 1, ymag: 1, znear: 0, zfar: 9 } }) }, false);
    b.clip('Take 1', [...tracks(b, 1, interpolation, grow),
        [3, 'rotation', [0, 1, 2], b.accessor('VEC4', FLOAT, [rolls[0], rolls[2].map((x) => -x), rolls[1]])]]);
    b.clip('Take 2', [[3, 'translation', [0, 3], b.accessor('VEC3', FLOAT, [[0, 0, 5], [1, 1, 1]])]]);
}

// Scales that differ between axes, and a mirror, above a node that turns.
function uneven(b) {
    b.node({ name: 'Wide', children: [1], scale: [3, 1, 0.5], rotation: turn([0, 0, 1], 20) });
    b.node({ name: 'Mirror', children: [2], matrix: matrix([1, 0, 0], 30, [-1, 1, 1], [1, 2, 3]) }, false);
    b.node({ name: 'Tip', translation: [1, 1, 1], rotation: turn([0, 1, 0], 50) }, false);
    b.clip('turn', [[2, 'rotation', times, b.accessor('VEC4', FLOAT, rolls)]]);
}

const files = {
    'nodes-linear': (b) => shot(b, 'LINEAR', true), 'nodes-step': (b) => shot(b, 'STEP', true),
    'nodes-cubicspline': (b) => shot(b, 'CUBICSPLINE', false), 'nodes-growing': (b) => shot(b, 'CUBICSPLINE', true),
    'nodes-uneven': uneven,
};

// ---- three.js ------------------------------------------------------------------------------------------------

function frame(object) {
    const [x, y, z] = [0, 1, 2].map((column) => new THREE.Vector3().setFromMatrixColumn(object.matrixWorld, column));
    const at = new THREE.Vector3().setFromMatrixPosition(object.matrixWorld), scale = z.length();
    z.normalize();
    y.addScaledVector(z, -z.dot(y)).normalize();
    return [...at.toArray(), ...z.toArray(), ...y.toArray(), scale];
}

// Scales quaternions to length 1, as kiln does; three.js takes them as they are.
function normalizeKeys(clip) {
    for (const track of clip.tracks.filter(({ name }) => name.endsWith('.quaternion'))) {
        const parts = track.values.length / track.times.length / 4;
        for (let i = Math.floor(parts / 2); i < track.values.length / 4; i += parts) {
            const length = Math.hypot(...track.values.slice(4 * i, 4 * i + 4));
            for (let c = 0; c < 4; c++)
                track.values[4 * i + c] /= length;
        }
    }
}

async function expect(name) {
    const gltf = await new GLTFLoader().parseAsync(readFileSync(join(folder, name)).toString(), '');
    const nodes = [];
    gltf.scene.traverse((object) => {
        const number = gltf.parser.associations.get(object)?.nodes;
        if (number !== undefined)
            nodes[number] = object;
    });
    const tell = (clip, seconds) => {
        gltf.scene.updateMatrixWorld(true);
        nodes.forEach((object, number) => lines.push([name, clip, seconds, number, ...frame(object)].join(' ')));
    };
    tell(-1, 0);
    for (const [number, clip] of gltf.animations.entries()) {
        normalizeKeys(clip);
        for (const part of [0, 0.05, 0.113, 0.3, 0.472, 0.7, 0.861, 1]) {
            const seconds = Math.fround(part * clip.duration), mixer = new THREE.AnimationMixer(gltf.scene);
            const action = mixer.clipAction(clip);
            action.setLoop(THREE.LoopOnce);
            action.clampWhenFinished = true;
            action.play();
            mixer.setTime(seconds);
            tell(number, seconds);
            mixer.stopAllAction();
            mixer.uncacheRoot(gltf.scene);
        }
    }
}

for (const [name, fill] of Object.entries(files)) {
    const b = new Builder();
    fill(b);
    b.json.asset.generator = 'kiln tests/gltf/nodes.mjs';
    b.writeText(join(folder, `${name}.gltf`));
    await expect(`${name}.gltf`);
}
writeFileSync(join(folder, 'expect.txt'), lines.join('\n') + '\n');
