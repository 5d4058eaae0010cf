"""Tests that names of X3D reach everywhere in worlds of X3D: fields in Python, events, routes, -D,
the control channel, edits (docs/versions.md)."""
import pytest

from conftest import SMALL
from control_server import start, until  # noqa: F401

xvrml = pytest.importorskip("xvrml")

WORLD = """#X3D V3.3 utf8
PROFILE Full
Viewpoint { position 0 0 10 }
DEF W Switch { whichChoice 0 children [ DEF A Group { } DEF B Group { } ] }
DEF L LOD { range 5 children [ DEF N Group { } DEF F Group { } ] }
DEF C Collision { enabled TRUE children DEF D Group { } }
DEF X Switch { }
"""


def world():
    return xvrml.loads(WORLD.encode())


def test_fields_of_a_world_at_rest():
    w = world()
    assert [node.def_name for node in w["W"].children] == ["A", "B"]
    assert [node.def_name for node in w["L"].children] == ["N", "F"]
    assert w["C"].enabled is True
    w["C"].enabled = False
    assert w["C"].enabled is False
    assert "children" in dir(w["W"]) and "choice" not in dir(w["W"])
    assert w["C"].fields["enabled"] == "SFBool"
    # VRML97's names are known as before.
    assert len(w["W"].choice) == 2
    with pytest.raises(AttributeError, match="did you mean enabled"):
        w["C"].enabeld


def test_events_of_a_running_world():
    browser = xvrml.Browser(WORLD.encode())
    heard = []
    for event in ("W.children_changed", "C.enabled_changed", "C.enabled", "L.level_changed"):
        browser.on(event, lambda value, time, event=event: heard.append(event))
    browser["C"].set_enabled = False
    browser["W"].addChildren = [browser["D"]]
    assert sorted(heard) == ["C.enabled", "C.enabled_changed", "W.children_changed"]
    assert len(browser["W"].children) == 3
    browser.route("W.children_changed", "X.set_children")
    browser["W"].children = [browser["A"]]
    assert [node.def_name for node in browser["X"].children] == ["A"]


def test_a_route_is_written_as_the_standard_spells_it():
    w = world()
    w.route("L.children_changed", "X.set_children")
    w.route("L.level_changed", "X.whichChoice")
    text = w.to_x3d("classic")
    assert "ROUTE L.level_changed TO X.whichChoice" in text
    again = xvrml.loads(text.encode())
    assert not again.warnings
    assert "ROUTE L.level_changed TO X.whichChoice" in again.to_x3d("classic")
    assert "TO X.set_children" in again.to_x3d("classic") and "ROUTE L.children" in again.to_x3d("classic")


def test_names_of_x3d_are_none_of_vrml97():
    w = xvrml.loads(b"#VRML V2.0 utf8\nDEF W Switch { choice Group { } } DEF C Collision { }")
    with pytest.raises(AttributeError):
        w["W"].children
    with pytest.raises(AttributeError):
        w["C"].enabled


def test_definitions(vv):
    vv.write("w.x3dv", WORLD)
    assert vv("w.x3dv", "-D", "C.enabled=FALSE", "-o", "a.ppm", *SMALL).returncode == 0
    assert vv("w.x3dv", "-D", "C.collide=FALSE", "-o", "a.ppm", *SMALL).returncode == 0
    refused = vv("w.x3dv", "-D", "C.enabeld=FALSE", "-o", "a.ppm", *SMALL)
    assert refused.returncode == 2 and b"did you mean enabled?" in refused.stderr


def test_ranges_follow_the_version(vv):
    light = "#X3D V%s utf8\nDEF L PointLight { }\n"
    for version, code in (("4.0", 0), ("3.3", 2)):
        vv.write("l.x3dv", light % version)
        assert vv("l.x3dv", "-D", "L.intensity=5", "-o", "a.ppm", *SMALL).returncode == code
        loaded = xvrml.loads((light % version).encode())
        if code:
            with pytest.raises(ValueError):
                loaded["L"].intensity = 5
        else:
            loaded["L"].intensity = 5
            assert loaded["L"].intensity == 5


def test_the_control_channel(start, tmp_path):
    (tmp_path / "w.x3dv").write_text(WORLD)
    vv = start("w.x3dv", *SMALL).connect()
    assert len(vv.get("W", "children")) == 2
    assert vv.get("C", "enabled") is True
    heard = []
    vv.subscribe("C", "enabled", lambda value, time: heard.append(value))
    vv.set("C", "enabled", False)
    until(vv, lambda: heard == [False])
    vv.route("W", "children_changed", "X", "set_children")
    vv.set("W", "addChildren", ["D"])
    assert len(vv.get("X", "children")) == 3
    names = {field["name"] for field in vv.node("W")["fields"]}
    assert "children" in names and "choice" not in names
    with vv.edit("names") as edit:
        edit.insert("Group { }", "L", "children")
    assert len(vv.get("L", "children")) == 3
