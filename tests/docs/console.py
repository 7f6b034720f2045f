#!/usr/bin/env python3
"""Checks that the examples of a document print what the document says.

    console.py [--update] [--keep FOLDER] [--only SECTION]... KILN DOCUMENT

If this fails, a reader who follows the document sees something else than it promises. The blocks of
the document are executed in its order, in an empty folder:

"```yaml PATH"          is written to the file PATH; also python, latex, makefile, html, c, cpp, cmake
"```yaml more of PATH"  is appended to the file
"```console"            is a session: each line "$ COMMAND" is run, and the lines up to the next
                        one must be its output, then "exit code N" if the code is not 0

In the output, times become "N s" and kiln's version becomes "kiln V"; everything else must be
equal. A picture that the document shows as NAME.jpg must look like NAME.png, if a session drew
that.

--update writes the output into the document instead of comparing it. --keep leaves the files in
FOLDER, which should be empty, and compares no pictures. --only executes only the blocks before the
first "## " and those below each "## SECTION".
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile

PATIENCE_S = 600  # for a command that hangs
TREE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def run(command, folder, environment):
    command = re.sub(r"(?<!\S)(?=(tools|examples)/)", lambda _: TREE + "/", command)
    command = command.replace("/usr/share/kiln/examples/", f"{TREE}/examples/")
    done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=PATIENCE_S)
    lines = [re.sub(r"\bkiln \d+\.\d+\.\d+( \([0-9a-f]+\+?\))?", "kiln V",
                    re.sub(r"\b[0-9.]+ s\b|(?<=in )[0-9.]+s\b", "N s", line)) for line in done.stdout.splitlines()]
    return lines + ([f"exit code {done.returncode}"] if done.returncode else [])


def play(block, folder, environment):
    printed = []
    for line in block:
        if line.startswith("$ "):
            printed += [line] + run(line[2:], folder, environment)
    return printed


def write_file(folder, name, block):
    more = name.startswith("more of ")
    target = os.path.join(folder, name.removeprefix("more of "))
    os.makedirs(os.path.dirname(target), exist_ok=True)
    with open(target, "a" if more else "w", encoding="utf-8") as file:
        file.write("\n".join(block) + "\n")


def check(path, folder, environment, update, only):
    """Executes the blocks of a document.

    Returns its lines, with the output of its sessions, and the number of sessions.
    """
    with open(path, encoding="utf-8") as file:
        lines = file.read().splitlines()
    result, sessions, section = [], 0, None
    while lines:
        line = lines.pop(0)
        result.append(line)
        if line.startswith("## "):
            section = line[3:]
        if only and section not in (None, *only):
            continue
        start = re.fullmatch(r"```((?:yaml|python|latex|makefile|html|c|cpp|cmake) (\S.*)|console)", line)
        if not start:
            continue
        end = lines.index("```")
        block, lines = lines[:end], lines[end:]
        if start[2]:
            write_file(folder, start[2], block)
        else:
            sessions += 1
            printed = play(block, folder, environment)
            if printed != block and not update:
                sys.exit(f"{path}: this is not what comes out:\n" + "\n".join(block) +
                         "\n---- but:\n" + "\n".join(printed))
            block = printed
        result += block
    return result, sessions


def compare_pictures(path, lines, folder, environment):
    """Compares the pictures that the document shows with those that its sessions drew.

    The limits allow for the loss by JPEG and the rounding of a driver.
    """
    for target, stem in re.findall(r"!\[[^]]*\]\((\S*?(\w+)\.jpg)\)", "\n".join(lines)):
        shown = os.path.join(os.path.dirname(os.path.abspath(path)), target)
        drawn = os.path.join(folder, f"{stem}.png")
        if not os.path.exists(drawn):
            continue
        done = subprocess.run(["kiln", "compare", drawn, shown, "--tolerance",
                               "flip.mean=0.04,flip.p99=0.2"], env=environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode:
            sys.exit(f"{path}: {target} is stale (tools/pictures draws it):\n{done.stdout}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--keep", metavar="FOLDER")
    parser.add_argument("--only", metavar="SECTION", action="append")
    parser.add_argument("kiln")
    parser.add_argument("document")
    given = parser.parse_args()
    path, update = given.document, given.update
    environment = dict(os.environ, LC_ALL="C", TERM="dumb",
                       PATH=os.path.dirname(os.path.abspath(given.kiln)) + ":" +
                       os.environ["PATH"])
    with tempfile.TemporaryDirectory() as scratch:
        os.chmod(scratch, 0o711)  # some sessions run a program as another user
        result, sessions = check(path, given.keep or scratch, environment, update, given.only)
        if not given.keep:
            compare_pictures(path, result, scratch, environment)
    if update:
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(result) + "\n")
    print(f"{sessions} sessions")
    if sessions == 0:
        sys.exit("nothing was checked")


main()
