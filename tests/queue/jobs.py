"""Makes the jobs of run.py, good and bad ones: each writes a scene and its files to a folder."""
import dataclasses
import importlib
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import zlib

from PIL import Image

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(SOURCE / "tests/hostile"))

import paths  # noqa: E402  (of tests/hostile)
import rows  # noqa: E402

TIMEOUT_S = 20 * int(os.environ.get("KILN_TEST_TIMEOUT_SCALE", "1"))
LIMITS = "service,output=96 KiB,asset_pixels=4194304"


@dataclasses.dataclass
class Job:
    kind: str
    name: str
    make: object  # writes the job into a folder that is empty
    code: int = 0
    says: str = ""  # a text that the reported cause must have
    smoke: bool = False


def shipped(kiln, scene, size, frames, seed):
    """Returns a maker of a scene of scenes/, smaller and shorter, with the files that it names."""
    def make(root):
        text = subprocess.run([kiln, "check", SOURCE / "scenes" / f"{scene}.yaml", "--set", f"output.size={size}",
                               "--set", f"output.frames={frames}", "--set", f"seed={seed}"],
                              check=True, capture_output=True, text=True).stdout
        (root / "scene.yaml").write_text(text)
        for file in set(re.findall(r'"((?:meshes|textures)/[^"]+)"', text)):
            (root / file).parent.mkdir(exist_ok=True)
            shutil.copy(SOURCE / "scenes" / file, root / file)
    return make


def noise(root, name, edge, chance):
    Image.frombytes("RGB", (edge, edge), chance.randbytes(3 * edge * edge)).save(root / name)


def picture(root, name, chance):
    if name.endswith((".mp4", ".gif")):
        subprocess.run(["ffmpeg", "-v", "error", "-f", "lavfi", "-i", "testsrc=size=32x32:rate=4", "-t", "2",
                        root / name], check=True)
    else:
        noise(root, name, chance.choice((16, 24, 40)), chance)


# Lines of YAML for generated scenes, by the kind of scene. FILE stands for an asset, one of FILES.
VARIATIONS = {
    "plain": ["a: {emit: {rate: 200, life: 1 s, speed: [1, 3]}, look: {shape: point, size: 3 cm}}",
              "a: {emit: {rate: 90, life: 2 s, speed: 2}, forces: [gravity: {}, drag: 0.3], look: {temperature: 1800}}",
              "a: {emit: {bursts: {0 s: 300}, life: 2 s, speed: [1, 4]}, forces: [gravity: {}], collide: {slowdown: 0.4}}",
              "a: {emit: {rate: 120, life: 1 s, speed: 3}, look: {blend: alpha, size: 0.3, soft: 1}}"],
    "texture": ["a: {emit: {rate: 60, life: 1 s, speed: 2}, look: {atlas: FILE, cells: [2, 2], size: 0.4}}",
                "backdrop: {floor: {image: FILE, tile: 2 m}}", "backdrop: {sky: {image: FILE}}",
                "backdrop: {objects: [{terrain: {size: [9, 1, 9], image: FILE}}]}"],
    "video": ["a: {emit: {rate: 60, life: 1 s, speed: 2}, look: {atlas: FILE, cells: [4, 2], size: 0.5}}"],
    "mesh": ["backdrop: {objects: [{mesh: {file: FILE, position: [0, 0, -1]}}]}",
             "a: {emit: {rate: 40, life: 1 s, speed: 2}, look: {shape: mesh, size: 0.5, mesh: {file: FILE}}}"],
    "moving": ["backdrop: {objects: [{mesh: {file: FILE, animation: {clip: walk}}}]}"],
    "wind": ["a: {emit: {rate: 90, life: 1 s}, forces: [{wind: {field: grid, file: FILE}}], look: {shape: point}}"],
}
FILES = {"texture": ("a.png", "a.jpg", "a.bmp", "a.tiff", "a.webp"), "video": ("a.mp4", "a.gif"),
         "mesh": ("slab.obj", "paper_plane.obj", "leaf_birch.obj", "falcon.obj"), "moving": ("walker.gltf",),
         "wind": ("wing.grid",), "plain": ("",)}


def own(kind, number):
    """Returns a maker of a generated scene. `number` chooses its line, file, size and rate."""
    chance = random.Random(f"{kind} {number}")
    line = VARIATIONS[kind][number % len(VARIATIONS[kind])]
    file = FILES[kind][number // len(VARIATIONS[kind]) % len(FILES[kind])]

    def make(root):
        if kind in ("texture", "video"):
            picture(root, file, chance)
        elif file:
            shutil.copy(SOURCE / "scenes/meshes" / file, root / file)
        size = [2 * chance.randint(12, 48), 2 * chance.randint(8, 27)]
        head = (f"kiln: 1\nseed: {number}\noutput: {{size: {size}, fps: {chance.choice(('10', '25', '30000/1001'))}, "
                f"frames: {chance.randint(2, 9)}}}\nsimulation: {{warmup: 0.5 s}}\n")
        text = line.replace("FILE", f'"{file}"')
        if text.startswith("backdrop"):
            text += "\nsystems:\n  a: {emit: {rate: 50, life: 1 s, speed: 1}, look: {shape: point}}\n"
        else:
            text = f"systems:\n  {text}\n"
        (root / "scene.yaml").write_text(head + text)
    return make


def good(kiln):
    """Yields 140 jobs that succeed. The first can be killed between its parts."""
    yield Job("long", "long", write("kiln: 1\noutput: {size: [96, 54], fps: 10, frames: 80}\nsystems: {a: {emit: "
                                    "{rate: 5000, life: 3 s, speed: [1, 4]}, look: {shape: point}}}\n"), smoke=True)
    scenes = sorted(path.stem for path in (SOURCE / "scenes").glob("*.yaml"))
    for number, scene in enumerate(2 * scenes):
        size = ([64, 36], [48, 48])[number // len(scenes)]
        yield Job("scenes", scene, shipped(kiln, scene, size, 3, number), smoke=number == scenes.index("embers"))
    left = 139 - 2 * len(scenes)
    kinds = {"video": 6, "moving": 5, "wind": 6, "mesh": 24, "texture": 30}
    kinds["plain"] = left - sum(kinds.values())
    smoke = {"wind": 1, "mesh": 1, "texture": 1, "plain": 3}
    for kind, many in kinds.items():
        for number in range(many):
            yield Job(kind, f"{kind} {number}", own(kind, number), smoke=number < smoke.get(kind, 0))


def write(text, mode=0o644):
    def make(root):
        (root / "scene.yaml").write_text(text)
        (root / "scene.yaml").chmod(mode)
    return make


def hostile(row):
    def make(root):
        if not (root.parent / "secret.txt").exists():
            (root.parent / "secret.txt").write_text(paths.SECRET)
        row.make(root)
        (root / "s.yaml").rename(root / "scene.yaml")
    return make


def rows_of_hostile(modules):
    """Yields rows of tests/hostile that kiln refuses, as many of a kind as the table `many` says.

    Rows of the smoke test come first. The modules are imported only when needed, since some take
    seconds to make their compressed files.
    """
    many = {"paths": 12, "pictures": 11, "videos": 6, "meshes": 7, "grids": 4, "scenes": 7}
    found = [row for module in modules for row in importlib.import_module(module).rows()
             if row.codes == rows.REFUSED and not row.meanwhile]
    for kind, count in many.items():
        if not (fitting := [row for row in found if row.kind == kind]):
            continue
        first = [row for row in fitting if row.smoke]
        rest = [row for row in fitting if not row.smoke]
        left = count - len(first)
        for i, row in enumerate(first + [rest[i * len(rest) // left] for i in range(left)]):
            yield Job(f"bad {kind}", row.name, hostile(row), 3, smoke=i == 0)


def broken():
    """Yields jobs that are broken or exceed a limit."""
    head, system = "kiln: 1\n", "systems: {a: {emit: {rate: 9, life: 1 s}}}\n"
    slow = "output: {size: [4096, 4096], frames: 1000}\n"

    def large(root):
        noise(root, "a.png", 512, random.Random(1))
        write(head + "output: {size: [512, 512], fps: 5, frames: 12}\nbackdrop: {sky: {image: a.png}}\n" + system)(root)

    def bomb(root):
        pictures = importlib.import_module("pictures")
        (root / "a.png").write_bytes(pictures.png(16384, 4096, 8, 6, pixels=zlib.compress(bytes(1 << 28), 9)))
        write(head + "backdrop: {sky: {image: a.png}}\n" + system)(root)

    def linked(root):
        os.symlink("/etc/hostname", root / "scene.yaml")

    def hard(root):
        write(head + system)(root)
        os.link(root / "scene.yaml", root.parent / "another name")
    yield Job("broken", "cut YAML", write("kiln: 1\nsystems: {a: {emit: \"\n"), 3, smoke=True)
    yield Job("broken", "no scene", lambda root: None, 3)
    yield Job("broken", "a scene that nobody may read", write(head + system, 0), 3)
    yield Job("broken", "a scene that is a FIFO", lambda root: os.mkfifo(root / "scene.yaml"), 3)
    yield Job("broken", "a scene that is a link", linked, 3)
    yield Job("broken", "a scene that is a hard link", hard, 3, "has another name", smoke=True)
    yield Job("broken", "an odd size", write(head + "output: {size: [33, 19], frames: 2}\n" + system), 2)
    yield Job("limits", "time of pictures", write(head + slow + system), 8, "limit `time`")
    yield Job("limits", "time of steps", write(head + "simulation: {warmup: 9000 s}\n" +
                                               system.replace("9", "200000")), 8, "limit `time`")
    yield Job("limits", "output", large, 8, "limit `output`")
    yield Job("limits", "frames", write(head + "output: {frames: 1000000}\n" + system), 8, "limit `frames`",
              smoke=True)
    yield Job("limits", "particles", write(head + "systems: {a: {emit: {rate: 4000000, life: 2 s}}}\n"), 8,
              "limit `particles`")
    yield Job("limits", "pixels of a picture", bomb, 8, "limit `asset_pixels`")


def bad(smoke):
    """Yields 60 jobs that must fail; for the smoke test, fewer, of which run.py takes some."""
    yield from rows_of_hostile(["paths", "texts"] if smoke else ["paths", "pictures", "meshes", "texts"])
    yield from broken()
