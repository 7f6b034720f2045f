"""Tests kiln.render, render_to and bake: frames as arrays without a copy, files, states, threads.

If these fail, Python programs get wrong pixels, crash on freed memory, or leave half-written files.
"""
import gc
import threading
import time

import numpy as np
import pytest

import kiln
from conftest import SMALL


def draw(scene, **options):
    return list(kiln.render(scene, device="cpu", **options))


def test_frames_are_views_of_the_library(scene):
    with kiln.Device("cpu") as device, kiln.render(scene, device=device, layers=("display", "beauty", "depth"),
                                                   state_hash=True) as job:
        frames = list(job)
    assert [frame.number for frame in frames] == [0, 1, 2, 3, 4]
    assert job.stats.frames == 5 and job.stats.state == frames[-1].state
    assert job.stats.techniques["raster"] == "cpu" and job.stats.pass_ms["simulate"] > 0
    for frame in frames:
        assert frame.pixels.shape == (32, 48, 4) and frame.pixels.dtype == np.uint8
        assert frame.linear.shape == (32, 48, 4) and frame.linear.dtype == np.float32
        assert frame.layers["depth"].shape == (32, 48)
        assert frame.pixels.max() > frame.pixels.min() and np.isfinite(frame.linear).all()
        assert frame.progress.total == 5 and len(frame.state) == 16
    with pytest.raises(AttributeError, match="fire"):
        frames[0]._layer("fire")


def test_arrays_are_not_copies_and_cannot_be_written(scene):
    frame = next(kiln.render(scene, device="cpu"))
    first, second = frame.pixels, np.asarray(frame.layers["display"])
    assert not first.flags.owndata and np.shares_memory(first, second)
    with pytest.raises(ValueError):
        first[0, 0, 0] = 1
    with pytest.raises(ValueError):
        first.flags.writeable = True
    copy = np.array(first)
    copy[0, 0, 0] = 1
    assert copy.flags.owndata


def test_arrays_outlive_their_frame_and_job(scene):
    """Checks that the arrays keep their pixels after later jobs, which would reuse freed memory."""
    kept = [frame.pixels[4:, ::2] for frame in kiln.render(scene, device="cpu")]
    before = [array.copy() for array in kept]
    gc.collect()
    for _ in range(3):
        draw(kiln.parse(SMALL.replace("rate: 90", "rate: 900")))
    assert all(np.array_equal(a, b) for a, b in zip(kept, before))
    assert not np.array_equal(kept[0], kept[4])


def test_memory_of_dropped_frames_is_freed():
    """Checks that the memory of frames that nobody keeps is freed; each frame has 0.98 MiB."""
    scene = kiln.parse(SMALL, {"output.frames": 70, "output.size": [640, 400]})

    def resident_mib():
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * 4096 / 2**20

    with kiln.render(scene, device="cpu") as job:
        for frame in job:
            if frame.number == 10:
                before = resident_mib()
    assert resident_mib() - before < 30  # the 59 frames after frame 10 would take 58 MiB


def test_size_frames_and_ranges(scene):
    frames = draw(scene, frames=range(1, 4, 2), size=(64, 48))
    assert [frame.number for frame in frames] == [1, 3] and frames[0].pixels.shape == (48, 64, 4)
    assert [frame.number for frame in draw(scene, frames=[0, 1, 4], layers=())] == [0, 1, 4]
    whole = draw(scene)
    assert np.array_equal(draw(scene, frames=3)[0].pixels, whole[3].pixels)
    assert [frame.number for frame in draw(scene, frames=np.int64(2), layers=())] == [2]
    assert [frame.number for frame in draw(scene, frames=np.arange(2), layers=())] == [0, 1]
    with pytest.raises(kiln.UsageError, match="9-9"):
        draw(scene, frames=9)
    with pytest.raises(ValueError, match="from 0 on"):
        draw(scene, frames=-1)
    with pytest.raises(kiln.UsageError, match="did you mean 'depth'"):
        draw(scene, layers="deptj")


@pytest.mark.parametrize("options, words", [
    ({"size": "320x180"}, "expected \\(width, height\\)"), ({"size": 320}, "expected \\(width, height\\)"),
    ({"frames": "0-10/5"}, "frames: found"), ({"frames": slice(0, 4)}, "frames: found")])
def test_wrong_arguments_are_named(scene, options, words):
    with pytest.raises(TypeError, match=words):
        kiln.render(scene, **options)


def test_a_path_is_no_scene():
    with pytest.raises(TypeError, match="expected a scene, as kiln.load reads it"):
        kiln.render("snow.yaml")


def test_wrong_shards_are_refused(scene, tmp_path):
    for shard in ((2, 2), (1, 0)):
        with pytest.raises(kiln.UsageError, match="count from 0"):
            draw(scene, shard=shard, output=tmp_path / "x_%d.png")
    with pytest.raises(kiln.UsageError, match="no output to share"):
        draw(scene, shard=(1, 2))
    assert not list(tmp_path.iterdir())


def test_render_to_writes_a_clip(scene, tmp_path):
    seen = []
    stats = kiln.render_to(scene, tmp_path / "clip.mp4", device="cpu", progress=seen.append)
    assert (tmp_path / "clip.mp4").stat().st_size > 500 and stats.files == 1
    assert [progress.done for progress in seen] == [1, 2, 3, 4, 5] and seen[-1].frame == 4
    with pytest.raises(kiln.UsageError, match="clip.mp4: the file exists .overwrite=True replaces it"):
        kiln.render_to(scene, tmp_path / "clip.mp4", device="cpu")
    kiln.render_to(scene, tmp_path / "clip.mp4", device="cpu", overwrite=True)


def test_frames_of_an_output_have_its_bits(scene, tmp_path):
    """Compares files with the arrays of their frames, whose memory the encoder reads meanwhile."""
    frames = draw(scene, output=tmp_path / "f_#.png", png_bits=16, layers=("display", "beauty"))
    assert frames[0].pixels.dtype == np.uint16
    for frame in frames:
        assert kiln.compare(tmp_path / f"f_{frame.number}.png", frame.pixels).frames[0].equal


def test_small_png_files_have_the_same_pixels(scene, tmp_path):
    for effort in ("fast", "small"):
        kiln.render_to(scene, tmp_path / f"{effort}.png", frames=3, png_effort=effort, device="cpu")
    assert kiln.compare(tmp_path / "fast.png", tmp_path / "small.png").frames[0].equal
    assert (tmp_path / "small.png").stat().st_size < (tmp_path / "fast.png").stat().st_size
    with pytest.raises(ValueError, match="png_effort: found 'smaller', expected one of fast, small"):
        kiln.render_to(scene, tmp_path / "x.png", frames=3, png_effort="smaller", device="cpu")


def test_a_job_that_is_left_early_leaves_no_file(scene, tmp_path):
    with kiln.render(scene, output=tmp_path / "clip.mp4", device="cpu") as job:
        next(job)
        with pytest.raises(ValueError, match="last frame"):
            job.stats
    for frame in kiln.render(scene, output=tmp_path / "other.mp4", device="cpu"):
        break
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(StopIteration):
        next(job)


def test_an_exception_of_progress_ends_the_job(scene, tmp_path):
    def fail(progress):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        kiln.render_to(scene, tmp_path / "clip.mp4", device="cpu", progress=fail)
    assert list(tmp_path.iterdir()) == []


def test_baked_states_give_the_same_frames(scene, tmp_path):
    saved = []
    stats = kiln.bake(scene, tmp_path, every=2, device="cpu", saved=saved.append)
    assert [state.frame for state in saved] == [2, 4] and stats.states == 2 and stats.steps == 8
    assert all(state.alive > 0 and not state.kept and state.file.startswith(str(tmp_path)) for state in saved)
    whole = draw(scene, state_hash=True)
    with kiln.render(scene, frames=4, states=tmp_path, device="cpu", state_hash=True) as job:
        last = next(job)
        assert next(job, None) is None
    assert job.stats.steps == 0 and last.state == whole[4].state
    assert np.array_equal(last.pixels, whole[4].pixels)
    with pytest.raises(kiln.UsageError):
        kiln.bake(scene, tmp_path, every=2, device="cpu")
    assert kiln.bake(scene, tmp_path, every=2, device="cpu", resume=True).steps == 0

    def fail(state):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        kiln.bake(scene, tmp_path, every=2, device="cpu", overwrite=True, saved=fail)


def test_a_device_belongs_to_its_thread(scene):
    said = []
    with kiln.Device("cpu") as device, kiln.render(scene, device=device) as job:
        next(job)
        with pytest.raises(ValueError, match="still runs"):
            device.close()

        def elsewhere():
            for call in (lambda: next(job), job.close, lambda: kiln.render(scene, device=device)):
                try:
                    call()
                except ValueError as error:
                    said.append(str(error))

        thread = threading.Thread(target=elsewhere)
        thread.start()
        thread.join()
        assert len(said) == 3 and all("another thread" in text for text in said)
        assert next(job).number == 1


def test_threads_draw_at_the_same_time(scene):
    hashes = []

    def work():
        hashes.append(draw(scene, state_hash=True)[-1].state)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(hashes) == 4 and len(set(hashes)) == 1


def test_other_threads_run_while_a_frame_is_drawn():
    """Checks that a call of the library releases the interpreter's lock.

    One thread draws a frame in one call, while the main thread records time stamps. If the call
    held the lock, there would be no stamps meanwhile. The main thread must not be the one that
    draws: there, the library calls back to check for signals, and other threads run during these
    calls.
    """
    scene = kiln.parse(SMALL, {"output.size": [1600, 1200], "systems.a.emit.rate": 20000, "output.frames": 60})
    times = []

    def draw_one():
        with kiln.render(scene, frames=50, device="cpu", threads=1) as job:
            times.append(time.monotonic())
            next(job)
            times.append(time.monotonic())

    stamps, thread = [], threading.Thread(target=draw_one)
    thread.start()
    while thread.is_alive():
        stamps.append(time.monotonic())
        time.sleep(0.002)
    start, end = times
    during = [stamp for stamp in stamps if start < stamp < end]
    assert end - start > 0.05, "the frame is drawn too fast to tell"
    assert np.diff([start, *during, end]).max() < (end - start) / 2, f"{len(during)} turns in {end - start:.3f} s"
