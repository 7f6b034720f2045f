"""Checks that a call of the Python module can be stopped: by Cancel, by Ctrl-C and by an exception.

If these fail, a long render cannot be stopped, or leaves half-written files.
"""
import os
import signal
import subprocess
import sys
import threading
import time

import pytest

import kiln
from conftest import LONG


def test_cancel_from_another_thread(long_scene, tmp_path):
    cancel = kiln.Cancel()
    assert not cancel.requested
    timer = threading.Timer(0.2, cancel.request)
    timer.start()
    with pytest.raises(kiln.Interrupted) as caught:
        kiln.render_to(long_scene, tmp_path / "clip.mp4", device="cpu", cancel=cancel)
    timer.join()
    assert caught.value.code is kiln.Code.INTERRUPTED and cancel.requested
    assert list(tmp_path.iterdir()) == []


def test_a_request_before_a_call_stops_it(scene, tmp_path):
    cancel = kiln.Cancel()
    cancel.request()
    for call in (lambda: list(kiln.render(scene, device="cpu", cancel=cancel)),
                 lambda: kiln.bake(scene, tmp_path / "states", every=1, device="cpu", cancel=cancel)):
        with pytest.raises(kiln.Interrupted):
            call()


# Overrides with which a single frame takes minutes on any machine.
ENDLESS = {"systems.a.emit.rate": 200000, "simulation.warmup": "500 s"}

# Each of these is one long call of a C function. Python handles signals only when the library calls
# back to ask whether to go on.
ONE_FRAME = "next(kiln.render(scene, frames=1999, output='clip.mp4', device='cpu'))"
BAKING = "kiln.bake(scene, 'states', every=1999, device='cpu')"


@pytest.mark.parametrize("call", [ONE_FRAME, BAKING])
def test_ctrl_c_stops_a_call(tmp_path, call):
    program = tmp_path / "program.py"
    program.write_text(
        "import kiln, sys\n"
        f"scene = kiln.parse({LONG!r}, {ENDLESS!r})\n"
        "print('ready', flush=True)\n"
        "try:\n"
        f"    {call}\n"
        "except KeyboardInterrupt:\n"
        "    print('stopped')\n")
    folder = tmp_path / "work"
    folder.mkdir()
    child = subprocess.Popen([sys.executable, program], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                             text=True)
    assert child.stdout.readline() == "ready\n"
    time.sleep(0.4)
    assert child.poll() is None
    start = time.monotonic()
    os.kill(child.pid, signal.SIGINT)
    out, problems = child.communicate(timeout=30)
    assert (out, problems, child.returncode) == ("stopped\n", "", 0)
    assert time.monotonic() - start < 5
    assert [path for path in folder.rglob("*") if path.is_file()] == []


def test_an_exception_of_a_signal_handler_stops_a_call():
    class Enough(Exception):
        pass

    def handler(number, frame):
        raise Enough

    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(Enough):
            next(kiln.render(kiln.parse(LONG, ENDLESS), frames=1999, device="cpu", threads=1))
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
