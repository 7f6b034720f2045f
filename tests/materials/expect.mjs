// Writes what three.js reads of the materials of the files of this folder: NAME.expect for each mesh. Each triangle has
// a line: its material, then red, green, blue and alpha of its corners. Each material has a line and one for each of its
// textures; - stands for what three.js does not tell. The lines are those that tests/unit/test_materials.c writes.
//     npm install three@0.187.0 && node expect.mjs
import fs from 'node:fs';
import path from 'node:path';
globalThis.self = globalThis;
globalThis.ProgressEvent ??= class extends Event {};
const THREE = await import('three');
const { GLTFLoader } = await import('three/addons/loaders/GLTFLoader.js');
const { MTLLoader } = await import('three/addons/loaders/MTLLoader.js');
const { OBJLoader } = await import('three/addons/loaders/OBJLoader.js');
const { PLYLoader } = await import('three/addons/loaders/PLYLoader.js');

const folder = path.resolve(process.argv[2] ?? '.');
const WRAPS = { [THREE.RepeatWrapping]: 0, [THREE.MirroredRepeatWrapping]: 1, [THREE.ClampToEdgeWrapping]: 2 };
const word = (text) => text.replaceAll(' ', '_');

// Stands in for a texture, which node cannot decode: it keeps where its picture is.
function stub(picture) {
    const texture = new THREE.Texture();
    texture.userData.picture = word(picture);
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    return texture;
}

function loadObj(file, libraries) {
    const names = {};
    for (const library of libraries) {
        const creator = new MTLLoader().parse(fs.readFileSync(path.join(folder, library)).toString(), '');
        creator.loadTexture = (url) => stub(url);
        creator.preload();
        Object.assign(names, creator.materials);
    }
    const loader = new OBJLoader();
    loader.setMaterials({ create: (name) => names[name], preload() {} });
    return loader.parse(fs.readFileSync(file).toString());
}

async function loadGltf(file) {
    const loader = new GLTFLoader();
    loader.register((parser) => {
        parser.loadImageSource = (index) => {
            const { uri, bufferView } = parser.json.images[index];
            const bytes = uri?.startsWith('data:') ? Buffer.from(uri.split(',')[1], 'base64').length
                : bufferView !== undefined ? parser.json.bufferViews[bufferView].byteLength : 0;
            return Promise.resolve(stub(bytes ? `bytes:${bytes}` : decodeURIComponent(uri)));
        };
        return { name: 'kiln' };
    });
    const bytes = fs.readFileSync(file);
    return (await loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '')).scene;
}

// The matrix that takes texture coordinates to where they are looked up, both counted from the bottom of the picture: those
// of a glTF count from its top, for which three.js does not flip the picture.
function rowsOf(map) {
    const top = map.flipY ? new THREE.Matrix3() : new THREE.Matrix3(1, 0, 0, 0, -1, 1, 0, 0, 1);
    const m = top.clone().multiply(map.matrix).multiply(top).elements;
    return [m[0], m[3], m[6], m[1], m[4], m[7]];
}

function mapLine(use, map, strength) {
    map.updateMatrix();
    const nearest = map.magFilter === THREE.NearestFilter ? 1 : 0;
    return `map ${use} ${map.userData.picture} ${map.channel} ${WRAPS[map.wrapS]} ${WRAPS[map.wrapT]} ${nearest} ` +
        `${strength} ${rowsOf(map).join(' ')}`;
}

function materialLines(m) {
    const phong = m.isMeshPhongMaterial, unlit = m.isMeshBasicMaterial;
    const c = m.color, e = m.emissive ?? new THREE.Color(0), power = m.emissiveIntensity ?? 1;
    const mode = m.transparent ? 'blend' : m.alphaTest > 0 ? `mask ${m.alphaTest}` : 'opaque';
    const lines = [`material ${word(m.name)} ${c.r} ${c.g} ${c.b} ${m.opacity} ${m.roughness ?? '-'} ${m.metalness ?? '-'} ` +
        `${e.r * power} ${e.g * power} ${e.b * power} ${mode} ${m.side === THREE.DoubleSide ? 1 : 0} ${unlit ? 1 : 0}`];
    const maps = { color: m.map, alpha: m.alphaMap, normal: m.normalMap, height: m.bumpMap, roughness: m.roughnessMap,
        metalness: m.metalnessMap, emission: m.emissiveMap };
    for (const [use, map] of Object.entries(maps))
        if (map)
            lines.push(mapLine(use, map, use === 'normal' && !phong ? m.normalScale.x : use === 'height' ? m.bumpScale : 1));
    return lines;
}

function triangleLines(geometry, group, name) {
    const { color } = geometry.attributes, lines = [];
    for (let i = group.start; i < group.start + group.count; i += 3) {
        const values = [0, 1, 2].flatMap((k) => {
            const v = geometry.index ? geometry.index.getX(i + k) : i + k;
            return color ? [color.getX(v), color.getY(v), color.getZ(v), color.itemSize > 3 ? color.getW(v) : 1] : [1, 1, 1, 1];
        });
        lines.push(`triangle ${name} ${values.join(' ')}`);
    }
    return lines;
}

function describe(object) {
    const triangles = [], materials = [], seen = new Set();
    object.traverse((mesh) => {
        if (!mesh.isMesh)
            return;
        const all = Array.isArray(mesh.material) ? mesh.material : [mesh.material];
        const count = (mesh.geometry.index ?? mesh.geometry.attributes.position).count;
        const groups = mesh.geometry.groups.length ? mesh.geometry.groups : [{ start: 0, count, materialIndex: 0 }];
        for (const group of groups) {
            const material = all[group.materialIndex], name = word(material?.name || '-');
            triangles.push(...triangleLines(mesh.geometry, group, name));
            if (!material?.name || seen.has(name))
                continue;
            seen.add(name);
            materials.push(...materialLines(material));
        }
    });
    return [...materials, ...triangles].join('\n') + '\n';
}

const meshes = {
    'painted.obj': (file) => loadObj(file, ['painted.mtl', 'more paint.mtl']),
    'painted.gltf': loadGltf,
    'painted.glb': loadGltf,
    'painted.ply': (file) => new THREE.Mesh(new PLYLoader().parse(fs.readFileSync(file).toString())),
};
for (const [name, load] of Object.entries(meshes))
    fs.writeFileSync(path.join(folder, name + '.expect'), describe(await load(path.join(folder, name))));
