#!/usr/bin/env python3
"""generate.py CC SONAME HEADER FOLDER: writes the two files of the module kiln that depend on the C header.

FOLDER/_abi.py has the declarations of kiln.h and of the headers beside it, compiled by cffi. FOLDER/_header.py
has the parts that cffi does not keep: texts that are macros, and the values that the inline functions
*_defaults() give to members. Both are written from the header alone, so the module cannot drift from it. A line
that this script does not understand ends the build.
"""
import os
import re
import subprocess
import sys

import cffi


def preprocess(compiler, header):
    """Returns the preprocessed lines of the header and of the headers beside it, without those of the system."""
    folder = os.path.dirname(os.path.abspath(header))
    done = subprocess.run([compiler, "-E", os.path.abspath(header)], stdout=subprocess.PIPE, text=True, check=True)
    kept, ours = [], False
    for line in done.stdout.splitlines():
        mark = re.match(r'# \d+ "(.*?)"', line)
        if mark:
            ours = os.path.dirname(mark[1]) == folder
        elif ours and line.strip():
            kept.append(line)
    return re.sub(r'__attribute__\s*\(\(visibility\("default"\)\)\)', "", "\n".join(kept))


def macro_texts(compiler, header):
    """Returns {name: text} of the macros that are texts, such as KILN_VERSION."""
    done = subprocess.run([compiler, "-E", "-dM", os.path.abspath(header)], stdout=subprocess.PIPE, text=True,
                          check=True)
    return dict(re.findall(r'^#define KILN_(\w+) "([^"\\]*)"$', done.stdout, re.M))


def literal(text):
    """Returns the value of a C literal: a text or a number."""
    if text.startswith('"'):
        return text[1:-1]
    return float(text) if "." in text else int(text)


def split_inline(text):
    """Removes the inline functions; returns the declarations that are left, and the values that the functions give
    to members, {struct: {member: value}}."""
    defaults = {}
    pattern = re.compile(r"static inline struct (\w+) (\w+)\(void\)\s*\{(.*?)\}", re.S)
    for struct, name, body in pattern.findall(text):
        values = {}
        for statement in filter(None, (" ".join(part.split()) for part in body.split(";"))):
            value = re.fullmatch(r'params\.(\w+) = ("[^"\\]*"|-?[\d.]+)', statement)
            if value:
                values[value[1]] = literal(value[2])
            elif not re.fullmatch(rf"struct {struct} (empty|params)|memset\(&(empty|params), 0, sizeof \2\)"
                                  r"|(empty|params)\.size = sizeof \3|return (empty|params)", statement):
                sys.exit(f"{name}: cannot read '{statement}'")
        defaults.setdefault(struct, {}).update(values)
    declarations = pattern.sub("", text)
    if re.search(r"\b(static|inline)\b|\{[^}]*return", declarations):
        sys.exit("the header has functions that are neither declared nor read by this script")
    return declarations, defaults


def write(path, text):
    with open(path + ".new", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(path + ".new", path)


def main():
    compiler, soname, header, folder = sys.argv[1:]
    declarations, defaults = split_inline(preprocess(compiler, header))
    texts = macro_texts(compiler, header)
    ffi = cffi.FFI()
    ffi.cdef(declarations)
    for struct, values in defaults.items():
        members = dict(ffi.typeof(f"struct {struct}").fields)
        if "size" not in members or not values.keys() <= members.keys():
            sys.exit(f"struct {struct} does not have the members that its defaults set: {sorted(values)}")
    ffi.set_source("kiln._abi", None)
    target = os.path.join(folder, "_abi.py")
    ffi.emit_python_code(target + ".new")
    os.replace(target + ".new", target)
    write(os.path.join(folder, "_header.py"),
          '"""What kiln.h says beside its declarations; python/generate.py writes it."""\n'
          "from typing import Any\n\n"
          f"SONAME = {soname!r}\n"
          f"TEXTS: dict[str, str] = {texts!r}\n"
          f"DEFAULTS: dict[str, dict[str, Any]] = {defaults!r}\n")


if __name__ == "__main__":
    main()
