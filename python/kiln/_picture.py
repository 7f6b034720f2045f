"""Converts pixels of the library to NumPy arrays, and writes arrays as pictures."""
from __future__ import annotations

import os
from typing import Any

import numpy as np
import numpy.typing as npt

from ._library import Failure, PathLike, Struct, ffi, lib, path_bytes

Array = npt.NDArray[Any]

_TYPES: dict[str, np.dtype[Any]] = {"KILN_SAMPLES_UINT8": np.dtype(np.uint8),
                                     "KILN_SAMPLES_UINT16": np.dtype(np.uint16),
                                     "KILN_SAMPLES_FLOAT": np.dtype(np.float32)}
_NUMBERS: dict[str, int] = ffi.typeof("enum kiln_sample_type").relements


class _Memory:
    """Describes memory of the library to NumPy. An array keeps this object alive, and the object keeps the owner of
    the memory alive."""

    def __init__(self, layer: Any, owner: Any) -> None:
        kind = _TYPES[ffi.typeof("enum kiln_sample_type").elements[int(layer.samples)]]
        size = kind.itemsize
        one = layer.channels == 1
        self.owner = owner
        self.__array_interface__ = {
            "version": 3,
            "data": (int(ffi.cast("uintptr_t", layer.pixels)), True),
            "typestr": kind.str,
            "shape": (layer.height, layer.width) if one else (layer.height, layer.width, layer.channels),
            "strides": (layer.row_bytes, size) if one else (layer.row_bytes, layer.channels * size, size),
        }


def view(layer: Any, owner: Any) -> Array:
    """Returns a read-only array of a layer's samples: height x width x channels, or height x width for one channel."""
    return np.asarray(_Memory(layer, owner))


def _as_pixels(array: Array) -> Array:
    """Returns the array with the channels and the memory layout that the library writes."""
    if array.dtype not in _TYPES.values():
        raise TypeError(f"pixels of type {array.dtype}: expected uint8, uint16 or float32")
    if array.ndim == 3 and array.shape[2] == 1:
        array = array[:, :, 0]
    if array.ndim == 2 and array.dtype != np.float32:
        array = np.repeat(array[:, :, np.newaxis], 3, axis=2)
    if array.ndim == 3 and array.shape[2] == 3:
        full = 1 if array.dtype == np.float32 else np.iinfo(array.dtype).max
        alpha = np.full(array.shape[:2] + (1,), full, array.dtype)
        array = np.concatenate((array, alpha), axis=2)
    if not (array.ndim == 2 or (array.ndim == 3 and array.shape[2] == 4)) or array.size == 0:
        raise ValueError(f"pixels of shape {array.shape}: expected height x width, with 1, 3 or 4 channels")
    packed = array.strides[-1] == array.itemsize and (array.ndim == 2 or array.strides[1] == 4 * array.itemsize)
    return array if packed and array.strides[0] >= array.shape[1] * array.strides[1] else np.ascontiguousarray(array)


def write_picture(path: PathLike, pixels: npt.ArrayLike, *, overwrite: bool = False) -> None:
    """Writes an array as a picture: uint8 and uint16 as a PNG (sRGB, straight alpha), float32 as an EXR of 32-bit
    floats (linear, premultiplied).

    The shape of the array is height x width x 4, 3 or 1, or height x width. A PNG whose pixels are all opaque gets
    no alpha. The file appears whole or not at all. Raises :class:`kiln.UsageError` when the file exists and
    `overwrite` is false.
    """
    array = _as_pixels(np.asarray(pixels))
    layer = Struct("kiln_frame_layer")
    layer.pointer.height, layer.pointer.width = array.shape[:2]
    layer.pointer.channels = 1 if array.ndim == 2 else 4
    layer.pointer.samples = next(_NUMBERS[name] for name, kind in _TYPES.items() if kind == array.dtype)
    layer.pointer.row_bytes = array.strides[0]
    layer.pointer.pixels = ffi.cast("void *", array.__array_interface__["data"][0])
    failure = Failure()
    if not lib.kiln_layer_write(layer.pointer, path_bytes(path), overwrite, failure.pointer):
        raise failure.exception()


def suffix_for(pixels: Array) -> str:
    """Returns the suffix of the file that write_picture makes of an array."""
    return ".exr" if pixels.dtype == np.float32 else ".png"


def is_path(picture: object) -> bool:
    return isinstance(picture, (str, os.PathLike))


__all__ = ["Array", "is_path", "suffix_for", "view", "write_picture"]
