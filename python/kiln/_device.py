"""Lists the devices that kiln can draw on, and opens them."""
from __future__ import annotations

import threading
import weakref
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Optional, Union

from ._library import Failure, Struct, ffi, lib, owned, text


@dataclass(frozen=True)
class DeviceInfo:
    """Facts of a device."""

    index: int
    name: str
    gl: bool
    """False for the device "cpu", which every machine has and which makes the same pixels everywhere."""
    usable: bool
    software: bool
    """True if the device draws on the processor."""
    exact: bool
    """True if the device passed the exactness probe, so that it may simulate."""
    platform: str
    problem: str
    """Why the device is not usable and what mends that; "" when it is usable."""


def _info(found: Any) -> DeviceInfo:
    return DeviceInfo(index=found.index, name=text(found.name), gl=found.gl, usable=found.usable,
                      software=found.software, exact=found.exact, platform=text(found.platform),
                      problem=text(found.problem))


def devices() -> list[DeviceInfo]:
    """Returns the devices of this machine; "cpu" is the first one."""
    room = 16
    while True:
        infos = ffi.new("struct kiln_device_info[]", room)
        size = ffi.sizeof(infos[0])
        for info in infos:
            info.size = size
        count = lib.kiln_device_list(infos, size, room, ffi.new("char[256]"))
        if count <= room:
            return [_info(infos[index]) for index in range(count)]
        room = count


class Device:
    """A device to draw on. Use it as a context manager, or close it.

    `wanted` is "cpu", an index into :func:`kiln.devices`, "software" (the first device with OpenGL that draws on
    the processor), or a part of a device's name. None takes the first GPU, or "cpu" if there is none; with `gl`,
    None takes only a device with OpenGL, if need be the software one. A device belongs to the thread that opened
    it.
    """

    def __init__(self, wanted: Union[str, int, None] = None, *, gl: bool = False, debug: bool = False) -> None:
        params = Struct("kiln_device_params")
        params.set("wanted", None if wanted is None else str(wanted))
        params.set("gl", gl)
        params.set("debug", debug)
        params.set_log()
        failure = Failure()
        pointer = lib.kiln_device_open(params.pointer, failure.pointer)
        if not pointer:
            raise failure.exception()
        self._params = params
        self._thread = threading.get_ident()
        self._renderings: "weakref.WeakSet[Any]" = weakref.WeakSet()
        self._open: Optional[Any] = owned(pointer, "kiln_device")
        self._info = _info(lib.kiln_device_get_info(pointer)[0])

    @property
    def info(self) -> DeviceInfo:
        """Facts of the device."""
        return self._info

    @property
    def _pointer(self) -> Any:
        if self._open is None:
            raise ValueError("the device is closed")
        if threading.get_ident() != self._thread:
            raise ValueError("the device belongs to another thread: open one in each")
        return self._open

    def close(self) -> None:
        """Closes the device. Closing it twice does nothing. A device on which a job runs cannot be closed."""
        if self._open is None:
            return
        if any(rendering._job[0] for rendering in self._renderings):
            raise ValueError("a job still runs on the device: close that first")
        ffi.release(self._open)
        self._open = None

    def __enter__(self) -> "Device":
        return self

    def __exit__(self, kind: Optional[type[BaseException]], value: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<kiln.Device {self._info.name!r}{', closed' if self._open is None else ''}>"


__all__ = ["Device", "DeviceInfo", "devices"]
