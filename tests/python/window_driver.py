"""Drives vv's window for tests, under an Xvfb of their own, with real pointer and key events from
xdotool. Tests check the state of a world by the pictures that the S key saves and by the command
that the C key prints."""
import os
import re
import shlex
import shutil
import struct
import subprocess
import threading
import time

import pytest

from conftest import HEADER, PATIENCE, find_vv
from xserver import display

Image = pytest.importorskip("PIL.Image")

SIZE = (160, 120)

SENSORS = HEADER + """
Viewpoint { position 0 0 10 fieldOfView 0.785398 description "front" }
DirectionalLight { direction -1 -1 -1 }
DEF Side Viewpoint { position 10 0 0 orientation 0 1 0 1.5707963 description "side" }
NavigationInfo { type [ "EXAMINE" "ANY" ] }
Transform { translation -2 0 0 children [
  DEF Touch TouchSensor {}
  Shape { appearance Appearance { material DEF Paint Material { diffuseColor 1 0 0 } } geometry Box { size 2 2 2 } } ] }
DEF Clock TimeSensor { cycleInterval 0.05 }
DEF Blend ColorInterpolator { key [ 0 1 ] keyValue [ 0 1 0, 0 1 0 ] }
ROUTE Touch.touchTime TO Clock.startTime
ROUTE Clock.fraction_changed TO Blend.set_fraction
ROUTE Blend.value_changed TO Paint.diffuseColor
Group { children [ DEF Plane PlaneSensor { offset 2 0 0 }
  DEF Place Transform { translation 2 0 0 children
    Shape { appearance Appearance { material Material { diffuseColor 0 0 1 } } geometry Box { size 1.5 1.5 1.5 } } } ] }
ROUTE Plane.translation_changed TO Place.set_translation
"""

SPINNING = HEADER + """
Viewpoint { position 0 0 6 }
DEF Clock TimeSensor { cycleInterval 2 loop TRUE }
DEF Turn OrientationInterpolator { key [ 0 .5 1 ] keyValue [ 0 1 0 0, 0 1 0 3.14, 0 1 0 6.28 ] }
DEF Place Transform { children Transform { translation 1.5 0 0 children
  Shape { appearance Appearance { material Material { diffuseColor 1 1 0 } } geometry Box { size 1 1 1 } } } }
ROUTE Clock.fraction_changed TO Turn.set_fraction
ROUTE Turn.value_changed TO Place.set_rotation
"""


def coloured(colour, extra=""):
    return HEADER + (
        "Viewpoint { position 0 0 5 } NavigationInfo { type [ \"EXAMINE\" \"ANY\" ] } " + extra +
        " Shape { appearance Appearance { material Material { diffuseColor %s } } geometry Box {} }"
        % colour)


def needs(*tools):
    for tool in tools:
        if not shutil.which(tool):
            pytest.skip(f"{tool} is not installed")


class Shot:
    """A picture whose pixels are addressed by positions from -1 to 1, like the pointer."""

    def __init__(self, path):
        self.bytes = path.read_bytes()
        with Image.open(path) as picture:
            self.width, self.height = picture.size
            flat = list(picture.convert("RGB").getdata())
        self.rows = [flat[y * self.width:(y + 1) * self.width] for y in range(self.height)]

    def at(self, x, y):
        return self.rows[int((1 - y) / 2 * self.height)][int((x + 1) / 2 * self.width)]

    def share(self, test):
        return sum(test(*p) for row in self.rows for p in row) / (self.width * self.height)


def red(r, g, b):
    return r > 100 and g < 60 and b < 60


def green(r, g, b):
    return g > 100 and r < 60 and b < 60


def blue(r, g, b):
    return b > 100 and r < 60 and g < 60


class Window:
    """vv with a window on a display of its own."""

    def __init__(self, folder, display, arguments, env=None):
        self.folder = folder
        self.env = {
            **os.environ, "DISPLAY": display,
            "SDL_AUDIODRIVER": "dummy",
            "SDL_RENDER_DRIVER": "software",
            "XDG_STATE_HOME": str(folder / "state"),  # panels have their usual widths
            "XDG_DATA_HOME": str(folder / "data"),  # there are no materials of a user
            **(env or {})
        }
        self.env.pop("WAYLAND_DISPLAY", None)
        self.program = subprocess.Popen([find_vv(), *map(str, arguments), "-v"],
                                        cwd=folder,
                                        env=self.env,
                                        stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE,
                                        text=True)
        self.out, self.err = [], []
        for stream, lines in ((self.program.stdout, self.out), (self.program.stderr, self.err)):
            threading.Thread(target=lambda s=stream, l=lines: [l.append(x.rstrip("\n")) for x in s],
                             daemon=True).start()

    def wait(self, test, what):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            answer = test()
            if answer:
                return answer
            if self.program.poll() is not None:
                break
            time.sleep(0.02)
        raise AssertionError(f"{what}: {self.out} {self.err}")

    def said(self, text, count=1):
        self.wait(lambda: sum(text in line for line in self.err) >= count, text)

    def ready(self, pictures=1):
        self.said("first picture", pictures)
        self.id = self.wait(lambda: self.tool("search", "--pid", str(self.program.pid)).split(),
                            "window")[0]
        self.tool("windowfocus", "--sync", self.id)
        return self

    def tool(self, *arguments):
        return subprocess.run(["xdotool", *map(str, arguments)],
                              env=self.env,
                              capture_output=True,
                              text=True,
                              timeout=PATIENCE).stdout

    def key(self, *names):
        self.tool("key", *names)

    def place(self, x, y):
        """Returns xdotool arguments for a position in the picture from -1 to 1, in window pixels.
        """
        width, height = self.size()
        return ["--window", self.id, int((x + 1) / 2 * width), int((1 - y) / 2 * height)]

    def size(self):
        text = self.tool("getwindowgeometry", "--shell", self.id)
        return [int(re.search(rf"{n}=(\d+)", text)[1]) for n in ("WIDTH", "HEIGHT")]

    def move(self, x, y):
        self.tool("mousemove", *self.place(x, y))

    def click(self, x, y):
        self.move(x, y)
        self.tool("click", 1)

    def drag(self, x0, y0, x1, y1, button=1, steps=4):
        self.move(x0, y0)
        self.tool("mousedown", button)
        for i in range(1, steps + 1):
            self.move(x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps)
            time.sleep(0.04)
        self.tool("mouseup", button)

    def shot(self):
        told = [line for line in self.err if "saved as" in line]
        self.key("s")
        self.said("saved as", len(told) + 1)
        line = [line for line in self.err if "saved as" in line][len(told)]
        return Shot(self.folder / line.split("saved as ")[1])

    def until(self, test):
        """Returns the first picture for which test is true."""
        return self.wait(lambda: (lambda s: s if test(s) else None)(self.shot()), "no such picture")

    def still(self):
        """Returns the picture once nothing changes any more."""
        return self.until(lambda s: s.width == SIZE[0] and s.bytes == self.shot().bytes)

    def command(self):
        count = len(self.out)
        self.key("c")
        self.wait(lambda: len(self.out) > count, "no command")
        return shlex.split(self.out[count])

    def camera(self):
        numbers = next(w for w in self.command() if w.startswith("--camera="))[9:]
        return [[float(v) for v in part.split(",")] for part in numbers.split(":")]

    def end(self, key="q"):
        self.key(key)
        return self.program.wait(PATIENCE)


@pytest.fixture(scope="module")
def screen(tmp_path_factory):
    needs("xdotool")
    folder = tmp_path_factory.mktemp("screen")
    with display("640x480", "-noreset", "-fbdir", str(folder)) as name:
        yield name, folder / "Xvfb_screen0"


@pytest.fixture
def window(vv, screen):
    opened = []

    def open_window(world, *arguments, env=None, ready=True):
        if world is not None and world.startswith("#VRML"):
            vv.write("world.wrl", world)
            world = "world.wrl"
        one = Window(
            vv.folder, screen[0],
            [*([world] if world else []), "--size",
             "%dx%d" % SIZE, "--spp", 1, *arguments], env)
        opened.append(one)
        if ready:
            one.ready()
        return one

    if "without SDL" in vv("box.wrl", env={"DISPLAY": ":no"}).talk:
        pytest.skip("vv is built without SDL")
    yield open_window
    for one in opened:
        one.program.kill()
        one.program.wait()


def framebuffer_row(path, y):
    """Returns the bytes of one row that the X server shows."""
    data = path.read_bytes()
    header = struct.unpack_from(">25I", data)
    start = header[0] + 12 * header[19] + y * header[12]
    return data[start:start + header[12]]


def framebuffer(path):
    """Returns the rows of (r, g, b) that the X server shows, from an XWD file."""
    data = path.read_bytes()
    header = struct.unpack_from(">25I", data)
    start, width, height, order, stride, colours = header[0], header[4], header[5], header[
        7], header[12], header[19]
    pixels = data[start + 12 * colours:]
    pick = (2, 1, 0) if order == 0 else (1, 2, 3)
    return [[tuple(pixels[y * stride + 4 * x + i]
                   for i in pick)
             for x in range(width)]
            for y in range(height)]
