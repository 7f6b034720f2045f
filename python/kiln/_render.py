"""Renders jobs: draws frames one after another into arrays or files."""
from __future__ import annotations

import operator
import threading
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Callable, Iterable, Iterator, Mapping, Optional, Union

from ._device import Device
from ._library import (Cancel, Failure, PathLike, Struct, Watch, ffi, lib, owned, pairs, set_watch, text)
from ._picture import Array, view
from ._scene import Scene

Frames = Union[int, range, Iterable[int], None]
AnyDevice = Union[Device, str, int, None]


@dataclass(frozen=True)
class Progress:
    """The progress of a job after a frame."""

    frame: int
    """The number of the frame in the clip."""
    done: int
    """The number of frames that this job has drawn."""
    total: int
    """The number of frames that this job draws in all."""
    elapsed_s: float
    """The time since the job began, in seconds."""
    eta_s: Optional[float]
    """The expected time until the job ends, in seconds; None: not known yet."""
    alive: int
    """The number of living particles at the frame."""
    state: Optional[str]
    """The state hash in hex, equal on every device and with every technique; None without `state_hash`."""


@dataclass(frozen=True)
class Stats:
    """Numbers of a finished job."""

    frames: int
    """The number of frames that were drawn."""
    kept: int
    """The number of frames that were there already, for a job with `resume`."""
    steps: int
    """The number of steps that were simulated."""
    setup_s: float
    """The time of making programs, textures and buffers, in seconds."""
    total_s: float
    """The time of the whole job, in seconds."""
    alive: int
    """The number of living particles after the last step."""
    state: str
    """The state hash after the last step, in hex."""
    techniques: Mapping[str, str]
    """The technique of each stage."""
    pass_ms: Mapping[str, float]
    """The time of each pass in milliseconds, summed up over the job."""
    files: int
    """The number of files of the output; 0 without an output."""
    first_file: Optional[str]
    """The path of the first of these files."""


class Frame:
    """A drawn frame.

    Its arrays are the memory that the library drew into, not copies. They are read-only, because an output may be
    encoding them. They stay valid as long as the frame or one of its arrays is referenced, so keeping many frames
    takes much memory. `numpy.array(frame.pixels)` is a copy that can be written.
    """

    def __init__(self, progress: Progress, layers: dict[str, Array]) -> None:
        self.number = progress.frame
        """The number of the frame in the clip."""
        self.progress = progress
        """The progress of the job after this frame."""
        self.layers: Mapping[str, Array] = layers
        """The requested layers, by their names."""

    def _layer(self, name: str) -> Array:
        try:
            return self.layers[name]
        except KeyError:
            raise AttributeError(f"the frame has no layer '{name}': render it with layers=('{name}', ...)") from None

    @property
    def pixels(self) -> Array:
        """The layer "display", with the samples of a PNG: height x width x 4, uint8, or uint16 if `png_bits` is 16;
        sRGB, straight alpha, rows from the top."""
        return self._layer("display")

    @property
    def linear(self) -> Array:
        """The layer "beauty", with the samples of an EXR: height x width x 4, float32, linear, premultiplied."""
        return self._layer("beauty")

    @property
    def alive(self) -> int:
        """The number of living particles at the frame."""
        return self.progress.alive

    @property
    def state(self) -> Optional[str]:
        """The state hash in hex; None for a job without `state_hash`."""
        return self.progress.state

    def __repr__(self) -> str:
        return f"<kiln.Frame {self.number}: {', '.join(self.layers)}>"


def _hash_text(state: Any) -> str:
    return f"{state.lane[0]:08x}{state.lane[1]:08x}"


def _progress(found: Any, has_state: bool) -> Progress:
    return Progress(frame=found.frame, done=found.done, total=found.total, elapsed_s=found.elapsed_s,
                    eta_s=found.eta_s if found.eta_s >= 0 else None, alive=found.alive,
                    state=_hash_text(found.state) if has_state else None)


def _stats(found: Any) -> Stats:
    passes = ffi.typeof("enum kiln_pass").relements["KILN_PASS_COUNT"]
    return Stats(frames=found.frames, kept=found.kept, steps=found.steps, setup_s=found.setup_s,
                 total_s=found.total_s, alive=found.alive, state=_hash_text(found.state),
                 techniques=dict(pair.split("=", 1) for pair in text(found.techniques).split()),
                 pass_ms={text(lib.kiln_pass_name(i)): found.pass_ms[i] for i in range(passes)},
                 files=found.files, first_file=text(found.first_file) or None)


def _ranges(frames: Frames) -> list[tuple[int, int]]:
    """Returns frames as ascending ranges (first, last); [] stands for the whole clip."""
    if frames is None:
        return []
    if isinstance(frames, (str, slice)):
        raise TypeError(f"frames: found {frames!r}, expected a number, range(first, end, step) or numbers")
    numbers = [operator.index(number) for number in (frames if isinstance(frames, Iterable) else [frames])]
    if not numbers:
        raise ValueError("frames: none are asked for")
    ranges: list[tuple[int, int]] = []
    for number in numbers:
        if number < 0:
            raise ValueError(f"frames: found {number}, expected numbers from 0 on")
        if ranges and ranges[-1][1] + 1 == number:
            ranges[-1] = (ranges[-1][0], number)
        else:
            ranges.append((number, number))
    return ranges


def open_for(device: AnyDevice, techniques: list[str]) -> tuple[Device, bool]:
    """Returns the device of a job, and whether the job owns it and has to close it."""
    if isinstance(device, Device):
        return device, False
    if device is None and techniques:
        params = Struct("kiln_render_params")
        params.set_texts("techniques", "technique_count", techniques)
        if lib.kiln_techniques_need_gl(params.pointer.techniques, params.pointer.technique_count):
            return Device(gl=True), True
    return Device(device), True


_EFFORTS = {"fast": "KILN_PNG_FAST", "small": "KILN_PNG_SMALL"}


@dataclass
class _Request:
    """The parameters that render and render_to have in common."""

    output: Optional[PathLike]
    frames: Frames
    states: Optional[PathLike]
    manifest: Optional[PathLike]
    techniques: Union[Mapping[str, str], Iterable[str]]
    threads: int
    overwrite: bool
    resume: bool
    shard: Optional[tuple[int, int]]
    state_hash: bool
    png_bits: Optional[int]
    png_effort: Optional[str]
    exr_bits: Optional[int]
    quality: Optional[int]
    cancel: Optional[Cancel]

    def params(self, watch: Watch) -> Struct:
        params = Struct("kiln_render_params")
        for name in ("output", "states", "manifest", "threads", "overwrite", "resume", "state_hash", "png_bits",
                     "exr_bits", "quality"):
            value = getattr(self, name)
            if value is not None:
                params.set(name, value)
        if self.png_effort is not None:
            if self.png_effort not in _EFFORTS:
                raise ValueError(f"png_effort: found {self.png_effort!r}, expected one of {', '.join(_EFFORTS)}")
            params.set("png_effort", ffi.typeof("enum kiln_png_effort").relements[_EFFORTS[self.png_effort]])
        ranges = _ranges(self.frames)
        params.pointer.ranges = params.keep(ffi.new("struct kiln_frame_range[]", ranges))
        params.pointer.range_count = len(ranges)
        params.set_texts("techniques", "technique_count", pairs(self.techniques, "techniques"))
        if self.shard is not None:
            params.pointer.shard, params.pointer.shards = self.shard
        set_watch(params, watch, self.cancel)
        params.set_log()
        return params


def _sized(scene: Scene, size: Optional[tuple[int, int]]) -> Scene:
    if not isinstance(scene, Scene):
        raise TypeError(f"found {scene!r}, expected a scene, as kiln.load reads it")
    if size is None:
        return scene
    edges: list[int] = [] if isinstance(size, str) or not isinstance(size, Iterable) else list(size)
    if len(edges) != 2:
        raise TypeError(f"size: found {size!r}, expected (width, height)")
    return scene.override({"output.size": [operator.index(edge) for edge in edges]})


class Rendering(Iterator[Frame]):
    """A job that is drawn frame by frame. :func:`kiln.render` makes it, and each iteration draws a frame.

    As a context manager, it ends when the block is left: a clip that has frames left is then given up, and nothing
    half-written stays. A job belongs to the thread that made it.
    """

    def __init__(self, scene: Scene, request: _Request, layers: Iterable[str], device: AnyDevice) -> None:
        self._job: Any = ffi.new("struct kiln_rendering **")  # NULL: not begun, or ended
        self._stats: Optional[Stats] = None
        self._scene = scene
        self._watch = Watch()
        self._layers = [layers] if isinstance(layers, str) else list(layers)
        self._has_state = request.state_hash
        self._params = request.params(self._watch)
        self._params.set_texts("layers", "layer_count", self._layers)
        self._params.pointer.keep_frames = bool(self._layers)
        self._device, self._owns_device = open_for(device, pairs(request.techniques, "techniques"))
        self._device._renderings.add(self)
        failure = Failure()
        try:
            self._begin(failure)
        except BaseException:
            self.close()
            raise
        if not self._job[0]:
            if self._owns_device:
                self._device.close()
            self._raise(failure)

    def _begin(self, failure: Failure) -> None:
        """Begins the job and stores its pointer. A signal's exception may come between any two instructions of the
        interpreter. map begins the job and stores the pointer within one instruction, so no job is left behind."""
        begun = map(lib.kiln_rendering_begin, [self._device._pointer], [self._scene._pointer],
                    [self._params.pointer], [failure.pointer])
        list(map(operator.setitem, [self._job], [0], begun))

    def _raise(self, failure: Failure) -> None:
        self._watch.raise_kept()
        self._scene._watch.raise_kept()
        raise failure.exception()

    def _end(self, failure: Failure) -> bool:
        """Ends the job. Returns False when the library reports an error; the job is ended in any case."""
        if threading.get_ident() != self._device._thread:
            raise ValueError("the job belongs to another thread")
        stats = Struct("kiln_render_stats")
        ok = bool(lib.kiln_rendering_end(self._job, stats.pointer, failure.pointer))  # sets self._job[0] to NULL
        if self._owns_device:
            self._device.close()
        if ok:
            self._stats = _stats(stats.pointer)
        return ok

    def _finish(self) -> None:
        failure = Failure()
        if not self._end(failure):
            self._raise(failure)

    def __iter__(self) -> "Rendering":
        return self

    def __next__(self) -> Frame:
        if not self._job[0]:
            raise StopIteration
        self._device._pointer  # raises an exception on any other thread
        drawn, progress, failure = ffi.new("bool *"), Struct("kiln_progress"), Failure()
        ok = lib.kiln_rendering_next(self._job[0], drawn, progress.pointer, failure.pointer)
        if not ok or self._watch.exception is not None:
            self._end(Failure())
            self._raise(failure)
        if not drawn[0]:
            self._finish()
            raise StopIteration
        return Frame(_progress(progress.pointer, self._has_state), self._take())

    def _take(self) -> dict[str, Array]:
        if not self._layers:
            return {}
        failure = Failure()
        pointer = lib.kiln_rendering_take_frame(self._job[0], failure.pointer)
        if not pointer:
            raise failure.exception()
        frame = owned(pointer, "kiln_frame")
        layers = {}
        for name in self._layers:
            layer = Struct("kiln_frame_layer")
            if not lib.kiln_frame_get_layer(frame, name.encode(), layer.pointer, failure.pointer):
                raise failure.exception()
            layers[name] = view(layer.pointer, frame)
        return layers

    @property
    def stats(self) -> Stats:
        """Numbers of the finished job; an exception before the last frame was drawn."""
        if self._stats is None:
            raise ValueError("the job has not drawn its last frame")
        return self._stats

    def close(self) -> None:
        """Ends the job; a job that has frames left is given up. Closing it twice does nothing."""
        if self._job[0]:
            self._end(Failure())

    def __enter__(self) -> "Rendering":
        return self

    def __exit__(self, kind: Optional[type[BaseException]], value: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()

    def __del__(self) -> None:
        if self._job[0] and threading.get_ident() == self._device._thread:
            self._end(Failure())


def render(scene: Scene, *, frames: Frames = None, size: Optional[tuple[int, int]] = None,
           layers: Union[str, Iterable[str]] = ("display",), output: Optional[PathLike] = None,
           device: AnyDevice = None, states: Optional[PathLike] = None, manifest: Optional[PathLike] = None,
           techniques: Union[Mapping[str, str], Iterable[str]] = (), threads: int = 0, overwrite: bool = False,
           resume: bool = False, shard: Optional[tuple[int, int]] = None, state_hash: bool = False,
           png_bits: Optional[int] = None, png_effort: Optional[str] = None, exr_bits: Optional[int] = None,
           quality: Optional[int] = None, cancel: Optional[Cancel] = None) -> Rendering:
    """Returns a job that draws one frame for each turn of a loop: `for frame in kiln.render(scene): ...`.

    `frames` are a number, a range or ascending numbers, or None for all; `size` is (width, height) in pixels in
    place of the scene's. `layers` are "display", "beauty", "depth", "fire", "smoke", "bloom" and, of scenes with
    gas, "gas.density", "gas.emission", "gas.depth"; () gives frames without pixels. `output` also writes a file, or
    files by a pattern such as "frame_####.png". `device` is an open :class:`Device`, or the value `wanted` of one to open. `states` is a folder of :func:`bake`; the job starts
    from the latest state there that serves it. `techniques` are {"stage": "name"}; `threads` 0 takes one a core;
    `shard` (i, n) draws the i-th of n shares, from 0. `png_bits` are 8 (the default) or 16; `png_effort`
    is "fast" (the default) or "small"; `exr_bits` are 16 (the default) or 32; `quality` of videos and JPEG is 0 to 100
    (80 by default). `overwrite` replaces files that exist.
    `cancel` ends the job from any thread; Ctrl-C ends it with KeyboardInterrupt.

    Raises :class:`kiln.Error`, in this call or when a frame is drawn.
    """
    request = _Request(output, frames, states, manifest, techniques, threads, overwrite, resume, shard, state_hash,
                       png_bits, png_effort, exr_bits, quality, cancel)
    return Rendering(_sized(scene, size), request, layers, device)


def render_to(scene: Scene, output: PathLike, *, frames: Frames = None, size: Optional[tuple[int, int]] = None,
              device: AnyDevice = None, progress: Optional[Callable[[Progress], None]] = None,
              states: Optional[PathLike] = None, manifest: Optional[PathLike] = None,
              techniques: Union[Mapping[str, str], Iterable[str]] = (), threads: int = 0, overwrite: bool = False,
              resume: bool = False, shard: Optional[tuple[int, int]] = None, state_hash: bool = False,
              png_bits: Optional[int] = None, png_effort: Optional[str] = None, exr_bits: Optional[int] = None,
              quality: Optional[int] = None, cancel: Optional[Cancel] = None) -> Stats:
    """Draws frames into a file, or into files by a pattern, and returns numbers of the job.

    The suffix of `output` is the format: a clip (.mp4, .webm, .mkv, .mov, .gif, .apng, .webp) or images (.png,
    .jpg, .exr, with a pattern such as "frame_####.png"). `progress` is called after each frame; an exception there ends
    the job. The other parameters are those of :func:`render`. Files appear whole or not at all.
    """
    request = _Request(output, frames, states, manifest, techniques, threads, overwrite, resume, shard, state_hash,
                       png_bits, png_effort, exr_bits, quality, cancel)
    with Rendering(_sized(scene, size), request, (), device) as job:
        for frame in job:
            if progress is not None:
                progress(frame.progress)
    return job.stats


__all__ = ["AnyDevice", "Frame", "Frames", "Progress", "Rendering", "Stats", "open_for", "render",
           "render_to"]
