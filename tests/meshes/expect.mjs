// Writes what three.js reads in the files of this folder: NAME.expect for each PLY, STL and OBJ. Each has a line for each
// triangle, with the position, normal and texture coordinate of each corner; zeros where the file has none.
//     npm install three@0.187.0 && node expect.mjs
import fs from 'node:fs';
import path from 'node:path';
import { OBJLoader } from 'three/examples/jsm/loaders/OBJLoader.js';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';
import { STLLoader } from 'three/examples/jsm/loaders/STLLoader.js';

const folder = path.resolve(process.argv[2] ?? '.');

// three.js takes no STL in capitals, and divides quads by the other diagonal.
const left = ['capitals.stl', 'quads.ply'];

function geometries(file) {
    const bytes = fs.readFileSync(file);
    const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
    if (file.endsWith('.ply')) return [new PLYLoader().parse(buffer)];
    if (file.endsWith('.stl')) return [new STLLoader().parse(buffer)];
    return new OBJLoader().parse(bytes.toString()).children.map((child) => child.geometry);
}

function triangles(geometry, isStl) {
    const { position, normal, uv } = geometry.attributes;
    const count = geometry.index ? geometry.index.count : position.count;
    const lines = [];
    for (let i = 0; i < count; i++) {
        const v = geometry.index ? geometry.index.getX(i) : i;
        const values = [position.getX(v), position.getY(v), position.getZ(v)];
        // the normals of an STL are those of its facets, which kiln computes
        if (normal && !isStl) values.push(normal.getX(v), normal.getY(v), normal.getZ(v));
        else values.push(0, 0, 0);
        if (uv) values.push(uv.getX(v), uv.getY(v));
        else values.push(0, 0);
        const text = values.map((value) => String(Math.fround(value))).join(' ');
        if (i % 3 === 0) lines.push(text);
        else lines[lines.length - 1] += ' ' + text;
    }
    return lines;
}

for (const name of fs.readdirSync(folder).filter((one) => /\.(ply|stl|obj)$/.test(one) && !left.includes(one))) {
    const lines = geometries(path.join(folder, name)).flatMap((one) => triangles(one, name.endsWith('.stl')));
    fs.writeFileSync(path.join(folder, name + '.expect'), lines.join('\n') + '\n');
}
