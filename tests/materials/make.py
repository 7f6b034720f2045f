#!/usr/bin/env python3
"""Writes painted.gltf, painted.glb and painted.ply of this folder. expect.mjs then writes what three.js reads in them and in
painted.obj, which is written by hand, and tests/unit/test_materials.c compares kiln with that."""
import base64
import json
import os
import struct

FOLDER = os.path.dirname(os.path.abspath(__file__))
POSITIONS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
TRIANGLES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
COLORS = [(255, 0, 0, 255), (128, 64, 255, 128), (0, 0, 25, 0), (5, 191, 230, 255)]
PICTURE = base64.b64decode("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M/wHwAEBgIApD5fRAAAAABJRU5ErkJggg==")


def path(name):
    return os.path.join(FOLDER, name)


def ply():
    with open(path("painted.ply"), "w", encoding="ascii") as file:
        file.write("ply\nformat ascii 1.0\nelement vertex 4\n")
        file.writelines(f"property float {name}\n" for name in "xyz")
        file.writelines(f"property uchar {name}\n" for name in ("red", "green", "blue"))
        file.write("element face 4\nproperty list uchar int vertex_indices\nend_header\n")
        file.writelines(" ".join(map(str, (*p, *c[:3]))) + "\n" for p, c in zip(POSITIONS, COLORS))
        file.writelines("3 " + " ".join(map(str, t)) + "\n" for t in TRIANGLES)


def material(name, **members):
    return {"name": name, **members}


def textured(texture, **members):
    return {"index": texture, **members}


MATERIALS = [
    material("unused", pbrMetallicRoughness={"baseColorTexture": textured(2)}),
    material("plain"),
    material("rough steel", doubleSided=True, alphaMode="MASK", alphaCutoff=0.25,
             pbrMetallicRoughness={"baseColorFactor": [0.5, 0.25, 0.125, 0.75], "metallicFactor": 0.875, "roughnessFactor": 0.375,
                                   "baseColorTexture": textured(0, extensions={"KHR_texture_transform": {
                                       "offset": [0.25, -0.5], "rotation": 0.7, "scale": [2, 2]}}),
                                   "metallicRoughnessTexture": textured(1, texCoord=1)},
             normalTexture=textured(2, scale=0.5), emissiveFactor=[1, 0.5, 0.25], emissiveTexture=textured(1),
             extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 8}}),
    material("flat glass", alphaMode="BLEND", extensions={"KHR_materials_unlit": {}},
             pbrMetallicRoughness={"baseColorFactor": [1, 1, 1, 0.25], "baseColorTexture": textured(2)}),
]


def gltf(name, picture_in_view):
    positions = b"".join(struct.pack("<3f", *p) for p in POSITIONS)
    colors = b"".join(struct.pack("<4B", *c) for c in COLORS)
    opaque = b"".join(struct.pack("<3f", *(x / 255 for x in c[:3])) for c in COLORS)
    uvs = b"".join(struct.pack("<2f", i / 4, 1 - i / 4) for i in range(4))
    second = b"".join(struct.pack("<2f", i / 8, i / 16) for i in range(4))
    indices = b"".join(struct.pack("<3H", *t) for t in TRIANGLES)
    parts = [positions, colors, opaque, uvs, second, indices, PICTURE]
    views, data = [], b""
    for part in parts:
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(part)})
        data += part + b"\0" * (-len(part) % 4)
    accessor = {"positions": (0, 5126, 4, "VEC3"), "colors": (1, 5121, 4, "VEC4"), "opaque": (2, 5126, 4, "VEC3"),
                "uvs": (3, 5126, 4, "VEC2"), "second": (4, 5126, 4, "VEC2")}
    accessors = [{"bufferView": v, "componentType": t, "count": c, "type": k} for v, t, c, k in accessor.values()]
    accessors[0] |= {"min": [0, 0, 0], "max": [1, 1, 1]}
    accessors[1]["normalized"] = True
    primitives = []
    for i, (number, color) in enumerate(((1, 1), (2, 1), (3, 2), (None, None))):
        accessors.append({"bufferView": 5, "byteOffset": 6 * i, "componentType": 5123, "count": 3, "type": "SCALAR"})
        attributes = {"POSITION": 0, "TEXCOORD_0": 3, "TEXCOORD_1": 4}
        if color:
            attributes["COLOR_0"] = color
        primitives.append({"attributes": attributes, "indices": len(accessors) - 1} | ({} if number is None else {"material": number}))
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "extensionsUsed": ["KHR_texture_transform", "KHR_materials_emissive_strength", "KHR_materials_unlit"],
        "meshes": [{"primitives": primitives}], "materials": MATERIALS, "accessors": accessors, "bufferViews": views,
        "textures": [{"source": 0, "sampler": 0}, {"source": 1}, {"source": 2, "sampler": 1}],
        "samplers": [{"wrapS": 33071, "wrapT": 33648}, {"magFilter": 9728}],
        "images": [{"uri": "my%20wood.png"}, {"uri": "both.png"},
                   {"bufferView": 6, "mimeType": "image/png"} if picture_in_view else
                   {"uri": "data:image/png;base64," + base64.b64encode(PICTURE).decode()}],
        "buffers": [{"byteLength": len(data)}]}
    if not picture_in_view:
        document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        with open(path(name), "w", encoding="ascii") as file:
            json.dump(document, file, indent=1)
        return
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    with open(path(name), "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data)


ply()
gltf("painted.gltf", False)
gltf("painted.glb", True)
