"""Tests the pytest plugin of kiln, the fixture assert_looks_like.

If these fail, users' tests accept wrong pictures, or their goldens are replaced unasked. Each test
runs pytest on small test files, by the plugin pytester. pytest finds kiln's plugin by its entry
point.
"""
import numpy as np

import kiln

TEST = """
    import numpy as np

    def test_it(assert_looks_like):
        pixels = np.full((32, 32, 4), 255, np.uint8)
        pixels[8:16, 8:16, 0] = {red}
        assert_looks_like(pixels, "golden/it.png")
"""


def run(pytester, *options, red=0):
    pytester.makepyfile(TEST.format(red=red))
    return pytester.runpytest_inprocess("-p", "no:cacheprovider", *options)


def test_a_golden_is_missing_accepted_and_compared(pytester):
    golden = pytester.path / "golden" / "it.png"
    result = run(pytester)
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*there is no golden picture *it.png", "picture: out/kiln/*it.png", "*--kiln-update"])
    assert not golden.exists()

    result = run(pytester, "--kiln-update")
    result.assert_outcomes(passed=1)
    result.stdout.fnmatch_lines(["kiln: wrote golden/it.png"])
    accepted = golden.read_bytes()

    result = run(pytester)
    result.assert_outcomes(passed=1)
    assert not list((pytester.path / "out" / "kiln").glob("*"))

    result = run(pytester, "--kiln-update", red=1)  # within the limits
    result.assert_outcomes(passed=1)
    result.stdout.no_fnmatch_line("kiln: wrote*")
    assert golden.read_bytes() == accepted


def test_a_failure_prints_metrics_and_writes_pictures(pytester):
    run(pytester, "--kiln-update").assert_outcomes(passed=1)
    result = run(pytester, "--kiln-results=here", red=200)
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["the picture does not look like *it.png", "flip.mean *, the limit is 0.01: beyond it",
                                 "picture: here/*it.png", "golden, picture and error map: here/*it_differences.png"])
    kept = next((pytester.path / "here").rglob("it.png"))
    assert kiln.compare(pytester.path / "golden" / "it.png", kept).frames[0].worst_pixel == (8, 8)
    assert next((pytester.path / "here").rglob("it_differences.png")).stat().st_size > 100
    run(pytester, "--kiln-results=here").assert_outcomes(passed=1)
    assert list((pytester.path / "here").iterdir()) == []


def test_update_replaces_what_looks_different(pytester):
    run(pytester, "--kiln-update").assert_outcomes(passed=1)
    result = run(pytester, "--kiln-update", red=255)
    result.stdout.fnmatch_lines(["kiln: wrote golden/it.png"])
    run(pytester, red=255).assert_outcomes(passed=1)


def test_tests_do_not_share_a_folder(pytester):
    for folder in ("a", "b"):
        pytester.mkdir(folder).joinpath("test_fire.py").write_text("""
import numpy as np
import pytest

@pytest.mark.parametrize("name", ["a b", "a?b"])
def test_x(assert_looks_like, name):
    for folder in ("u", "v"):
        with pytest.raises(pytest.fail.Exception):
            assert_looks_like(np.full((8, 8, 4), 255, np.uint8), folder + "/g.png")
""", encoding="utf-8")
    options = ("-p", "no:cacheprovider", "--import-mode=importlib")
    pytester.runpytest_inprocess(*options).assert_outcomes(passed=4)
    pytester.runpytest_inprocess(*options).assert_outcomes(passed=4)  # replaces the first run's files
    assert len(list((pytester.path / "out" / "kiln").rglob("g.png"))) == 8


def test_files_and_masks(pytester):
    pytester.makepyfile("""
        import numpy as np
        import kiln

        def test_files(assert_looks_like, tmp_path):
            pixels = np.zeros((32, 32, 4), np.float32)
            kiln.write_picture(tmp_path / "a.exr", pixels)
            assert_looks_like(tmp_path / "a.exr", "a.exr")
            pixels[0:8, 0:8] = 5
            kiln.write_picture(tmp_path / "b.exr", pixels)
            result = assert_looks_like(tmp_path / "b.exr", "a.exr", masks=[(0, 0, 8, 8)])
            assert result.hdr
    """)
    pytester.runpytest_inprocess("--kiln-update").assert_outcomes(passed=1)
    assert kiln.compare(pytester.path / "a.exr", np.zeros((32, 32, 4), np.float32)).frames[0].equal


def test_runs_without_the_fixture_do_not_load_the_library(pytester, monkeypatch):
    monkeypatch.setenv("KILN_LIBRARY", "/no/such/library.so")
    pytester.makepyfile("def test_nothing():\n    pass\n")
    pytester.runpytest_subprocess().assert_outcomes(passed=1)
