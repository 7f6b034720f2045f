#!/usr/bin/env python3
"""Writes the meshes of this folder: PLY and STL in every form that the formats have, and an OBJ. expect.mjs then writes what three.js
reads in them, and tests/unit/test_scans.c compares kiln with that."""
import os
import struct

FOLDER = os.path.dirname(os.path.abspath(__file__))

# A shape without symmetry: a box whose corners are moved, so that a wrong order of numbers or of corners shows.
POSITIONS = [(0, 0, 0), (2, 0, 0.25), (2.5, 1, 0), (0, 1.5, 0), (0, 0, 3), (2, 0.125, 3), (2, 1, 3.75), (-0.5, 1, 3)]
QUADS = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (3, 7, 6, 2), (0, 4, 7, 3), (1, 2, 6, 5)]
TRIANGLES = [triangle for a, b, c, d in QUADS for triangle in ((a, b, c), (a, c, d))]
NORMALS = [(0.6, 0.8, 0), (0, 0.6, -0.8), (1, 0, 0), (0, -1, 0), (0, 0, 1), (-0.6, 0, 0.8), (0.8, 0.6, 0), (0, 0, -1)]
UVS = [(i / 8, 1 - i * i / 64) for i in range(8)]


def write(name, *parts):
    with open(os.path.join(FOLDER, name), "wb") as file:
        for part in parts:
            file.write(part.encode() if isinstance(part, str) else part)


def header(form, vertex, faces, face="property list uchar int vertex_indices\n", before="", after="", between=""):
    return (f"ply\nformat {form} 1.0\n{before}element vertex {len(POSITIONS)}\n{vertex}{between}"
            f"element face {len(faces)}\n{face}{after}end_header\n")


def floats(names, kind="float"):
    return "".join(f"property {kind} {name}\n" for name in names.split())


def ascii_rows(rows):
    return "".join(" ".join(f"{number:g}" for number in row) + "\n" for row in rows)


def ply():
    corners = [(len(face), *face) for face in TRIANGLES]
    write("plain.ply", header("ascii", floats("x y z"), TRIANGLES), ascii_rows(POSITIONS), ascii_rows(corners))
    quads = [(len(face), *face) for face in QUADS]
    colored = [(*p, i, 255 - i, 7, 255) for i, p in enumerate(POSITIONS)]
    write("quads.ply", header("ascii", floats("x y z") + floats("red green blue alpha", "uchar"), QUADS,
                              before="comment by hand\nobj_info a scan\n").replace("\n", "\r\n"),
          (ascii_rows(colored) + ascii_rows(quads)).replace("\n", "\r\n"))
    # everything at once, in an order of its own, with properties and elements that nobody knows
    rows = [(p[2], 0.5, *n, p[0], *uv, p[1]) for p, n, uv in zip(POSITIONS, NORMALS, UVS)]
    write("more.ply", header("ascii", floats("z quality nx ny nz x s t y"), TRIANGLES,
                             "property float area\nproperty list uint8 int32 vertex_index\nproperty uchar flag\n",
                             between="element camera 2\nproperty float fov\nproperty list uchar short pins\n"),
          ascii_rows(rows), "40 2 -3 4\n50 0\n", ascii_rows([(0.5, *c, 1) for c in corners]))
    for form, mark in (("binary_little_endian", "<"), ("binary_big_endian", ">")):
        short = "little" if mark == "<" else "big"
        vertices = b"".join(struct.pack(mark + "3f3f2f3B", *p, *n, *uv, 1, 2, 3)
                            for p, n, uv in zip(POSITIONS, NORMALS, UVS))
        faces = b"".join(struct.pack(mark + "B3i", *c) for c in corners)
        write(f"{short}.ply", header(form, floats("x y z nx ny nz u v") + floats("red green blue", "uchar"), TRIANGLES),
              vertices, faces)
        # other types of numbers and lists, and lists to skip in front of and behind those that count
        vertices = b"".join(struct.pack(mark + "h3dI", -5, *p, 70000) for p in POSITIONS)
        between = struct.pack(mark + "Bhhf", 2, 1, -1, 0.5) + struct.pack(mark + "Bf", 0, 1.5)
        faces = b"".join(struct.pack(mark + "H2fI3HB", 2, 0, 1, *c, 9) for c in corners)
        write(f"{short}_types.ply",
              header(form, floats("a", "short") + floats("x y z", "double") + floats("b", "uint"), TRIANGLES,
                     "property list ushort float weights\nproperty list uint ushort vertex_indices\n"
                     "property uchar flag\n",
                     between="element odd 2\nproperty list uchar short what\nproperty float32 ever\n"),
              vertices, between, faces)


def facet(corners, wrong=False):
    a, b, c = (POSITIONS[i] for i in corners)
    u, v = ([q[k] - a[k] for k in range(3)] for q in (b, c))
    normal = [u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3] for k in range(3)]
    return ([0, 0, 0] if wrong else normal), (a, b, c)


def stl():
    def text(name, triangles):
        lines = [f"solid {name}"]
        for normal, corners in map(facet, triangles):
            lines.append("  facet normal " + " ".join(f"{n:e}" for n in normal))
            lines.append("    outer loop")
            lines += ["      vertex " + " ".join(f"{p:e}" for p in corner) for corner in corners]
            lines += ["    endloop", "  endfacet"]
        return "\n".join([*lines, f"endsolid {name}", ""])

    def binary(start, count, extra=b""):
        facets = b"".join(struct.pack("<12fH", *normal, *(n for corner in corners for n in corner), 0xffff)
                          for normal, corners in (facet(t, wrong=True) for t in TRIANGLES))
        return start.ljust(80, b" ") + struct.pack("<I", count) + facets + extra

    write("text.stl", text("a vertex of things", TRIANGLES))
    write("two.stl", text("one", TRIANGLES[:5]), text("two", TRIANGLES[5:]))
    write("capitals.stl", text("LOUD", TRIANGLES).upper().replace("\n", "\r\n"))
    write("binary.stl", binary(b"made by hand", len(TRIANGLES)))
    write("solid.stl", binary(b"solid as it is not", len(TRIANGLES)))


def obj():
    """Normals and texture coordinates are in another order than positions; half of the faces count backwards."""
    lines = ["# by make.py", "mtllib none.mtl", "o thing", "usemtl one thing"]
    lines += ["v " + " ".join(f"{n:g}" for n in p) + " 1 0.5 0.25" for p in POSITIONS]
    lines += [f"vt {u:g} {v:g} 0" for u, v in reversed(UVS)]
    lines += ["vn " + " ".join(f"{n:g}" for n in normal) for normal in reversed(NORMALS)]
    for i, face in enumerate(TRIANGLES):
        corners = [f"{c + 1}/{8 - c}/{8 - c}" if i % 2 else f"{c - 8}/{-1 - c}/{-1 - c}" for c in face]
        lines.append(f"f {corners[0]} {corners[1]} \\\n {corners[2]}" if i == 3 else "f " + " ".join(corners))
    write("mixed.obj", "\r\n".join([*lines, ""]))


obj()
ply()
stl()
