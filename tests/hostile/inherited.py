#!/usr/bin/python3
"""Checks which descriptors a job in a sandbox keeps of those that it was started with.

    inherited.py KILN

A supervisor may leave descriptors open by mistake: the socket of a data base, the log of another job, a
lock. If this fails, a job that is taken over reads and writes them. The standard streams stay, and so
do descriptors that an argument names.
"""
import os
import socket
import subprocess
import sys
import tempfile
import time

SCENE = b"kiln: 1\nsystems: {a: {emit: {rate: 9, life: 1 s}}}\n"


def descriptors(process):
    return {int(name) for name in os.listdir(f"/proc/{process}/fd")}


def run(kiln, given, named, expected, *options):
    """Starts kiln with descriptors; its scene comes by standard input. Returns what is wrong, or ""."""
    numbers = [file.fileno() for file in given + named]
    options = [option.replace("NAMED", str(named[0].fileno() if named else "")) for option in options]
    process = subprocess.Popen([kiln, "check", "-q", "-", *options], pass_fds=numbers, stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    wanted = {0, 1, 2} | {file.fileno() for file in expected}
    end = time.monotonic() + 10
    found = descriptors(process.pid)
    while time.monotonic() < end and found - wanted:
        time.sleep(0.01)
        found = descriptors(process.pid)
    output, _ = process.communicate(SCENE)
    if process.returncode != 0:
        return f"exit code {process.returncode}: {output.decode(errors='replace')}"
    if (found & set(numbers)) != wanted & set(numbers):
        return f"it keeps {sorted(found)} of {sorted(numbers)}, and should keep {sorted(wanted)}"
    return ""


def main():
    kiln = os.path.realpath(sys.argv[1])
    with tempfile.TemporaryFile() as a, tempfile.TemporaryFile() as b, socket.socket() as c, \
            tempfile.TemporaryFile() as events:
        given = [a, b, c]
        rows = (
            ("in a sandbox", run(kiln, given, [], [], "--sandbox", "--asset-root", ".")),
            ("in a sandbox, with events", run(kiln, given, [events], [events], "--sandbox", "--events",
                                              "ndjson:fd=NAMED")),
            ("without a sandbox", run(kiln, given, [], given)),
        )
        wrote = os.fstat(events.fileno()).st_size > 0
    # A scene by a pipe of the shell, which gets a high number.
    shell = subprocess.run(["bash", "-c", f"'{kiln}' check -q <(cat) --sandbox"], input=SCENE, stdout=subprocess.PIPE,
                           stderr=subprocess.STDOUT)
    rows += (("the events", "" if wrote else "there are none"),
             ("a pipe of the shell", shell.stdout.decode(errors="replace")))
    for label, problem in rows:
        print(f"{label:28} {problem or 'as it should be'}")
    return any(problem for _, problem in rows)


sys.exit(main())
