#!/usr/bin/env python3
"""Checks Jobs of Kubernetes beyond their schema, and stands in for kubectl and a cluster.

As a module, it finds faults that a JSON schema cannot describe. As the program `kubernetes.py KILN
WORK KUBECTL-ARGUMENT...` it runs the pods of a Job one after the other. The folder WORK is the
volume. WORK/jobs gets a line for each pod and each Job that has ended.
"""
import functools
import json
import os
import subprocess
import sys

import yaml


def decide(job, code):
    """Returns the action of the Job's rules for a pod whose container ended with the exit code."""
    for rule in job["spec"]["podFailurePolicy"]["rules"]:
        wanted = rule.get("onExitCodes")
        if wanted and (code in wanted["values"]) == (wanted["operator"] == "In"):
            return rule["action"]
    return "Count"


def policy_faults(job, again):
    """Yields the rules for exit codes that contradict `again`, the table of `kiln help exit-codes`.

    The table says for each exit code whether another try can succeed: never, again, or with more.
    """
    is_indexed = job["spec"].get("completionMode") == "Indexed"
    actions = {"never": "FailJob", "with more": "FailIndex" if is_indexed else "FailJob", "again": "Count"}
    for code, word in again.items():
        action = decide(job, code)
        if code and action != actions[word]:
            yield f"exit code {code} is '{word}' and leads to {action}"
    rules = job["spec"]["podFailurePolicy"]["rules"]
    if rules[0]["action"] != "Ignore" or [each["type"] for each in rules[0].get("onPodConditions", [])] != [
            "DisruptionTarget"]:
        yield "the first rule does not ignore a disruption"
    for rule in rules[1:]:
        values = rule["onExitCodes"]["values"]
        if values != sorted(values):
            yield f"the exit codes {values} are in no order"
        for code in values:
            if code not in again:
                yield f"there is no exit code {code}"


def job_faults(job, claims, again):
    """Yields the faults of a Job. `claims` has the names of the document's volume claims."""
    spec, pod = job["spec"], job["spec"]["template"]["spec"]
    containers = [container["name"] for container in pod["containers"]]
    for rule in spec["podFailurePolicy"]["rules"]:
        name = rule.get("onExitCodes", {}).get("containerName", containers[0])
        if name not in containers:
            yield f"there is no container {name}"
    volumes = {volume["name"]: volume["persistentVolumeClaim"]["claimName"] for volume in pod["volumes"]}
    for claim in volumes.values():
        if claim not in claims:
            yield f"there is no claim {claim}"
    for container in pod["containers"]:
        for mount in container["volumeMounts"]:
            if mount["name"] not in volumes:
                yield f"there is no volume {mount['name']}"
        shard = next((word for word in container["args"] if word.startswith("auto/")), None)
        wanted = f"auto/{spec['completions']}" if spec.get("completionMode") == "Indexed" else None
        if shard != wanted:
            yield f"the share is {shard} and should be {wanted}"
    if spec.get("maxFailedIndexes", 0) > spec.get("completions", 1):
        yield f"maxFailedIndexes is {spec['maxFailedIndexes']}, of {spec.get('completions', 1)}"
    yield from policy_faults(job, again)


def faults(documents, again):
    """Yields the faults of all Jobs of a file, each after the Job's name."""
    claims = [each["metadata"]["name"] for each in documents if each["kind"] == "PersistentVolumeClaim"]
    for job in documents:
        if job["kind"] == "Job":
            yield from (f"{job['metadata']['name']}: {fault}" for fault in job_faults(job, claims, again))


@functools.cache
def has_landlock(kiln):
    """Returns whether the machine has Landlock, which KILN_SANDBOX=require needs."""
    devices = subprocess.run([kiln, "devices", "--json"], stdout=subprocess.PIPE, check=True).stdout
    return json.loads(devices)["sandbox"]["landlock"] > 0


def run_pod(job, index, kiln, work):
    """Runs the command line of a pod's container, with the volume's folder in place of the mount.

    Returns the exit code.
    """
    [container] = job["spec"]["template"]["spec"]["containers"]
    [mount] = container["volumeMounts"]

    def mapped(text):
        return text.replace(mount["mountPath"], work) if text.startswith(mount["mountPath"]) else text
    environment = {variable["name"]: mapped(variable["value"]) for variable in container["env"]}
    environment["PATH"] = os.environ["PATH"]
    if index is not None:
        environment["JOB_COMPLETION_INDEX"] = str(index)
    if not has_landlock(kiln):
        environment["KILN_SANDBOX"] = "off"
    return subprocess.run([kiln, *map(mapped, container["args"])], env=environment, stdout=subprocess.DEVNULL).returncode


def run_job(job, kiln, work, log):
    """Runs a Job's pods, as its limits of failures say. Returns "Complete" or "Failed"."""
    spec = job["spec"]
    is_indexed = spec.get("completionMode") == "Indexed"
    failed_indexes = 0
    for index in range(spec["completions"]) if is_indexed else [None]:
        for attempt in range(1 + spec["backoffLimitPerIndex" if is_indexed else "backoffLimit"]):
            code = run_pod(job, index, kiln, work)
            action = decide(job, code) if code else "Complete"
            log(f"{job['metadata']['name']} {index} {attempt} {code} {action}")
            if action == "FailJob":
                return "Failed"
            if action != "Count":
                break
        failed_indexes += action != "Complete"
        if failed_indexes > spec.get("maxFailedIndexes", 0):
            return "Failed"
    return "Failed" if failed_indexes else "Complete"


def kubectl(kiln, work, words):
    """Does what the words of a kubectl command say, as far as the example's script uses kubectl."""
    def log(line):
        with open(os.path.join(work, "jobs"), "a", encoding="utf-8") as out:
            print(line, file=out)
    verb = words[0]
    if verb == "apply":
        key, value = words[words.index("-l") + 1].split("=")
        with open(words[words.index("-f") + 1], encoding="utf-8") as source:
            documents = list(yaml.safe_load_all(source))
        chosen = [each for each in documents if each["metadata"].get("labels", {}).get(key) == value]
        assert len(chosen) == 1, (key, value)
        if chosen[0]["kind"] == "Job":
            log(f"{chosen[0]['metadata']['name']} {run_job(chosen[0], kiln, work, log)}")
    elif verb == "get":
        assert words[1] == "job" and words[4].startswith("jsonpath={.status.conditions"), words
        with open(os.path.join(work, "jobs"), encoding="utf-8") as lines:
            print([line.split()[1] for line in lines if line.startswith(words[2] + " ")][-1])
    else:
        assert verb in ("delete", "describe"), words


if __name__ == "__main__":
    kubectl(sys.argv[1], sys.argv[2], sys.argv[3:])
