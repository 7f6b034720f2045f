"""Defines a row of run.py, a hostile input of kiln, and functions that make rows."""
import dataclasses
import pathlib

REFUSED, OK, USAGE, LIMIT, DEVICE = (3,), (0,), (2,), (8,), (5,)


@dataclasses.dataclass
class Row:
    kind: str
    name: str
    # Makes the files of the row in the asset root, and returns the words of the command.
    make: object
    codes: tuple = REFUSED
    seconds: float = 10
    says: str = ""  # a text that kiln must print
    smoke: bool = False
    environment: dict = dataclasses.field(default_factory=dict)
    meanwhile: object = None  # a function that runs beside the command, until its event is set


def write(path, data):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data if isinstance(data, bytes) else data.encode())


def quoted(text):
    """Returns a YAML scalar of any text."""
    out = ""
    for c in text:
        out += c if 32 <= ord(c) < 127 and c not in '"\\' else (
            f"\\x{ord(c):02x}" if ord(c) < 256 else f"\\u{ord(c):04x}")
    return f'"{out}"'


# For each use of an asset, a scene that names the file FILE.
USES = {
    "atlas": "systems: {a: {emit: {rate: 9, life: 1 s}, look: {atlas: FILE, cells: [1, 1]}}}",
    "cells": "systems: {a: {emit: {rate: 9, life: 1 s}, look: {atlas: FILE, cells: [4, 4]}}}",
    "floor": "backdrop: {floor: {image: FILE}}\nsystems: {a: {emit: {rate: 9, life: 1 s}}}",
    "sky": "backdrop: {sky: {image: FILE}}\nsystems: {a: {emit: {rate: 9, life: 1 s}}}",
    "mesh": "backdrop: {objects: [{mesh: {file: FILE}}]}\nsystems: {a: {emit: {rate: 9, life: 1 s}}}",
    "moving": "backdrop: {objects: [{mesh: {file: FILE, animation: {}}}]}\n"
              "systems: {a: {emit: {rate: 9, life: 1 s}}}",
    "nodes": "nodes: {n: {file: FILE, node: 0}}\ncamera: {attach: n}\nsystems: {a: {emit: {rate: 9, life: 1 s}}}",
    "wind": "systems: {a: {emit: {rate: 9, life: 1 s}, forces: [{wind: {field: grid, file: FILE}}]}}",
    "terrain": "backdrop: {objects: [{terrain: {size: [9, 1, 9], image: FILE}}]}\n"
               "systems: {a: {emit: {rate: 9, life: 1 s}}}",
}


def scene(root, use, name):
    text = USES[use].replace("FILE", quoted(name))
    write(root / "s.yaml", f"kiln: 1\noutput: {{size: [32, 18], frames: 2}}\n{text}\n")


def check(*options):
    return ["check", "-q", "s.yaml", *options]


def render(*options):
    return ["render", "-q", "s.yaml", "-o", "out/f_%d.png", "--device", "cpu", *options]


def asset(kind, use, label, name, data, codes=REFUSED, command=check, **more):
    """Returns a row that checks a scene with a file of this name and content as an asset."""
    def make(root):
        if data is not None:
            write(root / name, data() if callable(data) else data)
        scene(root, use, name)
        return command()
    return Row(kind, f"{use} {label}", make, codes, **more)


def text_row(kind, label, text, codes=REFUSED, command=check, **more):
    """Returns a row whose scene file has this text."""
    def make(root):
        write(root / "s.yaml", text() if callable(text) else text)
        return command()
    return Row(kind, label, make, codes, **more)


HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
