"""Tests parameters of scenes in the Python module.

If these fail, a program that makes a form of a scene's parameters shows wrong values, or a stranger's value means more
than a text.
"""
import pytest

import kiln

TITLE = """kiln: 1
params:
  brand: {color: "#e61e28", help: colour of the sparks}
  length: {number: 2 s, min: 1 s, max: 30 s}
  count: {integer: 3}
  tilt: {number: 5 deg, max: 90 deg}
  place: {vector: [0, 1, 2]}
  style: {choice: calm, of: [calm, wild]}
  on: {switch: true}
  title: {text: Kiln}
output: {duration: $length, size: [64, 32]}
seed: $count
systems: {a: {enabled: $on, emit: {rate: 5, life: 1 s, speed: 1}, look: {color: $brand}}}
"""


def test_a_scene_lists_its_parameters():
    brand, length, count, tilt, place, style, on, title = kiln.parse(TITLE, name="t.yaml").params
    assert (brand.name, brand.kind, brand.value, brand.help) == ("brand", "color", "#e61e28", "colour of the sparks")
    assert brand.place == "t.yaml:3:3" and brand.min is None
    assert (length.value, length.unit, length.min, length.max) == (2, "s", 1, 30)
    assert length.schema["minimum"] == 1
    assert count.kind == "integer" and count.value == 3
    assert (tilt.value, tilt.unit, tilt.min, tilt.max) == ("5 deg", "deg", None, 90)
    assert place.value == [0, 1, 2]
    assert style.words == ("calm", "wild") and style.schema == {"enum": ["calm", "wild"]}
    assert on.value is True and title.value == "Kiln"
    assert kiln.parse("kiln: 1").params == ()


def test_values_are_given():
    values = {"length": 3, "brand": "#00ff00", "on": False, "style": "wild", "tilt": "0.5 rad", "place": [1, 2, 3]}
    scene = kiln.parse(TITLE, params=values)
    assert scene.info.frames == 90
    found = {param.name: (param.value, param.default) for param in scene.params}
    assert found["brand"] == ("#00ff00", "#e61e28") and found["on"] == (False, True)
    assert scene.override(params={"length": "4 s"}).info.frames == 120


@pytest.mark.parametrize("values, message", [
    ({"length": 40}, "--set params.length: 40 is out of range; allowed is from 1 s to 30 s; declared at t.yaml:4:3"),
    ({"length": float("nan")}, "NaN is not a finite number"),
    ({"length": 10 ** 400}, "expected a number from 1 s to 30 s"),
    ({"length": "= 2 s"}, "expected a number from 1 s to 30 s"),
    ({"length": "$count"}, "expected a number from 1 s to 30 s"),
    ({"title": "x" * 10 ** 7}, "at most 4000 are allowed"),
    ({"title": [[]] * 3}, "expected a text, found a list"),
    ({"nothing": 1}, "there is no parameter 'nothing'"),
])
def test_values_of_strangers_are_errors(values, message):
    with pytest.raises(kiln.InvalidInput) as caught:
        kiln.parse(TITLE, params=values, name="t.yaml")
    assert message in str(caught.value)


def test_texts_of_strangers_are_texts():
    title = kiln.parse(TITLE, params={"title": "$brand"}).params[-1]
    assert title.value == "$brand"
