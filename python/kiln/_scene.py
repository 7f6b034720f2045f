"""Loads and parses scenes, and gives facts of them."""
from __future__ import annotations

import json
import os
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Mapping, Optional, Union

from ._library import (Cancel, Failure, Overrides, PathLike, Struct, Watch, ffi, lib, owned, pairs, path_bytes,
                       set_watch, text)


@dataclass(frozen=True)
class SceneInfo:
    """Facts of a scene, for a caller that plans a job."""

    width: int
    """The width of a frame in pixels."""
    height: int
    """The height of a frame in pixels."""
    frames: int
    fps: Fraction
    """The number of frames a second."""
    steps_per_frame: int
    warmup_steps: int
    steps: int
    """The number of steps up to the last frame of the clip, warm-up included."""
    systems: int
    """The number of particle systems."""
    particle_capacity: int
    """The number of slots for particles, over all systems."""
    memory_bytes: int
    """The memory that rendering on the device "cpu" is expected to take."""
    hash: str
    """The SHA-256 of the scene with every default and of its textures, in hex."""


@dataclass(frozen=True)
class Param:
    """A parameter of a scene, for a program that asks people for its value."""

    name: str
    kind: str
    """"number", "integer", "color", "vector", "choice", "switch", "text" or "file"."""
    value: Any
    """The value that the scene was loaded with. Numbers are in `unit`; angles are texts such as "45 deg"."""
    default: Any
    unit: str
    """The unit of its numbers, such as "s"; "" for none."""
    min: Optional[float]
    max: Optional[float]
    words: tuple[str, ...]
    """The words of a choice."""
    help: str
    place: str
    """Where it is declared, as in "scene.yaml:3:3"."""
    schema: Mapping[str, Any]
    """The JSON schema of its values."""


def _param(found: Any) -> Param:
    return Param(name=text(found.name), kind=text(lib.kiln_param_kind_name(found.kind)),
                 value=json.loads(text(found.value)), default=json.loads(text(found.fallback)),
                 unit=text(found.unit), min=found.min if found.has_min else None,
                 max=found.max if found.has_max else None,
                 words=tuple(text(found.words[index]) for index in range(found.word_count)),
                 help=text(found.help), place=text(found.place), schema=json.loads(text(found.schema)))


def _values(params: Optional[Mapping[str, Any]]) -> list[str]:
    """Returns the overrides that give parameters their values."""
    return [f"params.{name}={json.dumps(value)}" for name, value in (params or {}).items()]


class Scene:
    """A scene. :func:`kiln.load` and :func:`kiln.parse` make it, and it does not change afterwards.

    Any threads may use it at the same time.
    """

    def __init__(self, source: "_Source", overrides: list[str], cancel: Optional[Cancel]) -> None:
        self._source = source
        self._overrides = overrides
        self._watch = Watch()
        self._params = Struct("kiln_scene_params")
        self._params.set("asset_root", source.asset_root)
        self._params.set_texts("overrides", "override_count", overrides)
        set_watch(self._params, self._watch, cancel)
        self._params.set("budget", source.budget())
        failure = Failure()
        pointer = source.load(self._params, failure)
        if not pointer:
            self._watch.raise_kept()
            raise failure.exception()
        self._pointer: Any = owned(pointer, "kiln_scene", self._params)
        self._watch.raise_kept()

    def override(self, overrides: Overrides = (), *, params: Optional[Mapping[str, Any]] = None,
                 cancel: Optional[Cancel] = None) -> "Scene":
        """Returns a scene with other values: reads the file or the text once more, and applies these overrides after
        those that this scene has. `params` gives parameters values, as in :func:`kiln.load`."""
        return Scene(self._source, self._overrides + _values(params) + pairs(overrides, "overrides"), cancel)

    @property
    def params(self) -> tuple[Param, ...]:
        """The parameters that the scene declares, in their order."""
        count = lib.kiln_scene_list_params(self._pointer, ffi.NULL, 0, 0)
        found = ffi.new("struct kiln_scene_param[]", count + 1)
        size = ffi.sizeof(found[0])
        for entry in found:
            entry.size = size
        lib.kiln_scene_list_params(self._pointer, found, size, count)
        return tuple(_param(found[index]) for index in range(count))

    @property
    def name(self) -> str:
        """The path of the scene file, or the name that :func:`kiln.parse` was given."""
        return self._source.name

    @property
    def overrides(self) -> tuple[str, ...]:
        """The overrides, "key=value", in the order in which they were applied."""
        return tuple(self._overrides)

    @property
    def info(self) -> SceneInfo:
        """Size, frames, rate and other facts of the scene."""
        info = Struct("kiln_scene_info")
        lib.kiln_scene_get_info(self._pointer, info.pointer)
        found = info.pointer
        return SceneInfo(width=found.width, height=found.height, frames=found.frames,
                         fps=Fraction(found.fps_num, found.fps_den), steps_per_frame=found.steps_per_frame,
                         warmup_steps=found.warmup_steps, steps=found.steps, systems=found.system_count,
                         particle_capacity=found.particle_capacity, memory_bytes=found.memory_bytes,
                         hash=text(found.hash))

    def text(self) -> str:
        """Returns the scene as a scene file with every default spelled out; the file loads to the same scene."""
        length = lib.kiln_scene_text(self._pointer, ffi.NULL, 0)
        room = ffi.new("char[]", length + 1)
        if length == 0 or lib.kiln_scene_text(self._pointer, room, length + 1) != length:
            raise MemoryError("no memory for the text of a scene")
        return text(room)

    def __repr__(self) -> str:
        return f"<kiln.Scene {self.name!r}>"


class _Source:
    """The origin of a scene, from which it can be read again with other overrides."""

    def __init__(self, name: str, content: Optional[bytes], asset_root: Optional[PathLike],
                 limits: Optional[str]) -> None:
        self.name = name
        self.content = content
        self.asset_root = asset_root
        self.limits = limits

    def budget(self) -> Any:
        if self.limits is None:
            return None
        limits, failure = Struct("kiln_limits"), Failure()
        if not lib.kiln_limits_parse(limits.pointer, self.limits.encode(), failure.pointer):
            raise failure.exception()
        pointer = lib.kiln_budget_create(limits.pointer)
        if not pointer:
            raise MemoryError("no memory for limits")
        return owned(pointer, "kiln_budget")

    def load(self, params: Struct, failure: Failure) -> Any:
        if self.content is None:
            return lib.kiln_scene_load(path_bytes(self.name), params.pointer, failure.pointer)
        return lib.kiln_scene_parse(self.content, len(self.content), path_bytes(self.name), params.pointer,
                                    failure.pointer)


def load(path: PathLike, overrides: Overrides = (), *, params: Optional[Mapping[str, Any]] = None,
         asset_root: Optional[PathLike] = None, limits: Optional[str] = None,
         cancel: Optional[Cancel] = None) -> Scene:
    """Reads a scene file.

    `overrides` are texts such as "systems.fire.emit.rate=50", applied in order after the file, or a mapping of
    keys to values; a '*' in a key names every entry of a map or list. Textures and meshes lie below `asset_root`,
    by default the folder of the file. `limits` bound the frames, memory, time and other amounts that the scene and
    its jobs may take, as in "frames=1000,memory=4 GiB" or "service"; time counts from this call on. `params` gives
    parameters of the scene values: {"length": 5, "brand": "#e61e28"}. The values may be a stranger's: a text is a
    text, whatever it begins with.

    Raises :class:`kiln.InvalidInput` for a scene that is wrong or does not exist, :class:`kiln.UsageError` for an
    override that is not "key=value", :class:`kiln.OverLimit` and :class:`kiln.FileError`.
    """
    return Scene(_Source(os.fspath(path), None, asset_root, limits), _values(params) + pairs(overrides, "overrides"),
                 cancel)


def parse(content: Union[str, bytes], overrides: Overrides = (), *, params: Optional[Mapping[str, Any]] = None,
          name: str = "scene", asset_root: Optional[PathLike] = None, limits: Optional[str] = None,
          cancel: Optional[Cancel] = None) -> Scene:
    """Does what :func:`load` does, for the text of a scene. `name` stands for the file in messages. Relative paths of
    assets start at `asset_root`, by default the working directory."""
    encoded = content.encode() if isinstance(content, str) else bytes(content)
    return Scene(_Source(name, encoded, asset_root, limits), _values(params) + pairs(overrides, "overrides"), cancel)


__all__ = ["Param", "Scene", "SceneInfo", "load", "parse"]
