"""Tests the panels of the editor in vv's window with real clicks: looks, nodes in fields, hiding, and
the widths of the panels."""
import re

import pytest

from conftest import HEADER
from editor_window import needs_the_editor, press, saved, text, until_sheet  # noqa: F401
from window_driver import red, screen, window  # noqa: F401

WORLD = HEADER + """
Viewpoint { position 0 0 10 fieldOfView 0.785398 }
DirectionalLight { direction 0 0 -1 }
NavigationInfo { headlight FALSE }
DEF BOX Shape {
  appearance DEF PAINT Appearance { material Material { diffuseColor 1 0 0 } }
  geometry Box { } # of the hall
}
Transform { translation 20 0 0 children Shape { appearance USE PAINT geometry Box { } } }
"""
WIDTH, HEIGHT = 640, 400


class Panels:
    """The window with its panels: places are pixels of the window."""

    def __init__(self, window, vv, screen):
        self.state = vv.folder / "state"
        self.window = window(WORLD, "--size", f"{WIDTH}x{HEIGHT}")
        self.vv, self.screen = vv, screen
        self.window.key("e")

    def text(self):
        return text(self.vv)

    def move(self, x, y):
        self.window.tool("mousemove", "--window", self.window.id, x, y)

    def click(self, x, y, button=1):
        press(self.window, x, y, button)

    def saved(self, change):
        return saved(self.window, self.vv, change)


@pytest.fixture
def panels(window, vv, screen):
    return Panels(window, vv, screen)


def test_a_look_is_chosen_for_a_shape(panels):
    w = panels.window
    w.click(0, 0)  # selects the box
    until_sheet(w, panels.screen, WIDTH)
    panels.click(WIDTH - 160, 61)  # its look
    w.tool("type", "PhysicalM")
    w.key("Return")
    now = panels.saved(lambda t: t != WORLD)
    assert "PhysicalMaterial { baseColor 1 0 0 }" in now
    # The other Shape has the same Appearance: the choice was for this one alone.
    assert "Material { diffuseColor 1 0 0 }" in now and "# of the hall" in now
    w.key("ctrl+z")
    assert panels.saved(lambda t: t == WORLD)
    assert w.end() == 0


def test_hiding_is_seen_and_not_saved(panels):
    w = panels.window
    panels.click(80, 222, button=3)  # the menu of the box in the outline
    panels.click(100, 237)
    w.key("ctrl+s")
    w.key("e")
    w.until(lambda s: s.share(red) == 0)
    assert panels.text() == WORLD


def test_widths_of_panels_are_kept(panels, window):
    w = panels.window
    edge = int(0.26 * WIDTH)
    panels.move(edge, 300)
    w.tool("mousedown", 1)
    for x in (edge + 20, edge + 60, 250):
        panels.move(x, 300)
    w.tool("mouseup", 1)
    state = panels.state / "vv" / "panels"
    w.wait(lambda: state.exists() and "outline" in state.read_text(), "the state")
    width = int(re.search(r"outline (\d+)", state.read_text())[1])
    assert abs(width - 250) < 8
