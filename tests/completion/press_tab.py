#!/usr/bin/env python3
"""Checks that Tab completes command lines of kiln in a real shell: press_tab.py SHELL KILN SCRIPT.

If this fails, users of the shell get wrong completions or none, or Tab puts a command out of a
stranger's scene into their line. The shell runs on a pseudo-terminal. For each row of CASES, the
test types a text, presses Tab, and reads the line from the shell's line editor. Then a stand-in for
kiln offers names that a shell would act on: the line must have the name itself when the shell
evaluates it, or must not have changed, and nothing may be run. SCRIPT is the completion script; for
zsh, its folder becomes part of the fpath.
"""
import itertools
import os
import pty
import re
import select
import shutil
import subprocess
import sys
import tempfile
import time

# The text that is typed, and the line after Tab. Where the shells differ, the line is a dictionary
# by the name of the shell.
CASES = [
    ("kiln ren", "kiln render "),
    ("kiln comp", "kiln compare "),
    ("kiln test appr", "kiln test approve "),
    ("kiln test cal", "kiln test calibrate "),
    ("kiln figure tri", "kiln figure triptych "),
    ("kiln figure str", "kiln figure strip "),
    ("kiln help test cal", "kiln help test calibrate "),
    ("kiln help exit", "kiln help exit-codes "),
    ("true; kiln dev", "true; kiln devices "),
    ("NO_COLOR=1 kiln dev", "NO_COLOR=1 kiln devices "),
    ("kiln render --techn", "kiln render --technique "),
    ("kiln figure sheet --vari", "kiln figure sheet --variant "),
    ("kiln test list --file", "kiln test list --files "),
    ("kiln render --technique raster=geom", "kiln render --technique raster=geometry "),
    ("kiln render --technique sort=cpu,raster=geom",
     "kiln render --technique sort=cpu,raster=geometry "),
    ("kiln new --template fou", "kiln new --template fountain "),
    ("kiln help env", "kiln help environment "),
    ("kiln render --png-bits=1", "kiln render --png-bits=16 "),
    ("kiln render --progress nd", "kiln render --progress ndjson "),
    ("kiln test approve --as dev", "kiln test approve --as device "),
    ("kiln render --device softw", "kiln render --device software "),
    ("kiln compare --tolerance flip.mea", "kiln compare --tolerance flip.mean="),
    ("kiln render effects/to", "kiln render effects/torch.yaml "),
    ("kiln test effects/to", "kiln test effects/torch.yaml "),
    ("kiln check effects/no", {  # zsh offers other files where no scene fits
        "bash": "kiln check effects/no",
        "zsh": "kiln check effects/notes.txt ",
    }),
    ("kiln check effects/", "kiln check effects/torch.yaml "),
    ("kiln compare effects/no", "kiln compare effects/notes.txt "),
    ("kiln check effects/torch.yaml > effects/no",
     "kiln check effects/torch.yaml > effects/notes.txt "),
    ("kiln check my\\ sc", "kiln check my\\ scene.yaml "),
    ("kiln check ~/eff", "kiln check ~/effects/"),
    ("kiln render -o effects/to", "kiln render -o effects/torch.yaml "),
    ("kiln render -oeffects/to", "kiln render -oeffects/torch.yaml "),
    ("kiln render -qo effects/to", "kiln render -qo effects/torch.yaml "),
    ("kiln render -qoeffects/to", "kiln render -qoeffects/torch.yaml "),
    ("kiln render --output=effects/to", "kiln render --output=effects/torch.yaml "),
    ("kiln test --results eff", "kiln test --results effects/"),
    ("kiln test report eff", "kiln test report effects/"),
    ("kiln render --set post.tonem", "kiln render --set post.tonemap="),
    ("kiln render --set post.tonemap=ac", "kiln render --set post.tonemap=aces "),
    ("kiln render --set=post.tonemap=ac", "kiln render --set=post.tonemap=aces "),
    ("kiln render --set 'post.tonemap='ac", {
        "bash": "kiln render --set post.tonemap=aces ",
        "zsh": "kiln render --set 'post.tonemap=aces' ",
        "fish": "kiln render --set 'post.tonemap='aces ",
    }),
    ("kiln render effects/torch.yaml --set systems.bla",
     "kiln render effects/torch.yaml --set systems.blaze."),
    ("kiln render ~/effects/torch.yaml --set systems.bla",
     "kiln render ~/effects/torch.yaml --set systems.blaze."),
    ("kiln render effects/torch.yaml --set systems.blaze.emit.ra",
     "kiln render effects/torch.yaml --set systems.blaze.emit.rate="),
    ("kiln render --set systems.\\*.emit.ra", "kiln render --set systems.\\*.emit.rate="),
    ("kiln render --set 'systems.*.emit.ra", {
        "bash": "kiln render --set 'systems.*.emit.rate='",
        "zsh": "kiln render --set 'systems.*.emit.rate=",
        "fish": "kiln render --set 'systems.*.emit.rate=",
    }),
    ("kiln render --set 'simulation.warmup=4 s' effects/to",
     "kiln render --set 'simulation.warmup=4 s' effects/torch.yaml "),
    ("kiln figure sheet --sweep post.tonemap=agx,ac",
     "kiln figure sheet --sweep post.tonemap=agx,aces "),
    ("kiln figure sheet --variant 'seed=2;post.tonemap=ac",
     "kiln figure sheet --variant 'seed=2;post.tonemap=aces' "),
    # Keys of systems that no scene may have: they hold commands, and are not offered.
    ("kiln render hostile.yaml --set systems.n", "kiln render hostile.yaml --set systems.nice."),
    ("kiln render --nothing-is-called-so", "kiln render --nothing-is-called-so"),
    ("kiln rendre --techn", "kiln rendre --techn"),
]

FILES = {
    # An unfinished scene, which kiln cannot load; completion must read its systems all the same.
    "effects/torch.yaml": "kiln: 1\nsystems:\n  blaze: {emit: {}}\n",
    "effects/notes.txt": "",
    "my scene.yaml": "kiln: 1\n",
    "hostile.yaml": "kiln: 1\nsystems:\n  nice: {}\n" + "".join(
        f"  {name!r}: {{}}\n" for name in ("n$(touch owned)", "n`touch owned`", "n;touch owned", "n a", "n&")) +
        '  "n\\nword\\tnext": {}\n  "n\\x1b]0;a": {}\n',
}

# Names that a stand-in for kiln offers: each begins with an x, after which Tab is pressed.
NAMES = ["x$(touch owned)y", "x`touch owned`y", "x;touch owned;y", "x&touch owned&y", "x|touch owned", "x a b", "x'y", 'x"y',
         "x\\y", "x\\$(touch owned)", "x'$(touch owned)'y", 'x"$(touch owned)"y', "x*", "x?[a]", "x{a,b}", "x<owned", "x>owned",
         "x$HOME", "x#y", "x!!", "x!$", "x~", "x=(touch owned)", "x(touch owned)", "x%s", "x^y", "x-\u00e9\U0001f525", "x=y", "x:y"]
# What is typed before a name, and after it where quotes are still open.
QUOTES = ["", "'", '"']
STAND_IN = """#!/bin/sh
if [ "$1" = complete ]; then cat "$OFFER"; else printf '%s\\0' "$@" >"$GIVEN"; fi
"""

SETUP = {
    "fish": """function fish_prompt; echo 'ready> '; end; set -g fish_autosuggestion_enabled 0; set -g fish_greeting
bind \\cg 'printf "\\n<<%s>>\\n" (commandline | string collect)'
source {script}
""",
    "bash": """PS1='ready> '; bind 'set enable-bracketed-paste off'; bind 'set bell-style none'
bind -x '"\\C-g": printf "\\n<<%s>>\\n" "$READLINE_LINE"'
source {script}
""",
    "zsh": """PS1='ready> '; unsetopt beep; fpath=({folder} $fpath); autoload -Uz compinit; compinit -D -u
show() {{ printf '\\n<<%s>>\\n' "$BUFFER" }}; zle -N show; bindkey -e; bindkey '^G' show
""",
}
PATIENCE_S = 50  # for a shell that hangs
ARGUMENTS = {"bash": ["--norc", "--noprofile", "-i"], "zsh": ["-f", "-i"], "fish": ["--no-config", "-i"]}


class Shell:
    """A shell on a pseudo-terminal."""

    def __init__(self, name, folder, environment):
        pid, self.terminal = pty.fork()
        if pid == 0:
            os.chdir(folder)
            os.execvpe(name, [name] + ARGUMENTS[name], environment)

    def wait_for(self, pattern):
        text, end = "", time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            if select.select([self.terminal], [], [], 1)[0]:
                text += os.read(self.terminal, 65536).decode(errors="replace")
            found = re.search(pattern, text)
            if found:
                return found
        sys.exit(f"the shell never said {pattern}, but:\n{text}")

    def send(self, text):
        os.write(self.terminal, text.encode())


    def complete(self, typed):
        """Types a text and presses Tab. Returns the line."""
        self.send(typed + "\t\x07")
        line = self.wait_for(r"<<((?:.|\n)*)>>\r?\n")[1]
        self.send("\x05\x15")  # Ctrl-E and Ctrl-U delete the line
        return line.replace("\r\n", "\n")


def start(name, script, folder, programs, **more):
    environment = dict(os.environ, TERM="dumb", LC_ALL="C.UTF-8", HOME=folder, COLUMNS="400",
                       PATH=programs + ":" + os.environ["PATH"], **more)
    shell = Shell(name, folder, environment)
    shell.send(SETUP[name].format(script=script, folder=os.path.dirname(script)))
    shell.send("stty cols 400; echo set''up\n")
    shell.wait_for("setup\r?\n")
    return shell, environment


def press_all(name, script, folder, kiln):
    """Completes the lines of CASES by kiln itself."""
    shell, _ = start(name, script, folder, os.path.dirname(kiln))
    failures = 0
    for typed, expected in CASES:
        line = shell.complete(typed)
        if isinstance(expected, dict):
            expected = expected.get(name, expected["bash"])
        if line != expected:
            failures += 1
            print(f"{typed}<TAB>\n  became   {line}\n  expected {expected}")
    return failures


def words_of(name, line, folder, environment, given):
    """Returns the words that the shell gives to a program for a line, or None for no line of it."""
    if os.path.exists(given):
        os.unlink(given)
    done = subprocess.run([name, "-c", line], cwd=folder, env=environment, capture_output=True, timeout=PATIENCE_S,
                          check=False)
    if done.returncode or not os.path.exists(given):
        return None
    with open(given, encoding="utf-8") as file:
        return file.read().split("\0")[:-1]


def press_hostile(name, script, folder):
    """Completes names that a shell would act on, and lets the shell evaluate each line."""
    programs, offer, given, owned = (os.path.join(folder, part) for part in ("stand-in", "offer", "given", "owned"))
    os.mkdir(programs)
    with open(os.path.join(programs, "kiln"), "w", encoding="utf-8") as file:
        file.write(STAND_IN)
    os.chmod(os.path.join(programs, "kiln"), 0o755)
    shell, environment = start(name, script, folder, programs, OFFER=offer, GIVEN=given)
    failures = taken = 0
    for kind, text, quote in itertools.product(("word", "file"), NAMES, QUOTES):
        if quote == '"' and "!" in text and name == "zsh":
            continue  # zsh -c keeps the backslash that zsh writes before it, and zsh -i does not
        path = os.path.join(folder, text)
        if kind == "file":
            open(path, "w", encoding="utf-8").close()
        with open(offer, "w", encoding="utf-8") as file:
            file.write(f"word\t{text}\ta note\n" if kind == "word" else "file:*\t\t\n")
        typed = f"kiln {quote}x"
        line = shell.complete(typed)
        found = words_of(name, line, folder, environment, given) or \
            words_of(name, line + quote, folder, environment, given)
        if kind == "file":
            os.unlink(path)
        taken += found == [text]
        if os.path.exists(owned):
            os.unlink(owned)
            found = "a command of theirs was run"
        if found not in ([text], ["x"]):
            failures += 1
            print(f"{kind}: {typed}<TAB>\n  became   {line}\n  gives    {found}, not {[text]}")
    print(f"{name}: {2 * len(NAMES) * len(QUOTES)} hostile names, {taken} completed, {failures} failed")
    return failures + (taken < 2 * len(NAMES))


def main():
    name, kiln, script = sys.argv[1], *map(os.path.abspath, sys.argv[2:])
    if not shutil.which(name):
        sys.exit(f"{name} is not installed; tools/setup installs it")
    with tempfile.TemporaryDirectory() as folder:
        for path, text in FILES.items():
            os.makedirs(os.path.dirname(os.path.join(folder, path)), exist_ok=True)
            with open(os.path.join(folder, path), "w", encoding="utf-8") as file:
                file.write(text)
        failures = press_all(name, script, folder, kiln)
        print(f"{name}: {len(CASES)} lines, {failures} failed")
        failures += press_hostile(name, script, folder)
    sys.exit(failures > 0)


main()
