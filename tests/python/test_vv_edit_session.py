"""A session with the editor as a designer has it, with real keys and clicks: the light on a wall is
measured, a lamp is moved, the change is significant, undone, done again and saved."""
import csv
import difflib
import re
import time

import pytest

from conftest import HEADER, ROOT
from editor_window import changed, needs_the_editor, press, saved  # noqa: F401
from control_server import SMALL, start  # noqa: F401
from window_driver import screen, window  # noqa: F401

# A lamp of 100 cd in all directions, 5 m before a black wall, with a mark beside it, and a floor that
# adds a little.
WORLD = HEADER + """
NavigationInfo { headlight FALSE }
Viewpoint { position 0 0 10 fieldOfView 0.785398 }
DEF LAMP Transform { translation 0 0 0 # moved by hand
  children [
    ORTLight { shader ORTShader { name "Luminaire" file "luminaire" options "1f lumen 1256.6371" } }
    Shape {
      appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse"
        options "color reflectance 0 0 0" } }
      geometry IndexedFaceSet { solid FALSE coordIndex [ 0 1 2 3 ]
        coord Coordinate { point [ .6 .2 0, 1 .2 0, 1 .6 0, .6 .6 0 ] } } } ] }
DEF WALL Transform { translation 0 0 -6 children Shape { # black
  appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse"
    options "color reflectance 0 0 0" } }
  geometry Box { size 30 30 2 } } }
Transform { translation 0 -4 0 children Shape {
  appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse"
    options "color reflectance .5 .5 .5" } }
  geometry Box { size 30 1 30 } } }
"""
REPORT = (32, 118)  # the button, in pixels
LAMP_ROW = 203  # the third row of the outline


def changes(before, now):
    return [
        line for line in difflib.unified_diff(before.split("\n"), now.split("\n"), n=0)
        if line[0] in "+-" and line[:3] not in ("+++", "---")
    ]


class Reports:
    """Asks for reports and reads their tables."""

    def __init__(self, window, folder):
        self.window, self.folder, self.number = window, folder, 0

    def probe(self):
        self.number += 1
        press(self.window, *REPORT)
        self.window.said("report saved as", self.number)
        name = "world-report.csv" if self.number == 1 else f"world-report-{self.number}.csv"
        rows = [r for r in csv.DictReader((self.folder / name).open()) if r["kind"] == "probe"]
        return rows[0] if rows else None

    def until(self, test):
        def tried():
            row = self.probe()
            if row and test(row):
                return row
            time.sleep(.5)  # between two reports the probe is measured
            return None

        return self.window.wait(tried, "the probe")


def test_light_on_a_wall_is_measured_before_and_after_a_lamp_is_moved(window, vv):
    w = window(WORLD, "--size", "600x400", "--spp", "32")
    w.key("e")
    reports = Reports(w, vv.folder)
    w.move(.1, 0)  # the pointer may have been at the middle
    w.move(0, 0)
    w.key("u")
    row = reports.until(lambda r: r["now"])
    assert row["field"] == "illuminance in lx"
    assert (float(row["x"]), float(row["y"]), float(row["z"])) == pytest.approx((0, 0, -5), abs=.02)
    assert 4 < float(row["now"]) < 4.8 and row["remark"] == "trusted"
    w.key("b")
    # The group of the mark is the lamp.
    w.move(.129, .097)
    w.tool("keydown", "ctrl", "click", 1, "keyup", "ctrl")
    w.key("g", "z", "minus", "1", "Return")
    row = reports.until(lambda r: r["difference"])
    assert 4 < float(row["before"]) < 4.8 and 6.25 < float(row["now"]) < 7.1
    assert 2.25 < float(row["difference"]) < 2.7
    assert row["remark"] == "significant, trusted"
    w.key("ctrl+z")
    row = reports.until(lambda r: r["now"] and float(r["now"]) < 5)
    assert float(row["now"]) == float(row["before"]), "the same samples give the same light"
    assert row["remark"] == "not yet certain, trusted"
    w.key("ctrl+y")
    w.key("ctrl+s")
    now = changed(w, vv, lambda t: t != WORLD)
    assert changes(WORLD, now) == [
        "-DEF LAMP Transform { translation 0 0 0 # moved by hand",
        "+DEF LAMP Transform { translation 0 0 -1 # moved by hand"
    ]
    assert w.end() == 0


def test_a_jump_of_the_pointer_from_a_panel_counts(window, vv):
    w = window(WORLD, "--size", "600x400", "--spp", "1")
    w.key("e")
    reports = Reports(w, vv.folder)
    assert reports.probe() is None  # the pointer is at a button then
    w.move(.2, .1)
    w.key("u")
    row = reports.until(lambda r: r["x"])
    # The wall is 15 m away, and half as high as the tangent of half the field of view says.
    assert (float(row["x"]), float(row["y"]), float(row["z"])) == pytest.approx((1.864, .621, -5), abs=.05)
    assert w.end() == 0


def desk_of_the_page():
    """Returns the world of "A first session" in docs/editor.md, and the difference that it shows."""
    page = (ROOT / "docs/editor.md").read_text()
    return (re.search(pattern, page, re.S)[1]
            for pattern in (r"```vrml file=desk\.wrl\n(.*?)```", r"```diff\n(.*?)\n```"))


def test_the_first_session_of_the_page(window, vv):
    desk, told = desk_of_the_page()
    w = window(desk, "--size", "600x400")
    w.key("e")
    w.click(0, -.03)  # the top of the desk
    w.key("u", "b")
    press(w, 60, LAMP_ROW)
    w.key("g", "y", "minus", "period", "3", "Return")
    now = saved(w, vv, lambda t: t != desk)
    assert changes(desk, now) == told.split("\n")
    assert w.end() == 0


def test_the_light_of_the_first_session(start, tmp_path):
    """The change is significant with as many samples as a window takes."""
    desk, _ = desk_of_the_page()
    (tmp_path / "desk.wrl").write_text(desk)
    vv = start("desk.wrl", *SMALL, "--spp", 4096).connect()
    before = vv.probe(0, -.05, quantity="illuminance")
    with vv.edit("Lower") as step:
        step.set("LAMP", "translation", (0, 1.4, 0))
    now = vv.probe(0, -.05, quantity="illuminance")
    assert before["trusted"] and now["trusted"] and 6 < before["illuminance"] < 8
    difference = now["illuminance"] - before["illuminance"]
    assert 6 < difference < 9 and now["half_width"] + before["half_width"] < difference / 10
