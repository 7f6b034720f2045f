#!/usr/bin/env python3
"""Compares what kiln expects of scenes with what they take: estimates.py memory|time KILN TREE [OPTION...].

It draws scenes over all options that allocate or take time, changes those whose estimates were worst, and goes on
with the worst of all, so that it finds scenes that a fair draw would miss.

memory  The estimate is that of the event `loaded`; what a scene took is the peak of the process, by the kernel's
        count, with -o none. Fails when a scene takes more than 1.3 times its estimate.
time    The estimate is that of `kiln plan`; what a scene took is the time of all processors of `kiln render` with
        -o none. Fails when the one is more than 3 times the other.
"""
import argparse
import json
import os
import random
import re
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

MOST = {"memory": 1.3, "time": 3.0}  # times the estimate

SIZES = [[64, 36], [320, 180], [640, 360], [1280, 720], [1920, 1080], [2560, 1440]]
MESHES = ["bowl", "cabin", "firs", "fist", "monk", "people", "pines", "plinth", "pot", "slab", "statue", "trees"]
PAINTABLE = ["statue", "slab", "plinth"]


def count(rng, most):
    """Returns a number up to `most`; large numbers are as likely as small ones, by their logarithm."""
    return int(10 ** rng.uniform(1, len(str(most)) - 1 + 0.3) % most) + 1


def draw_look(rng, scene):
    look = {"shape": rng.choice(["billboard", "billboard", "point", "line", "sphere", "sphere", "mesh"]),
            "size": rng.choice([0.01, 0.05, 0.3, 1, 4]), "opacity": rng.choice([0.05, 0.5, 1])}
    if look["shape"] == "mesh":
        look["mesh"] = {"file": f"meshes/{rng.choice(['leaf_birch', 'paper_plane', 'starling'])}.obj"}
    if look["shape"] == "billboard":
        cells = rng.choice([1, 4, 8])
        look["atlas"] = [f"builtin:{rng.choice(['fire', 'smoke', 'spark'])}"]
        look["cells"] = [cells, cells]
        look["blend"] = rng.choice(["add", "alpha"])
        look["lit"] = rng.choice([0, 1])
        if look["blend"] == "alpha":
            look["shadow"] = rng.choice([0, 1])
        elif rng.random() < 0.3:
            look["light"] = 2
    if look["shape"] in ("sphere", "mesh"):
        look["lit"] = rng.choice([0, 1])
    if look["shape"] == "mesh" and rng.random() < 0.5:
        look["spin"] = "90 deg/s"
    return look


def draw_system(rng, scene, most, parent):
    particles = count(rng, most)
    emit = {"life": "20 s", "speed": rng.choice([0, 1]),
            "from": {"box": {"origin": [0, 2, 0], "size": [rng.choice([0.5, 4, 20])] * 3}}}
    if parent and rng.random() < 0.3:
        emit["parent"] = {"system": parent, "on": {"trail": {"rate": rng.choice([1, 5])}}}
        emit["life"] = "0.3 s"
    else:
        emit["bursts"] = {0: particles}
    system = {"emit": emit, "look": draw_look(rng, scene)}
    if rng.random() < 0.4:
        system["forces"] = [{"gravity": {}}]
    if rng.random() < 0.4:
        system["collide"] = {"dies": True} if rng.random() < 0.5 else {}
    if rng.random() < 0.4:
        system.setdefault("collide", {})
        system["paint"] = {"radius": 0.02}
    if rng.random() < 0.2 and system["look"]["shape"] == "sphere" and "parent" not in emit:
        emit["bursts"] = {0: min(particles, 400000)}
        emit["from"]["box"]["size"] = [60] * 3
        system["look"]["size"] = 0.05
        system["interact"] = [{"collide": {"spin": rng.choice([True, False])}}]
    return system


def draw_object(rng):
    kind = rng.choice(["mesh", "mesh", "mesh", "terrain", "sphere", "box"])
    if kind == "terrain":
        edge = rng.choice([33, 129, 513])
        return {"terrain": {"samples": [edge, edge], "collide": rng.choice([True, False])}}
    if kind != "mesh":
        return {kind: {"center": [rng.uniform(-3, 3), 0.5, rng.uniform(-3, 3)]}}
    if rng.random() < 0.4:
        return {"mesh": {"file": f"meshes/{rng.choice(PAINTABLE)}.obj",
                         "position": [rng.uniform(-3, 3), 0, rng.uniform(-3, 3)],
                         "collide": rng.choice([True, False]), "collider": rng.choice(["field", "volume"]),
                         "paint": {"size": rng.choice([64, 512, 2048]), "per_step": rng.choice([0, 0, 100])}}}
    mesh = {"file": f"meshes/{rng.choice(MESHES)}.obj", "position": [rng.uniform(-3, 3), 0, rng.uniform(-3, 3)]}
    if rng.random() < 0.4:
        mesh["collide"] = True
        mesh["collider"] = rng.choice(["volume", "volume", "depth_maps"])
        mesh["cells"] = rng.choice([16, 48, 128])
    return {"mesh": mesh}


def draw_lights(rng):
    lights = []
    for _ in range(rng.choice([0, 0, 1, 3, 12])):
        lights.append({"point": {"position": [rng.uniform(-4, 4), 3, rng.uniform(-4, 4)],
                                 "shadow": rng.choice([True, True, False])}})
    return lights


def draw_camera(rng):
    camera = {"position": [0, 2, 8], "target": [0, 1.5, 0]}
    if rng.random() < 0.5:
        camera["position"] = {"keys": {"0 s": [0, 2, 8], "1 s": [1, 2, 8]}}
    if rng.random() < 0.3:
        camera["shutter"] = {"samples": rng.choice([2, 3])}
    return camera


def draw_post(rng):
    post = {"bloom": {"kind": rng.choice(["none", "gaussian", "pyramid", "thesis"])},
            "compose": rng.choice(["merged", "merged", "separate", "alpha", "oit"])}
    if rng.random() < 0.2:
        post["particles"] = {"resolution": rng.choice(["half", "quarter"])}
    return post


def draw_backdrop(rng):
    backdrop = {"sun": {"color": rng.choice([0, 1]), "size": rng.choice(["0 deg", "2 deg"])},
                "haze": rng.choice([0, 0.02]),
                "floor": rng.choice(["none", {"gloss": 0.5}, {}]),
                "lights": draw_lights(rng),
                "objects": [draw_object(rng) for _ in range(rng.choice([0, 0, 1, 3, 8]))]}
    return backdrop


def draw_births(rng, system, most):
    """Gives a system births that vary over a clip of two seconds."""
    emit = system["emit"]
    if "parent" in emit:
        return
    emit.pop("bursts", None)
    particles = count(rng, most)
    kind = rng.choice(["rate", "keys", "burst", "bursts"])
    emit["life"] = rng.choice(["0.1 s", "0.5 s", ["0.2 s", "1.5 s"], "5 s"])
    if kind == "rate":
        emit["rate"] = particles
    elif kind == "keys":
        emit["rate"] = {"keys": {"0 s": 0, f"{rng.uniform(0.2, 1):.2f} s": particles, "1.2 s": 0}}
    else:
        times = [rng.uniform(-0.1, 1.8) for _ in range(1 if kind == "burst" else 4)]
        emit["bursts"] = {round(t, 3): particles for t in sorted(times)}


def draw_for_time(rng, most):
    """Returns a scene of two seconds, whose work varies."""
    scene = draw(rng, most)
    scene["output"] = {"size": rng.choice(SIZES[:4]), "fps": 30, "frames": 60}
    if rng.random() < 0.2:
        scene["output"]["samples"] = 4
    for name, system in scene["systems"].items():
        draw_births(rng, system, most)
        if "interact" in system:
            system["emit"]["bursts"] = {0: min(most, 20000)}
            system["emit"].pop("rate", None)
            system["emit"]["life"] = "3 s"
    return scene


def draw(rng, most):
    scene = {"kiln": 1, "seed": rng.randrange(1000)}
    scene["output"] = {"size": rng.choice(SIZES), "fps": 30, "frames": rng.choice([1, 3])}
    if rng.random() < 0.3:
        scene["output"]["samples"] = rng.choice([2, 4])
    scene["camera"], scene["post"], scene["backdrop"] = draw_camera(rng), draw_post(rng), draw_backdrop(rng)
    scene["systems"] = {}
    for i in range(rng.choice([1, 1, 2, 4])):
        scene["systems"][f"s{i}"] = draw_system(rng, scene, most, "s0" if i else None)
    return scene


def change(rng, scene, fresh, most):
    """Returns a scene with one part of a fresh one."""
    other = json.loads(json.dumps(scene))
    part = rng.choice(["output", "camera", "post", "backdrop", "system", "lights", "objects", "seed"])
    if part == "system":
        other["systems"]["s0"] = fresh["systems"]["s0"]
    elif part in ("lights", "objects"):
        other["backdrop"][part] = fresh["backdrop"][part]
    else:
        other[part] = fresh[part]
    return other


def write_picture(path, edge):
    """Writes a grey PNG."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", edge, edge, 8, 0, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(bytes(edge * (edge + 1)), 1)) + chunk(b"IEND", b""))


def scenes_of_files(folder):
    """Returns scenes whose memory is that of their files, and others that a short draw of options does not find."""
    def scene(look, **more):
        system = {"emit": {"bursts": {0: 10}, "life": "5 s"}, "look": look}
        return {"kiln": 1, "output": {"size": [64, 36], "frames": 1}, "systems": {"s0": system}, **more}
    write_picture(os.path.join(folder, "large.png"), 4096)
    write_picture(os.path.join(folder, "small.png"), 64)
    point = {"shape": "point"}
    billboard = {"shape": "billboard", "atlas": "small.png", "cells": [8, 8]}
    keys = {"keys": {f"{i} s": 0.01 for i in range(1000)}}
    many = scene(point)
    many["systems"] = {f"s{i}": {**many["systems"]["s0"], "look": {**point, "size": keys}} for i in range(64)}
    return [scene(point, backdrop={"sky": {"image": "large.png"}}),
            scene(point, backdrop={"floor": {"image": "large.png"}}),
            scene(point, backdrop={"objects": [{"terrain": {"image": "large.png", "samples": [33, 33]}}]}),
            scene({**billboard, "atlas": "large.png"}), scene({**billboard, "motion": "large.png"}), many,
            scene({"shape": "sphere"}, output={"size": [2560, 1440], "frames": 1}, camera={"shutter": {"samples": 3}},
                  backdrop={"floor": {"gloss": 0.5}})]


def text_of(scene):
    """Returns a scene as YAML: JSON whose keys are numbers where they look like numbers."""
    return re.sub(r'"(-?[0-9.]+)":', r"\1:", json.dumps(scene))


def run(command, folder, seconds, memory):
    """Returns (exit code, resources, message) of a command."""
    errors_path = os.path.join(folder, "stderr")
    with open(errors_path, "wb") as errors, open(os.path.join(folder, "stdout"), "wb") as out:
        process = subprocess.Popen(
            command + ["--timeout", str(seconds)], stdout=out, stderr=errors,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (memory, memory)))
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    with open(errors_path, encoding="utf-8", errors="replace") as errors:
        return process.returncode, usage, errors.read()


def measure_memory(arguments, folder, path):
    """Returns (estimate, taken) in bytes, or None where kiln refuses the scene; and what kiln said."""
    events = os.path.join(folder, "events")
    _, usage, message = run([arguments.kiln, "render", path, "-o", "none", "--device", "cpu", "--quiet",
                             "--events", f"ndjson:{events}", "--asset-root", folder],
                            folder, arguments.timeout, 20 << 30)
    estimate = 0
    if os.path.exists(events):
        with open(events, encoding="utf-8") as lines:
            for line in lines:
                event = json.loads(line)
                if event["event"] == "loaded":
                    estimate = event["memory_bytes"]
        os.remove(events)
    return (estimate, usage.ru_maxrss * 1024) if estimate else None, message


def measure_time(arguments, folder, path):
    """Returns (estimate, taken) in seconds of processors, or None; and what kiln said."""
    code, _, message = run([arguments.kiln, "plan", path, "--device", "cpu", "--json", "--asset-root", folder],
                           folder, arguments.timeout, 20 << 30)
    if code != 0:
        return None, message
    with open(os.path.join(folder, "stdout"), encoding="utf-8") as plan:
        estimate = json.load(plan)["cpu_s"]
    code, usage, message = run([arguments.kiln, "render", path, "-o", "none", "--device", "cpu", "--quiet",
                                "--asset-root", folder], folder, arguments.timeout, 20 << 30)
    return (estimate, usage.ru_utime + usage.ru_stime) if code == 0 else None, message


def badness(what, pair):
    """Returns how wrong an estimate is: too little memory; too little or too much time."""
    ratio = pair[1] / pair[0]
    return ratio if what == "memory" else max(ratio, 1 / ratio)


def search(arguments, folder):
    """Returns the scenes that were measured, as (badness, ratio, scene), the worst first; and how many were
    refused."""
    rng = random.Random(arguments.seed)
    fresh = draw if arguments.what == "memory" else draw_for_time
    measure = measure_memory if arguments.what == "memory" else measure_time
    path = os.path.join(folder, "scene.yaml")
    worst, refused = [], 0
    fixed = scenes_of_files(folder) if arguments.what == "memory" else []
    while len(worst) < arguments.scenes + len(fixed) and refused < 20 * arguments.scenes + 100:
        scene = fixed[len(worst)] if len(worst) < len(fixed) else fresh(rng, arguments.particles)
        drawn = [item for item in worst if item[2] not in fixed]
        if drawn and rng.random() < 0.6:
            scene = change(rng, rng.choice(drawn[:8])[2], scene, arguments.particles)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text_of(scene))
        found, message = measure(arguments, folder, path)
        if not found:
            refused += 1
            if arguments.verbose:
                print(message.strip()[:200])
            continue
        worst.append((badness(arguments.what, found), found[1] / found[0], scene))
        worst.sort(key=lambda item: -item[0])
        unit = 1 << 20 if arguments.what == "memory" else 1
        print(f"{len(worst):4} {found[0] / unit:8.1f} expected {found[1] / unit:8.1f} taken "
              f"{found[1] / found[0]:6.2f}   worst {worst[0][1]:.2f}", flush=True)
    return worst, refused


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=list(MOST))
    parser.add_argument("kiln")
    parser.add_argument("tree", help="the folder of the project, whose meshes the scenes have")
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--particles", type=int, default=2000000, help="the most of a system")
    parser.add_argument("--timeout", type=int, default=60, help="seconds for a scene")
    parser.add_argument("--keep", help="a folder for the scenes that are worst")
    parser.add_argument("--verbose", action="store_true", help="print why scenes are refused")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(os.path.join(arguments.tree, "scenes", "meshes"), os.path.join(folder, "meshes"))
        worst, refused = search(arguments, folder)
    if arguments.keep:
        os.makedirs(arguments.keep, exist_ok=True)
        for i, (_, ratio, scene) in enumerate(worst[:8]):
            with open(os.path.join(arguments.keep, f"{i}_{ratio:.2f}.yaml"), "w", encoding="utf-8") as file:
                file.write(text_of(scene))
    if len(worst) < arguments.scenes:
        print(f"estimates.py: only {len(worst)} of {arguments.scenes} scenes were measured", file=sys.stderr)
        return 1
    ratios = sorted(item[1] for item in worst)
    print(f"{len(ratios)} scenes, {refused} refused: taken / expected: least {ratios[0]:.2f}, "
          f"median {ratios[len(ratios) // 2]:.2f}, most {ratios[-1]:.2f}")
    if worst[0][0] > MOST[arguments.what]:
        print(f"estimates.py: a scene takes {worst[0][1]:.2f} times what was expected:\n{text_of(worst[0][2])}",
              file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
