"""Provides the fixture `assert_looks_like` to pytest, which compares a picture with a golden one.

    def test_fire(assert_looks_like):
        frame = next(kiln.render(kiln.load("fire.yaml"), frames=60, device="cpu"))
        assert_looks_like(frame.pixels, "golden/fire.png")

A test whose golden is missing fails; `pytest --kiln-update` writes goldens that are missing or look different. The
module kiln is imported when the fixture is called, so other test runs do not wait for it.
"""
from __future__ import annotations

import hashlib
import os
import re
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import pytest

if TYPE_CHECKING:
    from kiln._compare import Comparison, Picture

_written: "pytest.StashKey[list[str]]" = pytest.StashKey()


class AssertLooksLike(Protocol):
    """The type of the fixture."""

    def __call__(self, picture: "Picture", golden: "str | os.PathLike[str]", **options: Any) -> "Comparison":
        """Fails the test unless the picture looks like the golden one.

        `picture` is an array (as for kiln.write_picture) or a path. `golden` is a path; a relative one starts at the
        folder of the test. `options` are those of kiln.compare: limits, masks, layer, mode and so on.
        """


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("kiln", "pictures of kiln")
    group.addoption("--kiln-update", action="store_true",
                    help="write golden pictures that are missing or look different")
    group.addoption("--kiln-results", metavar="FOLDER", default="out/kiln",
                    help="where pictures of failures go (default: out/kiln)")


def pytest_configure(config: pytest.Config) -> None:
    none: list[str] = []
    config.stash[_written] = none


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    for path in config.stash[_written]:
        terminalreporter.write_line(f"kiln: wrote {path}")


def _shown(path: "str | os.PathLike[str]") -> str:
    """Returns a path for messages: relative to the working directory, if it is below that."""
    relative = os.path.relpath(path)
    return os.fspath(path) if relative.startswith("..") else relative


def _folder_of(test: str) -> str:
    """Returns the name of a test's own folder, from the test's id. If the name drops characters of the id, a digest
    keeps it apart from the names of other tests."""
    plain = test.replace("/", ".").replace(".py::", ".").replace("::", ".")
    name = re.sub(r"[^\w.\[\]-]+", "_", plain)
    return name if name == plain else f"{name}.{hashlib.sha256(test.encode()).hexdigest()[:8]}"


class _Judge:
    """Compares the pictures of one test with their goldens: the fixture's value."""

    def __init__(self, request: pytest.FixtureRequest) -> None:
        self.config = request.config
        self.folder = request.path.parent
        self.results = Path(self.config.getoption("--kiln-results"), _folder_of(request.node.nodeid))
        self.cleared = False

    def update(self, picture: "Picture", golden: Path) -> None:
        import kiln

        if isinstance(picture, (str, os.PathLike)):
            golden.parent.mkdir(parents=True, exist_ok=True)
            beside = golden.with_name(f".{golden.name}.new")
            shutil.copyfile(picture, beside)
            os.replace(beside, golden)
        else:
            kiln.write_picture(golden, picture, overwrite=True)
        self.config.stash[_written].append(_shown(golden))

    def keep(self, picture: "Picture", golden: Path) -> Path:
        """Returns the path of a picture that failed; writes an array into a file among the results first."""
        import kiln

        if isinstance(picture, (str, os.PathLike)):
            return Path(picture)
        path = self.place(golden)
        kiln.write_picture(path, picture, overwrite=True)
        return path

    def place(self, golden: Path) -> Path:
        """Returns the path among the results that a golden has below the folder of the test."""
        inside = golden.is_relative_to(self.folder) and ".." not in golden.parts
        return self.results / (golden.relative_to(self.folder) if inside else golden.name)

    def __call__(self, picture: "Picture", golden: "str | os.PathLike[str]", **options: Any) -> "Comparison":
        __tracebackhide__ = True
        import kiln

        path = self.folder / golden
        if not self.cleared and self.results.is_dir():
            shutil.rmtree(self.results)
        self.cleared = True
        update = self.config.getoption("--kiln-update")
        if not path.exists():
            if not update:
                kept = self.keep(picture, path)
                pytest.fail(f"there is no golden picture {_shown(path)}\npicture: {_shown(kept)}\n"
                            "look at it, and accept it by pytest --kiln-update", pytrace=False)
            self.update(picture, path)
        place = self.place(path)
        diff = place.with_name(f"{path.stem}_differences.png")
        result = kiln.compare(path, picture, diff=diff, overwrite=True, **options)
        if not result.same and update:
            self.update(picture, path)
            result = kiln.compare(path, picture, diff=diff, overwrite=True, **options)
        if result.same:
            diff.unlink(missing_ok=True)
            for folder in (diff.parent, *diff.parent.parents):
                if folder.is_relative_to(self.results) and folder.is_dir() and not any(folder.iterdir()):
                    folder.rmdir()
            return result
        lines = [f"the picture does not look like {_shown(path)}", str(result),
                 f"picture: {_shown(self.keep(picture, path))}"]
        if diff.exists():
            lines.append(f"golden, picture and error map: {_shown(diff)}")
        pytest.fail("\n".join(lines), pytrace=False)


@pytest.fixture
def assert_looks_like(request: pytest.FixtureRequest) -> AssertLooksLike:
    """Fails a test whose picture does not look like a golden one; see kiln's docs/python.md."""
    return _Judge(request)
