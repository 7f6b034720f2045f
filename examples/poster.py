"""Draws the poster of a clip: python3 poster.py SCENE FILE.png [KEY=VALUE...]. Draws every third frame small and
in memory alone, and then draws the brightest one in full size."""
import sys

import kiln


def brightest(scene, device):
    """Returns the number of the frame with the most light, among every third frame."""
    numbers = range(0, scene.info.frames, 3)
    with kiln.render(scene, frames=numbers, size=(96, 64), layers="beauty", device=device) as job:
        light = {frame.number: float(frame.linear[..., :3].mean()) for frame in job}
    return max(light, key=light.get)


def main():
    if len(sys.argv) < 3:
        print("usage: poster.py SCENE FILE.png [KEY=VALUE...]", file=sys.stderr)
        return kiln.Code.USAGE
    try:
        scene = kiln.load(sys.argv[1], sys.argv[3:])
        with kiln.Device() as device:
            number = brightest(scene, device)
            frame = next(kiln.render(scene, frames=number, device=device))
        kiln.write_picture(sys.argv[2], frame.pixels, overwrite=True)
    except kiln.Error as error:
        print(error, file=sys.stderr)
        return error.code
    print(f"frame {number} of {scene.info.frames}, {frame.alive} particles")
    return kiln.Code.OK


if __name__ == "__main__":
    sys.exit(main())
