#!/usr/bin/python3
"""Checks that kiln reads no scene from outside of the asset root while its path is swapped.

    swap.py KILN

A process replaces the scene, or the folder that it lies in, by a link out of the asset root and back,
as fast as it can, while kiln is started over and over. If this fails, a stranger who may write in
the folder of his job can have any file of the machine read as a scene, and see what it says in
kiln's messages. The scene outside has as many frames as no other, so that kiln's own words tell
which one it has read. With KILN_TESTS=all, each way is tried for a minute, otherwise for some
seconds.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import time

SCENE = "kiln: 1\noutput: {{size: [16, 16], frames: {}}}\nsystems: {{a: {{emit: {{rate: 9, life: 1 s}}}}}}\n"
INSIDE, OUTSIDE = 7, 7777


def swap_file(root):
    """Makes s.yaml by turns a file and a link out of the root, until the process is killed."""
    while True:
        os.link(root / "good.yaml", root / "next")
        os.rename(root / "next", root / "s.yaml")
        os.symlink("../secret/s.yaml", root / "next")
        os.rename(root / "next", root / "s.yaml")


def swap_folder(root):
    """Makes the folder `deep` by turns a link to a folder of the root and one out of the root."""
    while True:
        for target in ("real", "../secret"):
            os.symlink(target, root / "next")
            os.rename(root / "next", root / "deep")


WAYS = (
    ("scene", swap_file, "s.yaml", ()),
    ("scene, in a sandbox", swap_file, "s.yaml", ("--sandbox",)),
    ("scene by its full path", swap_file, "ROOT/s.yaml", ()),
    ("folder", swap_folder, "deep/s.yaml", ()),
    ("folder, in a sandbox", swap_folder, "deep/s.yaml", ("--sandbox",)),
)


def attack(kiln, swap, name, options, seconds):
    """Returns how often kiln was started, read the scene inside, and read the scene outside."""
    with tempfile.TemporaryDirectory(prefix="kiln-swap-") as place:
        place = pathlib.Path(os.path.realpath(place))
        root = place / "root"
        for folder, frames in (("root/real", INSIDE), ("secret", OUTSIDE)):
            (place / folder).mkdir(parents=True)
            (place / folder / "s.yaml").write_text(SCENE.format(frames))
        (root / "good.yaml").write_text(SCENE.format(INSIDE))
        (root / "s.yaml").write_text(SCENE.format(INSIDE))
        os.symlink("real", root / "deep")
        swapper = os.fork()
        if swapper == 0:
            swap(root)
        runs = inside = outside = 0
        end = time.monotonic() + seconds
        try:
            while time.monotonic() < end:
                done = subprocess.run(
                    [kiln, "check", name.replace("ROOT", str(root)), "--asset-root", ".", *options], cwd=root,
                    stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60)
                runs += 1
                inside += done.returncode == 0 and f"# work: {INSIDE} frames".encode() in done.stdout
                outside += str(OUTSIDE).encode() in done.stdout
        finally:
            os.kill(swapper, 9)
            os.waitpid(swapper, 0)
        return runs, inside, outside


def main():
    seconds = 60 if os.environ.get("KILN_TESTS") == "all" else 2
    kiln = os.path.realpath(sys.argv[1])
    failed = False
    for label, swap, name, options in WAYS:
        runs, inside, outside = attack(kiln, swap, name, options, seconds)
        failed = failed or outside > 0 or inside == 0
        print(f"{label:24} {runs:6} starts, {inside:6} of the scene inside, {outside:4} of the scene outside", flush=True)
    return failed


sys.exit(main())
