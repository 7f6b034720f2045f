#!/usr/bin/env python3
"""Checks that `kiln complete` offers what `kiln help` lists: tables.py KILN.

If this fails, Tab does not know a new command, option or value. Every command and option must be
offered. The value of an option must be offered, too, unless its placeholder in the help is in
NOTHING_TO_OFFER. A new placeholder fails until cmd/complete.c or NOTHING_TO_OFFER has it.
"""
import os
import re
import subprocess
import sys

NOTHING_TO_OFFER = {
    "10s|N", "I/N|auto|auto/N", "COLUMNSxROWS", "FACTOR", "I/N", "LAYER", "LENGTH", "LEVELS", "N", "NUMBER", "PIXELS", "RANGES", "RATE", "S", "STOPS", "TIME",
    "TEXT", "WxH", "X,Y,WxH",
    "DOMAIN",  # of a scene's gas (tests/cli/cases/complete.t)
    "PATTERN", "NAME",  # names of tests, offered where there are results (tests/cli/cases/test.t)
}
KILN = sys.argv[1]
failures = []


def run(*arguments):
    return subprocess.run([KILN, *arguments], check=True, capture_output=True, text=True).stdout


def offered(*words):
    """Returns the texts that `kiln complete` offers for the last of the words."""
    return [line.split("\t")[1] for line in run("complete", "--", *words).splitlines()]


def expect(what, found, expected):
    if sorted(found) != sorted(expected):
        failures.append(f"{what}: offered {sorted(found)}, but there are {sorted(expected)}")


def check_option(command, name, placeholder):
    if not placeholder or placeholder in NOTHING_TO_OFFER:
        return
    values = run("complete", "--", *command, f"--{name}=").splitlines()
    if not values:
        failures.append(f"kiln {' '.join(command)} --{name}: nothing is offered for {placeholder}")
    if re.fullmatch(r"[a-z0-9]+(\|[a-z0-9]+)+", placeholder):
        expect(name, [line.split("\t")[1] for line in values],
               [f"--{name}={word}" for word in placeholder.split("|")])


def check_command(command):
    help_text = run("help", *command)
    options = re.findall(r"^ +(?:-\w, )?--([a-z-]+)(?:\[=|[ ])?(?:(\S+?)\]?)?(?:  .*|$)", help_text,
                         re.M)
    expect(f"options of {command}", offered(*command, "--"), [f"--{name}" for name, _ in options])
    for name, placeholder in options:
        check_option(command, name, placeholder)
    synopsis = help_text.splitlines()[0].split("[OPTION...]")[1]
    for operand in re.findall("[A-Z]+", synopsis):
        if operand not in NOTHING_TO_OFFER and not offered(*command, ""):
            failures.append(f"kiln {' '.join(command)}: nothing is offered for {operand}")
    return len(options)


def check_without_gl():
    """Checks that completion loads no driver of OpenGL, even for devices, so that Tab is fast."""
    environment = dict(os.environ, LD_DEBUG="files")
    loaded = subprocess.run([KILN, "complete", "--", "render", "--device", ""], check=True,
                            capture_output=True, text=True, env=environment).stderr
    if "libc.so" not in loaded or re.search(r"_dri\.so|libEGL_", loaded):
        failures.append("a driver of OpenGL is loaded for completion")


def main():
    overview = run("help")
    commands = re.search(r"^commands:\n((?:  .*\n)+)", overview, re.M)[1]
    topics = re.search(r"^topics .*\n((?:  .*\n)+)", overview, re.M)[1]
    commands = [re.split("  +", line.strip())[0].split() for line in commands.splitlines()]
    topics = [line.split()[0] for line in topics.splitlines()]
    first = {command[0] for command in commands}
    expect("commands", offered(""), [*first, "--help", "--version"])
    expect("topics", offered("help", ""), [*first, *topics])
    count = sum(check_command(command) for command in commands)
    for group in {command[0] for command in commands if len(command) == 2}:
        second = [command[1] for command in commands if len(command) == 2 and command[0] == group]
        expect(group, offered("help", group, ""), second)
        expect(group, [word for word in offered(group, "") if word in second], second)
    check_without_gl()
    print("\n".join(failures) or f"{len(commands)} commands with {count} options complete")
    sys.exit(1 if failures or count < 100 else 0)


main()
