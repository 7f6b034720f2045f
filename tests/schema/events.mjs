// Each line of a file of events is one that the schema takes, and every event of the schema that these
// commands can tell is there; what is broken is refused: events.mjs SCHEMA EVENTS.
import { readFileSync } from "node:fs";
import Ajv from "ajv";

const [schema, events] = process.argv.slice(2).map((path) => readFileSync(path, "utf8"));
const ajv = new Ajv({ strict: true, allowUnionTypes: true, strictRequired: false });
const validate = ajv.compile(JSON.parse(schema));
let failures = 0;
const seen = new Map();
for (const line of events.trim().split("\n")) {
    const event = JSON.parse(line);
    seen.set(event.event, event);
    if (!validate(event)) {
        failures++;
        console.error(`refused: ${line}`);
    }
    const age = Date.now() - Date.parse(event.time);
    if (!(age >= 0 && age < 3600e3)) {
        failures++;
        console.error(`not of this hour: ${event.time}`);
    }
}
const wanted = ["started", "loaded", "device", "shard", "frame", "part", "file", "state", "job", "test", "result", "warning",
    "error", "ended"];
for (const name of wanted.filter((name) => !seen.has(name))) {
    failures++;
    console.error(`no command told '${name}'`);
}
for (const [name, event] of seen) {
    const { time, ...timeless } = event;
    for (const broken of [timeless, { ...event, more: 1 }, { ...event, event: "none" }, { ...event, time: 7 }]) {
        if (validate(broken)) {
            failures++;
            console.error(`taken: a broken '${name}', ${JSON.stringify(broken)}`);
        }
    }
}
console.log(`${events.trim().split("\n").length} events of ${seen.size} names`);
process.exit(failures > 0 ? 1 : 0);
