"""Rows of run.py with hostile scene files, and with a kiln-decode that has been taken over.

The scenes nest too deeply, repeat aliases, have odd names or values, or ask for too much work.
"""
from rows import DEVICE, LIMIT, OK, REFUSED, Row, asset, check, render, scene, text_row, write

SYSTEM = "systems: {a: {emit: {rate: 9, life: 1 s}}}\n"


def scenes():
    billion = "a0: &a0 [x,x,x,x,x,x,x,x,x]\n" + "".join(
        f"a{i}: &a{i} [{','.join([f'*a{i - 1}'] * 9)}]\n" for i in range(1, 12))
    texts = {
        "aliases": "kiln: 1\n" + billion, "anchor of itself": "kiln: 1\na: &a [*a]\n" + SYSTEM,
        "merge": "kiln: 1\nb: &b {<<: *b}\n" + SYSTEM, "nested lists": "kiln: 1\nsystems: " + "[" * 100000,
        "nested mappings": "kiln: 1\nsystems: " + "{a: " * 50000, "nested indents": "".join(" " * i + "a:\n" for i in range(3000)),
        "empty": "", "binary": bytes(range(256)), "zeros": bytes(100000), "large": b"#" * (5 << 20),
        "not UTF-8": b"kiln: 1\nsystems: {\xff\xfe: 1}\n", "tags": "kiln: !!python/object:os.system 1\n",
        "documents": "kiln: 1\n---\nkiln: 1\n", "blank lines": "a: |\n" + " \n" * 160000, "tabs": "kiln:\t1\n\tsystems:\n", "version": "kiln: 99\n" + SYSTEM,
        "name": 'kiln: 1\nsystems: {"\\e]0;owned\\a": {emit: {rate: 9}}}\n', "long name": f"kiln: 1\nsystems: {{{'a' * 100000}: 1}}\n",
        "override": 'kiln: 1\nsystems: {"\\u202egnp": {emit: {rate: 9}}}\n', "same name": "kiln: 1\nsystems: {a: {}, a: {}}\n",
        "rate": "kiln: 1\nsystems: {a: {emit: {rate: 1e300, life: 1e300 s}}}\n", "not a number": "kiln: 1\nsystems: {a: {emit: {rate: .nan}}}\n",
        "infinite": "kiln: 1\nsystems: {a: {emit: {rate: .inf}}}\n", "negative": "kiln: 1\nsystems: {a: {emit: {rate: -9}}}\n",
        "overflow": "kiln: 1\noutput: {frames: 99999999999999999999}\n" + SYSTEM,
        "systems": "kiln: 1\nsystems: {" + ", ".join(f"s{i}: {{emit: {{rate: 1}}}}" for i in range(3000)) + "}\n",
        "objects": "kiln: 1\nbackdrop: {objects: [" + ", ".join(["{sphere: {radius: 1}}"] * 5000) + "]}\n" + SYSTEM,
        "include of itself": "kiln: 1\ninclude: s.yaml\n", "include of a device": "kiln: 1\ninclude: /dev/zero\n",
        "include from outside": "kiln: 1\ninclude: [../../etc/passwd]\n", "use of itself": "kiln: 1\nsystems: {a: {use: b}, b: {use: a}}\n",
        "parameter of itself": "kiln: 1\nparams: {a: {number: $b}, b: {number: '= 2 * $a'}}\n",
        "parameter out of the root": "kiln: 1\nparams: {a: {file: ../../etc/passwd}}\n",
        "deep arithmetic": "kiln: 1\nseed: '= " + "(" * 100000 + "'\n", "long arithmetic": "kiln: 1\nseed: '= 1" + " + 1" * 500000 + "'\n",
        "endless arithmetic": "kiln: 1\nseed: '= 1e308 * 1e308 - 1e308 * 1e308'\n", "division by zero": "kiln: 1\nseed: '= 1 / 0'\n",
        "long clip": "kiln: 1\noutput: {duration: 1e300 s}\n" + SYSTEM,
        "rate of frames": "kiln: 1\noutput: {fps: 1/4294967295}\n" + SYSTEM, "size": "kiln: 1\noutput: {size: [0, 0]}\n" + SYSTEM,
    }
    for label, text in texts.items():
        yield text_row("scenes", label, text, smoke=label in ("aliases", "nested lists", "name"))
    service = lambda: check("--limits", "service")
    large = "kiln: 1\noutput: {size: [16384, 16384], frames: 1000000}\n" + SYSTEM
    yield text_row("scenes", "two years of work", large, LIMIT, service, smoke=True)
    yield text_row("scenes", "many particles", "kiln: 1\nsystems: {a: {emit: {rate: 10000000, life: 2 s}}}\n", LIMIT + REFUSED, service)
    yield text_row("scenes", "frames of a service", "kiln: 1\noutput: {frames: 1000000}\n" + SYSTEM, LIMIT, service)
    slow = "kiln: 1\noutput: {size: [4096, 4096], frames: 1000}\n" + SYSTEM
    yield text_row("scenes", "a deadline", slow, LIMIT, lambda: render("--timeout", "1"), seconds=4)
    yield text_row("scenes", "a deadline in a sandbox", slow, LIMIT, lambda: render("--timeout", "1", "--sandbox"), seconds=4)
    yield text_row("scenes", "little output", slow.replace("4096", "256"), LIMIT, lambda: render("--limits", "output=10 KiB"))
    yield text_row("scenes", "little memory", slow, LIMIT, lambda: check("--limits", "memory=16 MiB"))


PNG = bytes.fromhex("89504e470d0a1a0a0000000d49484452000000010000000108020000009077"
                    "53de0000000c4944415408d763f8cfc000000301010018dd8db00000000049454e44ae426082")
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def decoder(how, use="atlas", codes=REFUSED, command=check, says="", smoke=False, **more):
    """Returns a row whose kiln-decode is compromised.c, which misbehaves in the way `how`."""
    name, data = ("a.obj", OBJ) if use == "mesh" else ("a.png", PNG)
    row = asset("decoder", use, how, name, data, codes, command, says=says, smoke=smoke, **more)
    row.environment = {"KILN_COMPROMISED": how, "KILN_LIBEXEC_DIR": "COMPROMISED"}
    return row


def decoders():
    yield decoder("attempts", says="worked: and 14 were tried", smoke=True)
    for use in ("mesh", "floor"):
        yield decoder("attempts", use, says="worked: and 14 were tried")
    yield decoder("attempts", command=lambda: check("--sandbox"), says="worked: and 14 were tried")
    for how in ("huge", "overflow", "largest", "nothing", "type", "channels", "nan", "infinite", "short", "crash", "what", "other",
                "endless-text", "escapes", "no-error", "wrong-code", "over"):
        yield decoder(how, smoke=how in ("huge", "short"))
    yield decoder("warning", "floor", codes=OK, says="warning: s.yaml:3:27: backdrop.floor.image: 'a.png': \\x1b]0;x", smoke=True)
    for how in ("silent", "busy"):
        yield decoder(how, codes=LIMIT, command=lambda: check("--timeout", "1"), seconds=4, smoke=how == "silent")
    yield decoder("version", codes=DEVICE)
    for how in ("wants", "wants-deaf", "wants-secret", "vertices", "no-triangles", "beyond", "far", "no-place", "no-normal", "crash", "short"):
        yield decoder(how, "mesh", smoke=how == "beyond")
    yield decoder("sound", "mesh", codes=OK)


def rows():
    return [*scenes(), *decoders()]
