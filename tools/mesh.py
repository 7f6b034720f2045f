"""Helps tools/props, tools/graves and tools/mill to write meshes of scenes: OBJ files in scenes/meshes, noise, and
shapes."""
import os
import sys
from math import cos, floor, hypot, pi, sin

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scenes", "meshes")


class Mesh:
    def __init__(self):
        self.vertices, self.faces = [], []

    def add(self, point):
        """Adds a vertex, and returns its number in the OBJ file, which counts from 1."""
        self.vertices.append(point)
        return len(self.vertices)

    def join(self, rows, closed):
        """Adds quads between rows of equally many points. `closed` joins the last point of a row to the first."""
        for lower, upper in zip(rows, rows[1:]):
            for i in range(len(lower) if closed else len(lower) - 1):
                j = (i + 1) % len(lower)
                corners = list(dict.fromkeys([lower[i], lower[j], upper[j], upper[i]]))
                if len(corners) > 2:
                    self.faces.append(corners)

    def write(self, name, about):
        with open(os.path.join(FOLDER, name), "w", encoding="ascii") as out:
            print(f"# {about}, by tools/{os.path.basename(sys.argv[0])}. Metres, y up.", file=out)
            for x, y, z in self.vertices:
                print(f"v {x:.4f} {y:.4f} {z:.4f}", file=out)
            for face in self.faces:
                print("f", *face, file=out)


def lattice(x, y, z, seed):
    """Returns a random number from -1 to 1 for a point of a lattice."""
    h = (x * 0x9E3779B1 ^ y * 0x85EBCA77 ^ z * 0x27D4EB2F ^ seed * 0xC2B2AE3D) & 0xFFFFFFFF
    h = (h ^ h >> 15) * 0x2C1B3C6D & 0xFFFFFFFF
    h = (h ^ h >> 12) * 0x297A2D39 & 0xFFFFFFFF
    return (h ^ h >> 15) / 2147483648 - 1


def noise(x, y, z, seed):
    """Returns value noise from -1 to 1."""
    i, j, k = floor(x), floor(y), floor(z)
    a, b, c = (t * t * (3 - 2 * t) for t in (x - i, y - j, z - k))
    total = 0.0
    for corner in range(8):
        p, q, r = corner & 1, corner >> 1 & 1, corner >> 2
        weight = (a if p else 1 - a) * (b if q else 1 - b) * (c if r else 1 - c)
        total += weight * lattice(i + p, j + q, k + r, seed)
    return total


def rough(point, size, seed):
    """Returns two octaves of noise, from -1.5 to 1.5. The bumps of the first are about `size` wide."""
    x, y, z = (t / size for t in point)
    return noise(x, y, z, seed) + 0.5 * noise(2 * x, 2 * y, 2 * z, seed + 1)


def power(x, exponent):
    """Returns |x| to the power of the exponent, with the sign of x."""
    return abs(x) ** exponent * (1 if x > 0 else -1)


def add_tube(mesh, path, segments, shape=lambda a, k: 1.0):
    """Adds a closed tube along `path`, whose entries are (point, radius); a radius of 0 closes an end.
    shape(angle, index of the entry) returns a factor on the radius."""
    rows = []
    for k, (center, radius) in enumerate(path):
        before, after = path[max(k - 1, 0)][0], path[min(k + 1, len(path) - 1)][0]
        way = [q - p for p, q in zip(before, after)]
        aside = (0.0, 0.0, 1.0) if abs(way[2]) < 0.7 * hypot(*way) else (1.0, 0.0, 0.0)
        u = [way[1] * aside[2] - way[2] * aside[1], way[2] * aside[0] - way[0] * aside[2],
             way[0] * aside[1] - way[1] * aside[0]]
        u = [c / hypot(*u) for c in u]
        v = [(u[1] * way[2] - u[2] * way[1]), (u[2] * way[0] - u[0] * way[2]), (u[0] * way[1] - u[1] * way[0])]
        v = [c / hypot(*v) for c in v]
        if radius == 0:
            rows.append([mesh.add(center)] * segments)
            continue
        row = []
        for i in range(segments):
            a = 2 * pi * i / segments
            r = radius * shape(a, k)
            row.append(mesh.add([c + r * (p * cos(a) + q * sin(a)) for c, p, q in zip(center, u, v)]))
        rows.append(row)
    mesh.join(rows, True)


def add_stone(mesh, center, across, along, shape):
    """Adds a closed surface around the point `center`. shape(direction) returns the surface's distance in that
    direction, a unit vector, and factors that stretch it along x, y and z."""
    rows = []
    for j in range(across):
        v = -0.5 * pi + pi * j / (across - 1)
        row = []
        for i in range(1 if j in (0, across - 1) else along): # each pole is one point
            u = 2 * pi * i / along
            unit = (cos(v) * cos(u), sin(v), cos(v) * sin(u))
            r, stretch = shape(unit)
            row.append(mesh.add([c + r * s * t for c, s, t in zip(center, stretch, unit)]))
        rows.append(row if len(row) == along else row * along)
    mesh.join(rows, True)


def prism(mesh, outline, front, back):
    """Adds a closed prism between the planes z = front and z = back; `outline` is counterclockwise from +z."""
    rows = [[mesh.add((x, y, z)) for x, y in outline] for z in (front, back)]
    mesh.join([rows[1], rows[0]], True)
    mesh.faces.append(rows[0])
    mesh.faces.append(rows[1][::-1])
