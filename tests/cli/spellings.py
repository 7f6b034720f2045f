#!/usr/bin/env python3
"""Checks that an option means the same in all commands: spellings.py KILN.

If this fails, somebody who knows one command of kiln is misled by another one: a letter or a name
stands for two things, or one thing has two names. The options are those that `kiln help` lists.
"""
import re
import subprocess
import sys

KILN = sys.argv[1]

# Names whose values have several forms, and why these are one meaning all the same.
FORMS = {
    "output": {"FILE", "FOLDER", "STATES"},  # where the command writes
    "shard": {"I/N", "I/N|auto|auto/N"},     # a share of the work; only `render` knows schedulers
    "progress": {"tty|lines|none", "tty|lines|ndjson|none"},
    "stats": {None, "text|json"},            # times besides the result
    "update": {"FIGURE", "missing|failed|all"},  # what is drawn now becomes what was accepted
}
# Names that differ only by an "s" at their end.
NUMBERS = {("frame", "frames")}  # one frame, or a choice of frames

failures = []


def help_of(*words):
    return subprocess.run([KILN, "help", *words], check=True, capture_output=True, text=True).stdout


def commands():
    block = re.search(r"^commands:\n((?:  .*\n)+)", help_of(), re.M)[1]
    return [re.split("  +", line.strip())[0].split() for line in block.splitlines()]


def options():
    """Yields the command, letter, name, placeholder and help text of each option."""
    for command in commands():
        rows = re.findall(r"^ +(?:-(\w), )?--([a-z-]+)(?:\[=(\S+)\]| (\S+))?((?:.*)(?:\n {30}.*)*)",
                          help_of(*command).split("\nOptions and operands")[0], re.M)
        for letter, name, optional, value, text in rows:
            yield " ".join(command), letter, name, optional or value or None, " ".join(text.split())


def check_one(what, uses):
    """Fails where a key of `uses` has several values. A value comes with the commands that use it."""
    for key, values in uses.items():
        if len(values) > 1:
            places = "; ".join(f"{value} in {', '.join(sorted(set(names)))}"
                               for value, names in values.items())
            failures.append(f"{what} {key} is {places}")


def main():
    names_of, letters_of, forms_of, count = {}, {}, {}, 0
    for command, letter, name, value, text in options():
        count += 1
        if letter:
            names_of.setdefault(f"-{letter}", {}).setdefault(f"--{name}", []).append(command)
            letters_of.setdefault(f"--{name}", {}).setdefault(f"-{letter}", []).append(command)
        if value not in FORMS.get(name, ()):
            forms_of.setdefault(f"--{name}", {}).setdefault(value, []).append(command)
        if name == "force" and not text.startswith("Replace "):
            failures.append(f"--force of {command} does not replace files: {text}")
        limits_time = name == "timeout" or name.endswith("-timeout")
        if (value == "TIME") != limits_time:
            failures.append(f"--{name} of {command}: a limit of time is called --timeout, where it is for the "
                            "whole command, or --THING-timeout, and no other option is")
    check_one("the letter", names_of)
    check_one("the letter of", letters_of)
    check_one("the value of", forms_of)
    names = set(name[2:] for name in forms_of) | set(FORMS)
    for name in names:
        if name + "s" in names and (name, name + "s") not in NUMBERS:
            failures.append(f"--{name} and --{name}s are easily taken for each other")
    print("\n".join(failures) or f"{count} options have one meaning each")
    sys.exit(1 if failures or count < 200 else 0)


main()
