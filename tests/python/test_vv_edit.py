"""Tests the editor in vv's window with real clicks and keys, and what becomes of the file."""
import os
import signal

import pytest

from conftest import HEADER
from editor_window import changed, needs_the_editor, saved, text  # noqa: F401
from window_driver import screen, window  # noqa: F401

WORLD = HEADER + """
# The stage
Viewpoint { position 0 0 10 fieldOfView 0.785398 }
DirectionalLight { direction 0 0 -1 }
DEF LEFT Transform { translation -2 0 0 # moved by hand
  children [
    DEF Touch TouchSensor {}
    Shape { appearance Appearance { material DEF Paint Material { diffuseColor 1 0 0 } } geometry Box {} } ] }
DEF RIGHT Transform {
  translation 2 0 0 children Shape {
    appearance Appearance { material Material { diffuseColor 0 0 1 } } geometry Box {} } }
"""


@pytest.fixture
def editor(window):
    # Beside the panels a part of the picture must be free.
    w = window(WORLD, "--size", "600x400")
    w.key("e")
    return w


def stay_and_save(w, vv, before):
    """Answers the question with Escape and saves. The keys wait for the question."""
    w.key("Escape", "ctrl+s")
    return changed(w, vv, lambda t: t != before)


def test_a_box_is_selected_moved_undone_and_saved(editor, vv):
    w = editor
    w.click(0, 0)  # nothing is there
    w.click(-0.25, 0)
    w.key("g", "x", "1", "Return")
    w.key("ctrl+s")
    now = changed(w, vv, lambda t: t != WORLD)
    assert now.count("\n") > WORLD.count("\n")  # a Transform around the Shape
    assert "DEF LEFT Transform { translation -2 0 0 # moved by hand\n" in now
    assert "translation 1 0 0" in now
    w.key("ctrl+z")
    w.key("ctrl+s")
    assert changed(w, vv, lambda t: t == WORLD)
    w.key("ctrl+y")
    w.key("ctrl+s")
    assert changed(w, vv, lambda t: t == now)


def test_groups_are_selected_with_ctrl_and_the_file_differs_in_one_value(editor, vv):
    w = editor
    w.move(-0.25, 0)
    w.tool("keydown", "ctrl", "click", 1, "keyup", "ctrl")
    w.key("g", "y", "minus", "period", "5", "Return")
    w.key("ctrl+s")
    now = changed(w, vv, lambda t: t != WORLD)
    assert now == WORLD.replace("translation -2 0 0 #", "translation -2 -0.5 0 #")
    assert w.end() == 0


def test_a_key_that_was_held_counts_also_if_vv_is_late(editor, vv):
    w = editor
    w.move(-0.25, 0)
    os.kill(w.program.pid, signal.SIGSTOP)
    w.tool("keydown", "ctrl", "click", 1, "keyup", "ctrl")
    w.key("g", "y", "1", "Return")
    os.kill(w.program.pid, signal.SIGCONT)
    now = saved(w, vv, lambda t: t != WORLD)
    assert now == WORLD.replace("translation -2 0 0 #", "translation -2 1 0 #")
    assert w.end() == 0


def test_escape_takes_a_move_back(editor, vv):
    w = editor
    w.move(-0.25, 0)
    w.tool("keydown", "ctrl", "click", 1, "keyup", "ctrl")
    w.key("g")
    w.move(0.2, 0.3)
    w.key("Escape")
    w.key("r", "z", "3", "0", "Return")
    w.key("ctrl+s")
    now = changed(w, vv, lambda t: t != WORLD)
    assert "translation -2 0 0" in now and "rotation 0 0 1 0.5235988" in now


def test_a_window_with_unsaved_edits_asks(editor, vv):
    w = editor
    w.click(-0.25, 0)
    w.key("Delete")
    # The panels are closed, the edit stays. Nothing is removed while a question waits.
    w.key("e", "q", "Delete")
    now = stay_and_save(w, vv, WORLD)
    assert "diffuseColor 1 0 0" not in now and "TouchSensor" in now


def test_an_anchor_does_not_take_unsaved_edits_away(window, vv):
    vv.write("other.wrl", HEADER + "Shape { geometry Sphere {} }")
    there = WORLD.replace("children [\n    DEF Touch TouchSensor {}",
                          'children Anchor { url "other.wrl" children [')
    there = there.replace("geometry Box {} } ] }\nDEF RIGHT", "geometry Box {} } ] } }\nDEF RIGHT")
    w = window(there, "--size", "600x400")
    w.key("e")
    w.click(0.25, 0)
    w.key("Delete")
    w.move(-0.25, 0)
    w.tool("keydown", "alt", "click", 1, "keyup", "alt")
    now = stay_and_save(w, vv, there)
    assert "diffuseColor 0 0 1" not in now and "other.wrl" in now


def test_a_slip_does_no_harm(editor, vv):
    w = editor
    w.key("g", "x")  # nothing is selected
    w.key("r")
    w.key("s")
    assert not list(vv.folder.glob("*.png"))
    w.key("ctrl+s")
    assert w.program.poll() is None and text(vv) == WORLD


def test_edits_of_a_recording_are_refused(window, vv):
    w = window(WORLD, "--size", "600x400", "--record-input", "input.txt")
    w.key("e")
    w.click(-0.25, 0)
    w.key("Delete")
    w.key("ctrl+s")
    assert w.end() == 0
    assert text(vv) == WORLD


@pytest.mark.parametrize("arguments, why", [((), "a world"), (("box.wrl", "-o", "x.png"), "vv edit"),
                                            (("box.wrl", "--check"), "vv edit"),
                                            (("box.wrl", "--info"), "vv edit"),
                                            (("box.wrl", "--no-window"), "--no-window")])
def test_vv_edit_is_for_a_file_in_a_window(vv, arguments, why):
    done = vv("edit", *arguments)
    assert done.returncode == 2 and why in done.talk, done.talk
    assert len(done.talk.splitlines()) == 1
