"""Checks templates of Open Job Description beyond their schema, and stands in for an engine.

It finds faults that a JSON schema cannot describe, such as references to unknown parameters, and
runs the tasks of a template one after the other.
"""
import os
import re
import subprocess

REFERENCE = re.compile(r"{{\s*([^}]*?)\s*}}")
LINE = re.compile(r"openjd_(progress|status|fail): (.+)")


def texts(value, place=()):
    """Yields every text of a template with its place, a tuple of keys and indices."""
    if isinstance(value, str):
        yield place, value
    elif isinstance(value, dict):
        for key, item in value.items():
            yield from texts(item, place + (key,))
    elif isinstance(value, list):
        for index, item in enumerate(value):
            yield from texts(item, place + (str(index),))


def reference_faults(template):
    """Yields the references {{NAME}} to parameters that are not known at their place."""
    parameters = {parameter["name"]: parameter["type"] for parameter in template["parameterDefinitions"]}
    for place, text in texts(template):
        known = {f"RawParam.{name}" for name in parameters}
        if "script" in place:  # scripts run on a host; only there does a path have a value
            known |= {f"Param.{name}" for name in parameters}
            space = template["steps"][int(place[1])].get("parameterSpace", {"taskParameterDefinitions": []})
            known |= {f"Task.Param.{each['name']}" for each in space["taskParameterDefinitions"]}
        else:
            known |= {f"Param.{name}" for name, kind in parameters.items() if kind != "PATH"}
        for name in REFERENCE.findall(text):
            if name not in known:
                yield f"{'/'.join(place)}: there is no {name}"


def faults(template):
    """Yields the faults of a template: in references, the order of steps, and doubled names."""
    yield from reference_faults(template)
    before = set()
    for index, step in enumerate(template["steps"]):
        for dependency in step.get("dependencies", []):
            if dependency["dependsOn"] not in before:
                yield f"steps/{index}/dependencies: no step {dependency['dependsOn']} before {step['name']}"
        if step["name"] in before:
            yield f"steps/{index}/name: a second {step['name']}"
        before.add(step["name"])
        kinds = [each["type"] for each in step.get("parameterSpace", {}).get("taskParameterDefinitions", [])]
        if kinds.count("CHUNK[INT]") > 1:
            yield f"steps/{index}/parameterSpace: more than one CHUNK[INT]"
    names = [parameter["name"] for parameter in template["parameterDefinitions"]]
    for name in set(names):
        if names.count(name) > 1:
            yield f"parameterDefinitions: a second {name}"


def job_values(template, given):
    """Returns the values of a job's parameters: the given ones, else the template's defaults."""
    values = {}
    for parameter in template["parameterDefinitions"]:
        name = parameter["name"]
        value = given.get(name, parameter.get("default"))
        assert value is not None, f"{name} has no value"
        if parameter["type"] == "INT":
            assert parameter.get("minValue", value) <= value <= parameter.get("maxValue", value), f"{name}: {value}"
        values[name] = value
    assert not set(given) - set(values), f"there is no parameter {set(given) - set(values)}"
    return values


def resolve(text, values, task):
    names = {f"Param.{name}": value for name, value in values.items()}
    names.update((f"Task.Param.{name}", value) for name, value in task.items())
    return REFERENCE.sub(lambda match: str(names[match[1]]), text)


def tasks(step, values):
    """Returns a dictionary of the parameter of each task. A chunk's value is "FIRST-LAST"."""
    if "parameterSpace" not in step:
        return [{}]
    [parameter] = step["parameterSpace"]["taskParameterDefinitions"]
    first, last = (int(text) for text in resolve(parameter["range"], values, {}).split("-"))
    if parameter["type"] == "INT":
        return [{parameter["name"]: value} for value in range(first, last + 1)]
    count = int(resolve(str(parameter["chunks"]["defaultTaskCount"]), values, {}))
    return [{parameter["name"]: f"{begin}-{min(begin + count - 1, last)}"} for begin in range(first, last + 1, count)]


def command_line(step, values, task):
    action = step["script"]["actions"]["onRun"]
    return [resolve(text, values, task) for text in [action["command"], *action["args"]]]


def read_lines(output):
    """Returns a task's messages to the engine as pairs (kind, value).

    Every line that begins with "openjd_" must be a message.
    """
    lines = []
    for line in output.splitlines():
        match = LINE.fullmatch(line)
        assert match or not line.startswith("openjd_"), line
        if match:
            lines.append((match[1], match[2]))
    return lines


def check_progress(output):
    """Checks that the progress rises from 0 to 100, and that a status and no failure is sent."""
    lines = read_lines(output)
    progress = [float(value) for kind, value in lines if kind == "progress"]
    assert progress[0] == 0 and progress[-1] == 100 and progress == sorted(set(progress)), progress
    kinds = [kind for kind, _ in lines]
    assert "status" in kinds and "fail" not in kinds, lines


def environment():
    return {"PATH": os.environ["PATH"], "XDG_CACHE_HOME": "/dev/null"}


def run(template, given):
    """Runs all tasks of a job, which must succeed. Returns the number of tasks of each step."""
    values = job_values(template, given)
    counts = {}
    for step in template["steps"]:
        assert all(each["dependsOn"] in counts for each in step.get("dependencies", []))
        counts[step["name"]] = 0
        for task in tasks(step, values):
            done = subprocess.run(command_line(step, values, task), env=environment(), text=True,
                                  stdout=subprocess.PIPE, timeout=step["script"]["actions"]["onRun"]["timeout"])
            assert done.returncode == 0, f"{step['name']} {task}: exit code {done.returncode}\n{done.stdout}"
            check_progress(done.stdout)
            counts[step["name"]] += 1
    return counts


def cancel(step, values, task, percent):
    """Runs a task and cancels it at a progress in percent, as NOTIFY_THEN_TERMINATE asks.

    Returns its exit code and its messages to the engine.
    """
    cancelation = step["script"]["actions"]["onRun"]["cancelation"]
    assert cancelation["mode"] == "NOTIFY_THEN_TERMINATE"
    process = subprocess.Popen(command_line(step, values, task), env=environment(), text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    assert process.stdout
    text = ""
    for line in process.stdout:
        text += line
        if line.startswith("openjd_progress: ") and float(line.split()[1]) >= percent:
            process.terminate()
            break
    rest, _ = process.communicate(timeout=cancelation["notifyPeriodInSeconds"])
    return process.returncode, read_lines(text + rest)
