"""kiln: particle effects from scene files, drawn without a display.

    import kiln

    scene = kiln.load("fire.yaml", {"systems.fire.emit.rate": 50})
    for frame in kiln.render(scene, size=(320, 180)):
        print(frame.number, frame.alive, frame.pixels.mean())
    kiln.render_to(scene, "fire.mp4")

The module calls the library libkiln.so.0, or the file that the environment variable KILN_LIBRARY names. Calls
release the interpreter's lock, so other threads run while a frame is drawn. Messages go to the logger "kiln".
Calls that fail raise :class:`kiln.Error` or one of its subclasses.
"""
from . import _header
from ._bake import BakeStats, SavedState, bake
from ._compare import ComparedFrame, ComparedLayer, Comparison, Metric, compare
from ._device import Device, DeviceInfo, devices
from ._errors import Code, DeviceError, Error, FileError, Interrupted, InvalidInput, OverLimit, UsageError
from ._library import Cancel, version
from ._picture import write_picture
from ._render import Frame, Progress, Rendering, Stats, render, render_to
from ._scene import Param, Scene, SceneInfo, load, parse

__version__: str = _header.TEXTS["VERSION"]
DEFAULT_LIMITS: str = _header.TEXTS["COMPARE_DEFAULT_LIMITS"]
"""The limits that :func:`kiln.compare` uses when the caller gives none."""

__all__ = [
    "DEFAULT_LIMITS", "BakeStats", "Cancel", "Code", "ComparedFrame", "Comparison", "Device", "DeviceError",
    "DeviceInfo", "Error", "FileError", "Frame", "Interrupted", "InvalidInput", "Metric", "OverLimit", "Param",
    "Progress", "Rendering", "SavedState", "Scene", "SceneInfo", "Stats", "UsageError", "bake", "compare", "devices", "load",
    "parse", "render", "render_to", "version", "write_picture",
]
