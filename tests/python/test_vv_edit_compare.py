"""Tests comparisons, rectangles and handles of the editor in vv's window with real clicks and keys."""
import re
import time

import pytest

from conftest import HEADER
from editor_window import needs_the_editor, press, saved, text  # noqa: F401
from window_driver import framebuffer, screen, window  # noqa: F401

# At 600x400 the panels leave the picture from -0.48 to 0.4. The boxes are at -0.32 and 0.32.
WORLD = HEADER + """
Viewpoint { position 0 0 10 fieldOfView 0.785398 }
NavigationInfo { headlight FALSE type [ "EXAMINE" "ANY" ] }
DirectionalLight { direction 0 0 -1 }
DEF LEFT Transform { translation -2 0 0 children Shape {
  appearance Appearance { material Material { diffuseColor .5 .5 .5 } } geometry Box { size 1 1 1 } } }
DEF RIGHT Transform { translation 2 0 0 children Shape {
  appearance Appearance { material Material { diffuseColor .5 .5 .5 } } geometry Box { size 1 1 1 } } }
"""
HALF = 4.1421  # half the height of what is seen at the boxes
RIGHT = 2 / (1.5 * HALF)  # where the right one is seen
ARROW = 0.3 / 1.5  # the length of an arrow in the picture


class Editor:
    """The editor in a window, and what the screen shows of it."""

    def __init__(self, window, screen):
        self.window, self.screen = window, screen
        window.key("e")

    def corner(self):
        text = self.window.tool("getwindowgeometry", "--shell", self.window.id)
        return [int(re.search(rf"{n}=(-?\d+)", text)[1]) for n in ("X", "Y")]

    def rows(self):
        left, top = self.corner()
        return [row[left:left + 600] for row in framebuffer(self.screen[1])[top:top + 400]]

    def at(self, x, y):
        return self.rows()[int((1 - y) / 2 * 400)][int((x + 1) / 2 * 600)]

    def until(self, test, what):
        self.window.wait(lambda: test(self.rows()), what)

    def says(self):
        """Returns what the bottom of the window shows between the panels."""
        return [row[160:410] for row in self.rows()[384:]]

    def keep(self):
        """Keeps A, and waits for the long message that says that it has all its samples."""
        self.window.key("b")
        self.until(lambda rows: any(min(p) > 150 for row in rows[384:] for p in row[250:400]), "A")

    def drag(self, *places, keys=()):
        for key in keys:
            self.window.tool("keydown", key)
        self.window.drag(*places)
        for key in keys:
            self.window.tool("keyup", key)


@pytest.fixture
def editor(window, screen):
    return Editor(window(WORLD, "--size", "600x400", "--spp", 64), screen)


def is_grey(colour):
    return 90 < min(colour) and max(colour) - min(colour) < 12


def is_dark(colour):
    return max(colour) < 40


def is_loss(colour):
    return colour[2] > 200 and colour[0] < 110


def pixel(rows, x, y):
    return rows[int((1 - y) / 2 * 400)][int((x + 1) / 2 * 600)]


def remove_the_right_box(editor):
    editor.until(lambda rows: is_grey(pixel(rows, RIGHT, .05)), "the box")
    editor.keep()
    editor.window.click(RIGHT, .05)
    editor.window.key("Delete")
    editor.until(lambda rows: is_dark(pixel(rows, RIGHT, .05)), "no box")


def test_a_picture_is_kept_shown_and_compared(editor):
    w = editor.window
    remove_the_right_box(editor)
    w.key("backslash")
    editor.until(lambda rows: is_grey(pixel(rows, RIGHT, .05)), "A")
    w.key("backslash")
    editor.until(lambda rows: is_dark(pixel(rows, RIGHT, .05)), "the present picture")
    w.key("w")  # A is at the left of the middle
    editor.until(lambda rows: max(pixel(rows, 0, -.5)) > 120, "the line")
    assert is_dark(editor.at(RIGHT, .05))
    editor.drag(0, -.5, RIGHT + .05, -.5)
    editor.until(lambda rows: is_grey(pixel(rows, RIGHT, .05)), "A at the left of the line")
    w.key("d")
    editor.until(lambda rows: is_loss(pixel(rows, RIGHT, .05)), "the loss")
    assert not is_loss(editor.at(-RIGHT, .05)) and max(editor.at(-RIGHT, .05)) < 120
    w.key("Escape")
    editor.until(lambda rows: is_dark(pixel(rows, RIGHT, .05)), "the present picture")
    assert w.program.poll() is None


def test_another_view_is_not_compared(editor):
    w = editor.window
    remove_the_right_box(editor)
    w.key("backslash")
    editor.until(lambda rows: is_grey(pixel(rows, RIGHT, .05)), "A")
    before = editor.says()
    editor.drag(0, -.6, .02, -.6)  # turns the world
    editor.until(lambda rows: is_dark(pixel(rows, RIGHT, .05)), "the present picture")
    w.wait(lambda: editor.says() != before, "why not")


def test_handles_move_turn_and_scale(editor, vv):
    w = editor.window
    editor.until(lambda rows: is_grey(pixel(rows, -RIGHT, .05)), "the box")
    w.move(-RIGHT, .05)
    w.tool("keydown", "ctrl", "click", 1, "keyup", "ctrl")
    arrow = -RIGHT + .7 * ARROW
    editor.until(lambda rows: pixel(rows, arrow, 0)[0] > 150 > pixel(rows, arrow, 0)[1], "the arrow")
    editor.drag(arrow, 0, arrow + .15, 0)
    now = saved(w, vv, lambda t: t != WORLD)
    place = re.search(r"LEFT Transform { translation (\S+) 0 0 children", now)
    assert float(place[1]) == pytest.approx(-2 + .15 * 1.5 * HALF, abs=.05)
    w.key("ctrl+z", "t")
    saved(w, vv, lambda t: t == WORLD)
    across, up = .3 * .7071 / 1.5, .3 * .7071
    editor.drag(-RIGHT + across, up, -RIGHT - across, up)
    now = saved(w, vv, lambda t: t != WORLD)
    angle = re.search(r"rotation 0 0 1 (\S+)", now)
    assert float(angle[1]) == pytest.approx(1.5708, abs=.05)
    w.key("ctrl+z", "t")
    saved(w, vv, lambda t: t == WORLD)
    editor.drag(-RIGHT + ARROW, 0, -RIGHT + 2 * ARROW, 0)
    now = saved(w, vv, lambda t: t != WORLD)
    scale = re.search(r"scale (\S+) 1 1", now)
    assert float(scale[1]) == pytest.approx(2, abs=.1)


def test_a_drag_with_ctrl_selects_what_is_seen_in_a_rectangle(editor, vv):
    w = editor.window
    editor.until(lambda rows: is_grey(pixel(rows, -RIGHT, .05)), "the box")
    editor.drag(-.1, .4, .39, -.4, keys=["ctrl"])
    editor.drag(.1, .4, -.47, -.4, keys=["ctrl", "shift"])
    w.key("Delete")
    now = saved(w, vv, lambda t: t != WORLD)
    assert "Shape" not in now and "LEFT" in now and "RIGHT" in now


def test_a_readout_stands_beside_a_pointer_that_rests(editor):
    w = editor.window
    w.move(RIGHT, 0)
    # Towards the left, and above: the box of the readout is dark, its text is bright.
    beside = lambda rows: [row[220:370] for row in rows[140:185]]
    bright = lambda rows: sum(min(p) > 180 for row in beside(rows) for p in row)
    editor.until(lambda rows: bright(rows) > 40, "the readout")
    assert is_grey(editor.at(RIGHT, 0))  # what the pointer is on stays free
    w.move(0.1, -0.9)
    editor.until(lambda rows: bright(rows) < 10, "it goes with the pointer")
    w.move(RIGHT, 0)
    editor.until(lambda rows: bright(rows) > 40, "and is there again")
    w.move(-0.9, 0)  # over a panel
    editor.until(lambda rows: bright(rows) < 10, "it is of the picture alone")


def test_a_rectangle_is_measured(editor):
    w = editor.window
    editor.until(lambda rows: is_grey(pixel(rows, -RIGHT, .05)), "the box")
    w.key("shift+v")
    editor.drag(-.4, .6, .3, .4)
    line = int(.2 * 400)  # the upper edge

    def is_drawn(rows):
        return any(row[260][0] > row[260][2] + 60 for row in rows[line - 1:line + 2])

    editor.until(is_drawn, "the rectangle")
    # The list of the probes is at the bottom, between the panels.
    editor.until(lambda rows: sum(max(p) > 150 for row in rows[300:370] for p in row[170:400]) > 50,
                 "the list")
    assert w.program.poll() is None


def test_a_report_shows_how_far_it_is_until_escape_gives_it_up(window, screen, vv):
    editor = Editor(window(WORLD, "--size", "600x400", "--spp", 60000), screen)
    w = editor.window
    editor.until(lambda rows: is_grey(pixel(rows, RIGHT, .05)), "the box")
    before = editor.says()
    press(w, 32, 118)
    w.wait(lambda: editor.says() != before, "how far it is")
    w.key("Escape")
    w.said("no report: its picture was given up")
    assert not list(vv.folder.glob("world-report*"))
    assert w.program.poll() is None


def test_the_view_follows_the_camera_while_a_report_waits(window, screen, vv):
    editor = Editor(window(WORLD, "--size", "600x400", "--spp", 60000), screen)
    w = editor.window
    editor.until(lambda rows: is_grey(pixel(rows, RIGHT, .05)), "the box")
    before = editor.says()
    press(w, 32, 118)
    w.wait(lambda: editor.says() != before, "how far it is")

    def boxes(rows):
        return {x for x in range(170, 410) if is_grey(rows[190][x])}

    shown = boxes(editor.rows())
    editor.drag(0, -.6, .35, -.6)  # turns the world
    editor.until(lambda rows: len(boxes(rows) ^ shown) > 12, "the turned world")
    w.key("Escape")
    w.said("no report: its picture was given up")
    assert w.program.poll() is None


def test_the_menu_of_a_probe_keeps_it_in_the_world(editor, vv):
    w = editor.window
    editor.until(lambda rows: is_grey(pixel(rows, -RIGHT, .05)), "the box")
    w.move(-RIGHT, .05)
    w.key("v")

    def lines(rows):
        """The rows of pixels in the list of the probes that have text."""
        return [y for y in range(300, 370) if sum(max(p) > 150 for p in rows[y][170:400]) > 8]

    editor.until(lines, "the list")
    found = []

    def keeps(y):
        press(w, 200, y, button=3)
        w.key("Down", "Return", "ctrl+s")
        return "ORTSensor" in text(vv)

    def tried():
        found.extend(y for y in lines(editor.rows()) if not found and keeps(y))
        return found

    w.wait(tried, "the sensor")
    now = text(vv)
    assert now.count("ORTSensor") == 1 and 'description "probe 1"' in now
    w.key("ctrl+z", "ctrl+s")
    w.wait(lambda: "ORTSensor" not in text(vv), "no sensor")
    press(w, 200, found[0], button=3)
    w.key("D", "e", "s", "k", "Return")
    w.wait(lambda: keeps(found[0]), "the sensor with a name")
    assert 'description "Desk"' in text(vv)


@pytest.mark.timed
def test_the_message_of_a_tool_ends_with_it(editor):
    w = editor.window
    editor.until(lambda rows: is_grey(pixel(rows, -RIGHT, .05)), "the box")
    w.click(-RIGHT, .05)
    before = editor.says()
    w.key("g", "x", "1")
    w.wait(lambda: editor.says() != before, "what the tool does")
    w.key("Return")
    ended = time.monotonic()
    w.wait(lambda: editor.says() == before, "no message")
    assert time.monotonic() < ended + 4, "other messages stay for six seconds"


def test_the_legend_of_false_colours_stands_beside_the_panels(window, screen):
    editor = Editor(window(WORLD, "--size", "600x400", "--false-colour", 100), screen)

    def is_red(colour):
        return colour[0] > 150 and colour[0] > colour[1] + 50 and colour[2] < 60

    editor.until(lambda rows: any(is_red(p) for row in rows[20:140] for p in row[360:419]),
                 "the upper end of the scale")
