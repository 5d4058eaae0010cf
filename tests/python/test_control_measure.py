"""Tests photometry of a world that runs: "measure" and the illuminance of "probe"."""
import json
import math
import subprocess

import pytest
from conftest import HEADER, find_vv
from control_server import module, start  # noqa: F401

# A lamp of 100 cd in all directions, 2 m above a black floor, and a headlight that must not count.
WORLD = HEADER + """
DEF LAMP Transform { translation 0 2 0 children ORTLight { shader ORTShader {
  name "Luminaire" file "luminaire" options "1f lumen 1256.6371" } } }
DEF V Viewpoint { position 0 1 4 orientation 1 0 0 -.245 }
DEF FLOOR Shape {
  appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse"
    options [ "color reflectance 0 0 0" ] } }
  geometry Box { size 20 .000001 20 }
}
DEF Desk ORTSensor { position 0 0 0 direction 0 1 0 size 2 2 columns 3 rows 3 }
DEF Glare ORTSensor { quantity "LUMINANCE" position 0 1 3 direction 0 0 -1 }
"""


@pytest.fixture
def lamp(start, tmp_path):
    (tmp_path / "lamp.wrl").write_text(WORLD)
    return start("lamp.wrl", "--size", "48x32", "--spp", "64").connect()


def lux(height, distance):
    """The illuminance of a plane below the lamp, from the inverse square law."""
    return 100 * height / (height**2 + distance**2)**1.5


def test_sensors_read_what_the_command_line_reads(lamp, tmp_path):
    desk, glare = lamp.measure()
    assert (desk["name"], desk["unit"], desk["columns"], desk["rows"]) == ("Desk", "lx", 3, 3)
    assert (glare["name"], glare["unit"], glare["mean"]) == ("Glare", "cd/m2", 0)
    for point in desk["points"]:
        x, y, z = point["position"]
        assert point["value"] == pytest.approx(lux(2, math.hypot(x, z)), rel=1e-3)
        assert point["samples"] == 64, "--spp"
    subprocess.run([find_vv(), "lamp.wrl", "--measure", "out.json", "--spp", "64", "-q"],
                   cwd=tmp_path,
                   check=True)
    assert json.loads((tmp_path / "out.json").read_text())["sensors"] == [desk, glare]
    assert lamp.measure(samples=16)[0]["points"][4]["samples"] == 16


def test_a_lamp_that_is_moved_is_read_at_once(lamp):
    for height in (1, 4, 2):
        lamp.set("LAMP", "translation", [0, height, 0])
        assert lamp.measure()[0]["points"][4]["value"] == pytest.approx(lux(height, 0), rel=1e-3)
    with lamp.edit("Lift the lamp") as step:
        step.set("LAMP", "translation", [0, 5, 0])
    assert lamp.measure()[0]["points"][4]["value"] == pytest.approx(lux(5, 0), rel=1e-3)
    lamp.undo()
    assert lamp.measure()[0]["points"][4]["value"] == pytest.approx(lux(2, 0), rel=1e-3)


def test_the_illuminance_of_a_surface_that_is_seen(lamp):
    for x, y in ((0, -.2), (.4, -.5), (-.7, -.9)):
        read = lamp.probe(x, y, quantity="illuminance")
        assert read["hit"]["path"][-1]["name"] == "FLOOR"
        px, _, pz = read["hit"]["point"]
        assert read["illuminance"] == pytest.approx(lux(2, math.hypot(px, pz)), rel=1e-3)
        assert read["samples"] == 64 and "luminance" not in read
    assert lamp.probe(0, -.2)["luminance"] == 0, "a black floor"
    with pytest.raises(module().ControlError, match="nothing is seen there"):
        lamp.probe(0, .99, quantity="illuminance")
    with pytest.raises(module().ControlError, match='"luminance" or "illuminance"'):
        lamp.probe(0, 0, quantity="lux")


def test_pictures_are_the_same_before_and_after(lamp):
    before = lamp.render(format="ppm")
    lamp.measure()
    assert lamp.render(format="ppm") == before
    lamp.probe(0, -.2, quantity="illuminance")
    assert lamp.probe(0, -.2) == lamp.probe(0, -.2)
    assert lamp.render(format="ppm") == before, "the headlight is on again"


def test_readings_and_pictures_take_turns(start, tmp_path):
    (tmp_path / "lamp.wrl").write_text(WORLD)
    server = start("lamp.wrl", "--size", "48x32", "--spp", "16")
    clients = [server.raw() for _ in range(4)]
    commands = ({"command": "measure"}, {"command": "render", "format": "ppm"},
                {"command": "probe", "x": 0, "y": -.2, "quantity": "illuminance"},
                {"command": "probe", "x": 0, "y": -.2})
    for i in range(5):
        for client, command in zip(clients, commands):
            client.send({"id": i, **command})
    for client in clients:
        answers = [client.receive() for _ in range(5)]
        assert [a["id"] for a in answers] == list(range(5))
        assert all(a["result"] == answers[0]["result"] for a in answers), answers


def test_a_sensor_with_wrong_fields_is_named_and_nothing_is_lost(lamp):
    lamp.set("Desk", "direction", [0, 0, 0])
    with pytest.raises(module().ControlError, match="ORTSensor Desk: direction has no length"):
        lamp.measure()
    assert lamp.probe(0, -.2, quantity="illuminance")["illuminance"] > 0
    lamp.set("Desk", "direction", [0, 1, 0])
    assert len(lamp.measure()) == 2


def test_worlds_without_sensors_and_other_worlds(lamp, tmp_path):
    (tmp_path / "none.wrl").write_text(HEADER + "Shape { geometry Box { } }")
    lamp.load(str(tmp_path / "none.wrl"))
    assert lamp.measure() == []


def test_a_world_that_is_replaced_ends_a_reading(start, tmp_path):
    (tmp_path / "lamp.wrl").write_text(WORLD)
    server = start("lamp.wrl", "--size", "48x32")
    one, two = server.raw(), server.raw()
    one.send({"id": 1, "command": "measure", "samples": 65536})
    two.send({"id": 2, "command": "load", "url": "lamp.wrl"})
    answer = one.receive()
    assert "result" in answer or "replaced" in answer["error"]["message"], answer
    assert "result" in two.receive()
    one.send({"id": 3, "command": "measure", "samples": 16})
    while (answer := one.receive()).get("id") != 3:
        assert answer.get("event") == "world"
    assert len(answer["result"]) == 2
