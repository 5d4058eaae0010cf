"""Tests what comes into a world in the window's editor, with real clicks, keys and drops: nodes of
the menu, other files, materials of the user's folder, and sensors; and the list of the keys."""
import pytest

from conftest import HEADER
from editor_window import needs_the_editor, press, saved, text, until_sheet  # noqa: F401
from window_driver import framebuffer, screen, window  # noqa: F401
from xdrop import drop

WORLD = HEADER + """
Viewpoint { position 0 0 10 fieldOfView 0.785398 }
DirectionalLight { direction 0 0 -1 }
NavigationInfo { headlight FALSE }
DEF BOX Shape {
  appearance Appearance { material Material { diffuseColor 1 0 0 } }
  geometry Box { } # of the hall
}
"""
LEG = HEADER + "Transform { translation 2 0 0 children Shape { geometry Cone { } } }\n"
OAK = HEADER + """Shape { appearance Appearance {
  material Material { diffuseColor 0 1 0 }
  texture ImageTexture { url "oak.png" } } }
"""
WIDTH, HEIGHT = 640, 420


@pytest.fixture
def editor(window):
    w = window(WORLD, "--size", f"{WIDTH}x{HEIGHT}")
    w.key("e")
    return w


def test_the_menu_of_nodes_filters_and_works_by_keys(editor, vv):
    w = editor
    w.key("shift+a")
    w.tool("type", "cyl")
    w.key("Return")
    now = saved(w, vv, lambda t: "Cylinder" in t)
    assert now == WORLD + now[len(WORLD):] and now.count("Shape {") == 2
    w.key("shift+a")
    w.key("Down")
    w.key("Down")
    w.key("Up")
    w.key("Return")
    saved(w, vv, lambda t: "Sphere" in t)
    w.key("shift+a")
    w.tool("type", "timesens")  # only found by its name
    w.key("Return")
    saved(w, vv, lambda t: "TimeSensor" in t)
    w.key("shift+a")
    w.key("Escape")  # closes the menu; the keys behind it are the editor's again
    for _ in range(3):
        w.key("ctrl+z")
    saved(w, vv, lambda t: t == WORLD)
    assert w.end() == 0


def test_a_file_is_imported_by_its_path(editor, vv):
    w = editor
    (vv.folder / "parts").mkdir()
    vv.write("parts/leg 2.wrl", LEG)
    w.key("shift+a")
    w.tool("type", "inline f")
    w.key("Return")
    w.tool("type", "parts/leg 2.wrl")
    w.key("Return")
    now = saved(w, vv, lambda t: t != WORLD)
    assert now == WORLD + 'DEF leg_2 Inline { url [ "parts/leg%202.wrl" ] }\n'
    w.key("ctrl+z")
    saved(w, vv, lambda t: t == WORLD)


def test_a_dropped_file_is_imported_or_opened(editor, vv, screen):
    w = editor
    vv.write("leg.wrl", LEG)
    drop(screen[0], w.id, vv.folder / "leg.wrl")
    now = saved(w, vv, lambda t: t != WORLD)
    assert now == WORLD + 'DEF leg Inline { url [ "leg.wrl" ] }\n'
    w.key("e")
    drop(screen[0], w.id, vv.folder / "leg.wrl")
    w.said("first picture", 2)
    assert w.command()[1] == str((vv.folder / "leg.wrl").resolve())


def test_a_material_of_the_user_is_chosen(editor, vv, screen):
    w = editor
    folder = vv.folder / "data/xvrml/materials"
    folder.mkdir(parents=True)
    (folder / "oak.wrl").write_text(OAK)
    w.click(0, 0)
    until_sheet(w, screen, WIDTH)
    press(w, WIDTH - 160, 61)  # the look of the box
    w.tool("type", "oak")
    w.key("Return")
    now = saved(w, vv, lambda t: t != WORLD)
    assert "Material { diffuseColor 0 1 0 }" in now and "# of the hall" in now
    assert '"data/xvrml/materials/oak.png"' in now
    w.key("ctrl+z")
    saved(w, vv, lambda t: t == WORLD)


def test_f1_lists_the_keys_of_the_editor(editor, screen):
    w = editor

    def light():  # in the middle of the window
        rows = framebuffer(screen[1])[HEIGHT // 4:HEIGHT // 2]
        return sum(min(p) > 150 for row in rows for p in row[WIDTH // 3:WIDTH // 2])

    w.move(-0.95, 0)  # over a panel, where nothing is said about what is below the pointer
    w.wait(lambda: light() == 0, "only the picture")
    before = light()
    w.key("F1")
    w.wait(lambda: light() > before + 200, "the list")
    w.key("Escape")
    w.wait(lambda: light() == before, "no list")
