"""Tests scenes, overrides, devices and errors of the Python module.

If these fail, a scene is not the one of its text and overrides, or an error has the wrong type or
text.
"""
import pickle

import pytest

import kiln
from conftest import SMALL, TREE


def test_a_scene_tells_about_itself(scene):
    info = scene.info
    assert (info.width, info.height, info.frames, info.fps) == (48, 32, 5, 30)
    assert info.systems == 1 and info.particle_capacity >= 12 and len(info.hash) == 64


def test_the_printed_text_loads_to_the_same_scene(scene):
    text = scene.text()
    assert text.startswith("kiln: 1\n") and "rate: 90 1/s" in text
    assert kiln.parse(text).info.hash == scene.info.hash


@pytest.mark.parametrize("overrides", [
    ["systems.a.emit.rate=7", "output.size=[64, 48]"],
    {"systems.a.emit.rate": 7, "output.size": (64, 48)},
    {"systems.*.emit.rate": "7", "output.size": "[64, 48]"},
])
def test_overrides_are_texts_or_a_mapping(overrides):
    scene = kiln.parse(SMALL, overrides)
    assert scene.info.width == 64 and "rate: 7 1/s\n" in scene.text()


def test_later_overrides_are_appended(tmp_path):
    path = tmp_path / "small.yaml"
    path.write_text(SMALL)
    scene = kiln.load(path, "systems.a.emit.rate=7").override({"systems.a.emit.rate": 8, "output.frames": 3})
    assert scene.overrides == ("systems.a.emit.rate=7", "systems.a.emit.rate=8", "output.frames=3")
    assert "rate: 8 1/s\n" in scene.text() and scene.info.frames == 3 and scene.name == str(path)


@pytest.mark.parametrize("make, kind, code, message", [
    (lambda: kiln.load("no/such.yaml"), kiln.InvalidInput, kiln.Code.INVALID_INPUT, "no/such.yaml: No such file"),
    (lambda: kiln.parse("kiln: 1\nsistems: {}\n", name="mine"), kiln.InvalidInput, kiln.Code.INVALID_INPUT,
     "mine:2:1: sistems: unknown key (did you mean 'systems'?)"),
    (lambda: kiln.parse(SMALL, "nothing"), kiln.UsageError, kiln.Code.USAGE, "nothing"),
    (lambda: kiln.parse(SMALL, {"systems.a.emit.rat": 1}), kiln.InvalidInput, kiln.Code.INVALID_INPUT, "rat"),
    (lambda: kiln.parse(SMALL, limits="frames=4"), kiln.OverLimit, kiln.Code.OVER_LIMIT, "frames of the clip"),
    (lambda: kiln.parse(SMALL, limits="frames=many"), kiln.UsageError, kiln.Code.USAGE, "many"),
    (lambda: kiln.Device("no such device"), kiln.DeviceError, kiln.Code.NO_DEVICE, "no such device"),
])
def test_errors_have_codes_and_words(make, kind, code, message):
    with pytest.raises(kind) as caught:
        make()
    assert caught.value.code is code and message in str(caught.value)
    assert isinstance(caught.value, kiln.Error)
    again = pickle.loads(pickle.dumps(caught.value))
    assert type(again) is kind and again.code is code and str(again) == str(caught.value)


def test_values_that_are_no_text_are_refused():
    with pytest.raises(TypeError, match="key=value"):
        kiln.parse(SMALL, [3])
    with pytest.raises(ValueError, match="zero byte"):
        kiln.load("a\0b")


def test_meshes_are_read_by_the_decoder_of_the_library():
    assert kiln.load(f"{TREE}/scenes/campfire.yaml").info.systems > 0


def test_devices():
    infos = kiln.devices()
    assert infos[0].name == "cpu" and infos[0].usable and not infos[0].gl
    with kiln.Device("cpu") as device:
        assert device.info.name == "cpu"
    device.close()
    with pytest.raises(ValueError, match="closed"):
        kiln.render(kiln.parse(SMALL), device=device)
