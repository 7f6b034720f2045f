"""Defines what the tests of the Python module share: small scenes, and pytest's plugin pytester."""
import os

import pytest

import kiln

pytest_plugins = ["pytester"]

TREE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SMALL = """
kiln: 1
output: {size: [48, 32], frames: 5}
systems:
  a:
    emit: {rate: 90, life: 1 s}
    look: {size: 0.3}
"""
# A clip of 2000 frames takes so long on any machine that a test can stop it in its middle.
LONG = SMALL.replace("frames: 5", "frames: 2000")


@pytest.fixture
def scene():
    return kiln.parse(SMALL)


@pytest.fixture
def long_scene():
    return kiln.parse(LONG)
