"""Tests kiln.compare and kiln.write_picture of the Python module.

If these fail, a user's test accepts a wrong picture or refuses a right one, or an array is written
as another picture.
"""
import numpy as np
import pytest

import kiln


@pytest.fixture
def picture():
    rows, columns = np.mgrid[0:40, 0:60]
    red, green, blue = rows * 6, columns * 4, (rows + columns) * 2
    return np.stack([red, green, blue, np.full_like(red, 255)], axis=2).astype(np.uint8)


def test_equal_and_different_pictures(picture):
    same = kiln.compare(picture, picture)
    assert same and same.frames[0].equal and same.metrics["flip.mean"].worst == 0
    assert same.metrics["flip.mean"].limit == 0.01 and same.metrics["flip.mean"].passes
    assert kiln.DEFAULT_LIMITS.startswith("flip.mean=0.01")
    other = picture.copy()
    other[10:30, 20:40, :3] = 255 - other[10:30, 20:40, :3]
    result = kiln.compare(picture, other)
    assert not result and not result.metrics["flip.mean"].passes and result.frames[0].score > 1
    x, y = result.frames[0].worst_pixel
    assert 20 <= x < 40 and 10 <= y < 30
    assert "flip.mean" in str(result) and "they look different" in str(result)
    assert kiln.compare(picture, other, limits={"flip.mean": 0.9})
    assert kiln.compare(picture, other, masks=[(20, 10, 20, 20)])


def test_pictures_of_differences(picture, tmp_path):
    other = picture[::-1]
    kiln.compare(picture, other, diff=tmp_path / "diff.png", error_map=tmp_path / "map.png")
    assert (tmp_path / "diff.png").stat().st_size > 100 and (tmp_path / "map.png").stat().st_size > 100
    with pytest.raises(kiln.UsageError):
        kiln.compare(picture, other, diff=tmp_path / "diff.png")


def test_other_sizes_and_wrong_arguments(picture, tmp_path):
    result = kiln.compare(picture, picture[:20])
    assert not result and result.frames[0].verdict == "different" and "40" in str(result)
    with pytest.raises(kiln.UsageError, match="flop"):
        kiln.compare(picture, picture, limits={"flop.mean": 1})
    with pytest.raises(ValueError, match="auto, ldr, hdr"):
        kiln.compare(picture, picture, mode="both")
    with pytest.raises(kiln.InvalidInput):
        kiln.compare(tmp_path / "none.png", picture)


@pytest.mark.parametrize("kind, full", [(np.uint8, 255), (np.uint16, 65535), (np.float32, 1)])
@pytest.mark.parametrize("shape", ["rgba", "rgb", "grey", "turned"])
def test_arrays_become_pictures(tmp_path, kind, full, shape):
    values = np.random.default_rng(7).random((24, 36, 4)) * full
    pixels = values.astype(kind)
    if shape == "rgb":
        pixels = pixels[:, :, :3]
    elif shape == "grey":
        pixels = pixels[:, :, 0]
    elif shape == "turned":
        pixels = pixels.swapaxes(0, 1)[::-1, ::-1]
    layer = "depth" if shape == "grey" and kind is np.float32 else "beauty"
    path = tmp_path / ("a.exr" if kind is np.float32 else "a.png")
    kiln.write_picture(path, pixels)
    assert kiln.compare(path, np.ascontiguousarray(pixels), layer=layer).frames[0].equal
    changed = pixels.copy()
    changed[3, 3] = full - changed[3, 3]
    assert not kiln.compare(path, changed, layer=layer).frames[0].equal
    with pytest.raises(kiln.UsageError):
        kiln.write_picture(path, pixels)
    kiln.write_picture(path, pixels, overwrite=True)


def test_pillow_reads_written_pictures(picture, tmp_path):
    image = pytest.importorskip("PIL.Image")
    picture[2, 3] = (1, 2, 3, 4)
    kiln.write_picture(tmp_path / "a.png", picture)
    assert np.array_equal(np.asarray(image.open(tmp_path / "a.png")), picture)
    picture[2, 3, 3] = 255
    kiln.write_picture(tmp_path / "b.png", picture)
    read = image.open(tmp_path / "b.png")
    assert read.mode == "RGB" and np.array_equal(np.asarray(read), picture[:, :, :3])


def test_arrays_that_are_no_picture_are_refused(tmp_path):
    for pixels, kind, message in [(np.zeros((4, 4), np.int64), TypeError, "int64"),
                                  (np.zeros((4, 4, 2), np.uint8), ValueError, "1, 3 or 4 channels"),
                                  (np.zeros((0, 4, 4), np.uint8), ValueError, "shape"),
                                  (np.zeros((4, 4, 4), np.uint8), kiln.UsageError, "integer samples")]:
        with pytest.raises(kind, match=message):
            kiln.write_picture(tmp_path / "a.exr", pixels)
    assert list(tmp_path.iterdir()) == []
