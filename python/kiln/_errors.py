"""Defines the exceptions of the module, which have the codes of kiln.h."""
from __future__ import annotations

import enum
from typing import Union

from . import _abi

_PREFIX = "KILN_"


def _codes() -> dict[str, int]:
    names = _abi.ffi.typeof("enum kiln_code").relements
    return {name[len(_PREFIX):]: value for name, value in names.items()}


class Code(enum.IntEnum):
    """Kinds of errors: the values of `enum kiln_code`, which are also the exit codes of the program kiln."""

    OK = 0
    FRAME_FAILED = 1
    USAGE = 2
    INVALID_INPUT = 3
    NO_DEVICE = 4
    DEVICE_FAILED = 5
    IO = 6
    GOLDEN_MISSING = 7
    OVER_LIMIT = 8
    READER_GONE = 9
    INTERRUPTED = 130


if _codes() != {code.name: code.value for code in Code}:
    raise ImportError("kiln.Code does not have the codes of kiln.h")


class Error(Exception):
    """A call failed. `str` gives the place, what was found there and what is allowed.

    `code` is a :class:`Code`, or a plain number if a newer library has a code that this module does not know.
    """

    code: Union[Code, int]

    def __init__(self, code: Union[Code, int], message: str) -> None:
        super().__init__(message)
        self.code = code

    def __reduce__(self) -> tuple[type["Error"], tuple[Union[Code, int], str]]:
        return type(self), (self.code, str(self))


class UsageError(Error, ValueError):
    """The request makes no sense, or an output is there already (`Code.USAGE`)."""


class InvalidInput(Error, ValueError):
    """A scene, a texture or another input file is wrong (`Code.INVALID_INPUT`)."""


class DeviceError(Error, RuntimeError):
    """There is no usable device, or it failed (`Code.NO_DEVICE`, `Code.DEVICE_FAILED`)."""


class FileError(Error):
    """Reading or writing failed (`Code.IO`)."""


class OverLimit(Error):
    """The job takes more than its limits allow (`Code.OVER_LIMIT`)."""


class Interrupted(Error):
    """The caller asked to stop (`Code.INTERRUPTED`)."""


_CLASSES: dict[int, type[Error]] = {
    Code.USAGE: UsageError,
    Code.INVALID_INPUT: InvalidInput,
    Code.NO_DEVICE: DeviceError,
    Code.DEVICE_FAILED: DeviceError,
    Code.IO: FileError,
    Code.OVER_LIMIT: OverLimit,
    Code.INTERRUPTED: Interrupted,
}


def error_class(code: int) -> type[Error]:
    """Returns the class of exceptions for a code."""
    return _CLASSES.get(code, Error)
