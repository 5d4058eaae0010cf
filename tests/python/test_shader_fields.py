"""Tests parameters of shaders that worlds declare as fields: pictures, routes, edits of the file, the
control channel, and what vv writes."""
import pytest

from control_server import SMALL, refused, start  # noqa: F401

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

WORLD = """#VRML V2.0 utf8
Viewpoint { position 0 0 4 }
Background { skyColor [ 0 0 1, 1 1 0, 1 0 0 ] skyAngle [ 1.2, 2 ] }
DEF Ball Shape { appearance ORTAppearance { shader DEF S ORTShader {
  name "Glass" file "glass" %s # of the lens
} } geometry Sphere { } }
DEF Clock TimeSensor { cycleInterval 2 loop TRUE }
DEF Bend ScalarInterpolator { key [ 0, 1 ] keyValue [ 1.25, 1.75 ] }
ROUTE Clock.fraction_changed TO Bend.set_fraction
"""
FIELD = "exposedField SFFloat index %s"
VIEW = {"size": (24, 24), "spp": 2, "seed": 3}


def load(folder, text, name="w.wrl"):
    (folder / name).write_text(text)
    return xvrml.load(folder / name)


def test_a_field_gives_the_picture_of_the_option(tmp_path):
    wanted = load(tmp_path, WORLD % 'options "1f index 1.25"').render(**VIEW).array
    world = load(tmp_path, WORLD % FIELD % 1.25)
    assert world["S"].index == 1.25 and world["S"].fields["index"] == "SFFloat"
    assert isinstance(world["S"], xvrml.ORTShader)
    assert "index" in dir(world["S"])
    assert np.array_equal(world.render(**VIEW).array, wanted)
    world["S"].index = 1.6
    other = world.render(**VIEW).array
    assert not np.array_equal(other, wanted)
    assert np.array_equal(
        other,
        load(tmp_path, WORLD % 'options "1f index 1.6"').render(**VIEW).array)
    assert not world.warnings
    with pytest.raises(AttributeError, match="did you mean"):
        world["S"].indx = 2
    with pytest.raises((TypeError, ValueError)):
        world["S"].index = "glass"


def test_an_interpolator_changes_the_next_picture(tmp_path):
    world = load(tmp_path, WORLD % FIELD % 1.25 + "ROUTE Bend.value_changed TO S.index\n")
    world.time = 0
    first = world.render(**VIEW).array
    world.time = 1
    assert world["S"].index == 1.5
    later = world.render(**VIEW).array
    assert not np.array_equal(first, later)
    still = load(tmp_path, WORLD % 'options "1f index 1.5"')
    assert np.array_equal(later, still.render(**VIEW).array)


def test_an_edit_changes_the_declaration(tmp_path):
    world = load(tmp_path, WORLD % FIELD % "1.50")
    with world.edit("Bend"):
        world["S"].index = 1.75
    world.edit.save()
    assert (tmp_path / "w.wrl").read_text() == WORLD % FIELD % "1.75"
    assert world.edit.undo() == "Bend" and world["S"].index == 1.5


def test_what_is_wrong_is_a_problem_of_the_world(tmp_path):
    world = load(tmp_path, WORLD % "field SFFloat indx 1.5")
    world.render(**VIEW)
    told = [str(one) for one in world.warnings]
    assert any("w.wrl:5:43: error" in one and "did you mean 'index'?" in one for one in told), told


def test_written_worlds_have_it(tmp_path):
    world = load(tmp_path, WORLD % FIELD % 1.25)
    for name in ("a.wrl", "a.x3dv", "a.x3d"):
        world.save(tmp_path / name)
        assert xvrml.load(tmp_path / name)["S"].index == 1.25, name


def test_the_control_channel_knows_it(start, tmp_path):
    (tmp_path / "w.wrl").write_text(WORLD % FIELD % 1.25)
    vv = start("w.wrl", *SMALL).connect()
    fields = {one["name"]: one for one in vv.node("S")["fields"]}
    assert fields["index"] == {"name": "index", "type": "SFFloat", "access": "exposedField"}
    vv.set("S", "index", 1.5)
    assert vv.get("S", "index") == 1.5
    refused("field", "did you mean index?", vv.set, "S", "indx", 1.5)
