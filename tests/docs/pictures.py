#!/usr/bin/env python3
"""pictures.py SOURCE: the documents show the commands that their pictures were made by.

Renders nothing. Every picture in docs/images has a sidecar, is the file that this describes, is
shown by a document, and its command stands in one, word for word. A clip has a command and no
sidecar; all clips together stay small. Not among them: the guide, which docs.scenes compares with
what it draws, the pairs of two versions (tools/pairs), and the screenshot of a report.
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
    """What the documents' commands write -> each different one, without `kiln`."""
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
