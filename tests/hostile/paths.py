"""Rows of run.py: scenes that name files which a scene may not read, or FIFOs and the like."""
import os
import socket

from rows import REFUSED, Row, asset, check, scene, write

SECRET = "the secret of somebody else"


def rows():
    found = []
    names = {
        "absolute": "/etc/passwd",
        "up": "../secret.txt",
        "up and down": "deep/../../secret.txt",
        "dots": "./././../secret.txt",
        "proc": "/proc/self/environ",
        "device": "/dev/zero",
        "file URI": "file:///etc/passwd",
        "http URI": "http://127.0.0.1:1/a.png",
        "concat": "concat:/etc/passwd|/etc/passwd",
        "subfile": "subfile,,start,0,end,9,,:/etc/passwd",
        "empty": "",
        "dot": ".",
        "long": "a" * 5000,
        "long parts": "/".join("a" * 200 for _ in range(30)),
        "newline": "a\n/etc/passwd",
        "escapes": "\x1b]0;owned\x07.png",
        "override": "\u202egnp.a",
        "zero byte": "a.png\x00/etc/passwd",
        "spaces": "  /etc/passwd",
        "backslash": "..\\secret.txt",
    }
    for i, (label, name) in enumerate(names.items()):
        use = ("atlas", "floor", "sky", "mesh", "wind", "terrain")[i % 6]
        smoke = label in ("absolute", "up", "escapes")
        found.append(asset("paths", use, label, name, None, smoke=smoke))

    def special(label, use, make_file, name="a.png", codes=REFUSED, smoke=False, says=""):
        def make(root):
            make_file(root)
            scene(root, use, name)
            return check()
        found.append(Row("paths", f"{use} {label}", make, codes, smoke=smoke, says=says))

    def symlink(target, name="a.png"):
        def make(root):
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            os.symlink(target, root / name)
        return make

    # One text, whether or not something is where the link leads.
    outside = "'a.png' leads outside the asset root"
    special("link out", "atlas", symlink("../secret.txt"), smoke=True, says=outside)
    special("link to nothing outside", "atlas", symlink("../nothing.txt"), smoke=True, says=outside)
    special("absolute link out", "floor", symlink("/etc/passwd"), says=outside)
    special("absolute link to nothing", "floor", symlink("/etc/nothing"), says=outside)
    special("link below a file outside", "floor", symlink("/etc/passwd/a"), says=outside)
    special("link to what only root may see", "floor", symlink("/root/a/b"), says=outside)
    special("link to proc", "sky", symlink("/proc/self/environ"))
    special("link to a device", "atlas", symlink("/dev/zero"))
    special("link to itself", "atlas", symlink("a.png"))
    special("linked folder", "mesh", symlink("..", "up"), "up/secret.txt", says="leads outside the asset root")
    special("linked folder to nothing", "mesh", symlink("..", "up"), "up/nothing.txt",
            says="leads outside the asset root")
    special("link of a wind", "wind", symlink("../secret.txt", "a.grid"), "a.grid")
    special("link of a mesh", "mesh", symlink("../secret.txt", "a.obj"), "a.obj")
    special("FIFO", "atlas", lambda root: os.mkfifo(root / "a.png"), smoke=True)
    special("FIFO as a mesh", "mesh", lambda root: os.mkfifo(root / "a.obj"), "a.obj")
    special("FIFO as a wind", "wind", lambda root: os.mkfifo(root / "a.grid"), "a.grid")
    special("FIFO as a video", "atlas", lambda root: os.mkfifo(root / "a.mp4"), "a.mp4")
    special("folder", "sky", lambda root: (root / "a.png").mkdir())
    special("hard link", "atlas", lambda root: os.link(root.parent / "secret.txt", root / "a.png"))

    def make_socket(root):
        before = os.getcwd()
        os.chdir(root)
        server = socket.socket(socket.AF_UNIX)
        server.bind("a.png")
        server.close()
        os.chdir(before)
    special("socket", "atlas", make_socket)

    def linked_scene(root):
        os.symlink("../secret.txt", root / "s.yaml")
        return check("--asset-root", ".")
    found.append(Row("paths", "a scene that is a link", linked_scene, REFUSED, smoke=True))
    found.append(Row("paths", "a scene that is a link, in a sandbox",
                     lambda root: linked_scene(root) + ["--sandbox"], REFUSED))

    # A glTF file names its buffer by an URI.
    for i, (label, uri) in enumerate({
            "absolute": "/etc/passwd", "up": "../secret.txt", "encoded": "%2e%2e/secret.txt",
            "http": "http://127.0.0.1:1/a.bin", "file": "file:///etc/passwd",
            "proc": "/proc/self/mem", "itself": "a.gltf", "link": "link.bin",
            "FIFO": "fifo.bin", "missing": "no.bin", "long": "b" * 6000,
            "escapes": "\\u001b[2J.bin"}.items()):
        def make(root, uri=uri):
            os.symlink("../secret.txt", root / "link.bin")
            os.mkfifo(root / "fifo.bin")
            write(root / "a.gltf", '{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], '
                  '"nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], '
                  '"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", '
                  '"min": [0, 0, 0], "max": [1, 1, 1]}], "bufferViews": [{"buffer": 0, "byteLength": 36}], '
                  f'"buffers": [{{"byteLength": 36, "uri": "{uri}"}}]}}')
            scene(root, "moving" if i % 2 else "mesh", "a.gltf")
            return check()
        found.append(Row("paths", f"buffer {label}", make, REFUSED, smoke=label == "up"))

    # The name is by turns a link out of the root and a link to a file in the root, while kiln reads
    # it.
    for use in ("atlas", "mesh", "wind"):
        name = {"atlas": "a.png", "mesh": "a.obj", "wind": "a.grid"}[use]
        def make(root, use=use, name=name):
            scene(root, use, name)
            write(root / "sound", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" if use == "mesh" else b"kiln-grid 1\n")
            os.symlink("sound", root / name)
            return check()
        def swap(root, stop, name=name):
            for i in range(1 << 30):
                if stop.is_set():
                    return
                os.symlink(("../secret.txt", "sound")[i % 2], root / "next")
                os.rename(root / "next", root / name)
        found.append(Row("paths", f"{use} swapped while it is read", make, (0, 3), meanwhile=swap))
    return found
