#!/usr/bin/python3
"""Checks that kiln withstands files from strangers.

    run.py [--smoke] [--list] KILN COMPROMISED [KIND...]

If this fails, a malicious scene or asset can read or write other files, hang kiln, or crash it.
Each row of the modules paths, pictures, meshes and texts makes files in an asset root, beside a
secret file. kiln must end in time with the row's exit code, and print a short reason without
control characters. It may write only its output, and open only files of the asset root and those
that every program opens; strace shows that. COMPROMISED is the folder of a kiln-decode that has
been taken over (compromised.c). --smoke runs a few rows, --list only prints them.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time

import meshes
import paths
import pictures
import texts

# Prefixes of the paths that every program opens, or that kiln reads to know the machine.
COMMON = ("/usr/", "/lib/", "/lib64/", "/etc/ld.so.", "/proc/self/", "/proc/filesystems",
          "/sys/devices/system/", "/sys/kernel/mm/transparent_hugepage/", "/dev/null")
CALL = re.compile(r'(?:open|openat|openat2|creat|connect|socket|bind|execve|mkdir|mkdirat|unlink|unlinkat|rename\w*'
                  r'|link\w*|symlink\w*|truncate|chmod|mknod\w*)\(')
PATH = re.compile(r'"((?:[^"\\]|\\.)*)"')


def snapshot(folder):
    """Returns mode, size and time of every file below a folder; links are not followed."""
    found = {}
    for path in sorted(folder.rglob("*")):
        status = path.lstat()
        found[str(path.relative_to(folder))] = (status.st_mode, status.st_size, status.st_mtime_ns)
    return found


def outside(trace, root, allowed):
    """Returns the system calls that reached a file which is not allowed, or a network."""
    bad = []
    for line in trace.read_text(errors="replace").splitlines():
        line = re.sub(r"^\d+ +", "", line)
        if not CALL.match(line) or " = -1 " in line or "resumed>" in line or line.endswith("<unfinished ...>") or \
                "O_PATH" in line:
            continue
        if line.startswith(("socket(", "connect(", "bind(")):
            bad.append(line)
            continue
        strings = PATH.findall(line)
        name = strings[0].encode().decode("unicode_escape") if strings else ""
        # kiln calls openat2 with the descriptor of the root, below which the kernel keeps it.
        if line.startswith("openat2(") and not name.startswith("/"):
            continue
        real = os.path.realpath(os.path.join(root, name))
        places = (name, real)
        if not any(place.startswith(prefix) for place in places for prefix in allowed):
            bad.append(line)
        elif real.endswith("secret.txt"):
            bad.append(line)
    return bad


def said_well(row, code, output):
    """Returns what is wrong with the text that kiln printed, or "" if nothing is."""
    text = output.decode("utf-8", errors="surrogateescape")
    if any(ord(c) < 32 and c not in "\n\t" or 0x7f <= ord(c) < 0xa0 or c in "\u202a\u202b\u202c\u202d\u202e" or
           0xdc80 <= ord(c) <= 0xdcff for c in text):
        return "it prints what acts on a terminal"
    if code and not text.strip():
        return "it ends without a word"
    if code and len(text) > 4000:
        return "it says too much"
    if "secret of somebody" in text or "root:x:" in text:
        return "it tells what is in a file of others"
    return "" if row.says in text else f"it does not say '{row.says}'"


def run(row, kiln, compromised):
    """Runs kiln for a row. Returns its exit code, its seconds, the problems and its output."""
    with tempfile.TemporaryDirectory(prefix="kiln-hostile-") as place:
        place = pathlib.Path(os.path.realpath(place))
        root = place / "root"
        (root / "out").mkdir(parents=True)
        (place / "cache").mkdir()
        (place / "secret.txt").write_text(paths.SECRET)
        command = row.make(root)
        before = snapshot(place)
        trace = place / "cache" / "trace"
        environment = dict(os.environ, XDG_CACHE_HOME=str(place / "cache"), **{
            key: value.replace("COMPROMISED", str(compromised)) if key == "KILN_LIBEXEC_DIR" else value
            for key, value in row.environment.items()})
        stop = threading.Event()
        beside = threading.Thread(target=row.meanwhile, args=(root, stop)) if row.meanwhile else None
        if beside:
            beside.start()
        start = time.monotonic()
        try:
            done = subprocess.run(
                ["strace", "-f", "-qq", "-s", "300", "-e", "trace=%file,%network", "-o", str(trace), str(kiln), *command],
                cwd=root, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                timeout=60 + row.seconds)
            code, output = done.returncode, done.stdout
        except subprocess.TimeoutExpired:
            code, output = None, b"it hangs"
        seconds = time.monotonic() - start
        stop.set()
        if beside:
            beside.join()
        problems = []
        if code not in row.codes:
            problems.append(f"exit code {code}, not {' or '.join(map(str, row.codes))}")
        if seconds > row.seconds * float(os.environ.get("KILN_TEST_TIMEOUT_SCALE", "1")):
            problems.append(f"{seconds:.1f} s, allowed are {row.seconds} s")
        problems.append(said_well(row, code, output))
        written = {k: v for k, v in snapshot(place).items()
                   if not k.startswith(("cache", "root/out")) and before.get(k) != v and not row.meanwhile}
        if written.keys() - {"root"} or not set(before) <= set(snapshot(place)):
            problems.append(f"it wrote {sorted(written)}")
        if list(root.glob("out/*.tmp")) + list(root.glob("out/.*")):
            problems.append("it left something half-written")
        if os.path.exists("/tmp/kiln-compromised"):
            problems.append("the decoder got out")
        allowed = COMMON + (str(root), str(place / "cache"), str(kiln), str(kiln.parent / "libexec"), str(compromised),
)
        problems += outside(trace, str(root), allowed)[:3]
        return code, seconds, [p for p in problems if p], output


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--smoke", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("kiln")
    parser.add_argument("compromised")
    parser.add_argument("kinds", nargs="*")
    given = parser.parse_args()
    kiln = pathlib.Path(os.path.realpath(given.kiln))
    compromised = pathlib.Path(os.path.realpath(given.compromised))
    failed = count = 0
    for row in [*paths.rows(), *pictures.rows(), *meshes.rows(), *texts.rows()]:
        if (given.kinds and row.kind not in given.kinds) or (given.smoke and not row.smoke):
            continue
        count += 1
        if given.list:
            print(f"{row.kind:10} {row.name}")
            continue
        code, seconds, problems, output = run(row, kiln, compromised)
        print(f"{row.kind:9} {row.name[:40]:40} {code!s:>4} {seconds:6.2f} s  {'; '.join(problems)}", flush=True)
        if problems:
            failed += 1
            print("    said: " + ascii(output.decode(errors="replace"))[:600])
    print(f"{count} inputs, {failed} of them not as they should be")
    return failed > 0 or count == 0


sys.exit(main())
