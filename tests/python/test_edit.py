"""Tests World.edit: edits of a world's file from Python."""
import os
import pathlib
import threading

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

HEAD = "#VRML V2.0 utf8\n"
LAMP = HEAD + "# by day\nDEF L PointLight { intensity 0.80 # bright\n}\nDEF G Group { }\n"
XML = """<?xml version="1.0" encoding="UTF-8"?>
<X3D profile='Immersive' version='3.3'>
  <Scene>
    <!-- by day -->
    <PointLight DEF='L' intensity='0.80'/> <!-- bright -->
    <Group DEF='G'/>
  </Scene>
</X3D>
"""


@pytest.fixture
def lamp(tmp_path):
    (tmp_path / "l.wrl").write_text(LAMP)
    return xvrml.load(tmp_path / "l.wrl")


def test_a_step_without_a_name_can_be_undone(lamp):
    with lamp.edit(""):
        lamp["L"].intensity = 0.5
    assert lamp.edit.undo() == "Edit"
    assert lamp["L"].intensity == pytest.approx(0.8)


@pytest.mark.parametrize("runs", [False, True])
def test_a_step_is_saved_in_place(lamp, runs):
    if runs:
        lamp.time = 1
    with lamp.edit("Dim"):
        lamp["L"].intensity = .25
        lamp["L"].intensity = .5
        lamp["L"].on = False
    assert lamp["L"].intensity == .5
    assert lamp.edit.changed
    lamp.edit.save()
    assert not lamp.edit.changed
    saved = pathlib.Path(lamp.path).read_text()
    assert saved == LAMP.replace("0.80", "0.5").replace("bright\n", "bright\n  on FALSE\n")
    assert lamp.edit.undo() == "Dim"
    assert lamp["L"].intensity == np.float32(.8) and lamp["L"].on
    assert lamp.edit.changed and lamp.edit.text() == LAMP
    assert lamp.edit.undo() is None
    assert lamp.edit.redo() == "Dim"


def test_an_edit_may_begin_before_the_world_runs(lamp):
    lamp.edit.set(lamp["L"], "intensity", .5)
    lamp.time = 2
    lamp.edit.set(lamp["L"], "intensity", .25)
    lamp.edit.undo()
    assert lamp["L"].intensity == .5
    lamp.edit.undo()
    assert lamp["L"].intensity == np.float32(.8)


def test_what_moves_is_not_saved(tmp_path):
    text = HEAD + """DEF T Transform { translation 1 0 0 children Shape { geometry Box { } } }
DEF C TimeSensor { loop TRUE }
DEF P PositionInterpolator { key [ 0 1 ] keyValue [ 0 0 0 0 9 0 ] }
ROUTE C.fraction_changed TO P.set_fraction
ROUTE P.value_changed TO T.set_translation
"""
    (tmp_path / "m.wrl").write_text(text)
    world = xvrml.load(tmp_path / "m.wrl")
    world.time = .25
    assert world["T"].translation[1] > 0
    world.edit.set(world["T"], "scale", (2, 2, 2))
    assert world.edit.text() == text.replace("{ } } }", "{ } } scale 2 2 2 }", 1)
    world.edit.undo()
    assert world["T"].translation[1] > 0, "undo restores what the edit has changed"


def test_an_exception_undoes_the_step(lamp):
    with pytest.raises(ZeroDivisionError):
        with lamp.edit("Fail"):
            lamp["L"].intensity = .5
            1 / 0
    assert lamp["L"].intensity == np.float32(.8) and not lamp.edit.changed
    lamp["L"].intensity = .5  # no edit of the file
    assert lamp.edit.text() == LAMP


def test_steps_within_steps(lamp):
    with lamp.edit("Outer"):
        lamp["L"].intensity = .5
        try:
            with lamp.edit("Inner"):
                lamp["L"].intensity = .25
                raise KeyError
        except KeyError:
            pass
        assert lamp["L"].intensity == .5
        lamp["L"].on = False
        with pytest.raises(xvrml.EditError, match="a step is open"):
            lamp.edit.save()
    assert lamp.edit.undo() == "Outer" and lamp.edit.text() == LAMP


def test_a_route_is_undone_once_the_world_runs(lamp):
    lamp.edit.add_route(lamp["L"], "on_changed", lamp["L"], "set_on")
    lamp.time = 1
    assert lamp.edit.undo() == "Add route" and lamp.edit.text() == LAMP


def test_the_file_that_was_loaded_is_edited(lamp, tmp_path, monkeypatch):
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "l.wrl").write_text(LAMP)
    monkeypatch.chdir(tmp_path)
    world = xvrml.load("l.wrl")
    monkeypatch.chdir(tmp_path / "sub")
    with pytest.raises(xvrml.EditError, match="load it again"):
        world.edit.set(world["L"], "on", False)
    monkeypatch.chdir(tmp_path)
    world = xvrml.load("l.wrl")
    world.edit.set(world["L"], "on", False)
    (tmp_path / "l.wrl").write_text(LAMP + "# others\n")
    with pytest.raises(xvrml.EditError, match="another program"):
        world.edit.save(tmp_path / "l.wrl")


def test_another_world_is_not_saved_over(tmp_path):
    (tmp_path / "next.wrl").write_text(HEAD + "DEF NEXT Group { }\n")
    (tmp_path / "w.wrl").write_text(
        HEAD + 'DEF L PointLight { }\nDEF A Anchor { url "next.wrl" children Shape { } }\n')
    browser = xvrml.Browser(str(tmp_path / "w.wrl"))
    browser.edit.set(browser["L"], "on", False)
    browser.replace([xvrml.Group()]) if hasattr(browser, "replace") else browser.load_url(["next.wrl"])
    with pytest.raises(xvrml.EditError, match="another world"):
        browser.edit.save()


def test_nodes(lamp):
    edit = lamp.edit
    box = edit.insert("Shape { geometry Box { } }", lamp["G"])
    edit.rename(box, "BOX")
    copy = edit.duplicate(lamp["BOX"])
    assert copy.def_name == "BOX_2" and copy == lamp["BOX_2"]
    place = edit.wrap(copy)
    edit.set(place, "translation", (1, 0, 0))
    edit.use(lamp["BOX"], lamp["G"])
    edit.move(lamp["L"])  # to the end of the file
    with pytest.raises(xvrml.EditError, match="stands in 2 places"):
        edit.remove(lamp["BOX"])
    reloaded = xvrml.loads(edit.text())
    assert [node.node_type for node in reloaded.roots] == ["Group", "PointLight"]
    assert len(reloaded["G"].children) == 3
    assert reloaded["G"].children[2] == reloaded["BOX"]
    assert tuple(reloaded["G"].children[1].translation) == (1, 0, 0)
    while edit.undo():
        pass
    assert edit.text() == LAMP and list(lamp.names) == ["G", "L"]


def test_xml(tmp_path):
    path = tmp_path / "l.x3d"
    path.write_text(XML)
    world = xvrml.load(path)
    with world.edit("Dim"):
        world["L"].intensity = .5
        world["L"].on = False
    world.edit.save()
    dimmed = XML.replace("0.80'", "0.5' on='false'")
    assert path.read_text() == dimmed
    world.edit.insert("<Shape DEF='S'><Box/></Shape>", world["G"])
    world.edit.use(world["S"], world["G"])
    world.edit.add_route(world["L"], "on", world["L"], "on")
    assert world.edit.text() == dimmed.replace(
        "<Group DEF='G'/>\n", """<Group DEF='G'>
      <Shape DEF='S'><Box/></Shape>
      <Shape USE='S'/>
    </Group>
    <ROUTE fromNode='L' fromField='on' toNode='L' toField='on'/>
""")
    while world.edit.undo():
        pass
    assert world.edit.text() == XML
    with pytest.raises(xvrml.EditError):
        world.edit.insert("Shape { }", world["G"])


JSON = """{ "X3D": {
    "@version":"3.3",
    "Scene": {
      "-children":[
        {"#comment":"by day"},
        {"PointLight": {"@DEF":"L", "@intensity":0.80, "#comment":"bright"}},
        {"Group": {"@DEF":"G"}}
      ]
    }
  }
}
"""


def test_json(tmp_path):
    path = tmp_path / "l.x3dj"
    path.write_text(JSON)
    world = xvrml.load(path)
    with world.edit("Dim"):
        world["L"].intensity = .5
        world["L"].on = False
    world.edit.save()
    dimmed = JSON.replace("0.80", "0.5").replace('"bright"}', '"bright", "@on":false}')
    assert path.read_text() == dimmed
    world.edit.insert('{"Shape": {"@DEF":"S"}}', world["G"])
    world.edit.use(world["S"], world["G"])
    world.edit.add_route(world["L"], "on", world["L"], "on")
    assert world.edit.text() == dimmed.replace(
        """{"@DEF":"G"}}
""", """{"@DEF":"G", "-children":[
          {"Shape": {"@DEF":"S"}},
          {"Shape": {"@USE": "S"}}
        ]}},
        {"ROUTE": {"@fromNode": "L", "@fromField": "on", "@toNode": "L", "@toField": "on"}}
""")
    while world.edit.undo():
        pass
    assert world.edit.text() == JSON
    with pytest.raises(xvrml.EditError):
        world.edit.insert("Shape { }", world["G"])


def test_routes(lamp):
    lamp.edit.add_route(lamp["L"], "on_changed", lamp["L"], "set_on")
    assert lamp.edit.text().endswith("ROUTE L.on_changed TO L.set_on\n")
    lamp.edit.delete_route(lamp["L"], "on_changed", lamp["L"], "set_on")
    assert lamp.edit.text() == LAMP


def test_files_on_disk(lamp, tmp_path):
    path = tmp_path / "l.wrl"
    os.chmod(path, 0o640)
    lamp.edit.set(lamp["L"], "on", False)
    lamp.edit.save(tmp_path / "other.wrl")
    assert lamp.edit.changed and path.read_text() == LAMP
    path.write_text(LAMP + "# others\n")
    with pytest.raises(xvrml.EditError, match="another program"):
        lamp.edit.save()
    lamp.edit.save(overwrite=True)
    assert "on FALSE" in path.read_text() and path.stat().st_mode & 0o777 == 0o640
    with pytest.raises(OSError):
        lamp.edit.save(tmp_path / "none" / "x.wrl")


def test_refusals(lamp):
    with pytest.raises(ValueError, match=r"in \[0,1\]"):
        lamp.edit.set(lamp["L"], "intensity", 2)
    with pytest.raises(TypeError):
        lamp.edit.set(lamp["L"], "intensity", "much")
    with pytest.raises(xvrml.EditError):
        with lamp.edit("Nodes"):
            lamp["G"].children = [xvrml.Shape()]
    loose = xvrml.loads(LAMP)
    assert "does not come from a file" in loose.edit.read_only
    with pytest.raises(xvrml.EditError):
        loose.edit.set(loose["L"], "on", False)
    with pytest.raises(ValueError):
        loose.edit.rename(lamp["L"], "M")


def test_edits_while_pictures_are_rendered(lamp):
    failures = []

    def draw():
        try:
            for _ in range(10):
                lamp.render(size=(16, 12), spp=1)
        except Exception as error:
            failures.append(error)

    thread = threading.Thread(target=draw)
    thread.start()
    for i in range(50):
        lamp.edit.set(lamp["L"], "intensity", i / 50)
        lamp.edit.undo()
    thread.join()
    assert not failures and lamp.edit.text() == LAMP
