"""Tests the window of rtut by real keys and drags: a program for GLUT, compiled for OpenRT, under an
Xvfb of its own."""
import contextlib
import os
import struct
import subprocess
import time

import numpy
import pytest
from conftest import find_vv
from window_driver import PATIENCE, needs
from xserver import display

BIN = find_vv().parent


def screen(path):
    """Returns what is on the screen, as Xvfb keeps it in an XWD file."""
    data = path.read_bytes()
    header, width, height, stride, colours = (struct.unpack_from(">I", data, 4 * k)[0]
                                              for k in (0, 4, 5, 12, 19))
    start = header + 12 * colours
    rows = numpy.frombuffer(data, numpy.uint8, stride * height, start).reshape(height, stride)
    return rows[:, :4 * width].reshape(height, width, 4)[:, :, 2::-1] / 255.0


class Window:

    def __init__(self, program, folder):
        self.folder = folder
        self.env = {k: v for k, v in os.environ.items() if k != "WAYLAND_DISPLAY"}
        self.out = folder / "out"
        with self.out.open("wb") as out:
            self.program = subprocess.Popen([BIN / program],
                                            cwd=folder,
                                            env=self.env,
                                            stdout=out,
                                            stderr=subprocess.PIPE)

    def focus(self, title):
        window = self.wait(lambda: self.tool("search", "--name", title), "no window")[0]
        self.tool("windowfocus", "--sync", window)
        return window

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


@contextlib.contextmanager
def shown(program, folder):
    needs("xdotool")
    if not (BIN / program).exists():
        pytest.skip(f"{program} is not built")
    with display("400x300", "-noreset", "-fbdir", str(folder)):
        one = Window(program, folder)
        try:
            yield one
        finally:
            one.program.kill()
            one.program.wait()


@pytest.fixture
def viewer(tmp_path):
    with shown("gl_viewer", tmp_path) as one:
        yield one


def colourful(picture):
    """Returns the share of pixels that are green or blue more than red."""
    return (picture[:, :, 1:].max(2) > picture[:, :, 0] + 0.15).mean()


def test_keys_and_drags_reach_the_program(viewer):
    viewer.wait(lambda: colourful(viewer.picture()) > 0.1, "no picture")
    window = viewer.focus("Viewer")
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


def test_keys_go_down_and_up_and_the_wheel_is_two_buttons(tmp_path):
    with shown("gl_input", tmp_path) as program:
        program.wait(lambda: "ready" in program.out.read_text(), "no picture")
        window = program.focus("Input")

        def lines():
            return [line for line in program.out.read_text().splitlines() if line != "ready"]

        def press():  # SDL ignores a key that comes before the focus
            program.tool("key", "a")
            return "up 97" in lines()

        program.wait(press, "the key does not come")
        before = len(lines())
        program.tool("key", "shift+b", "key", "Left", "key", "Return", "mousemove", "--window",
                     window, 20, 30, "click", 4, "click", 5)
        wanted = [
            "down 66", "up 66", "special 100", "special up 100", "down 13", "up 13",
            "button 3 0 at 20 30", "button 3 1 at 20 30", "button 4 0 at 20 30",
            "button 4 1 at 20 30"
        ]
        program.wait(lambda: len(lines()) >= before + len(wanted), "not all events come")
        assert [line for line in lines() if "97" not in line] == wanted
        program.tool("keydown", "c")
        program.wait(lambda: "down 99" in lines(), "the key does not come")
        program.tool("keyup", "c")
        program.wait(lambda: "up 99" in lines(), "the key does not go up")
        assert lines().count("down 99") == 1
        program.tool("key", "Escape")
        assert program.program.wait(PATIENCE) == 0
