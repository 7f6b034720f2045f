// Writes what three.js reads of glTF files, for compare.c: `node expect.mjs FILE... FOLDER` writes FOLDER/NAME.expect
// for each file, where NAME is FILE with underscores for slashes, and prints the files that gltf-validator or three.js refuse.
//
// Texture coordinates count from the bottom of a picture, as kiln's do.
//
// An .expect is a list of little-endian numbers of 32 bits: a mark, the number of triangles, whether it has texture
// coordinates; of each corner position, normal and texture coordinates (NaN: there is none); the number of clips; of
// each its length and three times, and for each time position and normal of each corner. The triangles of the mesh
// at rest are in the order in which their materials are used first, in children before their parents, those of a clip in the order of nodes, near the root first, which are
// kiln's orders. A mirrored triangle has its corners turned, so that its front is in front.
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

globalThis.self = globalThis;
globalThis.ProgressEvent ??= class extends Event {};
const THREE = await import('three');
const { GLTFLoader } = await import('three/addons/loaders/GLTFLoader.js');
const { MeshoptDecoder } = await import('meshoptimizer');
const require = createRequire(import.meta.url);
const validator = require('gltf-validator');
const decoders = await require('draco3dgltf').createDecoderModule({});

const MARK = 0x58454c47, MOST_CLIPS = 8;
// Times of a clip, as parts of its length. No key of a test lies at one of them, since STEP jumps there.
const TIMES = [0.113, 0.472, 0.861];

// ---- loading -------------------------------------------------------------------------------------------------

// Stands in for three.js' DRACOLoader, which needs workers of a browser.
const draco = {
    preload() { return this; },
    decodeDracoFile(bytes, done, ids, types) {
        const decoder = new decoders.Decoder(), mesh = new decoders.Mesh(), data = new Int8Array(bytes);
        const status = decoder.DecodeArrayToMesh(data, data.length, mesh);
        if (!status.ok())
            throw new Error(status.error_msg());
        const geometry = new THREE.BufferGeometry();
        for (const [name, id] of Object.entries(ids)) {
            const attribute = decoder.GetAttributeByUniqueId(mesh, id), width = attribute.num_components();
            const floats = new decoders.DracoFloat32Array(), integers = new decoders.DracoInt32Array();
            const isFloat = types[name] === 'Float32Array';
            if (isFloat)
                decoder.GetAttributeFloatForAllPoints(mesh, attribute, floats);
            else
                decoder.GetAttributeInt32ForAllPoints(mesh, attribute, integers);
            const values = globalThis[types[name]].from({ length: mesh.num_points() * width },
                (_, i) => (isFloat ? floats : integers).GetValue(i));
            geometry.setAttribute(name, new THREE.BufferAttribute(values, width));
        }
        const face = new decoders.DracoInt32Array(), index = [];
        for (let i = 0; i < mesh.num_faces(); i++) {
            decoder.GetFaceFromMesh(mesh, i, face);
            index.push(face.GetValue(0), face.GetValue(1), face.GetValue(2));
        }
        geometry.setIndex(index);
        done(geometry);
    },
};

function load(path) {
    const manager = new THREE.LoadingManager();
    manager.setURLModifier((url) => url.startsWith('data:') ? url : 'data:application/octet-stream;base64,' +
        readFileSync(join(dirname(path), decodeURIComponent(url))).toString('base64'));
    const loader = new GLTFLoader(manager);
    loader.setDRACOLoader(draco);
    loader.setMeshoptDecoder(MeshoptDecoder);
    // Textures are not looked at. Of several scenes, three.js would only keep notes of the last.
    loader.register((parser) => ({ name: 'kiln', loadTexture: () => Promise.resolve(new THREE.Texture()),
        beforeRoot: async () => {
            const json = parser.json;
            if (json.scenes)
                json.scenes = [json.scenes[json.scene ?? 0]];
            json.scene = 0;
        } }));
    const file = readFileSync(path);
    const bytes = file.buffer.slice(file.byteOffset, file.byteOffset + file.length);
    return loader.parseAsync(path.endsWith('.gltf') ? file.toString() : bytes, '');
}

// ---- triangles -----------------------------------------------------------------------------------------------

function primitivesOf(gltf, object) {
    const isNode = (o) => gltf.parser.associations.get(o)?.nodes !== undefined;
    return [object, ...object.children.filter((o) => !isNode(o))].filter((o) => o.isMesh);
}

function nodesOf(gltf, object) {
    const isNode = (o) => gltf.parser.associations.get(o)?.nodes !== undefined;
    return object.children.filter(isNode);
}

// The meshes of a scene: depth first, or those near the root first.
function meshesOf(gltf, nearFirst) {
    const found = [], left = [...nodesOf(gltf, gltf.scene)];
    while (left.length) {
        const node = left.shift();
        found.push(...primitivesOf(gltf, node));
        left.splice(nearFirst ? left.length : 0, 0, ...nodesOf(gltf, node));
    }
    return found;
}

function materialOf(gltf, mesh) {
    const json = gltf.parser.json, known = gltf.parser.associations.get(mesh);
    if (known?.meshes !== undefined)
        return json.meshes[known.meshes].primitives[known.primitives].material;
    // An instanced mesh is only known by its node, of which it is a child if there are several.
    const node = known ? mesh : mesh.parent, of = json.nodes[gltf.parser.associations.get(node).nodes].mesh;
    const number = known ? 0 : primitivesOf(gltf, node).indexOf(mesh);
    return json.meshes[of].primitives[number].material;
}

// The materials of a scene in the order in which they are used first.
function materialsOf(gltf) {
    const json = gltf.parser.json, found = [];
    const visit = (node) => {
        (node.children ?? []).forEach((child) => visit(json.nodes[child]));
        for (const { material } of json.meshes?.[node.mesh]?.primitives ?? [])
            if (material !== undefined && !found.includes(material))
                found.push(material);
    };
    (json.scenes?.[json.scene].nodes ?? []).forEach((root) => visit(json.nodes[root]));
    return found;
}

// The matrix that places a vertex of a mesh.
function matrixOf(mesh, vertex, instance) {
    const matrix = new THREE.Matrix4();
    const { skinIndex, skinWeight } = mesh.geometry.attributes;
    if (mesh.isSkinnedMesh && skinIndex && skinWeight) {
        matrix.elements.fill(0);
        for (let k = 0; k < 4; k++) {
            const bone = new THREE.Matrix4().multiplyMatrices(mesh.skeleton.bones[skinIndex.getComponent(vertex, k)]
                .matrixWorld, mesh.skeleton.boneInverses[skinIndex.getComponent(vertex, k)]);
            bone.elements.forEach((x, i) => { matrix.elements[i] += x * skinWeight.getComponent(vertex, k); });
        }
        return matrix;
    }
    matrix.copy(mesh.matrixWorld);
    if (mesh.isInstancedMesh) {
        const own = new THREE.Matrix4();
        mesh.getMatrixAt(instance, own);
        matrix.multiply(own);
    }
    return matrix;
}

function morphed(mesh, name, vertex) {
    const { attributes, morphAttributes } = mesh.geometry;
    const out = new THREE.Vector3().fromBufferAttribute(attributes[name], vertex);
    (morphAttributes[name] ?? []).forEach((target, i) => {
        out.addScaledVector(new THREE.Vector3().fromBufferAttribute(target, vertex),
            mesh.morphTargetInfluences?.[i] ?? 0);
    });
    return out;
}

function uvOf(mesh, vertex) {
    const uv = mesh.geometry.attributes.uv, map = mesh.material.map;
    if (!uv)
        return [NaN, NaN];
    const out = new THREE.Vector2().fromBufferAttribute(uv, vertex);
    if (map && map.channel === 0) {
        if (map.matrixAutoUpdate)
            map.updateMatrix();
        out.applyMatrix3(map.matrix);
    }
    return [out.x, 1 - out.y];
}

function cornersOf(mesh, withUvs) {
    const { attributes, index } = mesh.geometry;
    const count = index ? index.count : attributes.position.count, out = [];
    for (let instance = 0; instance < (mesh.isInstancedMesh ? mesh.count : 1); instance++)
        for (let i = 0; i + 2 < count; i += 3) {
            const at = (k) => index ? index.getX(i + k) : i + k;
            const turned = matrixOf(mesh, at(0), instance).determinant() < 0;
            for (const k of turned ? [0, 2, 1] : [0, 1, 2]) {
                const matrix = matrixOf(mesh, at(k), instance);
                out.push(...morphed(mesh, 'position', at(k)).applyMatrix4(matrix).toArray());
                const normal = attributes.normal ? morphed(mesh, 'normal', at(k)).applyMatrix3(
                    new THREE.Matrix3().getNormalMatrix(matrix)).normalize() : new THREE.Vector3();
                out.push(...(normal.lengthSq() > 0.5 ? normal.toArray() : [NaN, NaN, NaN]));
                if (withUvs)
                    out.push(...uvOf(mesh, at(k)));
            }
        }
    return out;
}

// ---- clips ---------------------------------------------------------------------------------------------------

// Scales quaternions to length 1, as kiln does; three.js takes them as they are.
function normalizeKeys(clip) {
    for (const track of clip.tracks) {
        if (!track.name.endsWith('.quaternion'))
            continue;
        const parts = track.values.length / track.times.length / 4;
        for (let i = Math.floor(parts / 2); i < track.values.length / 4; i += parts) {
            const length = Math.hypot(...track.values.slice(4 * i, 4 * i + 4));
            for (let c = 0; c < 4; c++)
                track.values[4 * i + c] /= length;
        }
    }
}

function pose(gltf, clip, seconds) {
    const mixer = new THREE.AnimationMixer(gltf.scene), action = mixer.clipAction(clip);
    action.setLoop(THREE.LoopOnce);
    action.clampWhenFinished = true;
    action.play();
    mixer.setTime(seconds);
    gltf.scene.updateMatrixWorld(true);
    const corners = meshesOf(gltf, true).flatMap((mesh) => cornersOf(mesh, false));
    mixer.stopAllAction();
    mixer.uncacheRoot(gltf.scene);
    return corners;
}

function expect(gltf) {
    gltf.scene.updateMatrixWorld(true);
    const materials = [...materialsOf(gltf), undefined];
    const meshes = meshesOf(gltf, false).map((mesh, i) => ({ mesh, order: i,
        rank: materials.indexOf(materialOf(gltf, mesh)) }));
    meshes.sort((a, b) => a.rank - b.rank || a.order - b.order);
    const corners = meshes.flatMap(({ mesh }) => cornersOf(mesh, true));
    const uvs = meshes.every(({ mesh }) => mesh.geometry.attributes.uv);
    const words = [MARK, corners.length / 24, uvs ? 1 : 0], clips = gltf.animations.slice(0, MOST_CLIPS);
    const bytes = [Uint32Array.from(words), Float32Array.from(corners), Uint32Array.of(clips.length)];
    for (const clip of clips) {
        normalizeKeys(clip);
        bytes.push(Float32Array.of(clip.duration));
        for (const part of TIMES) {
            const seconds = Math.fround(part * clip.duration);
            bytes.push(Float32Array.of(seconds), Float32Array.from(pose(gltf, clip, seconds)));
        }
    }
    return Buffer.concat(bytes.map((array) => Buffer.from(array.buffer)));
}

// ---- all files -----------------------------------------------------------------------------------------------

async function validate(path) {
    const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), {
        externalResourceFunction: async (uri) => new Uint8Array(readFileSync(join(dirname(path),
            decodeURIComponent(uri)))), maxIssues: 100 });
    return report.issues.messages.filter(({ severity }) => severity === 0);
}

const folder = process.argv.at(-1);
let count = 0;
for (const path of process.argv.slice(2, -1)) {
    const errors = await validate(path).catch((error) => [{ code: 'UNREADABLE', message: error.message ?? error }]);
    if (errors.length)
        console.log(`${path}: gltf-validator: ${errors[0].code} ${errors[0].message}`);
    if (errors.length && process.env.EXPECT_VALID === '1')
        continue;
    try {
        const bytes = expect(await load(path));
        writeFileSync(join(folder, path.replaceAll('/', '_') + '.expect'), bytes);
        count++;
    } catch (error) {
        console.log(`${path}: three.js: ${error.message}`);
    }
}
console.log(`${count} files`);
