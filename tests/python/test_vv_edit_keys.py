"""Tests that the editor in vv's window is worked by the keyboard: panels that are hidden and shown,
and panels that are worked by keys alone. Also that textures are seen there."""
import re

import pytest

from conftest import HEADER
from editor_window import changed, needs_the_editor, press, saved, text  # noqa: F401
from window_driver import framebuffer, screen, window  # noqa: F401

WIDTH, HEIGHT = 600, 400
WORLD = HEADER + """
Background { skyColor 0 0 1 }
Viewpoint { position 0 0 10 fieldOfView 0.785398 }
NavigationInfo { type [ "EXAMINE" "ANY" ] }
DEF BOX Shape {
  appearance DEF LOOK Appearance { texture DEF GREEN PixelTexture { image 2 1 3 0x00ff00 0x00ff00 } }
  geometry Box { }
}
DEF LAMP PointLight { on FALSE }
"""


def is_sky(colour):
    return colour[2] > 180 and colour[0] < 60


def is_green(colour):
    return colour[1] > 200 and max(colour[0], colour[2]) < 60


class Keys:
    """The editor in a window, and what the screen shows of it."""

    def __init__(self, window, vv, screen, world=WORLD):
        self.window, self.vv, self.screen = window(world, "--size", f"{WIDTH}x{HEIGHT}"), vv, screen
        place = self.window.tool("getwindowgeometry", "--shell", self.window.id)
        self.left, self.top = [int(re.search(rf"{n}=(-?\d+)", place)[1]) for n in ("X", "Y")]
        self.window.key("e")
        self.until_shown(True)

    def at(self, x, y):
        return framebuffer(self.screen[1])[self.top + y][self.left + x]

    def until_shown(self, shown):
        """Waits until both panels are shown, or neither."""
        sides = lambda: [is_sky(self.at(x, HEIGHT - 60)) for x in (10, WIDTH - 10)]
        self.window.wait(lambda: sides() == [not shown] * 2, "the panels")

    def sheet(self, test):
        """Returns how many pixels of the fields pass a test."""
        rows = framebuffer(self.screen[1])[self.top:self.top + HEIGHT]
        return sum(test(p) for row in rows for p in row[self.left + WIDTH - 175:self.left + WIDTH])

    def find(self, name):
        """Selects what the search finds, by keys alone."""
        w = self.window
        w.key("ctrl+Tab")
        w.tool("type", name)
        w.key("Down", "Right", "space")


@pytest.fixture
def keys(window, vv, screen):
    return Keys(window, vv, screen)


def test_tab_hides_the_panels_and_shows_them_again(keys, vv):
    w = keys.window
    w.key("Tab")
    keys.until_shown(False)
    w.click(0, 0)  # clicks and keys go on
    w.key("shift+d")
    saved(w, vv, lambda t: "BOX_2" in t)
    w.key("ctrl+z")
    saved(w, vv, lambda t: t == WORLD)
    w.key("Tab")
    keys.until_shown(True)
    w.key("Tab")
    keys.until_shown(False)
    w.key("shift+a")  # its menu belongs to a panel
    keys.until_shown(True)
    w.key("Escape")
    press(w, 80, 143)  # the search field has the keyboard now
    w.key("Tab")
    w.tool("type", "x")
    keys.until_shown(True)
    w.click(0.1, 0.8)
    w.key("Tab")
    keys.until_shown(False)
    assert w.end() == 0


def test_keys_alone_select_change_and_undo(keys, vv):
    w = keys.window
    keys.find("GREEN")
    w.key("ctrl+Tab", "Down", "space")  # the fields: `repeatS` is the first that can be set
    now = saved(w, vv, lambda t: t != WORLD)
    assert now == WORLD.replace("0x00ff00 }", "0x00ff00 repeatS FALSE }")
    w.key("ctrl+z")
    saved(w, vv, lambda t: t == WORLD)
    w.key("Escape")  # the picture has the keys again
    w.click(0, 0)
    w.key("shift+d")
    saved(w, vv, lambda t: "BOX_2" in t)
    w.key("ctrl+z", "ctrl+s")
    assert w.end() == 0


def test_keys_wait_for_what_is_searched_for(window, vv, screen):
    # Keys come faster than so many nodes are searched. They are meant for the rows that are found, not
    # for the Background, which the first letters find.
    world = WORLD.replace("Background", "DEF GREEK Background")
    world += "Group { children [\n" + "Group { }\n" * 500_000 + "] }\n"
    keys = Keys(window, vv, screen, world)
    keys.find("GREEN")
    keys.window.key("ctrl+Tab", "Down", "space", "ctrl+s")
    now = changed(keys.window, vv, lambda t: t != world)
    assert now == world.replace("0x00ff00 }", "0x00ff00 repeatS FALSE }")
    keys.window.key("Escape")  # the picture has the keys again
    assert keys.window.end() == 0


def test_a_node_is_renamed(keys, vv):
    w = keys.window
    w.click(0, 0)
    w.key("F2")
    w.tool("type", "CRATE")
    w.key("Return")
    saved(w, vv, lambda t: t == WORLD.replace("DEF BOX", "DEF CRATE"))
    w.key("F2")
    w.tool("type", "LAMP")  # another node has this name: the edit is refused
    w.key("Return")
    w.key("ctrl+z", "ctrl+s")
    saved(w, vv, lambda t: t == WORLD)
    w.key("F2")
    w.key("Escape")  # closes the question alone
    w.key("shift+d")
    saved(w, vv, lambda t: "BOX_2" in t)


def test_a_texture_has_a_small_picture(keys):
    assert keys.sheet(is_green) < 50
    keys.find("GREEN")
    keys.window.wait(lambda: keys.sheet(is_green) > 1000, "its own picture")
