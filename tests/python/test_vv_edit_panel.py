"""Tests that Tk panels of a world's Scripts go on working beside the editor in vv's window: the panel
changes the world, the editor changes the file, and each hears of the other."""
import re

import pytest

from conftest import HEADER, find_vv
from editor_window import needs_the_editor, press, saved  # noqa: F401
from window_driver import screen, window  # noqa: F401

if not (find_vv().parents[1] / "lib/xvrml/scripts/tcl.so").exists():
    pytest.skip("the Tcl engine is not built", allow_module_level=True)

# The box is in the middle of the picture. The panel raises it, and is told of each of its places.
WORLD = HEADER + r"""
Viewpoint { position 0 0 10 fieldOfView 0.785398 }
NavigationInfo { type [ "EXAMINE" "ANY" ] }
DEF PLACE Transform { translation 0 0 0 children DEF BOX Shape { geometry Box { } } }
DEF PANEL Script {
  directOutput TRUE
  field SFNode place USE PLACE
  eventIn SFVec3f moved
  url "tcl:
package require Tk
wm title . {Test panel}
wm geometry . 200x60+420+10
button .up -text Up -command up
pack .up -expand 1 -fill both
proc up {} {$::place set translation {0 0.5 0}; puts {the panel has moved it}}
proc moved {value time} {puts [format {it is at %.1f} [lindex $value 1]]}
"
}
ROUTE PLACE.translation_changed TO PANEL.moved
"""


def panel(w):
    """Returns the middle of the panel on the screen."""
    number = w.wait(lambda: w.tool("search", "--onlyvisible", "--name", "Test panel").split(),
                    "the panel")[0]
    text = w.tool("getwindowgeometry", "--shell", number)
    x, y, width, height = [
        int(re.search(rf"{n}=(-?\d+)", text)[1]) for n in ("X", "Y", "WIDTH", "HEIGHT")
    ]
    return x + width // 2, y + height // 2


def says(w, text, count=1):
    w.wait(lambda: sum(text in line for line in w.out + w.err) >= count, text)


def test_a_panel_of_a_script_works_beside_the_editor(window, vv):
    w = window(WORLD, "--size", "400x300", "--trust")
    x, y = panel(w)
    w.key("e")
    w.click(0, 0)  # selects the box
    w.tool("mousemove", x, y)
    w.tool("click", 1)
    says(w, "the panel has moved it")
    says(w, "it is at 0.5")
    w.tool("windowfocus", "--sync", w.id)
    w.key("shift+d")
    now = saved(w, vv, lambda t: "BOX_2" in t)
    assert "DEF PLACE Transform { translation 0 0 0 children" in now  # the panel's place is not saved
    w.key("ctrl+z")
    w.tool("keydown", "ctrl")
    w.click(0, 0.12)  # selects the Transform of the box
    w.tool("keyup", "ctrl")
    w.key("g", "y", "1", "Return")
    says(w, "it is at 1.5")
    saved(w, vv, lambda t: t == WORLD.replace("translation 0 0 0", "translation 0 1.5 0"))
    w.tool("mousemove", x, y)
    w.tool("click", 1)
    says(w, "the panel has moved it", 2)
    w.tool("windowfocus", "--sync", w.id)
    w.key("ctrl+z")
    saved(w, vv, lambda t: t == WORLD)
    assert w.end() == 0
