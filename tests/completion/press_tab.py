#!/usr/bin/env python3
"""Checks that Tab completes command lines of kiln in a real shell: press_tab.py SHELL KILN SCRIPT.

If this fails, users of the shell get wrong completions or none. The shell runs on a
pseudo-terminal. For each row of CASES, the test types a text, presses Tab, and reads the line from
the shell's line editor. SCRIPT is the completion script; for zsh, its folder becomes part of the
fpath.
"""
import os
import pty
import re
import select
import shutil
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
    }),
    ("kiln render --set 'simulation.warmup=4 s' effects/to",
     "kiln render --set 'simulation.warmup=4 s' effects/torch.yaml "),
    ("kiln figure sheet --sweep post.tonemap=agx,ac",
     "kiln figure sheet --sweep post.tonemap=agx,aces "),
    ("kiln figure sheet --variant 'seed=2;post.tonemap=ac",
     "kiln figure sheet --variant 'seed=2;post.tonemap=aces' "),
    ("kiln render --nothing-is-called-so", "kiln render --nothing-is-called-so"),
    ("kiln rendre --techn", "kiln rendre --techn"),
]

FILES = {
    # An unfinished scene, which kiln cannot load; completion must read its systems all the same.
    "effects/torch.yaml": "kiln: 1\nsystems:\n  blaze: {emit: {}}\n",
    "effects/notes.txt": "",
    "my scene.yaml": "kiln: 1\n",
}

SETUP = {
    "bash": """PS1='ready> '; bind 'set enable-bracketed-paste off'; bind 'set bell-style none'
bind -x '"\\C-g": printf "\\n<<%s>>\\n" "$READLINE_LINE"'
source {script}
""",
    "zsh": """PS1='ready> '; unsetopt beep; fpath=({folder} $fpath); autoload -Uz compinit; compinit -D -u
show() {{ printf '\\n<<%s>>\\n' "$BUFFER" }}; zle -N show; bindkey -e; bindkey '^G' show
""",
}
PATIENCE_S = 50  # for a shell that hangs
ARGUMENTS = {"bash": ["--norc", "--noprofile", "-i"], "zsh": ["-f", "-i"]}


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


def main():
    name, kiln, script = sys.argv[1], *map(os.path.abspath, sys.argv[2:])
    if not shutil.which(name):
        sys.exit(f"{name} is not installed; tools/setup installs it")
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        for path, text in FILES.items():
            os.makedirs(os.path.dirname(os.path.join(folder, path)), exist_ok=True)
            with open(os.path.join(folder, path), "w", encoding="utf-8") as file:
                file.write(text)
        environment = dict(os.environ, TERM="dumb", LC_ALL="C.UTF-8", HOME=folder, COLUMNS="400",
                           PATH=os.path.dirname(kiln) + ":" + os.environ["PATH"])
        shell = Shell(name, folder, environment)
        shell.send(SETUP[name].format(script=script, folder=os.path.dirname(script)))
        shell.send("stty cols 400; echo set''up\n")
        shell.wait_for("setup\r?\n")
        for typed, expected in CASES:
            shell.send(typed + "\t\x07")
            line = shell.wait_for(r"<<(.*)>>\r?\n")[1]
            shell.send("\x05\x15")  # Ctrl-E and Ctrl-U delete the line
            if isinstance(expected, dict):
                expected = expected[name]
            if line != expected:
                failures += 1
                print(f"{typed}<TAB>\n  became   {line}\n  expected {expected}")
    print(f"{name}: {len(CASES)} lines, {failures} failed")
    sys.exit(failures > 0)


main()
