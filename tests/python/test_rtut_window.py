"""Tests the window of rtut by real keys and drags: a program for GLUT, compiled for OpenRT, under an
Xvfb of its own."""
import os
import struct
import subprocess
import time

import numpy
import pytest
from conftest import find_vv
from window_driver import PATIENCE, needs
from xserver import display

PROGRAM = find_vv().parent / "gl_viewer"


def screen(path):
    """Returns what is on the screen, as Xvfb keeps it in an XWD file."""
    data = path.read_bytes()
    header, width, height, stride, colours = (struct.unpack_from(">I", data, 4 * k)[0]
                                              for k in (0, 4, 5, 12, 19))
    start = header + 12 * colours
    rows = numpy.frombuffer(data, numpy.uint8, stride * height, start).reshape(height, stride)
    return rows[:, :4 * width].reshape(height, width, 4)[:, :, 2::-1] / 255.0


class Viewer:

    def __init__(self, folder):
        self.folder = folder
        self.env = {k: v for k, v in os.environ.items() if k != "WAYLAND_DISPLAY"}
        self.program = subprocess.Popen([PROGRAM], cwd=folder, env=self.env, stderr=subprocess.PIPE)

    def tool(self, *arguments):
        done = subprocess.run(["xdotool", *map(str, arguments)],
                              env=self.env,
                              capture_output=True,
                              text=True,
                              timeout=PATIENCE)
        return done.stdout.split()

    def picture(self):
        return screen(self.folder / "Xvfb_screen0")[:300, :400]

    def wait(self, test, what):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if answer := test():
                return answer
            assert self.program.poll() is None, self.program.stderr.read()
            time.sleep(0.02)
        raise AssertionError(what)


@pytest.fixture
def viewer(tmp_path):
    needs("xdotool")
    if not PROGRAM.exists():
        pytest.skip("gl_viewer is not built")
    with display("400x300", "-noreset", "-fbdir", str(tmp_path)):
        one = Viewer(tmp_path)
        try:
            yield one
        finally:
            one.program.kill()
            one.program.wait()


def colourful(picture):
    """Returns the share of pixels that are green or blue more than red."""
    return (picture[:, :, 1:].max(2) > picture[:, :, 0] + 0.15).mean()


def test_keys_and_drags_reach_the_program(viewer):
    viewer.wait(lambda: colourful(viewer.picture()) > 0.1, "no picture")
    window = viewer.wait(lambda: viewer.tool("search", "--name", "Viewer"), "no window")[0]
    viewer.tool("windowfocus", "--sync", window)
    before = viewer.picture()

    def drag():  # SDL ignores a click that comes with the focus
        viewer.tool("mousemove", "--window", window, 100, 150, "mousedown", 1, "mousemove",
                    "--window", window, 170, 150, "mouseup", 1)
        return numpy.abs(viewer.picture() - before).mean() > 0.02

    viewer.wait(drag, "drags turn nothing")
    viewer.tool("key", "c")  # one material instead of colours
    viewer.wait(lambda: colourful(viewer.picture()) < 0.02, "the key changes no colours")
    viewer.tool("windowsize", window, 320, 200)
    viewer.wait(lambda: (viewer.picture()[210:] == 0).all() and viewer.picture()[:200].any(),
                "the window has the old size")
    viewer.tool("key", "Escape")
    assert viewer.program.wait(PATIENCE) == 0
