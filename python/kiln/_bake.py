"""Saves states of the simulation while it steps through a clip once, so that later jobs can start in its middle."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Iterable, Mapping, Optional, Union

from ._library import Cancel, Failure, PathLike, Struct, Watch, lib, pairs, set_watch, text
from ._render import AnyDevice, open_for
from ._scene import Scene


@dataclass(frozen=True)
class SavedState:
    """A state of the simulation in a file."""

    frame: int
    """The frame that the state precedes."""
    step: int
    """The number of steps that led to the state."""
    alive: int
    """The number of living particles."""
    file: str
    """The path of the file."""
    bytes: int
    """The size of the file."""
    kept: bool
    """True if the file was there already."""


@dataclass(frozen=True)
class BakeStats:
    """Numbers of a finished :func:`bake`."""

    states: int
    """The number of states that are there now."""
    kept: int
    """The number of states that were there before."""
    steps: int
    """The number of steps that were simulated."""
    bytes: int
    """The size of the files that were written."""
    total_s: float
    """The time that the call took, in seconds."""
    motion: str
    """The hash of the scene's motion, which identifies its states. It does not depend on looks, camera and lights."""


def bake(scene: Scene, states: PathLike, *, every: int = 0, device: AnyDevice = None,
         saved: Optional[Callable[[SavedState], None]] = None,
         techniques: Union[Mapping[str, str], Iterable[str]] = (), threads: int = 0, overwrite: bool = False,
         resume: bool = False, cancel: Optional[Cancel] = None) -> BakeStats:
    """Steps through the clip once and saves states in a folder, for `render(..., states=folder)`.

    A state is saved before every `every`-th frame; 0 saves one before each part of the clip. `saved` is called with
    each state; an exception there ends the job. A state whose file exists already is an error, unless `overwrite`
    replaces it or `resume` keeps it and goes on from it.
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
