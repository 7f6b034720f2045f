"""Rows of run.py: meshes and grids that are broken, lie about their sizes, or nest too deeply."""
import json
import struct

from rows import LIMIT, OK, REFUSED, Row, asset, check, scene, write


def gltf(**changes):
    """Returns a glTF of one triangle, whose buffer is in the file itself, with changed members."""
    import base64
    data = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    tree = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                           "min": [0, 0, 0], "max": [1, 1, 0]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}
    tree.update(changes)
    return tree


def glb(text, length=None, chunk=None):
    """Returns a GLB file of a JSON text; `length` and `chunk` replace the true sizes."""
    text = text if isinstance(text, bytes) else text.encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) if length is None else length,
                       len(text) if chunk is None else chunk, b"JSON") + text


def nested(levels, open_="[", close="]"):
    return json.dumps(gltf())[:-1] + ', "extras": ' + open_ * levels + close * levels + "}"


def scans():
    """Yields PLY and STL files."""
    def ply(form, vertices="element vertex 3\nproperty float x\nproperty float y\nproperty float z\n",
            faces="element face 1\nproperty list uchar int vertex_index\n", data=b""):
        head = f"ply\nformat {form} 1.0\n{vertices}{faces}end_header\n".encode()
        return head + (data if isinstance(data, bytes) else data.encode())

    little, points = "binary_little_endian", struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    plys = {
        "sound": ply(little, data=points + struct.pack("<B3i", 3, 0, 1, 2)),
        "vertices": ply(little, "element vertex 4294967295\nproperty float x\n"),
        "faces": ply("ascii", faces="element face 999999999999999999\nproperty list uchar int vertex_index\n",
                     data="0 0 0 " * 3),
        "list": ply(little, faces="element face 1\nproperty list uint int vertex_index\n",
                    data=points + struct.pack("<I", 0xffffffff)),
        "negative list": ply(little, faces="element face 1\nproperty list char int vertex_index\n",
                             data=points + b"\xff" + bytes(40)),
        "index": ply(little, data=points + struct.pack("<B3i", 3, 0, 1, -1)),
        "element without properties": ply("ascii", "element nothing 999999999999999999\n", data="3 0 1 2"),
        "unknown element for ever": ply("ascii", "element odd 999999999999999999\nproperty int a\n", data="1 2 3"),
        "many elements": ply("ascii", "element a 1\n" * 100000), "many properties": ply(
            "ascii", "element vertex 1\n" + "property float x\n" * 100000),
        "no end": b"ply\nformat ascii 1.0\n" + b"comment a\n" * 100000, "head": b"ply", "zeros": b"ply\n" + bytes(1000),
        "long words": ply("ascii", data="9" * 100000 + " 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
    }
    for label, data in plys.items():
        yield asset("meshes", "mesh", f"PLY {label}", "a.ply", data, OK if label == "sound" else REFUSED,
                    smoke=label in ("list", "vertices"))
    stls = {
        "count": bytes(80) + b"\xff\xff\xff\xff" + bytes(200), "cut": bytes(80) + struct.pack("<I", 2) + bytes(99),
        "none": bytes(84), "short": b"a" * 83, "not a number": bytes(80) + struct.pack("<I12fH", 1, *[float("nan")] * 12, 0),
        "text": b"solid\n" + b"vertex " * 100000, "corners": b"solid\nfacet\n" + b"vertex 0 1 2\n" * 100000 + b"endfacet\n",
        "zero byte": b"solid\nfacet\n\0" + b"vertex 0 1 2\n" * 10,
    }
    for label, data in stls.items():
        yield asset("meshes", "mesh", f"STL {label}", "a.stl", data, smoke=label == "count")


def painted(label, files, says, **more):
    """Returns a row that prints what the mesh is, which reads its materials, too. A wrong material is no error."""
    def make(root):
        for name, data in files.items():
            write(root / name, data)
        scene(root, "mesh", next(iter(files)))
        return ["check", "s.yaml"]
    return Row("meshes", f"materials {label}", make, OK, says=says, **more)


def materials():
    """Yields meshes whose materials are broken, many, or elsewhere."""
    triangle = "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    mtls = {
        "sound": ("newmtl a\nKd 1 0 0\n", "base colour 1 0 0"),
        "secret": ("newmtl a\nmap_Kd ../secret.txt\n", "names the texture '../secret.txt'; it is left out"),
        "root": ("newmtl a\nmap_Kd -o 1 /etc/passwd\n", "names the texture '/etc/passwd'; it is left out"),
        "escapes": ("newmtl a\nmap_Kd \x1b]0;x\x07%s%n.png\n", "(missing)"),
        "not a number": ("newmtl a\nKd nan inf -inf\nPr 1e999\nd nan\nNs -5\nTr -1e38\n", "material 'a'"),
        "binary": ("newmtl a\n" + "".join(map(chr, range(256))) * 100, "material 'a'"),
        "long line": ("newmtl a\nmap_Kd " + "x" * 1000000, "longer than 255 bytes"),
        "options": ("newmtl a\nmap_Kd " + "-o 1 2 3 -s 1 " * 100000 + "-o", "material 'a'"),
        "many": ("".join(f"newmtl m{i}\nmap_Kd {i}.png\n" for i in range(200000)), "has its material 'a'"),
        "the same": ("newmtl a\nmap_Kd a.png\n" * 200000, "'a.png' (missing)"),
        "textures": ("".join(f"newmtl a\nmap_Kd {i}.png\n" for i in range(20000)), "'19999.png' (missing)"),
        "too large": ("#" * (17 << 20), "the mesh file names the file 'a.mtl'"),
        "UTF-16": (b"\xff\xfen\0e\0", "UTF-16"),
    }
    for label, (text, says) in mtls.items():
        yield painted(label, {"a.obj": triangle, "a.mtl": text}, says, smoke=label in ("secret", "not a number"))
    yield painted("outside", {"a.obj": triangle.replace("a.mtl", "../secret.txt")}, "must lie in its folder or below", smoke=True)
    yield painted("many textures", {
        "a.obj": "mtllib a.mtl\n" + "".join(f"usemtl {i}\nf 1 2 3\n" for i in range(1000)) + triangle,
        "a.mtl": "".join(f"newmtl {i}\nmap_Kd {i}.png\nbump b{i}.png\n" for i in range(1000))}, "more textures are missing")
    yield painted("files", {"a.obj": "mtllib s.yaml\n" * 100000 + triangle}, "files of materials; only 16 are read")
    yield painted("names", {"a.obj": "".join(f"usemtl {i}\nf 1 2 3\n" for i in range(100000)) + triangle}, "those beyond 1024")
    image = {"uri": "data:image/png;base64," + "A" * 1000}
    used = gltf()["meshes"][0]["primitives"][0] | {"material": 0}
    trees = {
        "circle": ({"textures": [{"source": 5}]}, "material"), "data": ({"images": [{"uri": "data:,%zz"}]}, "material"),
        "view": ({"images": [{"bufferView": 0}]}, "a picture of 36 bytes"), "path": ({"images": [{"uri": "..%2fsecret.txt"}]},
                                                                                   "it is left out"),
        "zero": ({"images": [{"uri": "a%00b"}]}, "has a zero"), "many": ({"images": [image] * 30000}, "a picture of 750 bytes"),
        "wrong": ({"images": {"a": 1}, "textures": 5, "samplers": "x"}, "material"),
    }
    for label, (changes, says) in trees.items():
        tree = gltf(meshes=[{"primitives": [used]}], **({"textures": [{"source": 0, "sampler": 9}]} | changes),
                    materials=[{"name": "\x1b[2J", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}}}])
        yield painted(f"glTF {label}", {"a.gltf": json.dumps(tree)}, says, smoke=label == "path")


def meshes():
    triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
    accessor = gltf()["accessors"][0]
    objs = {
        "empty": "", "no faces": triangle, "lines": triangle + "l 1 2 3\n", "points": triangle + "p 1 2 3\n",
        "index 0": triangle + "f 0 0 0\n", "beyond": triangle + "f 1 2 9999999\n", "negative": triangle + "f -9 -8 -7\n",
        "not a number": "v nan nan nan\n" * 3 + "f 1 2 3\n", "infinite": "v inf 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "far": "v 1e38 0 0\nv 1 0 0\nv 0 1e38 0\nf 1 2 3\n", "overflow": "v 1e999 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "no area": "v 0 0 0\n" * 3 + "f 1 2 3\n", "polygon": triangle + "f " + "1 2 3 " * 20000 + "\n",
        "line": "v " + "0 " * 100000 + "\n" + triangle + "f 1 2 3\n", "zero byte": triangle + "f 1 2 3\n\0",
        "materials": "mtllib ../secret.txt\nusemtl a\n" + triangle + "f 1 2 3\n",
        "many materials": "".join(f"usemtl {i}\nf 1 2 3\n" for i in range(200000)) + triangle,
        "crossed": "".join(f"v {i * 7919 % 10007} {i * i % 10007} 0\n" for i in range(3000)) +
                   "f " + " ".join(map(str, range(1, 3001))) + "\n",
        "joined lines": "v 0 0 0 \\\n" * 100000, "texture coordinates": "vt 0\n" * 4000000 + triangle + "f 1 2 3\n",
        "too many": triangle + "f 1 2 3\n" * 1100000, "groups": "g a\n" * 50000 + triangle + "f 1 2 3\n",
    }
    fine = {"polygon", "line", "materials", "groups", "many materials", "crossed"}
    for label, text in objs.items():
        codes = OK + REFUSED if label in fine else REFUSED
        yield asset("meshes", "mesh", f"OBJ {label}", "a.obj", text, codes, smoke=label in ("not a number", "lines"))
    yield asset("meshes", "mesh", "OBJ over the limit", "a.obj", triangle + "f 1 2 3\nf 1 3 2\n" * 50, LIMIT,
                lambda: check("--limits", "triangles=10"))
    yield from scans()
    yield from materials()
    trees = {
        "sound": gltf(), "no nodes": gltf(nodes=[]), "node of itself": gltf(nodes=[{"mesh": 0, "children": [0]}]),
        "nodes in a ring": gltf(nodes=[{"children": [1]}, {"children": [0], "mesh": 0}]),
        "mesh missing": gltf(nodes=[{"mesh": 77}]), "count": gltf(accessors=[dict(accessor, count=0x7fffffff)]),
        "negative count": gltf(accessors=[dict(accessor, count=-3)]), "type": gltf(accessors=[dict(accessor, type="MAT99")]),
        "offset": gltf(accessors=[dict(accessor, byteOffset=1 << 40)]),
        "view": gltf(bufferViews=[{"buffer": 0, "byteOffset": 30, "byteLength": 1 << 50}]),
        "view missing": gltf(accessors=[dict(accessor, bufferView=5)]), "buffer missing": gltf(buffers=[]),
        "buffer length": gltf(buffers=[{"byteLength": 1 << 60, "uri": "data:,a"}]),
        "sparse": gltf(accessors=[dict(accessor, sparse={"count": 1 << 30, "indices": {"bufferView": 0, "componentType": 5125},
                                                          "values": {"bufferView": 0}})]),
        "extension": gltf(extensionsRequired=["KHR_draco_mesh_compression"], extensionsUsed=["KHR_draco_mesh_compression"]),
        "version": gltf(asset={"version": "99.0"}), "names": gltf(nodes=[{"mesh": 0, "name": "\x1b]0;x\x07" * 1000}]),
        "many nodes": gltf(nodes=[{"mesh": 0, "children": list(range(1, 3000))}] + [{"mesh": 0}] * 2999),
        "instances": gltf(nodes=[{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}}}],
                          accessors=[accessor, dict(accessor, count=1 << 20, bufferView=None)]),
        "Draco": gltf(meshes=[{"primitives": [{"attributes": {}, "extensions": {"KHR_draco_mesh_compression": {
            "bufferView": 0, "attributes": {"POSITION": 0}}}}]}]),
        "meshopt": gltf(bufferViews=[{"buffer": 1, "byteLength": 36, "extensions": {"EXT_meshopt_compression": {
            "buffer": 0, "byteLength": 36, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES"}}}],
            buffers=gltf()["buffers"] + [{"byteLength": 36}]),
        "targets": gltf(meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 0}] * 5000}]}]),
        "list for a number": gltf(scene=[[[]]]), "number for a list": gltf(nodes=3, meshes="a"),
    }
    loose = {"sound", "names", "many nodes", "sparse", "extension", "version", "list for a number", "number for a list",
             "mesh missing", "no nodes", "instances"}
    for i, (label, tree) in enumerate(trees.items()):
        codes = OK + REFUSED if label in loose else REFUSED
        yield asset("meshes", "mesh", f"glTF {label}", "a.gltf", json.dumps(tree), codes, seconds=45,
                    smoke=label == "node of itself")
    texts = {
        "nested lists": nested(64), "nested objects": nested(64, '{"a":', "}").replace('"a":}', '"a":0}'),
        "nested for ever": nested(200000), "cut": json.dumps(gltf())[:100], "binary": b"{" + bytes(range(256)),
        "number": json.dumps(gltf()).replace("36", "3" * 5000), "array": "[]",
    }
    for label, text in texts.items():
        codes = OK if label in ("nested lists", "nested objects") else REFUSED
        yield asset("meshes", "mesh", f"glTF {label}", "a.gltf", text, codes, smoke=label == "nested lists")
    glbs = {
        "head": b"glTF", "length": glb(json.dumps(gltf()), length=0xffffffff), "chunk": glb(json.dumps(gltf()), chunk=0xffffffff),
        "nested": glb(nested(64)), "version": b"glTF" + struct.pack("<II", 77, 12) + bytes(40), "text": glb("no JSON"),
    }
    for label, data in glbs.items():
        yield asset("meshes", "moving" if label == "nested" else "mesh", f"GLB {label}", "a.glb", data)
    yield asset("meshes", "moving", "glTF that does not move", "a.gltf", json.dumps(gltf()))
    yield from nodes()


def nodes():
    """Yields glTF files of whose nodes a scene takes one."""
    accessor = {"componentType": 5126, "count": 2, "type": "SCALAR"}
    def moving(**changes):
        sampler = {"input": 1, "output": 2} | changes
        return {"accessors": [gltf()["accessors"][0], accessor, dict(accessor, type="VEC3")], "animations": [
            {"samplers": [sampler], "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]}
    chain = [{"children": [i + 1]} for i in range(200000)] + [{}]
    trees = {
        "sound": gltf(), "none": gltf(nodes=[]), "ring": gltf(nodes=[{"children": [1]}, {"children": [0]}]),
        "huge numbers": gltf(nodes=[{"translation": [1e308] * 3, "scale": [1e308] * 3}]),
        "chain": gltf(nodes=chain), "many": gltf(nodes=[{"name": "x" * 60}] * 70000, scenes=[{"nodes": list(range(70000))}]),
        "camera missing": gltf(nodes=[{"camera": 3}]), "camera of text": gltf(nodes=[{"camera": 0}], cameras=["x"]),
        "keys": gltf(**moving()), "clip missing": gltf(**moving(output=99)), "interpolation": gltf(**moving(interpolation="X")),
        "clips": gltf(**(moving() | {"animations": moving()["animations"] * 300})),
    }
    for label, tree in trees.items():
        codes = OK + REFUSED if label in ("sound", "keys") else REFUSED
        yield asset("meshes", "nodes", f"glTF {label}", "a.gltf", json.dumps(tree), codes, seconds=45, smoke=label == "ring")


def grids():
    head = "kiln-grid 1\nsize 2 2 2\norigin 0 0 0\nspacing 1 1 1\ndata\n"
    files = {
        "empty": "", "head": "kiln-grid 1\n", "cut": head + "\0" * 20, "too long": head.encode() + bytes(97),
        "size": head.replace("2 2 2", "1024 1024 1024"), "negative": head.replace("2 2 2", "-2 -2 -2"),
        "overflow": head.replace("2 2 2", "4294967298 4294967298 2"), "not a number": head.encode() + struct.pack("<24f", *[float("nan")] * 24),
        "spacing": head.replace("spacing 1 1 1", "spacing 0 0 0"), "line": "kiln-grid " + "1" * 100000,
        "escapes": "kiln-grid 1\nsize \x1b[31m 2 2\n", "no newline": "kiln-grid 1",
    }
    for label, data in files.items():
        yield asset("grids", "wind", label, "a.grid", data, smoke=label == "not a number")


def rows():
    return [*meshes(), *grids()]
