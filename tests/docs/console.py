#!/usr/bin/env python3
"""console.py [--update] KILN DOCUMENT: a document's examples do what it says.

In an empty folder, in the order of the document: a block "```yaml PATH" is a file, and a block
"```console" is a session: each line "$ COMMAND" is run, and the lines up to the next one must be what
it prints, then "exit code N" where that is not 0. Times are written as "N s"; of fractions the
digits are not compared. With --update, what is
printed is written into the document.
"""
import os
import re
import subprocess
import sys
import tempfile


def run(command, folder, environment):
    done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120)
    lines = [re.sub(r"\b[0-9.]+ s\b", "N s", line) for line in done.stdout.splitlines()]
    return lines + ([f"exit code {done.returncode}"] if done.returncode else [])


def rough(lines):
    """Metrics differ in their last digits from driver to driver."""
    return [re.sub(r"\b0\.[0-9]+\b", "0.x", line) for line in lines]


def play(block, folder, environment):
    printed = []
    for line in block:
        if line.startswith("$ "):
            printed += [line] + run(line[2:], folder, environment)
    return printed


def main():
    update = sys.argv[1] == "--update"
    program, path = sys.argv[-2:]
    with open(path, encoding="utf-8") as file:
        lines = file.read().splitlines()
    environment = dict(os.environ, LC_ALL="C", TERM="dumb",
                       PATH=os.path.dirname(os.path.abspath(program)) + ":" + os.environ["PATH"])
    result, sessions = [], 0
    with tempfile.TemporaryDirectory() as folder:
        while lines:
            line = lines.pop(0)
            result.append(line)
            start = re.fullmatch(r"```(yaml (\S+)|console)", line)
            if not start:
                continue
            end = lines.index("```")
            block, lines = lines[:end], lines[end:]
            if start[2]:
                target = os.path.join(folder, start[2])
                os.makedirs(os.path.dirname(target), exist_ok=True)
                with open(target, "w", encoding="utf-8") as file:
                    file.write("\n".join(block) + "\n")
            else:
                sessions += 1
                printed = play(block, folder, environment)
                if rough(printed) != rough(block) and not update:
                    sys.exit(f"{path}: this is not what comes out:\n" + "\n".join(block) +
                             "\n---- but:\n" + "\n".join(printed))
                block = printed
            result += block
    if update:
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(result) + "\n")
    print(f"{sessions} sessions")
    if sessions == 0:
        sys.exit("nothing was checked")


main()
