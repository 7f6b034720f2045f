// The schema takes every scene of the tree, as written and as kiln prints it, and refuses scenes
// that are broken in each way a schema can see, as kiln itself does: ajv.mjs SCENE_TEXT SOURCE.
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import Ajv from "ajv";
import { parse } from "yaml";

const [sceneText, source] = process.argv.slice(2);
const run = (...args) => execFileSync(sceneText, args, { encoding: "utf8", maxBuffer: 1 << 26 });

const ajv = new Ajv({ strict: true, allowUnionTypes: true, strictRequired: false });
const validate = ajv.compile(JSON.parse(run("schema")));
let failures = 0;

function expectGood(name, text) {
    if (validate(parse(text)))
        return;
    failures++;
    const [first] = validate.errors.slice(-1);
    console.error(`${name}: refused at ${first.instancePath}: ${first.message}`);
}

const folders = ["scenes", "scenes/templates", "tests/fuzz/corpus/scene/good"];
let scenes = 0;
for (const folder of folders) {
    for (const file of readdirSync(join(source, folder)).filter((f) => f.endsWith(".yaml"))) {
        const path = join(source, folder, file);
        expectGood(file, readFileSync(path, "utf8"));
        expectGood(`${file}, printed`, run("print", path));
        scenes++;
    }
}

// What a scene may write in the place of values and of what another file or entry gives.
const good = {
    "parameters": "kiln: 1\nparams: {a: {number: 1, min: 0}, b: {choice: x, of: [x, y]}}\nseed: $a",
    "arithmetic": "kiln: 1\ncamera: {fov: '= 2 * $a', position: [0, '= 1 m + $b', $c], target: $d}",
    "times in parts of the clip": "kiln: 1\ncamera: {roll: {keys: {50 %: 1 deg, '= $a / 2': $b}}}",
    "duration": "kiln: 1\noutput: {duration: 5 s}\nseed: 1",
    "includes": "kiln: 1\ninclude: [a.yaml, b/c.yaml]\nsystems: {a: {emit: {rate: 3}}}",
    "include": "kiln: 1\ninclude: a.yaml",
    "use": "kiln: 1\nsystems: {a: {use: b}}\nbackdrop: {objects: {a: {use: b, box: {}}, c: {use: b}}}",
    "names": "kiln: 1\nbackdrop: {lights: {a: {point: {}}}}",
    "colour": "kiln: 1\nsystems: {a: {look: {color: $brand, shape: $shape}}}",
};
for (const [name, text] of Object.entries(good))
    expectGood(name, text);

const system = (text) => `kiln: 1\nsystems: {a: ${text}}`;
const emit = (text) => system(`{emit: ${text}}`);
const look = (text) => system(`{look: ${text}}`);
const camera = (text) => `kiln: 1\ncamera: ${text}`;
const broken = {
    "no version": "seed: 1",
    "another version": "kiln: 2",
    "not a mapping": "[1, 2]",
    "unknown key": "kiln: 1\nsede: 1",
    "unknown key inside": emit("{raet: 1}"),
    "text for a number": "kiln: 1\nseed: many",
    "quoted number": "kiln: 1\nseed: '7'",
    "fraction for a whole number": "kiln: 1\nseed: 1.5",
    "negative seed": "kiln: 1\nseed: -1",
    "no frames": "kiln: 1\noutput: {frames: 0}",
    "tiny picture": "kiln: 1\noutput: {size: [8, 720]}",
    "one edge": "kiln: 1\noutput: {size: [720]}",
    "three edges": "kiln: 1\noutput: {size: [720, 720, 720]}",
    "word for a rate": "kiln: 1\noutput: {fps: fast}",
    "auto fps": "kiln: 1\noutput: {fps: auto}",
    "rate above": "kiln: 1\noutput: {fps: 2000}",
    "wrong unit": camera("{fov: 45 s}"),
    "bare angle": camera("{fov: 45}"),
    "unit on a plain number": "kiln: 1\npost: {bloom: {strength: 2 m}}",
    "percent on a length": camera("{near: 5 %}"),
    "not a number": camera("{near: .nan}"),
    "infinite": camera("{near: .inf}"),
    "two components": camera("{position: [1, 2]}"),
    "number for a vector": camera("{position: 3}"),
    "life of a camera": camera("{fov: {life: [40 deg, 50 deg]}}"),
    "random camera": camera("{fov: {random: [40 deg, 50 deg]}}"),
    "unknown ease": camera("{fov: {keys: {0 s: 40 deg}, ease: soft}}"),
    "too many octaves": camera("{fov: {noise: [40 deg, 50 deg], octaves: 9}}"),
    "noise without a period": camera("{fov: {noise: [40 deg, 50 deg], period: 0}}"),
    "choice of a mapping": look("{size: {choose: {0: 1}}}"),
    "one random number": look("{size: {random: 3}}"),
    "unknown word beside": look("{size: {random: [1, 2], tmies: 3}}"),
    "keys in a list": camera("{fov: {keys: [40 deg, 50 deg]}}"),
    "no keys": camera("{fov: {keys: {}}}"),
    "key that is no time": camera("{fov: {keys: {now: 40 deg}}}"),
    "keys and life": look("{size: {keys: {0 s: 1}, life: [1, 2]}}"),
    "unknown clock": look("{size: {time: [1, 2]}}"),
    "animated shape of the clip": "kiln: 1\noutput: {frames: {keys: {0 s: 1}}}",
    "unknown word": "kiln: 1\npost: {tonemap: film}",
    "word for a switch": "kiln: 1\npost: {dither: on}",
    "unknown force": system("{forces: [{gravty: [0, 1, 0]}]}"),
    "bare force": system("{forces: [gravity]}"),
    "two kinds in one": system("{forces: [{drag: 1, gravity: [0, 1, 0]}]}"),
    "member of another variant": system("{forces: [{wind: {octaves: 2}}]}"),
    "unknown variant": system("{forces: [{wind: {field: swirl}}]}"),
    "two shapes": emit("{from: {cone: {}, sphere: {}}}"),
    "no shape": emit("{from: {}}"),
    "member of another shape": emit("{from: {point: {radius: 1}}}"),
    "bursts in a list": emit("{bursts: [1, 2]}"),
    "part of a particle": emit("{bursts: {0 s: 1.5}}"),
    "range of three": emit("{life: [1, 2, 3]}"),
    "life below": emit("{life: 0}"),
    "collide as a switch": system("{collide: true}"),
    "bounds without max": system("{bounds: {min: [0, 0, 0]}}"),
    "none among demitters": system("{demitters: [none]}"),
    "name with a blank": "kiln: 1\nsystems: {'a b': {}}",
    "unknown built-in": look("{atlas: 'builtin:fog'}"),
    "absolute path": look("{atlas: /etc/passwd}"),
    "number for a path": look("{atlas: 3}"),
    "empty path": look("{atlas: ''}"),
};
const folder = mkdtempSync(join(tmpdir(), "kiln-schema-"));
for (const [name, text] of Object.entries(broken)) {
    if (validate(parse(text))) {
        failures++;
        console.error(`${name}: accepted, though broken:\n${text}`);
    }
    const file = join(folder, "scene.yaml");
    writeFileSync(file, text);
    if (spawnSync(sceneText, ["print", file]).status !== 3) {
        failures++;
        console.error(`${name}: the schema refuses what kiln accepts:\n${text}`);
    }
}
rmSync(folder, { recursive: true });

console.log(`${scenes} scenes, ${Object.keys(broken).length} broken ones, ${failures} failures`);
process.exit(failures ? 1 : 0);
