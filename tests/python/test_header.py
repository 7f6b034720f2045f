"""Checks that the Python module has the structs, defaults and functions of the C headers.

If these fail, the module passes wrong values to the library, or reads wrong ones, without an error.
"""
import os
import subprocess
import sys

import pytest

import kiln
from kiln import _abi, _header
from conftest import TREE

ffi = _abi.ffi
COMPILER = os.environ.get("CC", "cc")


def structs():
    names = [name for name in ffi.list_types()[1] if name.startswith("kiln_")]
    return [ffi.typeof(f"struct {name}") for name in names]


def test_structs_have_the_layout_of_the_compiler(tmp_path):
    """Compares the size of every struct and the offset of every member with the C compiler's.

    At the end, a wrong offset is planted, which the compiler must refuse.
    """
    lines, members = ['#include <kiln.h>', '#include <stddef.h>'], 0
    for struct in structs():
        if struct.fields is None:
            continue  # an opaque struct, of which the header has only pointers
        name = struct.cname
        lines.append(f'_Static_assert(sizeof({name}) == {ffi.sizeof(struct)}, "{name}");')
        for member, field in struct.fields:
            members += 1
            lines.append(f'_Static_assert(offsetof({name}, {member}) == {field.offset}, "{name} {member}");')
    assert len(lines) > 25 and members > 200
    source = tmp_path / "layout.c"
    source.write_text("\n".join(lines))
    subprocess.run([COMPILER, "-fsyntax-only", f"-I{TREE}/lib", source], check=True)
    source.write_text("\n".join(lines).replace("offsetof(struct kiln_error, message) == ",
                                               "offsetof(struct kiln_error, message) == 1"))
    wrong = subprocess.run([COMPILER, "-fsyntax-only", f"-I{TREE}/lib", source], capture_output=True, text=True)
    assert "kiln_error message" in wrong.stderr


def test_defaults_are_those_of_the_inline_functions(tmp_path):
    """Compares the defaults with those of the C functions, by a program that prints differences."""
    functions = {"kiln_render_params": "kiln_render_defaults", "kiln_compare_params": "kiln_compare_defaults",
                 "kiln_encode_params": "kiln_encode_defaults", "kiln_plan_params": "kiln_plan_defaults",
                 "kiln_export_params": "kiln_export_defaults"}
    assert {name for name, values in _header.DEFAULTS.items() if values} == functions.keys()
    checks = []
    for struct, function in functions.items():
        for member, value in _header.DEFAULTS[struct].items():
            expected = f'strcmp({function}().{member}, "{value}") == 0' if isinstance(value, str) else \
                f"{function}().{member} == {value}"
            checks.append(f'if (!({expected})) puts("{struct} {member}");')
    source, program = tmp_path / "defaults.c", tmp_path / "defaults"
    source.write_text("#include <kiln.h>\nint main(void)\n{\n" + "\n".join(checks) + "\nreturn 0;\n}\n")
    subprocess.run([COMPILER, f"-I{TREE}/lib", source, "-o", program], check=True)
    assert subprocess.run([program], check=True, capture_output=True, text=True).stdout == ""
    assert len(checks) >= 9


def test_every_function_is_there():
    from kiln._library import lib
    names = [name for name in dir(lib) if name.startswith("kiln_")]
    assert len(names) > 40
    for name in names:
        getattr(lib, name)  # AttributeError: the library does not export it


def generate(header, folder):
    return subprocess.run([sys.executable, f"{TREE}/python/generate.py", COMPILER, "libkiln.so.0", header, folder],
                          capture_output=True, text=True)


@pytest.mark.parametrize("addition, message", [
    ("static inline struct kiln_odd kiln_odd_defaults(void)\n"
     "{\n struct kiln_odd params;\n params.a = other();\n return params;\n}\n",
     "kiln_odd_defaults: cannot read 'params.a = other()'"),
    ("static inline int kiln_twice(int a)\n{\n return 2 * a;\n}\n", "neither declared nor read"),
])
def test_a_header_that_is_not_understood_ends_the_build(tmp_path, addition, message):
    header = tmp_path / "odd.h"
    header.write_text("struct kiln_odd { unsigned long size; int a; };\n" + addition)
    done = generate(header, tmp_path)
    assert done.returncode != 0 and message in done.stderr
    assert not (tmp_path / "_abi.py").exists() and not (tmp_path / "_header.py").exists()


def imported(library):
    environment = dict(os.environ, KILN_LIBRARY=str(library))
    return subprocess.run([sys.executable, "-c", "import kiln; print(kiln.version())"], env=environment,
                          capture_output=True, text=True)


@pytest.mark.parametrize("version, works", [("0.0.9", False), (kiln.__version__, True), ("99.0.1", True)])
def test_an_older_library_is_refused(tmp_path, version, works):
    source, library = tmp_path / "old.c", tmp_path / "libold.so"
    source.write_text(f'const char *kiln_version(void) {{ return "{version}"; }}\n')
    subprocess.run([COMPILER, "-shared", "-fPIC", source, "-o", library], check=True)
    done = imported(library)
    if works:
        assert done.stdout == f"{version}\n", done.stderr
    else:
        assert f"{library} is kiln 0.0.9, and this module was made for {kiln.__version__} or later" in done.stderr


def test_a_library_that_is_not_there_is_named(tmp_path):
    done = imported(tmp_path / "none.so")
    assert "ImportError: kiln's library cannot be used" in done.stderr and "KILN_LIBRARY" in done.stderr
