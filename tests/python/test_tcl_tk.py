"""Tests Tk panels of Tcl Scripts in trusted worlds, under Xvfb: the panel acts on the world and the
world on the panel. One process per test, because Tk does not survive the end of its display."""
import os
import shutil
import subprocess
import sys
import textwrap

import pytest
from conftest import find_vv
from xserver import display

pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

if not (find_vv().parents[1] / "lib/xvrml/scripts/tcl.so").exists():
    pytest.skip("the Tcl engine is not built", allow_module_level=True)
if not shutil.which("Xvfb"):
    pytest.skip("Xvfb is not installed", allow_module_level=True)

PANEL = r"""#VRML V2.0 utf8
DEF Place Transform { children Shape { geometry Box {} } }
DEF Panel Script {
  directOutput TRUE
  field SFNode place USE Place
  eventIn SFFloat height
  eventIn SFTime press
  eventIn SFTime close
  eventIn SFTime boom
  eventIn SFTime later
  eventOut SFInt32 pressed
  eventOut SFString shown
  url "tcl:
package require Tk
wm title . {Test panel}
label .height -text none
button .up -text Up -command up
pack .height .up
proc up {} {
  set ::pressed [expr {$::pressed + 1}]
  $::place set translation [list 0 $::pressed 0]
}
proc height {value time} {.height configure -text $value; set ::shown [.height cget -text]}
proc press {} {after 10 {.up invoke}}
proc close {} {event generate . <<Close>>; {*}[wm protocol . WM_DELETE_WINDOW]; destroy .}
proc later {} {event generate . <<Up>> -when tail}
bind . <<Up>> up
proc boom {} {.up configure -command {error boom}; .up invoke}
"
}
"""

START = """
import os, sys, time
import xvrml
class World:
    def __init__(self, text):
        self.browser = xvrml.Browser(text.encode(), trust=True)
        self.time = 0.0
    def until(self, condition, seconds=20):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, self.browser.warnings
            self.time += 1 / 60
            self.browser.tick(self.time)
            time.sleep(0.005)
    def some(self, ticks=20):
        for _ in range(ticks):
            self.time += 1 / 60
            self.browser.tick(self.time)
            time.sleep(0.005)
"""

WINDOWS = """
import subprocess
def windows(): return subprocess.run(["xdotool", "search", "--onlyvisible", "--name", ".*", "getwindowname", "%@"], capture_output=True, text=True).stdout
"""


def run(program, world=PANEL):
    """Runs the program in a Python process with a display of its own; returns its output."""
    with display():
        done = subprocess.run([
            sys.executable, "-c", START + WINDOWS +
            f"world = World({world!r})\nb = world.browser\n" + textwrap.dedent(program)
        ],
                              capture_output=True,
                              text=True,
                              timeout=100,
                              env=os.environ)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_a_button_changes_the_world():
    run("""
        b["Panel"].press = 1.0
        world.until(lambda: b["Place"].translation[1] == 1)
        assert b["Panel"].pressed == 1
        b["Panel"].height = 2.5
        world.until(lambda: b["Panel"].shown == "2.5")
        assert b.warnings == []
    """)


def test_the_pointer_presses_a_button():
    if not shutil.which("xdotool"):
        pytest.skip("xdotool is not installed")
    run("""
        import subprocess
        def find():
            found = subprocess.run(["xdotool", "search", "--name", "Test panel"], capture_output=True, text=True).stdout.split()
            return found[0] if found else None
        world.until(find)
        world.some()
        size = dict(line.split("=") for line in subprocess.run(["xdotool", "getwindowgeometry", "--shell", find()],
                                                                capture_output=True, text=True).stdout.split())
        x, y = int(size["X"]) + int(size["WIDTH"]) // 2, int(size["Y"]) + int(size["HEIGHT"]) - 15
        subprocess.run(["xdotool", "mousemove", str(x), str(y)], check=True)
        world.some()
        subprocess.run(["xdotool", "click", "1"], check=True)
        world.until(lambda: b["Panel"].pressed == 1)
        assert tuple(b["Place"].translation) == (0, 1, 0)
    """)


def test_errors_of_a_panel_are_told_and_the_world_goes_on():
    run("""
        b["Panel"].press = 1.0
        world.until(lambda: b["Panel"].pressed == 1)
        b["Panel"].boom = 2.0
        world.some()
        assert len(b.warnings) == 1 and "boom" in str(b.warnings[0]), b.warnings
        b["Panel"].height = 3
        world.until(lambda: b["Panel"].shown == "3.0")
    """)


def test_closing_the_panel_ends_the_panel_only():
    out = run("""
        b["Panel"].close = 1.0
        world.some()
        b["Place"].translation = (5, 0, 0)
        world.some()
        assert b["Place"].translation[0] == 5
        print("alive")
    """)
    assert out.endswith("alive\n")


def test_exit_ends_the_script_and_its_windows_but_not_the_host():
    out = run(
        """
        world.until(lambda: "Test panel" in windows())
        world.until(lambda: "Test panel" not in windows())
        print("alive")
    """, PANEL.replace("package require Tk",
                       "package require Tk; after 300 {puts leaving; exit 1}"))
    assert out.endswith("alive\n")


def test_a_panel_that_does_not_end_is_stopped_and_closed():
    out = run(
        """
        world.some()
        assert "Test panel" in windows()
        b["Panel"].press = 1.0
        world.until(lambda: any("took too long" in str(w) for w in b.warnings))
        b["Place"].translation = (5, 0, 0)
        world.some()
        assert b["Place"].translation[0] == 5
        assert "Test panel" not in windows()
        print("alive")
    """,
        PANEL.replace("proc up {} {",
                      "bind .up <Destroy> {while 1 {}}; proc up {} {while 1 {catch {while 1 {}}};"))
    assert out.endswith("alive\n")


def test_dialogs_wait_in_a_coroutine():
    program = r"""
package require Tk
proc ask {} {
  if {[catch {tk_messageBox -message x} why]} {puts $why}
  coroutine asking apply {{} {set ::answer [tk_messageBox -type yesno -message Sure?]}}
  after 100 {.__tk__messagebox.yes invoke}
}
proc press {} ask
"""
    world = PANEL.split("url")[0].replace(
        "eventOut SFString shown", "eventOut SFString answer") + 'url "tcl:' + program + '" }'
    run(
        """
        b["Panel"].press = 1.0
        world.until(lambda: b["Panel"].answer == "yes")
    """, world)


def test_two_panels_of_one_world():
    second = PANEL.split("DEF Panel", 1)[1].replace("Test panel", "Other")
    run(
        """
        b["Panel"].press = 1.0
        b["Other"].press = 1.0
        world.until(lambda: b["Panel"].pressed == 1 and b["Other"].pressed == 1)
        world.some()
        assert b.warnings == []
    """, PANEL + "DEF Other" + second)


def test_an_event_that_another_scripts_tick_serves_is_not_lost():
    second = PANEL.split("DEF Panel", 1)[1].replace("Test panel", "Other")
    run(
        """
        world.some()
        b["Other"].later = 1.0  # in the queue when Panel, which comes first, is given its turn
        world.until(lambda: b["Other"].pressed == 1)
        assert tuple(b["Place"].translation) == (0, 1, 0) and b["Panel"].pressed == 0
        assert b.warnings == [], b.warnings
    """, PANEL + "DEF Other" + second)


def test_without_a_display_the_world_goes_on():
    env = {k: v for k, v in os.environ.items() if k != "DISPLAY"}
    done = subprocess.run([
        sys.executable, "-c",
        START + f"world = World({PANEL!r})\nworld.some()\nprint(world.browser.warnings)"
    ],
                          capture_output=True,
                          text=True,
                          timeout=100,
                          env=env)
    assert done.returncode == 0, done.stderr
    assert "Tk cannot be used here" in done.stdout
