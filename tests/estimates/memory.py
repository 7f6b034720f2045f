#!/usr/bin/env python3
"""Compares the memory that kiln expects of scenes with what they take: memory.py KILN TREE [OPTION...].

It draws scenes over all options that allocate, changes those whose estimates were worst, and goes on with the
worst of all, so that it finds scenes that a fair draw would miss. A scene's estimate is that of the event
`loaded`; what it took is the peak of the process, by the kernel's count, with -o none. Fails when a scene takes
more than 1.3 times its estimate.
"""
import argparse
import json
import os
import random
import re
import resource
import subprocess
import sys
import tempfile

MOST = 1.3  # times the estimate

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


def change(rng, scene, most):
    """Returns a scene with one part drawn anew."""
    other = json.loads(json.dumps(scene))
    fresh = draw(rng, most)
    part = rng.choice(["output", "camera", "post", "backdrop", "system", "lights", "objects", "seed"])
    if part == "system":
        name = rng.choice(list(other["systems"]))
        other["systems"][name] = draw_system(rng, other, most, "s0" if name != "s0" else None)
    elif part in ("lights", "objects"):
        other["backdrop"][part] = fresh["backdrop"][part]
    else:
        other[part] = fresh[part]
    return other


def text_of(scene):
    """Returns a scene as YAML: JSON whose keys are numbers where they look like numbers."""
    return re.sub(r'"(-?[0-9.]+)":', r"\1:", json.dumps(scene))


def measure(kiln, folder, scene, seconds, memory):
    """Returns (estimate, taken) in bytes, or None where kiln refuses the scene or it takes too long."""
    path = os.path.join(folder, "scene.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text_of(scene))
    events = os.path.join(folder, "events")
    command = [kiln, "render", path, "-o", "none", "--device", "cpu", "--quiet", "--events", f"ndjson:{events}",
               "--asset-root", folder, "--timeout", str(seconds)]
    with open(os.path.join(folder, "stderr"), "wb") as errors:
        process = subprocess.Popen(command, stderr=errors, preexec_fn=lambda: resource.setrlimit(
            resource.RLIMIT_AS, (memory, memory)))
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = status
    with open(os.path.join(folder, "stderr"), encoding="utf-8", errors="replace") as errors:
        message = errors.read()
    estimate = 0
    if os.path.exists(events):
        with open(events, encoding="utf-8") as lines:
            for line in lines:
                event = json.loads(line)
                if event["event"] == "loaded":
                    estimate = event["memory_bytes"]
        os.remove(events)
    if estimate == 0:
        return None, message
    return (estimate, usage.ru_maxrss * 1024), message


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kiln")
    parser.add_argument("tree", help="the folder of the project, whose meshes the scenes have")
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--particles", type=int, default=2000000, help="the most of a system")
    parser.add_argument("--timeout", type=int, default=60, help="seconds for a scene")
    parser.add_argument("--keep", help="a folder for the scenes that are worst")
    arguments = parser.parse_args()
    rng = random.Random(arguments.seed)
    worst = []  # (ratio, scene), the worst first
    measured = refused = 0
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(os.path.join(os.path.realpath(arguments.tree), "scenes", "meshes"), os.path.join(folder, "meshes"))
        os.remove(os.path.join(folder, "meshes"))
        subprocess.run(["cp", "-r", os.path.join(arguments.tree, "scenes", "meshes"), folder], check=True)
        while measured < arguments.scenes and refused < 20 * arguments.scenes + 100:
            if worst and rng.random() < 0.6:
                scene = change(rng, rng.choice(worst[:8])[1], arguments.particles)
            else:
                scene = draw(rng, arguments.particles)
            found, message = measure(arguments.kiln, folder, scene, arguments.timeout, 20 << 30)
            if not found:
                refused += 1
                if os.environ.get("SHOW"):
                    print(message.strip()[:200])
                continue
            measured += 1
            ratio = found[1] / found[0]
            worst.append((ratio, scene))
            worst.sort(key=lambda pair: -pair[0])
            print(f"{measured:4} {found[0] >> 20:6} MiB expected {found[1] >> 20:6} MiB taken {ratio:6.2f}"
                  f"   worst {worst[0][0]:.2f}", flush=True)
    if arguments.keep:
        os.makedirs(arguments.keep, exist_ok=True)
        for i, (ratio, scene) in enumerate(worst[:8]):
            with open(os.path.join(arguments.keep, f"{i}_{ratio:.2f}.yaml"), "w", encoding="utf-8") as file:
                file.write(text_of(scene))
    ratios = sorted(pair[0] for pair in worst)
    if measured < arguments.scenes:
        print(f"memory.py: only {measured} of {arguments.scenes} scenes were measured", file=sys.stderr)
        return 1
    print(f"{measured} scenes, {refused} refused: taken / expected: least {ratios[0]:.2f}, "
          f"median {ratios[len(ratios) // 2]:.2f}, most {ratios[-1]:.2f}")
    if ratios[-1] > MOST:
        print(f"memory.py: a scene takes {ratios[-1]:.2f} times what was expected:\n{json.dumps(worst[0][1])}",
              file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
