"""Tests the list of problems and the report of the editor in vv's window, with real clicks."""
import base64
import csv
import re
import shlex

import pytest

from conftest import HEADER
from editor_window import changed, needs_the_editor, press, text  # noqa: F401
from window_driver import screen, window  # noqa: F401

WORLD = HEADER + """
Viewpoint { position 0 0 10 fieldOfView 0.785398 }
DirectionalLight { direction 0 0 -1 }
DEF LEFT Transform { translation -2 0 0 children
  Shape { appearance Appearance { material DEF Paint Material { diffuseColor 1 0 0 } } geometry Box {} } }
DEF RIGHT Transform {
  children DEF INNER Shape {
    appearance Appearance { material Material { diffuseColor 0 0 1 } } geometry Box {} }
  bogus 3
  translation 2 0 0
}
"""

# In pixels: the buttons below the tools, and the first row of the list.
PROBLEMS, REPORT, FIRST_ROW = (50, 93), (33, 118), (250, 70)


@pytest.fixture
def editor(window):
    w = window(WORLD, "--size", "640x420")
    w.key("e")
    return w


def test_a_click_on_a_problem_selects_its_node(editor, vv):
    w = editor
    press(w, *PROBLEMS)

    def tried():  # the list is read when the world can be used
        press(w, *FIRST_ROW)
        w.key("Delete")
        w.key("ctrl+s")
        return text(vv) != WORLD

    w.wait(tried, "the file")
    now = text(vv)
    assert "RIGHT" not in now and "INNER" not in now and "DEF LEFT" in now


def test_a_report_has_the_picture_the_edits_and_a_command_that_repeats_it(editor, vv):
    w, page, table = editor, vv.folder / "world-report.html", vv.folder / "world-report.csv"
    w.click(-0.25, 0)
    w.key("g", "x", "1", "Return")
    w.key("ctrl+s")
    changed(w, vv, lambda t: t != WORLD)
    press(w, *REPORT)
    w.said("report saved as")
    html = page.read_text()
    assert "<h1>world.wrl</h1>" in html and "<script" not in html
    png = base64.b64decode(re.search(r'src="data:image/png;base64,([^"]*)"', html)[1])
    assert png.startswith(b"\x89PNG")
    rows = list(csv.DictReader(table.open()))
    assert [row["kind"] for row in rows] == ["picture", "field"]
    picture, field = rows
    assert (field["name"], field["field"]) == ("LEFT  Transform", "children")
    assert (picture["x"], picture["y"]) == ("640", "420")
    command = shlex.split(picture["remark"])
    assert command[0] == "vv" and "world.wrl" in command
    done = vv(*command[1:], "-o", "again.png")
    assert done.returncode == 0, done.talk
    assert (vv.folder / "again.png").read_bytes() == png
    press(w, *REPORT)
    w.said("report saved as", 2)
    assert (vv.folder / "world-report-2.csv").exists()
    assert page.read_text() == html
