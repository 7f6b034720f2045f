"""Opens the shared library, and provides parameters, errors, logs and a way to stop for calls to it.

Only the module itself uses this file. cffi releases the interpreter's lock while it calls the library.
"""
from __future__ import annotations

import logging
import os
import re
import threading
from types import TracebackType
from typing import Any, Callable, Iterable, Mapping, Optional, Union

from . import _abi, _header
from ._errors import Code, Error, error_class

ffi: Any = _abi.ffi
PathLike = Union[str, "os.PathLike[str]"]
Overrides = Union[str, Iterable[str], Mapping[str, Any]]

_log = logging.getLogger("kiln")
_LEVELS = (logging.DEBUG, logging.INFO, logging.WARNING)


def _numbers(version: str) -> tuple[int, ...]:
    return tuple(int(number) for number in re.findall(r"\d+", version)[:3])


def _open() -> Any:
    name = os.environ.get("KILN_LIBRARY") or _header.SONAME
    try:
        library = ffi.dlopen(name)
        found = ffi.string(library.kiln_version()).decode()
    except (OSError, AttributeError) as problem:
        raise ImportError(f"kiln's library cannot be used: {problem}. Install it, or let the variable KILN_LIBRARY "
                          f"name the file {_header.SONAME} of a build") from None
    wanted = _header.TEXTS["VERSION"]
    if _numbers(found) < _numbers(wanted):
        raise ImportError(f"{name} is kiln {found}, and this module was made for {wanted} or later: install a newer "
                          f"library, or the module of {found}")
    return library


lib: Any = _open()


def text(value: Any) -> str:
    """Returns a C text as a str; "" for NULL."""
    if not value:
        return ""
    return str(ffi.string(value).decode("utf-8", "replace"))


def path_bytes(path: PathLike) -> bytes:
    """Returns a path as the library takes it. A zero byte is refused: the library would see a shorter path."""
    encoded = os.fsencode(path)
    if b"\0" in encoded:
        raise ValueError(f"a path with a zero byte: {path!r}")
    return encoded


class Struct:
    """A struct of the header with its size and defaults. It keeps everything alive that its members point to."""

    def __init__(self, name: str) -> None:
        self.pointer: Any = ffi.new(f"struct {name} *")
        self._kept: list[Any] = []
        self.pointer.size = ffi.sizeof(self.pointer[0])
        for member, value in _header.DEFAULTS[name].items():
            self.set(member, value)

    def set(self, member: str, value: Any) -> None:
        """Sets a member. Texts, structs and pointers are kept alive; None becomes NULL."""
        if value is None:
            value = ffi.NULL
        elif isinstance(value, (str, os.PathLike)):
            value = self.keep(ffi.new("char[]", path_bytes(value)))
        elif isinstance(value, Struct):
            value = self.keep(value).pointer
        elif isinstance(value, ffi.CData):
            self.keep(value)
        setattr(self.pointer, member, value)

    def set_texts(self, member: str, count: str, values: Iterable[str]) -> None:
        """Sets a member that is a list of texts, and the member `count` to their number."""
        items = [self.keep(ffi.new("char[]", path_bytes(value))) for value in values]
        setattr(self.pointer, member, self.keep(ffi.new("char *[]", items)))
        setattr(self.pointer, count, len(items))

    def set_log(self) -> None:
        """Sends the library's messages to the logger "kiln"."""
        self.pointer.log.write = self.keep(_write_log)

    def keep(self, thing: Any) -> Any:
        self._kept.append(thing)
        return thing


@ffi.callback("void(void *, enum kiln_log_level, const char *)")  # type: ignore[misc]
def _write_log(user: Any, level: int, line: Any) -> None:
    _log.log(_LEVELS[min(level, len(_LEVELS) - 1)], "%s", text(line))


class Failure:
    """The struct kiln_error that a call fills."""

    def __init__(self) -> None:
        self.struct = Struct("kiln_error")
        self.pointer = self.struct.pointer

    def exception(self) -> Error:
        code = int(self.pointer.code)
        known = Code(code) if code in [member.value for member in Code] else code
        message = text(self.pointer.message).replace("--force replaces it", "overwrite=True replaces it")
        return error_class(code)(known, message)


class Watch:
    """Ends a long call at a signal, or at an exception in a callback.

    The library calls `stop` now and then on the thread that called it. During `stop`, the interpreter runs the
    handlers of signals, and Ctrl-C becomes an exception. An exception cannot pass through C: so it is kept, the
    call ends, and `raise_kept` raises it.
    """

    def __init__(self) -> None:
        self.exception: Optional[BaseException] = None

        def failed(kind: type[BaseException], value: Optional[BaseException],
                   trace: Optional[TracebackType]) -> None:
            self.exception = self.exception or value or kind()

        def asked(user: Any) -> bool:
            return self.exception is not None

        self.stop: Any = ffi.callback("bool(void *)", asked, error=True, onerror=failed)
        self._failed = failed

    def callback(self, signature: str, function: Callable[..., None]) -> Any:
        """Returns a C callback. An exception in it ends the call."""
        return ffi.callback(signature, function, onerror=self._failed)

    def raise_kept(self) -> None:
        kept, self.exception = self.exception, None
        if kept is not None:
            raise kept


class Cancel:
    """A request to stop. Any thread and any signal handler may make it.

    Calls that were given this object then end with :class:`kiln.Interrupted` and leave nothing half-written.
    """

    def __init__(self) -> None:
        pointer = lib.kiln_cancel_create()
        if not pointer:
            raise MemoryError("no memory for a request to stop")
        self._pointer: Any = owned(pointer, "kiln_cancel")

    def request(self) -> None:
        """Asks the calls that were given this object to end."""
        lib.kiln_cancel_request(self._pointer)

    @property
    def requested(self) -> bool:
        """True after :meth:`request` was called."""
        return bool(lib.kiln_cancel_is_requested(self._pointer))

    def __repr__(self) -> str:
        return f"<kiln.Cancel{', requested' if self.requested else ''}>"


_DESTROYERS = {"kiln_cancel": "kiln_cancel_destroy", "kiln_scene": "kiln_scene_destroy",
               "kiln_device": "kiln_device_close", "kiln_frame": "kiln_frame_destroy",
               "kiln_budget": "kiln_budget_destroy"}


def owned(pointer: Any, kind: str, *needed: Any) -> Any:
    """Returns a pointer to a struct whose destroyer is called when Python drops its last reference. The objects
    `needed` live as long as the pointer."""
    destroy = getattr(lib, _DESTROYERS[kind])

    def release(dying: Any, needed: Any = needed) -> None:
        destroy(ffi.new(f"struct {kind} **", dying))

    return ffi.gc(pointer, release)


def set_watch(params: Struct, watch: Watch, cancel: Optional[Cancel]) -> None:
    """Sets parameters so that signals, on the main thread, and `cancel` end the call."""
    if threading.current_thread() is threading.main_thread():
        params.pointer.stop = params.keep(watch).stop
    if cancel is not None:
        params.pointer.cancel = params.keep(cancel)._pointer


def _as_yaml(value: Any, place: str) -> str:
    """Returns a value as YAML. It may be a number or an array of NumPy."""
    import json

    def listed(other: Any) -> Any:
        if hasattr(other, "tolist"):
            return other.tolist()
        raise TypeError(f"{place}: found {other!r}, expected a text, a number, or lists and mappings of these")

    return value if isinstance(value, str) else json.dumps(value, default=listed)


def pairs(values: Union[str, Iterable[str], Mapping[str, Any], None], what: str) -> list[str]:
    """Returns the texts "key=value" of one text, several texts or a mapping. Values of a mapping become YAML."""
    if values is None:
        return []
    if isinstance(values, str):
        return [values]
    if isinstance(values, Mapping):
        return [f"{key}={_as_yaml(value, f'{what}: {key}')}" for key, value in values.items()]
    found = list(values)
    for value in found:
        if not isinstance(value, str):
            raise TypeError(f"{what}: expected texts 'key=value' or a mapping, found {value!r}")
    return found


def version() -> str:
    """Returns the version of the library that is loaded."""
    return text(lib.kiln_version())


__all__ = ["Cancel", "Code", "Error", "Failure", "Overrides", "PathLike", "Struct", "Watch", "ffi", "lib", "owned",
           "pairs", "path_bytes", "set_watch", "text", "version"]
