"""vv's window under Xvfb, with real pointer and key events from xdotool. What the world has become shows in the pictures that the S
key saves, and in the command that the C key prints."""
import contextlib
import math
import os
import re
import shlex
import shutil
import signal
import struct
import subprocess
import threading
import time
import wave
import zlib

import pytest

from conftest import HEADER, ROOT, find_vv, read_ppm

SIZE = (160, 120)
PATIENCE = 20  # seconds, for what takes a moment on an idle machine

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
    return HEADER + ("Viewpoint { position 0 0 5 } NavigationInfo { type [ \"EXAMINE\" \"ANY\" ] } " + extra +
                     " Shape { appearance Appearance { material Material { diffuseColor %s } } geometry Box {} }" % colour)


def needs(*tools):
    for tool in tools:
        if not shutil.which(tool):
            pytest.skip(f"{tool} is not installed")


def read_png(path):
    """Width, height and rows of (r, g, b) of a PNG with 8 bits a colour."""
    data = path.read_bytes()
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + length]
        at += 12 + length
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack_from(">IIBB", body)
            assert (depth, colour) == (8, 2)
        elif kind == b"IDAT":
            packed += body
    raw, stride, rows = zlib.decompress(packed), 3 * width, []
    before = bytearray(stride)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            left, up, corner = line[x - 3] if x > 2 else 0, before[x], before[x - 3] if x > 2 else 0
            if kind == 4:
                guess = min((abs(up - corner), 0, left), (abs(left - corner), 1, up), (abs(left + up - 2 * corner), 2, corner))[2]
            else:
                guess = (0, left, up, (left + up) // 2)[kind]
            line[x] = (line[x] + guess) & 255
        rows.append([tuple(line[x:x + 3]) for x in range(0, stride, 3)])
        before = line
    return width, height, rows


class Shot:
    """A picture that is asked by places from -1 to 1, as pointers are."""

    def __init__(self, path):
        self.bytes = path.read_bytes()
        self.width, self.height, self.rows = read_png(path)

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
        self.env = {**os.environ, "DISPLAY": display, "SDL_AUDIODRIVER": "dummy", "SDL_RENDER_DRIVER": "software", **(env or {})}
        self.env.pop("WAYLAND_DISPLAY", None)
        self.program = subprocess.Popen([find_vv(), *map(str, arguments), "-v"], cwd=folder, env=self.env, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        self.out, self.err = [], []
        for stream, lines in ((self.program.stdout, self.out), (self.program.stderr, self.err)):
            threading.Thread(target=lambda s=stream, l=lines: [l.append(x.rstrip("\n")) for x in s], daemon=True).start()

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
        self.id = self.wait(lambda: self.tool("search", "--pid", str(self.program.pid)).split(), "window")[0]
        self.tool("windowfocus", "--sync", self.id)
        return self

    def tool(self, *arguments):
        return subprocess.run(["xdotool", *map(str, arguments)], env=self.env, capture_output=True, text=True, timeout=PATIENCE).stdout

    def key(self, *names):
        self.tool("key", *names)

    def place(self, x, y):
        """Of the screen's pixels, for places of the picture from -1 to 1."""
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
        """The first picture of which test is true."""
        return self.wait(lambda: (lambda s: s if test(s) else None)(self.shot()), "no such picture")

    def still(self):
        """The picture when nothing changes any more."""
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
    needs("Xvfb", "xdotool")
    folder = tmp_path_factory.mktemp("screen")
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "640x480x24", "-nolisten", "tcp", "-noreset", "-fbdir", folder],
                              pass_fds=(write,), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as pipe:
        number = pipe.readline().strip()
    if not number:
        server.wait()
        pytest.skip("Xvfb does not start")
    yield f":{number}", folder / "Xvfb_screen0"
    server.terminate()
    server.wait()


@pytest.fixture
def window(vv, screen):
    opened = []

    def open_window(world, *arguments, env=None, ready=True):
        if world is not None and world.startswith("#VRML"):
            vv.write("world.wrl", world)
            world = "world.wrl"
        one = Window(vv.folder, screen[0], [*([world] if world else []), "--size", "%dx%d" % SIZE, "--spp", 1, *arguments], env)
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


def without_display(vv, **env):
    kept = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")}
    return subprocess.run([vv.program, "box.wrl"], cwd=vv.folder, env={**kept, **env}, capture_output=True, text=True, timeout=60)


@pytest.mark.parametrize("env", [{}, {"DISPLAY": ":no"}])
def test_without_a_display_one_line_says_so(vv, env):
    done = without_display(vv, **env)
    assert done.returncode == 1 and done.stdout == ""
    assert len(done.stderr.splitlines()) == 1 and done.stderr.startswith("vv: error: no window: "), done.stderr
    assert "-o picture.png" in done.stderr


def test_a_touch_sensor_is_clicked(window):
    w = window(SENSORS)
    assert red(*w.until(lambda s: s.width == SIZE[0]).at(-0.3, 0))
    w.click(-0.35, 0)
    w.until(lambda s: green(*s.at(-0.35, 0)))
    assert w.end() == 0


def test_a_plane_sensor_is_dragged_and_the_viewer_stays(window):
    w = window(SENSORS)
    assert blue(*w.shot().at(0.36, 0))
    before = w.camera()
    w.drag(0.36, 0, 0.36, 0.5)
    w.until(lambda s: blue(*s.at(0.36, 0.5)) and not blue(*s.at(0.36, 0)))
    assert w.camera() == before


def test_viewpoint_keys(window):
    w = window(SENSORS)
    front = w.camera()
    w.key("Page_Down")
    w.wait(lambda: abs(w.camera()[0][0] - 10) < 1e-6, "the side")
    w.key("bracketleft")
    w.wait(lambda: w.camera() == front, "the front")
    w.key("End")
    w.wait(lambda: abs(w.camera()[0][0] - 10) < 1e-6, "the last")
    w.key("Home")
    w.wait(lambda: w.camera() == front, "the first")
    w.drag(0, 0.8, 0.3, 0.8)
    assert w.camera() != front
    w.key("BackSpace")
    w.wait(lambda: w.camera() == front, "back")


def test_the_printed_command_gives_the_same_view(window, vv):
    w = window(SENSORS, "--shadows", "off")
    w.drag(0, 0.8, 0.3, 0.5)
    w.key("h")
    shot = w.still()
    command = w.command()
    assert command[0] == "vv" and "off" in command
    done = vv(*command[1:-2], "-o", "again.png")
    assert done.returncode == 0, done.talk
    again = Shot(vv.folder / "again.png")
    far = sum(max(abs(p - q) for p, q in zip(a, b)) > 2 for r, s in zip(shot.rows, again.rows) for a, b in zip(r, s))
    assert (again.width, again.height) == SIZE and far < SIZE[0] * SIZE[1] / 200


def test_examine_turns_moves_and_zooms(window):
    w = window(coloured("1 0 0"))
    w.drag(0, 0.9, 0.5, 0.9)  # the world follows the pointer
    eye = w.camera()[0]
    assert math.hypot(*eye) == pytest.approx(5, abs=1e-3) and eye[0] == pytest.approx(-5 * math.sin(math.pi / 4), abs=0.2)
    w.key("BackSpace")
    w.move(0, 0.9)
    w.tool("click", 4)
    w.wait(lambda: 3 < w.camera()[0][2] < 4.9, "nearer")
    w.key("BackSpace")
    w.wait(lambda: w.camera()[0] == [0, 0, 5], "back")
    w.drag(0, 0.9, 0.5, 0.9, button=3)
    assert w.camera()[0][0] == pytest.approx(-0.5 * 5 * math.tan(math.pi / 8) * 4 / 3, abs=0.06)


def test_walking_by_keys_and_by_mouse_on_the_ground(window):
    w = window(HEADER + "NavigationInfo { type \"WALK\" speed 4 } Viewpoint { position 0 1.6 30 } "
               "Transform { translation 0 -1 0 children Shape { geometry Box { size 100 2 100 } } }")
    w.tool("keydown", "Up")
    w.wait(lambda: w.camera()[0][2] < 29.5, "ahead")
    w.tool("keyup", "Up")
    eye = w.camera()[0]
    assert eye[0] == pytest.approx(0, abs=1e-6) and eye[1] == pytest.approx(1.6, abs=1e-4)
    w.move(0, 0)
    w.tool("mousedown", 1)
    w.move(0, 0.5)
    w.wait(lambda: w.camera()[0][2] < eye[2] - 0.5, "ahead by mouse")
    w.tool("mouseup", 1)
    w.key("4")  # the world allows nothing but WALK
    w.tool("keydown", "Left")
    w.wait(lambda: w.camera()[1][0] < -0.1, "turned to the left")
    w.tool("keyup", "Left")


def test_resizing_makes_larger_pictures(window):
    w = window(SENSORS)
    w.tool("windowsize", w.id, 240, 200)
    shot = w.until(lambda s: (s.width, s.height) == (240, 200))
    assert red(*shot.at(-0.4, 0))


def test_pausing_holds_the_world_and_not_the_viewer(window):
    w = window(SPINNING)
    first = w.shot().bytes
    w.until(lambda s: s.bytes != first)
    w.key("p")
    held = w.still()
    before = w.camera()
    w.key("3")
    w.tool("keydown", "Up")
    w.wait(lambda: w.camera()[0][2] < before[0][2] - 0.1, "flying")
    w.tool("keyup", "Up")
    w.key("p")
    w.until(lambda s: s.bytes != held.bytes)


def test_headlight_key(window):
    w = window(coloured("1 0 0"))
    assert red(*w.shot().at(0, 0))
    w.key("h")
    w.until(lambda s: s.at(0, 0) == (0, 0, 0))


def test_frame_all_shows_a_world_far_away(window):
    w = window(HEADER + "Viewpoint { position 0 0 500 } NavigationInfo { type \"EXAMINE\" } Shape { appearance Appearance { "
               "material Material { diffuseColor 1 0 0 } } geometry Box {} }")
    assert w.shot().share(red) < 0.01
    w.key("f")
    w.until(lambda s: s.share(red) > 0.2)


def test_a_world_without_viewpoint_is_seen_whole_as_in_a_picture(window, vv):
    w = window(HEADER + "Transform { translation 40 3 2 children Shape { geometry Box { size 6 1 1 } } }")
    shot = w.until(lambda s: s.width == SIZE[0])
    assert vv("world.wrl", "-o", "p.png", "--size", "%dx%d" % SIZE, "--spp", 1).returncode == 0
    still = Shot(vv.folder / "p.png")
    assert sum(a != b for r, s in zip(shot.rows, still.rows) for a, b in zip(r, s)) < 20


def test_an_anchor_leads_to_another_world_and_a_bad_one_nowhere(window, vv):
    vv.write("other.wrl", coloured("0 0 1"))
    anchors = ('Anchor { url "missing.wrl" children Transform { translation -1.2 0 0 children Shape { geometry Box { size 1 1 1 } } } } '
               'Anchor { url "other.wrl" description "away" children Transform { translation 1.2 0 0 children Shape { geometry '
               'Box { size 1 1 1 } } } }')
    w = window(HEADER + "Viewpoint { position 0 0 5 } " + anchors)
    w.click(-0.45, 0)
    w.said("missing.wrl")
    assert not blue(*w.shot().at(0, 0))
    w.click(0.45, 0)
    w.ready(2)
    w.until(lambda s: blue(*s.at(0, 0)))
    assert w.end() == 0


def test_watch_reads_a_changed_file_and_keeps_the_viewer(window, vv):
    w = window(coloured("1 0 0"), "--watch")
    w.drag(0, 0.9, 0.2, 0.9)
    w.until(lambda s: red(*s.at(0, 0)))
    place = w.camera()
    vv.write("world.wrl", coloured("0 0 1"))
    w.until(lambda s: blue(*s.at(0, 0)))
    assert all(a == pytest.approx(b) for a, b in zip(w.camera(), place))
    vv.write("world.wrl", "no world at all")
    w.said("vv: error")
    assert blue(*w.shot().at(0, 0))


def test_a_world_that_cannot_be_read_is_said_in_the_window(window):
    w = window("absent.wrl", ready=False)
    w.said("absent.wrl")
    w.id = w.wait(lambda: w.tool("search", "--pid", str(w.program.pid)).split(), "window")[0]
    w.tool("windowfocus", "--sync", w.id)
    assert w.end("Escape") == 3


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_end_it(window, number):
    w = window(SPINNING, "--spp", 60000)
    w.program.send_signal(number)
    assert w.program.wait(PATIENCE) == 130


def test_inlines_come_after_the_first_picture(window, vv):
    vv.write("part.wrl", coloured("0 0 1"))
    vv.write("nest.wrl", HEADER + 'Inline { url "part.wrl" }')
    w = window(HEADER + 'Viewpoint { position 0 0 5 } Inline { url "nest.wrl" }')
    w.until(lambda s: blue(*s.at(0, 0)))


def framebuffer(path):
    """Rows of (r, g, b) of what the X server shows: an XWD file."""
    data = path.read_bytes()
    header = struct.unpack_from(">25I", data)
    start, width, height, order, stride, colours = header[0], header[4], header[5], header[7], header[12], header[19]
    pixels = data[start + 12 * colours:]
    pick = (2, 1, 0) if order == 0 else (1, 2, 3)
    return [[tuple(pixels[y * stride + 4 * x + i] for i in pick) for x in range(width)] for y in range(height)]


def test_the_screen_shows_the_picture_and_the_overlay(window, screen):
    w = window(coloured("1 0 0"))
    w.move(0, -0.9)  # the cursor is part of the screen
    w.until(lambda s: s.width == SIZE[0])

    def seen():
        rows = framebuffer(screen[1])
        text = w.tool("getwindowgeometry", "--shell", w.id)
        left, top = (int(re.search(rf"\b{n}=(\d+)", text)[1]) for n in "XY")
        part = [row[left:left + SIZE[0]] for row in rows[top:top + SIZE[1]]]
        corner = sum(max(p) > 150 for row in part[:20] for p in row[:100])  # letters
        return red(*part[SIZE[1] // 2][SIZE[0] // 2]), corner > 20

    w.wait(lambda: seen() == (True, True), "picture and overlay")
    w.key("i")  # two at once are taken for a key that repeats
    w.key("i")
    w.wait(lambda: seen() == (True, False), "no overlay")


INPUT = """# a click, a drag, a viewpoint, a way round
0.1 move -0.35 0
0.2 press left
0.3 release left
0.5 press left 0.36 0
0.6 move 0.36 0.25
0.7 release left 0.36 0.5
1 press left 0 0.9
1.1 move 0.2 0.8
1.2 release left
1.5 wheel 1
"""


def test_the_same_input_gives_the_same_bytes(vv):
    vv.write("world.wrl", SENSORS)
    vv.write("in.txt", INPUT)
    made = []
    for name in ("a.ppm", "b.ppm"):
        done = vv("world.wrl", "--input", "in.txt", "-o", name, "--size", "160x120", "--spp", 2)
        assert done.returncode == 0, done.talk
        made.append((vv.folder / name).read_bytes())
    assert made[0] == made[1]
    rows = read_ppm(made[0])[2]
    count = [sum(test(*p) for row in rows for p in row) for test in (red, green, blue)]
    assert count[0] == 0 and count[1] > 200 and count[2] > 100
    assert vv("world.wrl", "-o", "c.ppm", "--size", "160x120", "--spp", 2).returncode == 0
    assert (vv.folder / "c.ppm").read_bytes() != made[0]


def test_with_and_without_a_window_input_gives_the_same_bytes(window, vv):
    vv.write("world.wrl", SPINNING)
    vv.write("in.txt", "0.2 press left 0 0.5\n0.4 move 0.3 0.1\n0.6 release left\n0.7 key F\n1 save w.png\n1.1 quit\n")
    w = window("world.wrl", "--input", "in.txt", "--spp", 3, ready=False)
    assert w.program.wait(PATIENCE) == 0
    done = vv("world.wrl", "--input", "in.txt", "--time", 1, "-o", "h.png", "--size", "%dx%d" % SIZE, "--spp", 3)
    assert done.returncode == 0, done.talk
    assert (vv.folder / "w.png").read_bytes() == (vv.folder / "h.png").read_bytes()


def test_what_was_recorded_can_be_played(window, vv):
    w = window(SENSORS, "--record-input", "in.txt")
    w.click(-0.35, 0)
    w.drag(0.36, 0, 0.36, 0.5)
    w.key("Page_Down")
    w.until(lambda s: blue(*s.at(0, 0.4)))
    assert w.end() == 0
    text = (vv.folder / "in.txt").read_text()
    assert "press left" in text and "down PageDown" in text
    end = float(text.splitlines()[-1].split()[0]) + 2
    for name in ("a.png", "b.png"):
        assert vv("world.wrl", "--input", "in.txt", "--time", end, "-o", name, "--size", "%dx%d" % SIZE, "--spp", 1).returncode == 0
    assert (vv.folder / "a.png").read_bytes() == (vv.folder / "b.png").read_bytes()
    shot = Shot(vv.folder / "a.png")
    assert shot.share(blue) > 0.01 and shot.share(red) == 0


@pytest.mark.parametrize("line, word", [("x", "number"), ("0 jump", "no event"), ("1 move 0", "a place"), ("1 press up", "middle"),
                                        ("1 key H super", "shift"), ("1 leave it", "not expected"), ("2 leave\n1 leave", "earlier")])
def test_a_script_that_is_wrong_names_its_line(vv, line, word):
    vv.write("in.txt", "# first\n" + line + "\n")
    done = vv("box.wrl", "--input", "in.txt", "-o", "x.png")
    assert done.returncode == 2 and re.search(r"in\.txt:[23]: ", done.talk) and word in done.talk, done.talk
    assert vv("box.wrl", "--input", "absent.txt", "-o", "x.png").returncode == 3


def test_sound_arrives_with_its_pitch_on_its_side(window, vv):
    rate, tone = 8000, 500
    with wave.open(str(vv.folder / "tone.wav"), "wb") as file:
        file.setnchannels(1), file.setsampwidth(2), file.setframerate(rate)
        file.writeframes(b"".join(struct.pack("<h", int(16000 * math.sin(2 * math.pi * tone * i / rate))) for i in range(rate)))
    w = window(HEADER + "Viewpoint { position 0 0 0 } Sound { location 5 0 0 minFront 20 minBack 20 maxFront 90 maxBack 90 intensity 1 "
               "source AudioClip { url \"tone.wav\" loop TRUE pitch 2 } } Shape { geometry Box {} }",
               env={"SDL_AUDIODRIVER": "disk", "SDL_DISKAUDIOFILE": "sound.raw", "SDL_DISKAUDIODELAY": "5"})
    raw = vv.folder / "sound.raw"
    w.wait(lambda: raw.exists() and raw.stat().st_size > 8 * 48000, "sound")
    assert w.end() == 0
    data = raw.read_bytes()
    pairs = struct.unpack(f"<{len(data) // 8 * 2}f", data[:len(data) // 8 * 8])
    left, right = pairs[4096:8 * 4096:2], pairs[4097:8 * 4096:2]  # after it has faded in
    strength = [math.sqrt(sum(v * v for v in side) / len(side)) for side in (left, right)]
    assert strength[1] > 1.2 * strength[0] > 0
    assert max(right) < 16000 / 32768 * math.sqrt(2) * 1.01
    crossings = sum(a < 0 <= b for a, b in zip(right, right[1:]))
    assert crossings / (len(right) / 48000) == pytest.approx(2 * tone, rel=0.03)


def test_the_page_lists_the_keys(vv):
    done = vv("--list-keys")
    assert done.returncode == 0
    page = (ROOT / "docs/window.md").read_text()
    rows = {tuple(cell.strip() for cell in line.strip("|").split("|")) for line in page.splitlines() if line.startswith("|")}
    for line in done.text.splitlines():
        assert (line[:24].strip(), line[24:].strip()) in rows, line
