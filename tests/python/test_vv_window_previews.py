"""Tests what vv's window does while something moves: it saves the true picture of an instant, shows
previews or raw samples, and loses no picture that waits for its samples."""
import pathlib
import re
import time

import pytest

from conftest import HEADER
from window_driver import PATIENCE, SIZE, SPINNING, Shot, coloured, framebuffer, screen, window  # noqa: F401

# A wall under a sky that is bright above and dark below, and a box that turns beside it for ever.
NOISY = HEADER + """
NavigationInfo { headlight FALSE }
Viewpoint { position 0 0 6 }
Background { skyColor [ 1 1 1, 1 1 1, 0 0 0, 0 0 0 ] skyAngle [ 1.5, 1.6, 3.1 ] }
Shape { appearance Appearance { material Material { diffuseColor .7 .7 .7 } } geometry Box { size 4 3 .2 } }
DEF Clock TimeSensor { cycleInterval 2 loop TRUE }
DEF Turn OrientationInterpolator { key [ 0 .5 1 ] keyValue [ 0 1 0 0, 0 1 0 3.14, 0 1 0 6.28 ] }
Transform { translation 2.6 1.6 0 children DEF Place Transform { children
  Shape { appearance Appearance { material Material { diffuseColor 1 1 0 } } geometry Box { size .5 .5 .2 } } } }
ROUTE Clock.fraction_changed TO Turn.set_fraction
ROUTE Turn.value_changed TO Place.set_rotation
"""

ENDLESS = 65536  # samples per pixel; no picture gets them while a test lasts


def hold(w):
    """Presses S and waits until the world is held: its time stands still."""

    def held():
        before = w.command()
        time.sleep(0.3)  # longer than a picture takes
        return w.command() == before

    w.key("s")
    w.wait(held, "a world that is held")


def goes_on(w):
    w.wait(lambda: w.command() != w.command(), "a world that goes on")


def ended(w, text):
    """Returns what the program has printed about a picture when it has ended."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        found = [line for line in w.err if re.search(text, line)]
        if found:
            return found[-1]
        time.sleep(0.02)
    raise AssertionError(f"{text}: {w.err}")


def saved_picture(w, line, vv):
    """Checks that a line about a picture is true: it was saved, with how many samples, or not."""
    saved = re.search(r"saved as (\S+\.png), with (\d+) of 65536 samples", line)
    if saved:
        shot = Shot(vv.folder / saved[1])
        assert (shot.width, shot.height) == SIZE and 1 <= int(saved[2]) < ENDLESS
    else:
        assert "is not saved: its picture has not begun yet" in line
        assert not list(vv.folder.glob("world-*.png"))


def test_a_picture_saved_during_motion_is_the_headless_one_of_that_instant(window, vv):
    spp = 24
    w = window(SPINNING, "--spp", spp, "--record-input", "in.txt")
    first = w.shot()
    second = w.until(lambda s: s.bytes != first.bytes)
    assert w.end() == 0
    saved = sorted(vv.folder.glob("world-*.png"), key=lambda p: int(p.stem.split("-")[1]))
    times = [
        line.split()[0]
        for line in (vv.folder / "in.txt").read_text().splitlines()
        if line.split()[1:3] == ["down", "S"]
    ]
    assert len(saved) == len(times) >= 2
    for path, at in [(saved[0], times[0]), (saved[-1], times[-1])]:
        done = vv("world.wrl", "--input", "in.txt", "--time", at, "-o", "h.png", "--size",
                  "%dx%d" % SIZE, "--spp", spp)
        assert done.returncode == 0, done.talk
        assert path.read_bytes() == (vv.folder / "h.png").read_bytes(), at
    assert saved[-1].read_bytes() == second.bytes


@pytest.mark.parametrize("again", ["s", "Escape"])
def test_saving_can_be_given_up_and_the_world_goes_on(window, vv, again):
    w = window(SPINNING, "--spp", ENDLESS)
    goes_on(w)
    hold(w)
    w.key(again)
    w.said("world-1.png is not saved: given up")
    goes_on(w)
    assert not list(vv.folder.glob("world-*.png"))
    assert w.end() == 0


def test_the_viewer_is_held_with_the_world(window):
    w = window(SPINNING, "--spp", ENDLESS)
    hold(w)
    before = w.command()
    w.drag(0, 0.8, 0.4, 0.8)
    w.key("3", "H", "End")
    assert w.command() == before
    w.key("s")
    w.said("is not saved: given up")
    goes_on(w)


def test_a_picture_that_is_waited_for_is_not_lost_when_the_window_closes(window, vv):
    w = window(SPINNING, "--spp", ENDLESS)
    hold(w)
    assert w.end() == 0
    saved_picture(w, ended(w, "saved"), vv)


def test_a_picture_that_is_waited_for_is_not_lost_with_its_world(window, vv):
    w = window(SPINNING, "--spp", ENDLESS)
    hold(w)
    vv.write("world.wrl", coloured("0 0 1"))
    w.key("r")
    w.ready(2)
    saved_picture(w, ended(w, "saved"), vv)


def test_the_overlay_of_a_restless_world_names_the_key_that_stops_it(window, screen):
    """After three seconds its line grows by " P pauses: full picture", until P is pressed."""
    w = window(SPINNING, "--size", "640x480")
    w.move(0, -0.95)

    def length():
        """Returns the first column behind the letters of the overlay's first line."""
        rows = framebuffer(screen[1])[:18]
        letters = [x for x in range(len(rows[0])) if any(min(row[x]) > 150 for row in rows)]
        return letters[-1] + 1 if letters else 0

    w.shot()  # the world rests for it, and then moves
    time.sleep(0.5)
    before = w.wait(length, "an overlay")
    w.wait(lambda: length() > before + 100, "a longer line")
    w.key("p")
    w.wait(lambda: 0 < length() < before + 100, "a shorter line")
    assert w.end() == 0


def test_a_key_shows_the_raw_samples(window, screen):
    w = window(NOISY, "--transport", "path", "--spp", 4)
    w.move(0, -0.95)

    def noise():
        """Returns the standard deviation of the wall, which has one colour, below the overlay."""
        text = w.tool("getwindowgeometry", "--shell", w.id)
        left, top = (int(re.search(rf"\b{n}=(\d+)", text)[1]) for n in "XY")
        rows = framebuffer(screen[1])[top + SIZE[1] // 2 + 12:top + SIZE[1] // 2 + 32]
        values = [row[left + SIZE[0] // 2 + x][1] for row in rows for x in range(-15, 15)]
        mean = sum(values) / len(values)
        return (sum((v - mean)**2 for v in values) / len(values))**0.5

    rebuilt = min(noise() for _ in range(5))
    w.key("n")
    w.wait(lambda: noise() > 2 * rebuilt + 4, "raw samples")
    w.key("n")
    w.wait(lambda: noise() < 1.5 * rebuilt + 2, "rebuilt pictures")
    assert w.end() == 0


@pytest.mark.timed
def test_a_finished_picture_lets_the_processor_sleep(window):
    """The window wakes up for its clock, 5 times a second here, and not to ask for input."""
    w = window(coloured("1 0 0"), "--fps", 5)
    w.still()

    def wakes():
        text = pathlib.Path(f"/proc/{w.program.pid}/status").read_text()
        return int(re.search(r"\nvoluntary_ctxt_switches:\s+(\d+)", text)[1])

    def sleeps():
        before, begin = wakes(), time.monotonic()
        time.sleep(1)
        return wakes() - before < 60 * (time.monotonic() - begin)

    w.wait(sleeps, "a window that sleeps")
    w.key("h")  # and wakes up for input
    w.until(lambda s: s.at(0, 0) == (0, 0, 0))


def test_a_large_world_begins_with_the_fast_view(window, vv):
    """The first picture is that of the z-buffer; what is saved is the one of rays."""
    side = 330  # 217,800 triangles
    w = window(HEADER + """
Viewpoint { position 0 0 3 }
Transform { rotation 1 0 0 1.2 translation -1 1 0 children Shape {
  appearance Appearance { material Material { diffuseColor .2 .8 .4 } }
  geometry ElevationGrid { solid FALSE xDimension %d zDimension %d xSpacing .006 zSpacing .006
    height [ %s ] } } }""" % (side + 1, side + 1, "0 " * (side + 1)**2))
    w.said("first picture (fast view)")
    w.still()
    assert w.end() == 0
    assert vv("world.wrl", "-o", "h.png", "--size", "%dx%d" % SIZE, "--spp", "1").returncode == 0
    saved = sorted(vv.folder.glob("world-*.png"), key=lambda p: int(p.stem.split("-")[1]))
    assert saved[-1].read_bytes() == (vv.folder / "h.png").read_bytes()
