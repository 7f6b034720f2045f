#!/usr/bin/python3
"""Tests tools/flicker, which measures how much a clip flickers: flicker.py SOURCE KILN.

If this fails, tools/flicker mistakes motion for flicker, or misses flicker. The test makes frames
of its own and also draws scenes with kiln. An edge that moves, a field of drops and one fast drop
must not count as flicker. A pixel that blinks, a picture that is brighter for one frame, and noise
must count. Discs that turn and cross each other must not count, since they move smoothly in slow
motion, even if they fly more pixels a frame than the slow motion has pictures. Discs that live for
less than a frame must count, with and without fades.
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy
from PIL import Image

WIDTH, HEIGHT, FRAMES = 320, 180, 12
PIXELS = WIDTH * HEIGHT * (FRAMES - 2)


def still():
    return numpy.full((FRAMES, HEIGHT, WIDTH), 60.0)


def edge():
    frames = still()
    for t in range(FRAMES):
        frames[t, :, :100 + 7 * t] = 180
    return frames


def drops(count, speed):
    """Returns streaks of 2x6 pixels that fall by `speed` pixels a frame and wrap at the bottom."""
    frames = still()
    chance = numpy.random.default_rng(3)
    columns, starts = chance.integers(0, WIDTH // 6, count) * 6, chance.integers(0, HEIGHT, count)
    for column, start in zip(columns, starts):
        for t in range(FRAMES):
            rows = (start + speed * t + numpy.arange(6)) % HEIGHT
            frames[t, rows, column:column + 2] = 160
    return frames


def blinking(count):
    """Returns `count` pixels that are on in every third frame, so in 4 of the 10 inner frames."""
    frames = still()
    chance = numpy.random.default_rng(4)
    rows, columns = chance.integers(0, HEIGHT // 16, count) * 16, chance.choice(WIDTH // 4, count, False) * 4
    frames[1:-1:3, rows, columns] = 150
    return frames


def flash():
    frames = still()
    frames[6] += 100
    return frames


def noise():
    return numpy.random.default_rng(5).uniform(0, 255, (FRAMES, HEIGHT // 2, WIDTH // 2))


SCENE = """kiln: 1
output: {{size: [320, 180], fps: 30, frames: 24}}
simulation: {{rate: 60, warmup: 1 s}}
camera: {{position: [0, 0, 6], target: [0, 0, 0], roll: {{keys: {{0 s: 0 deg, 1 s: {turn} deg}}}}}}
backdrop: {{floor: none, sky: {{top: 0.05, horizon: 0.05}}}}
systems:
  discs:
    emit: {{rate: {rate}, life: {life}, speed: [0, 1.5], from: {{sphere: {{radius: 2 m, outward: true}}}}}}
    look: {{shape: point, point: {{size: 5 px}}, color: 3, fade: {{in: {fade}, out: {fade}}}, soft: 0}}
"""


def measure_scene(source, kiln, rate, life, turn=200, fade=0):
    """Returns the shares of pixels, 0 to 1, that tools/flicker prints for a scene.

    They are spikes, moving, smooth and flicker. The scene emits `rate` discs a second that live for
    `life`, such as "4 ms". The camera rolls by `turn` degrees a second. A disc fades in during the
    first part of its life and out during the last, each the fraction `fade` of its life.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "discs.yaml")
        path.write_text(SCENE.format(rate=rate, life=life, turn=turn, fade=fade))
        return row_of(source, path, "--kiln", kiln, "--size", "320x180", "--frames", "5")


def row_of(source, *arguments):
    said = subprocess.run([source / "tools/flicker", *arguments], check=True, capture_output=True,
                          text=True).stdout.splitlines()
    return [float(cell.strip(" %")) / 100 for cell in said[-1].split("|")[4:8]]


def measure(source, frames, *options):
    """Returns the shares of pixels that tools/flicker prints for frames, as measure_scene does."""
    with tempfile.TemporaryDirectory() as folder:
        for t, frame in enumerate(frames):
            Image.fromarray(frame.astype(numpy.uint8)).convert("RGB").save(f"{folder}/{t:03d}.png")
        return row_of(source, folder, *options)


def main():
    source = pathlib.Path(sys.argv[1])
    failed = False

    def expect(name, measured, valid):
        nonlocal failed
        if not valid:
            print(name, "spikes, moving, smooth, flicker", *(f"{share:.5f}" for share in measured))
            failed = True

    for name, frames in (("still", still()), ("edge", edge())):
        measured = measure(source, frames)
        expect(name, measured, measured == [0, 0, 0, 0])
    for name, frames in (("one drop", drops(1, 9)), ("200 drops", drops(200, 9))):
        measured = measure(source, frames)
        expect(name, measured, measured[0] > 0 and measured[3] < 0.1 * measured[0])
    measured = measure(source, blinking(60))
    share = 60 * 4 / PIXELS
    expect("blinking", measured, abs(measured[0] - share) < 1e-5 and measured[3] > 0.95 * share)
    measured = measure(source, blinking(60), "--threshold", "100")
    expect("blinking, below the threshold", measured, measured == [0, 0, 0, 0])
    measured = measure(source, flash())
    expect("flash", measured, abs(measured[0] - 0.1) < 1e-5 and measured[3] > 0.099)
    measured = measure(source, noise())
    expect("noise", measured, measured[0] > 0.3 and measured[3] > 0.95 * measured[0])
    measured = measure_scene(source, sys.argv[2], 100, "3 s")
    expect("discs that turn", measured, measured[2] > 0.002 and measured[3] < 0.1 * measured[2])
    measured = measure_scene(source, sys.argv[2], 100, "3 s", turn=600)
    expect("discs that turn fast", measured, measured[2] > 0.002 and measured[3] < 0.1 * measured[2])
    measured = measure_scene(source, sys.argv[2], 6000, "4 ms", fade=0.5)
    expect("discs that flash and fade", measured, measured[3] > 0.5 * measured[0] > 0.002)
    measured = measure_scene(source, sys.argv[2], 3000, "20 ms")
    expect("discs that flash", measured, measured[3] > 0.5 * measured[0] > 0.002)
    return failed


sys.exit(main())
