"""Compares pictures and judges them by limits."""
from __future__ import annotations

import os
import tempfile
from dataclasses import dataclass
from typing import Any, Iterable, Mapping, Optional, Union

import numpy as np
import numpy.typing as npt

from ._library import Cancel, Failure, PathLike, Struct, Watch, ffi, lib, pairs, set_watch, text
from ._picture import is_path, suffix_for, write_picture

Picture = Union[PathLike, npt.ArrayLike]
Mask = Union[tuple[int, int, int, int], PathLike]
_MODES = {"auto": "KILN_COMPARE_AUTO", "ldr": "KILN_COMPARE_LDR", "hdr": "KILN_COMPARE_HDR"}


@dataclass(frozen=True)
class Metric:
    """One metric of a comparison, over all measured frames."""

    name: str
    unit: str
    worst: float
    mean: float
    limit: Optional[float]
    """The worst value that passes; None: the metric has no limit."""
    higher_is_better: bool
    worst_name: str
    """The name of the frame with the worst value."""

    @property
    def passes(self) -> bool:
        """True if the worst value is within the limit."""
        if self.limit is None:
            return True
        return self.worst >= self.limit if self.higher_is_better else self.worst <= self.limit

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        limit = "" if self.limit is None else f", the limit is {self.limit:.4g}{unit}"
        return f"{self.name} {self.worst:.4g}{unit}{limit}"


@dataclass(frozen=True)
class ComparedLayer:
    """One layer of a pair of pictures."""

    name: str
    """"beauty" is the picture, and the only layer of all formats but EXR."""
    data: bool
    """True if it holds no light, such as depths, and was compared by its numbers."""
    verdict: str
    """"same", "different", "missing" (only in the reference) or "extra" (only in the test)."""
    message: str
    """Why the layer was not measured, or how the kinds of files differ; else ""."""
    equal: bool
    """True if no number differs."""
    values: Mapping[str, float]
    """The values by the names of metrics; empty for data."""
    score: float
    """The largest share of a limit that a value takes up; up to 1 is within all limits."""
    difference: float
    """Of data: the largest difference of two numbers."""
    differing: int
    """Of data: how many numbers differ."""
    worst_pixel: tuple[int, int]
    """The x and y of a pixel of the largest difference."""


@dataclass(frozen=True)
class ComparedFrame:
    """One pair of pictures."""

    name: str
    verdict: str
    """"same", "different", "missing", "extra" or "unreadable"."""
    message: str
    """Why the pair was not measured; "" when it was."""
    equal: bool
    """True if no sample differs."""
    values: Mapping[str, float]
    """The values by the names of metrics; empty when the pair was not measured."""
    score: float
    """The largest share of a limit that a value takes up; up to 1 is within all limits."""
    worst_pixel: tuple[int, int]
    """The x and y of a pixel of the largest difference."""
    layers: tuple[ComparedLayer, ...]
    """The layers; none if the pair is missing, extra or unreadable."""


@dataclass(frozen=True)
class Comparison:
    """The result of :func:`kiln.compare`. Its truth value is `same`."""

    same: bool
    """True if every frame is within all limits."""
    hdr: bool
    """True if FLIP judged light at several exposures."""
    metrics: Mapping[str, Metric]
    frames: tuple[ComparedFrame, ...]

    def __bool__(self) -> bool:
        return self.same

    def __str__(self) -> str:
        lines = [f"{frame.name}: {frame.message}" for frame in self.frames if frame.message]
        lines += [str(metric) + ("" if metric.passes else ": beyond it")
                  for metric in self.metrics.values() if metric.limit is not None and self._measured]
        return "\n".join(lines + ["they look the same" if self.same else "they look different"])

    @property
    def _measured(self) -> bool:
        return any(frame.values for frame in self.frames)


def _columns(result: Any) -> list[str]:
    return [text(result.columns[i].name) for i in range(result.column_count)]


def _values(result: Any, found: Any) -> dict[str, float]:
    return {name: found.values[i] for i, name in enumerate(_columns(result))} if found.measured else {}


def _layer(result: Any, found: Any) -> ComparedLayer:
    return ComparedLayer(name=text(found.name), data=found.data,
                         verdict=text(lib.kiln_compare_verdict_name(found.verdict)), message=text(found.message),
                         equal=found.equal, values=_values(result, found), score=found.score,
                         difference=found.difference, differing=found.differing,
                         worst_pixel=(found.worst_x, found.worst_y))


def _layers(result: Any, found: Any) -> tuple[ComparedLayer, ...]:
    first = int(ffi.cast("uintptr_t", found.layers))
    return tuple(_layer(result, ffi.cast("struct kiln_compare_layer *", first + i * found.layer_stride))
                 for i in range(found.layer_count))


def _frame(result: Any, found: Any) -> ComparedFrame:
    return ComparedFrame(name=text(found.name), verdict=text(lib.kiln_compare_verdict_name(found.verdict)),
                         message=text(found.message), equal=found.equal, values=_values(result, found),
                         score=found.score, worst_pixel=(found.worst_x, found.worst_y),
                         layers=_layers(result, found))


def _metrics(result: Any) -> dict[str, Metric]:
    metrics = {}
    for i, name in enumerate(_columns(result)):
        column = result.columns[i]
        metrics[name] = Metric(name=name, unit=text(column.unit), worst=result.worst[i], mean=result.mean[i],
                               limit=column.limit if column.limited else None,
                               higher_is_better=column.higher_is_better, worst_name=text(result.worst_names[i]))
    return metrics


def _set_masks(params: Struct, masks: Iterable[Mask]) -> None:
    given = list(masks)
    array = params.keep(ffi.new("struct kiln_compare_mask[]", len(given)))
    for mask, found in zip(given, array):
        found.size = ffi.sizeof(found)
        if isinstance(mask, (str, os.PathLike)):
            found.picture = params.keep(ffi.new("char[]", os.fsencode(mask)))
        elif isinstance(mask, (tuple, list)) and len(mask) == 4:
            found.x, found.y, found.width, found.height = mask
        else:
            raise TypeError(f"masks: found {mask!r}, expected (x, y, width, height) or the name of a picture")
    params.pointer.masks = array
    params.pointer.mask_stride = ffi.sizeof("struct kiln_compare_mask")
    params.pointer.mask_count = len(given)


def _as_file(picture: Picture, folder: str, name: str) -> PathLike:
    """Returns the path of a picture; writes an array into a file in the folder first."""
    if is_path(picture):
        return picture  # type: ignore[return-value]
    array = np.asarray(picture)
    path = os.path.join(folder, name + suffix_for(array))
    write_picture(path, array)
    return path


def compare(reference: Picture, test: Picture, *, limits: Union[str, Iterable[str], Mapping[str, float]] = (),
            layer: Optional[str] = None, mode: str = "auto", threshold: Optional[float] = None,
            window: Optional[int] = None, pixels_per_degree: Optional[float] = None,
            masks: Iterable[Mask] = (), diff: Optional[PathLike] = None, error_map: Optional[PathLike] = None,
            overwrite: bool = False, threads: int = 0, data_limit: float = 0.0, cancel: Optional[Cancel] = None) -> Comparison:
    """Compares pictures as `kiln compare` does, by FLIP, SSIM and more, and judges them by limits.

    Each of `reference` and `test` is an array (as for :func:`write_picture`), a picture, a video, a folder of
    pictures, or a numbered pattern such as "frame_####.png". `limits` are {"flip.mean": 0.01} or texts
    "flip.mean=0.01"; if there are none, `kiln.DEFAULT_LIMITS` are used. `layer` is the layer of EXR
    files to compare, instead of all; `data_limit` is the largest difference that passes of two numbers in layers
    of data, such as depths. `mode` is "ldr", "hdr" or "auto", which is "hdr" for floats. `masks` are areas that are not judged:
    (x, y, width, height), or the path of a picture that is black there. `diff` is the path of a PNG of reference,
    test and error map side by side, `error_map` the path of a PNG of the error map alone.

    Raises :class:`kiln.Error` only when the comparison could not take place.
    """
    if mode not in _MODES:
        raise ValueError(f"mode: found {mode!r}, expected one of {', '.join(_MODES)}")
    watch = Watch()
    params = Struct("kiln_compare_params")
    if layer is not None:
        params.set("layer", layer)
    params.set("mode", ffi.typeof("enum kiln_compare_mode").relements[_MODES[mode]])
    for name, value in (("threshold", threshold), ("window", window), ("pixels_per_degree", pixels_per_degree)):
        if value is not None:
            params.set(name, value)
    for name, path in (("diff", diff), ("error_map", error_map)):
        params.set(name, path)
    params.set("overwrite", overwrite)
    params.set("threads", threads)
    params.set("data_limit", data_limit)
    params.set_texts("limits", "limit_count", pairs(limits, "limits"))
    _set_masks(params, masks)
    set_watch(params, watch, cancel)
    frames: list[ComparedFrame] = []

    def tell(user: Any, result: Any, frame: Any) -> None:
        frames.append(_frame(result, frame))

    params.pointer.frame = params.keep(watch.callback(
        "void(void *, const struct kiln_compare_result *, const struct kiln_compare_frame *)", tell))
    result, failure = Struct("kiln_compare_result"), Failure()
    with tempfile.TemporaryDirectory(prefix="kiln-") as folder:
        params.set("reference", _as_file(reference, folder, "reference"))
        params.set("test", _as_file(test, folder, "test"))
        ok = lib.kiln_compare(params.pointer, result.pointer, failure.pointer)
    watch.raise_kept()
    if not ok:
        raise failure.exception()
    found = result.pointer
    return Comparison(same=found.same, hdr=found.hdr, metrics=_metrics(found), frames=tuple(frames))


__all__ = ["ComparedFrame", "ComparedLayer", "Comparison", "Metric", "compare"]
