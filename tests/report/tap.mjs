// The blocks of YAML in a TAP report say what they are to say: tap.mjs FILE.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { parse } from "yaml";

const text = readFileSync(process.argv[2], "utf8");
const tests = {};
for (const [, line, block] of text.matchAll(/^((?:not )?ok \d+ - .*)\n  ---\n([^]*?)\n  \.\.\.$/gm))
    tests[line.replace(/^.*? - /, "")] = parse(block);

assert.equal(Object.keys(tests).length, 10);
assert.equal(tests["effects/fire"].status, "pass");
assert.equal(tests["effects/fire"].seconds, 1.25);
assert.equal(tests["effects/fire"].frames, undefined);
assert.equal(tests["effects/smoke"].notes[1], "the scene changed (2 keys)");
const [frame] = tests["fail/metrics"].frames;
assert.equal(tests["fail/metrics"].frames.length, 1);
assert.deepEqual(frame, {
    frame: 96,
    status: "fail",
    judged_by: "metrics",
    message: "flip.mean 0.03125 > 0.01",
    metrics: {
        "flip.mean": { value: 0.03125, limit: 0.01, beyond: true },
        ssim: { value: 0.9688, limit: 0.9, beyond: false },
    },
});
assert.equal(tests["fail/state"].frames[0].judged_by, "state");
assert.equal(tests["new"].frames[0].metrics, undefined);
assert.equal(tests["lost"].code, 5);
const nasty = Object.values(tests)[0];
assert.equal(nasty.message, "a&b<c>\"d'#e\\f%g:h,i]]>j{k}\x01\x1b[31m\nl\tm\r\u00e9\ufffe");
