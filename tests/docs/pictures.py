#!/usr/bin/env python3
"""Checks that documents show the commands by which their pictures were made: pictures.py SOURCE.

If this fails, a reader who runs a command gets another picture than the document shows. Nothing is
rendered. Every picture in docs/images must be shown by a document and be the file that its sidecar
describes, and the documents must show the command of the sidecar, word for word. A clip has a
command but no sidecar; all clips together must stay small. Three kinds of pictures are left out:
those of the guide, which the test docs.scenes compares with what its sessions draw, the pairs of
pictures by two versions (tools/pairs), and the screenshot of a report.
"""
import glob
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys

SUFFIX = ".figure.json"
CLIPS = "docs/images/moving/"
CLIPS_BYTES = 3_000_000
OTHERS = ("docs/images/guide/", "docs/images/pairs/", "docs/images/report.jpg")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def shown_commands():
    """Returns a dictionary from each output file to the documents' different commands for it.

    A command is a list of words without `kiln`.
    """
    listed = subprocess.run(["tools/pictures", "--list"], check=True, text=True,
                            stdout=subprocess.PIPE).stdout
    shown = {}
    for line in listed.splitlines():
        words = shlex.split(line)[1:]
        output = words[words.index("-o") + 1]
        if words not in shown.setdefault(output, []):
            shown[output].append(words)
    return shown


def links():
    found = set()
    for document in ["README.md"] + glob.glob("docs/*.md"):
        folder = os.path.dirname(document)
        for target in re.findall(r"!\[[^]]*\]\(([^)]+)\)", read(document)):
            found.add(os.path.normpath(os.path.join(folder, target)))
    return found


def problems_of(picture, shown, linked):
    if picture not in linked:
        yield "no document shows it"
    if picture.startswith(OTHERS):
        return
    commands = shown.get(picture, [])
    if len(commands) != 1:
        yield f"documents show {len(commands)} different commands for it"
    if picture.startswith(CLIPS):
        return
    if not os.path.exists(picture + SUFFIX):
        yield f"it has no {SUFFIX}"
        return
    sidecar = json.loads(read(picture + SUFFIX))
    with open(picture, "rb") as file:
        if hashlib.sha256(file.read()).hexdigest() != sidecar["file"]:
            yield "it is not the file that its sidecar describes"
    for command in commands:
        if command != sidecar["command"]:
            yield f"made by:\n  {shlex.join(sidecar['command'])}\nthe documents say:\n  " + \
                shlex.join(command)


def main():
    os.chdir(sys.argv[1])
    shown, linked = shown_commands(), links()
    pictures = {path for path in glob.glob("docs/images/**", recursive=True)
                if os.path.isfile(path) and not path.endswith(SUFFIX)}
    sidecars = {path.removesuffix(SUFFIX) for path in glob.glob(f"docs/**/*{SUFFIX}",
                                                               recursive=True)}
    found = [f"{picture}: {problem}" for picture in sorted(pictures)
             for problem in problems_of(picture, shown, linked)]
    found += [f"{path}: a document has a command for it, but it is not there"
              for path in sorted(set(shown) - pictures)]
    found += [f"{path}: it is not there, but its sidecar is" for path in sorted(sidecars - pictures)]
    clips = sum(os.path.getsize(path) for path in pictures if path.startswith(CLIPS))
    if clips > CLIPS_BYTES:
        found.append(f"{CLIPS}: {clips} bytes; {CLIPS_BYTES} are allowed")
    print(f"{len(pictures)} pictures, {len(sidecars)} of them figures")
    if not sidecars:
        sys.exit("nothing was checked")
    if found:
        sys.exit("\n".join(found))


main()
