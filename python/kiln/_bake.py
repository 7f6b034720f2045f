"""Saved states: steps through a clip once, so that later jobs start in its middle."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Iterable, Mapping, Optional, Union

from ._library import Cancel, Failure, PathLike, Struct, Watch, lib, pairs, set_watch, text
from ._render import AnyDevice, open_for
from ._scene import Scene


@dataclass(frozen=True)
class SavedState:
    """A state that was saved, or was there already."""

    frame: int
    """The frame before which the state was saved."""
    step: int
    alive: int
    """The number of living particles in the state."""
    file: str
    bytes: int
    kept: bool
    """Whether the state was there already."""


@dataclass(frozen=True)
class BakeStats:
    """The result of :func:`kiln.bake`."""

    states: int
    """How many states are in the folder now."""
    kept: int
    """How many of these states were there before."""
    steps: int
    """How many steps were done."""
    bytes: int
    """The size of the files that were written."""
    total_s: float
    motion: str
    """The motion hash, by which states are known: looks, camera and lights have no part in it."""


def bake(scene: Scene, states: PathLike, *, every: int = 0, device: AnyDevice = None,
         saved: Optional[Callable[[SavedState], None]] = None,
         techniques: Union[Mapping[str, str], Iterable[str]] = (), threads: int = 0, overwrite: bool = False,
         resume: bool = False, cancel: Optional[Cancel] = None) -> BakeStats:
    """Steps through the clip once and saves states in a folder, for `render(..., states=folder)`.

    There is a state before every `every` frames; 0 takes those before each part of a clip. `saved` is told of
    each; an exception there ends the job. States that are there are refused, or replaced with `overwrite`, or
    with `resume` kept and gone on from.
    """
    watch = Watch()
    params = Struct("kiln_bake_params")
    params.set("states", states)
    for name, value in (("every", every), ("threads", threads), ("overwrite", overwrite), ("resume", resume)):
        params.set(name, value)
    texts = pairs(techniques, "techniques")
    params.set_texts("techniques", "technique_count", texts)
    params.set_log()
    set_watch(params, watch, cancel)

    def tell(user: Any, found: Any) -> None:
        if saved is not None:
            saved(SavedState(frame=found.frame, step=found.step, alive=found.alive, file=text(found.file),
                             bytes=found.bytes, kept=found.kept))

    if saved is not None:
        params.pointer.saved = params.keep(watch.callback("void(void *, const struct kiln_baked *)", tell))
        params.pointer.stop = watch.stop
    stats, failure = Struct("kiln_bake_stats"), Failure()
    opened, own = open_for(device, texts)
    try:
        ok = lib.kiln_bake(opened._pointer, scene._pointer, params.pointer, stats.pointer, failure.pointer)
    finally:
        if own:
            opened.close()
    watch.raise_kept()
    scene._watch.raise_kept()
    if not ok:
        raise failure.exception()
    done = stats.pointer
    return BakeStats(states=done.states, kept=done.kept, steps=done.steps, bytes=done.bytes, total_s=done.total_s,
                     motion=text(done.motion))


__all__ = ["BakeStats", "SavedState", "bake"]
