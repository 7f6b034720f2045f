#!/usr/bin/env python3
"""Checks the examples for Kubernetes and Open Job Description: schemas.py KILN SOURCE.

If this fails, a farm refuses the examples, or the clip that they make is wrong. The examples must
follow JSON schemas of the fields that they use. Each planted fault must be found. Run by stand-ins
for a cluster and an engine, the examples must make the clip of a single run.
"""
import copy
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

import jsonschema
import kubernetes
import openjd
import yaml

FRAMES = 180  # 6 s at 30 frames a second: three parts of a clip

# Each row of the tables below plants a fault in an example: the place, the value that is put there
# (REMOVED: the place is deleted), and the faults that must be found. A row stands for a typing
# mistake, or for a value that the scheduler refuses.
REMOVED = object()
POD = "2/spec/template/spec"
BROKEN_KUBERNETES = [
    ("2/apiVersion", "batch/v1beta1", "apiVersion: const; apiVersion: enum"),
    ("2/spec/backoffLimitPerIndexes", 3, "spec: additionalProperties"),
    ("2/spec/completions", REMOVED, "spec: required"),
    ("2/spec/completionMode", "NonIndexed", "spec/completionMode: const"),
    ("2/spec/parallelism", "4", "spec/parallelism: type"),
    ("2/spec/activeDeadlineSeconds", 0, "spec/activeDeadlineSeconds: minimum"),
    ("2/metadata/name", "Kiln_parts", "metadata/name: pattern"),
    ("1/spec/maxFailedIndexes", 1, "spec: dependencies"),
    ("1/spec/podFailurePolicy/rules/1/action", "FailIndex", "spec/podFailurePolicy/rules/1/action: enum"),
    ("2/spec/podFailurePolicy/rules/1/action", "Fail", "spec/podFailurePolicy/rules/1/action: enum"),
    ("2/spec/podFailurePolicy/rules/1/onPodConditions", [], "spec/podFailurePolicy/rules/1: maxProperties"),
    ("2/spec/podFailurePolicy/rules/1/onExitCodes/values/0", 0,
     "spec/podFailurePolicy/rules/1/onExitCodes/values/0: not"),
    ("2/spec/podFailurePolicy/rules/1/onExitCodes/values/0", 2,
     "spec/podFailurePolicy/rules/1/onExitCodes/values: uniqueItems"),
    (POD + "/restartPolicy", "OnFailure", "spec/template/spec/restartPolicy: const"),
    (POD + "/containers/0/env/0/value", 1, "spec/template/spec/containers/0/env/0/value: type"),
    (POD + "/containers/0/resources/limits/memory", "8GB",
     "spec/template/spec/containers/0/resources/limits/memory: pattern"),
    (POD + "/containers/0/securityContext/readOnly", True,
     "spec/template/spec/containers/0/securityContext: additionalProperties"),
    ("0/spec/accessModes/0", "ReadWriteAll", "spec/accessModes/0: enum"),
    # faults that the schema cannot find; kubernetes.py must find them
    ("2/spec/podFailurePolicy/rules/2/onExitCodes/values", [5, 8, 200], "kiln-parts: there is no exit code 200"),
    ("2/spec/podFailurePolicy/rules/2/onExitCodes/values", [8], "kiln-parts: exit code 5 is 'with more' and leads to Count"),
    ("2/spec/podFailurePolicy/rules/3/onExitCodes/values", [6, 4, 9, 129, 130, 143],
     "kiln-parts: the exit codes [6, 4, 9, 129, 130, 143] are in no order"),
    ("1/spec/podFailurePolicy/rules/1/onExitCodes/values", [1, 2, 3, 4, 5, 7, 8],
     "kiln-bake: exit code 4 is 'again' and leads to FailJob"),
    ("2/spec/podFailurePolicy/rules/0/onPodConditions/0/type", "ConfigIssue",
     "kiln-parts: the first rule does not ignore a disruption"),
    ("2/spec/podFailurePolicy/rules/3/onExitCodes/containerName", "main", "kiln-parts: there is no container main"),
    ("2/spec/completions", 9, "kiln-parts: the share is auto/8 and should be auto/9"),
    ("2/spec/maxFailedIndexes", 9, "kiln-parts: maxFailedIndexes is 9, of 8"),
    (POD + "/volumes/0/persistentVolumeClaim/claimName", "work", "kiln-parts: there is no claim work"),
    (POD + "/containers/0/volumeMounts/0/name", "out", "kiln-parts: there is no volume out"),
]
RUN = "steps/1/script/actions/onRun"
SPACE = "steps/1/parameterSpace/taskParameterDefinitions"
BROKEN_JOB = [
    ("specificationVersion", "jobtemplate-2024-01", "specificationVersion: const"),
    ("steps", [], "steps: minItems"),
    ("name", REMOVED, "<top>: required"),
    ("extensions", ["TASK_CHUNKS"], "extensions/0: enum"),
    ("parameterDefinitions/0/type", "TEXT", "parameterDefinitions/0/type: enum"),
    ("parameterDefinitions/0/dataFlow", "IN", "parameterDefinitions/0/dataFlow: not"),
    ("parameterDefinitions/5/default", "eight", "parameterDefinitions/5/default: type"),
    ("steps/0/dependsOn", "Join", "steps/0: additionalProperties"),
    ("steps/1/dependencies/0", "Bake", "steps/1/dependencies/0: type"),
    ("steps/0/hostRequirements/amounts/0/name", "worker.vcpu", "steps/0/hostRequirements/amounts/0/name: pattern"),
    (SPACE + "/0/type", "CHUNK[INT]", f"{SPACE}/0/type: not; {SPACE}/0: required"),
    (RUN + "/command", "", RUN + "/command: minLength"),
    (RUN + "/args/0", "render\n", RUN + "/args/0: not"),
    (RUN + "/timeout", 0, RUN + "/timeout: minimum"),
    (RUN + "/cancelation/mode", "NOTIFY", RUN + "/cancelation/mode: enum"),
    (RUN + "/cancelation/mode", "TERMINATE", RUN + "/cancelation/notifyPeriodInSeconds: not"),
    (RUN + "/cancelation/notifyPeriodInSeconds", 601, RUN + "/cancelation/notifyPeriodInSeconds: maximum"),
    # faults that the schema cannot find; openjd.py must find them
    ("steps/1/dependencies/0/dependsOn", "Join", "steps/1/dependencies: no step Join before Parts"),
    ("steps/1/name", "Bake", "steps/1/name: a second Bake; steps/2/dependencies: no step Parts before Join"),
    (RUN + "/args/3", "{{Param.Clip}}", RUN + "/args/3: there is no Param.Clip"),
    (SPACE + "/0/range", "1-{{Param.Output}}", SPACE + "/0/range: there is no Param.Output"),
    ("parameterDefinitions/6/name", "Kiln", "steps/0/script/actions/onRun/args/6: there is no Param.Device; "
     f"{RUN}/args/9: there is no Param.Device; parameterDefinitions: a second Kiln"),
]
BROKEN_FRAMES = [
    ("extensions", REMOVED, SPACE + "/0/type: not"),
    (SPACE + "/0/chunks", REMOVED, SPACE + "/0: required"),
    (SPACE + "/0/chunks/rangeConstraint", "ANY", SPACE + "/0/chunks/rangeConstraint: enum"),
    (SPACE + "/0/chunks/defaultTaskCount", 0, SPACE + "/0/chunks/defaultTaskCount: minimum"),
    (SPACE + "/0/chunks/defaultTaskCount", "many", SPACE + "/0/chunks/defaultTaskCount: anyOf"),
    (SPACE + "/1", {"name": "Other", "type": "CHUNK[INT]", "range": "1-2",
                    "chunks": {"defaultTaskCount": 1, "rangeConstraint": "CONTIGUOUS"}},
     "steps/1/parameterSpace: more than one CHUNK[INT]"),
]


def broken(example, place, value):
    """Returns a copy of an example with a planted fault."""
    example = copy.deepcopy(example)
    *parents, last = [int(word) if word.isdigit() else word for word in place.split("/")]
    where = example
    for word in parents:
        where = where[word]
    if value is REMOVED:
        del where[last]
    elif isinstance(where, list) and last == len(where):
        where.append(value)
    else:
        where[last] = value
    return example


def schema_faults(schema, document):
    """Returns the faults that a JSON schema finds in a document, as "PLACE: RULE"."""
    faults = set()
    for error in jsonschema.Draft7Validator(schema).iter_errors(document):
        faults.add(f"{'/'.join(map(str, error.absolute_path)) or '<top>'}: {error.validator}")
    return sorted(faults)


def check(example, faults, table):
    """Checks that an example has no faults, and that each row of a table leads to its faults.

    `faults` is a function that returns the faults of an example.
    """
    found = faults(example)
    assert not found, found
    for place, value, expected in table:
        found = "; ".join(faults(broken(example, place, value)))
        assert found == expected, f"{place}: {value}\nfound:    {found}\nexpected: {expected}"


def read_exit_codes(kiln):
    """Returns the table of `kiln help exit-codes`: for each code, whether to try again."""
    text = subprocess.run([kiln, "help", "exit-codes"], stdout=subprocess.PIPE, text=True, check=True).stdout
    again = {int(code): word for code, word in re.findall(r"^ +(\d+)  (never|again|with more) ", text, re.M)}
    assert again[0] == "never" and set(again.values()) == {"never", "again", "with more"}, again
    return again


def check_same(clip, reference):
    with open(clip, "rb") as found, open(reference, "rb") as wanted:
        assert found.read() == wanted.read(), f"{clip} has not the bytes of one run"


def run_openjd(kiln, templates, work, reference):
    given = {"Kiln": kiln, "Folder": os.path.join(work, "scene"), "States": os.path.join(work, "states")}
    job = {**given, "Shares": 3, "Output": os.path.join(work, "job", "clip.mp4")}
    assert openjd.run(templates["job"], job) == {"Bake": 1, "Parts": 3, "Join": 1}
    check_same(job["Output"], reference)
    frames = {**given, "Images": os.path.join(work, "images"), "LastFrame": FRAMES - 1, "ChunkFrames": 70,
              "Output": os.path.join(work, "frames.mp4")}
    assert openjd.run(templates["frames"], frames) == {"Bake": 1, "Frames": 3, "Encode": 1}
    check_same(frames["Output"], reference)

    # A task that is cancelled must end in time and leave only whole files. Run again, it must
    # resume.
    job = {**job, "Shares": 1, "Output": os.path.join(work, "cancelled", "clip.mp4")}
    values = openjd.job_values(templates["job"], job)
    code, lines = openjd.cancel(templates["job"]["steps"][1], values, {"Share": 1}, 30)
    assert code == 143 and lines[-1] == ("status", "exit code 143, again: again"), (code, lines)
    assert [kind for kind, _ in lines].count("fail") == 1 and ("progress", "100") not in lines, lines
    assert not os.path.exists(job["Output"])
    openjd.run(templates["job"], job)
    check_same(job["Output"], reference)


def run_kubernetes(kiln, source, work, reference):
    """Runs the example's script with kubernetes.py in place of kubectl, and checks its clip."""
    os.makedirs(os.path.join(work, "bin"))
    volume = os.path.join(work, "volume")
    os.makedirs(os.path.join(volume, "output"))
    os.symlink(os.path.join(work, "scene"), os.path.join(volume, "scene"))
    program = os.path.join(work, "bin", "kubectl")
    here = os.path.dirname(os.path.abspath(__file__))
    with open(program, "w", encoding="utf-8") as out:
        out.write(f"#!/bin/sh\nexec {sys.executable} {here}/kubernetes.py {kiln} {volume} \"$@\"\n")
    os.chmod(program, 0o755)

    def run():
        environment = {**os.environ, "PATH": os.path.join(work, "bin") + ":" + os.environ["PATH"]}
        done = subprocess.run([os.path.join(source, "examples/farm/kubernetes/run")], env=environment,
                              stderr=subprocess.PIPE, text=True)
        with open(os.path.join(volume, "jobs"), encoding="utf-8") as lines:
            jobs = lines.read().splitlines()
        os.remove(os.path.join(volume, "jobs"))
        return done, jobs

    done, jobs = run()
    parts = [f"kiln-parts {index} 0 0 Complete" for index in range(8)]
    assert done.returncode == 0 and jobs == ["kiln-bake None 0 0 Complete", "kiln-bake Complete", *parts,
                                             "kiln-parts Complete", "kiln-join None 0 0 Complete",
                                             "kiln-join Complete"], (done, jobs)
    check_same(os.path.join(volume, "output", "clip.mp4"), reference)

    # A wrong scene must fail the first Job at once, and no other Job may begin.
    with open(os.path.join(work, "scene", "scene.yaml"), "a", encoding="utf-8") as scene:
        scene.write("unknown: 1\n")
    done, jobs = run()
    assert done.returncode == 1 and "the Job kiln-bake failed" in done.stderr, done
    assert jobs == ["kiln-bake None 0 3 FailJob", "kiln-bake Failed"], jobs


def make_scene(source, work):
    """Writes the scene of the runs: small, and long enough for three parts."""
    scenes = os.path.join(source, "tests", "cli", "scenes")
    os.makedirs(os.path.join(work, "scene"))
    with open(os.path.join(scenes, "tiny.yaml"), encoding="utf-8") as scene:
        text, count = re.subn(r"frames: \d+", f"frames: {FRAMES}", scene.read())
    assert count == 1
    with open(os.path.join(work, "scene", "scene.yaml"), "w", encoding="utf-8") as out:
        out.write(text)
    shutil.copy(os.path.join(scenes, "puff.png"), os.path.join(work, "scene", "puff.png"))


def main(kiln, source):
    examples = os.path.join(source, "examples", "farm")
    schemas, templates = {}, {}
    for name in "kubernetes", "openjd":
        with open(os.path.join(source, "tests", "farm", f"{name}.schema.json"), encoding="utf-8") as schema:
            schemas[name] = json.load(schema)
        jsonschema.Draft7Validator.check_schema(schemas[name])
    for name in "job", "frames":
        with open(os.path.join(examples, "openjd", f"{name}.yaml"), encoding="utf-8") as template:
            templates[name] = yaml.safe_load(template)
    with open(os.path.join(examples, "kubernetes", "job.yaml"), encoding="utf-8") as documents:
        jobs = list(yaml.safe_load_all(documents))
    again = read_exit_codes(kiln)

    def kubernetes_faults(documents):
        found = [fault for document in documents for fault in schema_faults(schemas["kubernetes"], document)]
        return found or list(kubernetes.faults(documents, again))

    def openjd_faults(template):
        return schema_faults(schemas["openjd"], template) or list(openjd.faults(template))
    check(jobs, kubernetes_faults, BROKEN_KUBERNETES)
    check(templates["job"], openjd_faults, BROKEN_JOB)
    check(templates["frames"], openjd_faults, BROKEN_FRAMES)
    with tempfile.TemporaryDirectory() as work:
        make_scene(source, work)
        reference = os.path.join(work, "reference.mp4")
        subprocess.run([kiln, "render", os.path.join(work, "scene", "scene.yaml"), "-o", reference, "--device", "cpu",
                        "--quiet"], check=True)
        run_openjd(kiln, templates, work, reference)
        run_kubernetes(kiln, source, work, reference)


if __name__ == "__main__":
    main(os.path.realpath(sys.argv[1]), os.path.realpath(sys.argv[2]))
