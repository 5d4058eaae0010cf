"""Tests photometric sensors: vv --measure, World.measure() and --false-colour."""
import copy
import csv
import io
import json
import math
import pickle

import numpy as np
import pytest
from conftest import read_pfm

xvrml = pytest.importorskip("xvrml")

ROOM = """#VRML V2.0 utf8
NavigationInfo { headlight FALSE }
Transform { translation 0 2 0 children ORTLight { shader ORTShader {
  name "Luminaire" file "luminaire" options "1f lumen 1256.6371" } } }
DEF Desk ORTSensor { size 2 2 columns 2 rows 2 }
ORTSensor { description "=glare, \\"hard\\"" quantity "LUMINANCE" position 0 1 3 direction 0 0 -1 }
Shape {
  appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse"
    options "color reflectance 0 0 0 color emission 50 50 50" } }
  geometry IndexedFaceSet { solid FALSE coordIndex [ 0 1 2 3 ]
    coord Coordinate { point [ -1 0 -9, 1 0 -9, 1 2 -9, -1 2 -9 ] } }
}
"""


@pytest.fixture
def room(vv):
    (vv.folder / "room.wrl").write_text(ROOM)
    return vv


def test_few_samples_are_not_trusted_even_where_they_are_exact(vv):
    """Fewer than 32 samples make no batches, from which trust is judged."""
    vv.write("lamp.wrl", ROOM[:ROOM.index("ORTSensor { description")])
    world = xvrml.load(str(vv.folder / "lamp.wrl"))
    readings = [world.measure(spp=spp)[0] for spp in (16, 31, 32)]
    for one in readings:
        np.testing.assert_array_equal(one.values, readings[0].values)
        assert not one.half_widths.any()
    assert [one.trusted.all() for one in readings] == [False, False, True]
    assert not readings[1].trusted.any()


def test_readings_as_csv(room):
    done = room("room.wrl", "--measure", "out.csv", "--spp", "64")
    assert done.returncode == 0, done.talk
    rows = list(csv.DictReader(io.StringIO((room.folder / "out.csv").read_text())))
    assert len(rows) == 5
    for row in rows[:4]:
        assert row["sensor"] == "Desk" and row["unit"] == "lx"
        assert abs(float(row["x [m]"])) == .5 and abs(float(row["z [m]"])) == .5
        # 100 cd at a height of 2 m, and a little of the luminous wall
        direct = 100 * 2 / 4.5**1.5
        value = float(row["value [unit]"])
        half = float(row["half-width of the 95 % interval [unit]"])
        assert direct - half < value < direct + 5
    glare = rows[4]
    assert glare["sensor"] == "'=glare, \"hard\"", "no formula for a spreadsheet"
    assert (glare["quantity"], glare["unit"]) == ("luminance", "cd/m2")
    assert float(glare["value [unit]"]) == pytest.approx(50, rel=1e-5)
    assert "Desk: " in done.talk and " lx " in done.talk


def test_readings_as_json(room):
    done = room("room.wrl", "--measure", "out.json", "--spp", "256", "-q")
    assert done.returncode == 0, done.talk
    said = json.loads((room.folder / "out.json").read_text())
    assert said["schema"] == 1 and said["interval"]["level"] == .95
    assert said["units"] == {"position": "m", "illuminance": "lx", "luminance": "cd/m2"}
    desk, glare = said["sensors"]
    assert desk["unit"] == "lx" and len(desk["points"]) == 4 and desk["direction"] == [0, 1, 0]
    values = [point["value"] for point in desk["points"]]
    assert desk["mean"] == pytest.approx(np.mean(values))
    assert desk["minimum"] == min(values) and desk["maximum"] == max(values)
    assert desk["uniformity"] == pytest.approx(min(values) / np.mean(values))
    assert all(point["samples"] == 256 and point["half_width"] > 0 for point in desk["points"])
    assert glare["points"][0]["value"] == pytest.approx(50, rel=1e-5)


def test_the_same_bytes_for_any_number_of_threads(room):
    texts = {
        room("room.wrl", "--measure", "-", "--spp", "64", "-q", "--threads", n).stdout
        for n in (1, 3)
    }
    assert len(texts) == 1 and texts.pop().startswith(b"sensor,quantity,unit")
    other = room("room.wrl", "--measure", "-", "--spp", "64", "-q", "--seed", "3").stdout
    assert other.startswith(b"sensor,quantity,unit") and other not in texts


def test_a_target_that_is_missed_says_what_was_promised_and_reached(room):
    done = room("room.wrl", "--measure", "out.csv", "--error", ".001%", "--spp", "64")
    assert done.returncode == 0
    lines = [line for line in done.talk.splitlines() if "promised" in line]
    assert lines and all("reached" in line for line in lines), done.talk
    done = room("room.wrl", "-o", "x.png", "--size", "16x16", "--error", ".001%", "--spp", "64")
    (line,) = [line for line in done.talk.splitlines() if "promised" in line]
    assert "--error promised 0.001 %, reached" in line


def test_a_missed_target_does_not_advise_what_leaves_paths_from_lamps_as_they_are(room):
    """With --error the target decides how many paths from lamps are taken; --spp changes none."""
    (room.folder / "lens.wrl").write_text("""#VRML V2.0 utf8
NavigationInfo { headlight FALSE }
Transform { translation 0 2 0 children ORTLight { shader ORTShader {
  name "Luminaire" file "luminaire" options "1f lumen 1000" } } }
Transform { translation 0 1 0 children Shape {
  appearance ORTAppearance { shader ORTShader { name "Glass" file "glass" options "1f index 1.5" } }
  geometry Sphere { radius .4 } } }
DEF Desk ORTSensor { size 2 2 columns 4 rows 4 direction 0 1 0 }
""")
    done = room("lens.wrl", "--measure", "out.csv", "--error", ".1%", "--spp", "256",
                "--transport", "light")
    (line,) = [line for line in done.talk.splitlines() if "promised" in line]
    assert "--spp N without --error takes N of both" in line
    done = room("lens.wrl", "--measure", "out.csv", "--error", ".1%", "--spp", "64")
    lines = [line for line in done.talk.splitlines() if "promised" in line]
    assert all("of both" not in line for line in lines), done.talk


@pytest.mark.parametrize("fields, expected", [
    ('quantity "LUX"', "quantity is ILLUMINANCE, LUMINANCE or UGR"),
    ("direction 0 0 0", "direction has no length"),
    ("columns 4096 rows 4096 size 1 1", "at most 1048576 points"),
    ('quantity "UGR" columns 65 rows 64 size 1 1', "at most 4096 points"),
    ("columns 4 rows 4", "a grid of 4 x 4 points needs a size along both, not 0 x 0"),
    ("columns 4 rows 4 size 1 0", "needs a size along both, not 1 x 0"),
    ("columns 4 size 1e-20 1", "nearer together than 1e-13 m"),
])
def test_wrong_sensors_are_refused(vv, fields, expected):
    (vv.folder / "bad.wrl").write_text("#VRML V2.0 utf8\nDEF Bad ORTSensor { %s }\n" % fields)
    done = vv("bad.wrl", "--measure", "out.csv", "--spp", "1")
    assert done.returncode == 4 and expected in done.talk and "Bad" in done.talk, done.talk
    assert not (vv.folder / "out.csv").exists()


def test_worlds_without_sensors_and_wrong_options(vv):
    done = vv("box.wrl", "--measure", "out.csv")
    assert done.returncode == 4 and "no ORTSensor" in done.talk
    for arguments in (("--measure", "out.txt"), ("--measure", "out.csv", "--frames", "1-2"),
                      ("--measure", "-", "--stats", "-", "-o", "x.png"),
                      ("--false-colour", "auto", "--check"), ("--false-colour", "-3", "-o",
                                                              "x.png"), ("--false-colour", "auto",
                                                                         "-o", "x.exr")):
        assert vv("box.wrl", *arguments).returncode == 2, arguments


def test_false_colours_widen_the_picture_and_leave_exr_alone(room):
    done = room("room.wrl", "-o", "x.ppm", "-o", "x.exr", "--false-colour", "60", "--size", "64x48",
                "--spp", "4", "-q")
    assert done.returncode == 0, done.talk
    width, height = map(int, (room.folder / "x.ppm").read_bytes().split(b"\n")[1].split()[:2])
    assert width > 64 and height == 48
    assert room("room.wrl", "--compare", "x.exr", "--size", "64x48", "--spp", "4",
                "-q").returncode == 0, "the EXR file holds the picture itself"


def test_the_pictures_of_a_film_have_one_scale_of_false_colours(vv):
    """A lamp that grows brighter: the scale is that of the first picture, in files and films."""
    (vv.folder / "film.wrl").write_text("""#VRML V2.0 utf8
Shape { geometry Box { size 9 9 1 } appearance Appearance { material DEF M Material {
  diffuseColor 0 0 0 emissiveColor .1 .1 .1 } } }
DEF T TimeSensor { cycleInterval 4 loop TRUE startTime 1 }
DEF I ColorInterpolator { key [ 0 1 ] keyValue [ .1 .1 .1 .9 .9 .9 ] }
ROUTE T.fraction_changed TO I.set_fraction ROUTE I.value_changed TO M.emissiveColor""")
    common = ("film.wrl", "--size", "48x40", "--spp", "1", "--frames", "0-2", "--fps", "1", "-q")
    done = vv(*common, "-o", "x.gif", "-o", "x.ppm", "-o", "x.pfm", "--false-colour", "auto")
    assert done.returncode == 0, done.talk
    read = lambda name: (vv.folder / name).read_bytes()
    frames = sorted(path.name for path in vv.folder.glob("x*.ppm"))
    assert len(frames) == 3
    first = read(frames[0])
    # The same end of the scale, given as a number: the box has one luminance.
    most = str(max(np.ravel(read_pfm(read("x-0000.pfm"))[2])))
    assert vv(*common, "-o", "y.ppm", "--false-colour", most).returncode == 0
    others = sorted(path.name for path in vv.folder.glob("y*.ppm"))
    assert [read(name) for name in others] == [read(name) for name in frames]
    width, height = map(int, first.split(b"\n")[1].split()[:2])
    data = read("x.gif")
    assert (data[6] + 256 * data[7], data[8] + 256 * data[9]) == (width, height) and width > 48
    image = pytest.importorskip("PIL.Image")
    with image.open(vv.folder / "x.gif") as film, image.open(vv.folder / frames[0]) as picture:
        # GIF has 256 colours.
        shown = np.asarray(film.convert("RGB")).astype(int)
        assert abs(shown - np.asarray(picture.convert("RGB"))).mean() < 8


def test_python_reads_the_same(room):
    world = xvrml.load(room.folder / "room.wrl")
    desk, glare = world.measure(spp=256)
    assert (desk.name, desk.quantity, desk.unit) == ("Desk", "illuminance", "lx")
    assert desk.values.shape == desk.half_widths.shape == desk.trusted.shape == (2, 2)
    assert desk.positions.shape == (2, 2, 3) and desk.direction == (0, 1, 0)
    assert glare.values[0, 0] == pytest.approx(50, rel=1e-5)
    assert room("room.wrl", "--measure", "out.json", "--spp", "256", "-q").returncode == 0
    said = json.loads((room.folder / "out.json").read_text())
    for point, value in zip(said["sensors"][0]["points"], desk.values.flat):
        assert np.float32(point["value"]) == value
    assert (desk.samples == 256).all()
    more = world.measure(spp=65536, error=.02)
    assert more[0].stats["error_half_width"] < .03


def test_measurements_can_be_pickled_and_copied(room):
    for given in xvrml.load(room.folder / "room.wrl").measure(spp=64):
        for made in (pickle.loads(pickle.dumps(given)), copy.deepcopy(given)):
            for name in ("name", "quantity", "unit", "direction", "stats"):
                assert getattr(made, name) == getattr(given, name)
            for name in ("positions", "values", "half_widths", "trusted", "samples"):
                assert np.array_equal(getattr(made, name), getattr(given, name))
                assert getattr(made, name).dtype == getattr(given, name).dtype
            assert repr(made) == repr(given)


def test_wrong_pickles_of_measurements_are_refused(room):
    given = xvrml.load(room.folder / "room.wrl").measure(spp=1)[0]
    state = given.__getstate__()
    grid = np.zeros((2, 2), np.float32)
    for i, wrong in ((0, 99), (0, None), (1, 3), (4, (0, 0)), (8, "x"), (8, grid[:1]), (9, grid[0]),
                     (11, grid[:0]), (12, 5)):
        made = xvrml.Measurement.__new__(xvrml.Measurement)
        with pytest.raises(ValueError, match="no pickled Measurement"):
            made.__setstate__(state[:i] + (wrong,) + state[i + 1:])
    with pytest.raises(ValueError, match="no pickled Measurement"):
        xvrml.Measurement.__new__(xvrml.Measurement).__setstate__(())


def test_python_places_sensors(room):
    world = xvrml.loads("#VRML V2.0 utf8\nNavigationInfo { headlight FALSE }\n"
                        "Transform { scale 2 2 2 rotation 1 0 0 1.5707963\n"
                        " children DEF S ORTSensor { position 0 0 -1 size 1 1 rows 2 } }")
    (sensor,) = world.measure(spp=1)
    # The normal y becomes z, and the plane's z becomes -y.
    assert np.allclose(sensor.direction, (0, 0, 1), atol=1e-6)
    assert np.allclose(sensor.positions[:, 0], [(0, 2.5, 0), (0, 1.5, 0)], atol=1e-5)
    assert math.isclose(float(sensor.values[0, 0]), 0)


def test_a_line_of_points_needs_one_size():
    world = xvrml.loads("#VRML V2.0 utf8\nORTSensor { columns 4 size 2 0 }")
    assert world.measure(spp=1)[0].positions[0, :, 0].tolist() == [-.75, -.25, .25, .75]


MIRROR = """#VRML V2.0 utf8
NavigationInfo { headlight FALSE }
Transform { translation 0 3 0 children ORTLight { shader ORTShader {
  name "Luminaire" file "luminaire" options "1f lumen 1256.6371" } } }
Shape {
  appearance ORTAppearance { shader ORTShader { name "Mirror" file "mirror"
    options "color reflectance .8 .8 .8" } }
  geometry IndexedFaceSet { solid FALSE coordIndex [ 0 1 2 3 ]
    coord Coordinate { point [ -9 0 9, 9 0 9, 9 0 -9, -9 0 -9 ] } }
}
DEF Grid ORTSensor { position 0 2 0 direction 0 -1 0 size 2 2 columns 2 rows 2 }
DEF Point ORTSensor { position 0 2 0 direction 0 -1 0 }
"""


def test_light_paths_reach_sensors_that_have_cells(vv):
    """100 cd, mirrored: the grid looks away from the lamp and sees its image at a distance of 5."""
    (vv.folder / "mirror.wrl").write_text(MIRROR)
    arguments = ("mirror.wrl", "--measure", "out.json", "--spp", "1024")
    done = vv(*arguments, "--transport", "light")
    assert done.returncode == 0, done.talk
    grid, point = json.loads((vv.folder / "out.json").read_text())["sensors"]
    steps = np.linspace(-1, 1, 101)
    x, y = np.meshgrid(steps, steps)
    expected = .8 * np.mean(100 * 5 / (x**2 + y**2 + 25)**1.5)
    assert grid["mean"] == pytest.approx(expected, abs=3 * grid["mean_half_width"])
    assert grid["mean_half_width"] < .03 * expected and grid["unreached_lamps"] == 0
    assert point["mean"] == 0 and point["unreached_lamps"] == 1
    assert "Point: the light that 1 lamps" in done.talk and "give the sensor a size" in done.talk
    done = vv(*arguments)
    assert "Grid: the light that 1 lamps" in done.talk and "--transport light" in done.talk
    (other, _) = xvrml.load(vv.folder / "mirror.wrl").measure(spp=1024, transport="light")
    values = [p["value"] for p in grid["points"]]
    assert other.values.flatten().tolist() == pytest.approx(values, rel=1e-6)


def test_lights_of_groups_are_left_out_and_this_is_said():
    """The readings are those without the light of the group (docs/photometry.md)."""
    sun = "DirectionalLight { direction 0 -1 0 }"
    sensor = "Group { children DEF S ORTSensor { } }"
    for world, reading, warned in ((sun + sensor, math.pi,
                                    False), (f"Group {{ children [ {sun} {sensor} ] }}", 0, True),
                                   (f"Group {{ children {sun} }} {sensor}", 0, False),
                                   (f"Group {{ children [ {sun[:-1]} on FALSE }} {sensor} ] }}", 0,
                                    False)):
        graph = xvrml.loads("#VRML V2.0 utf8\nNavigationInfo { headlight FALSE }\n" + world)
        (got,) = graph.measure(spp=16)
        assert got.values[0, 0] == pytest.approx(reading)
        said = [str(w) for w in graph.warnings if "lights the shapes of that group" in str(w)]
        assert bool(said) == warned, said


def test_the_way_to_find_light_behind_glass_is_one_that_exists(vv):
    """In fog no light is followed from lamps, so the warning does not advise it again."""
    world = """#VRML V2.0 utf8
NavigationInfo { headlight FALSE }
Transform { translation 0 3 0 children ORTLight { shader ORTShader {
  name "Luminaire" file "luminaire" options "1f lumen 1000" } } }
Transform { translation 0 1.5 0 children Shape { geometry Box { size 2 .1 2 } appearance
  ORTAppearance { shader ORTShader { name "Glass" file "glass" } } } }
%s
DEF S ORTSensor { size 1 1 }
"""
    fog = """Shape { geometry Sphere { radius 9 }
  appearance ORTAppearance { shader ORTShader { name "Fog" file "fog" } } }"""
    for name, body, expected in (("clear", "", "--transport light follows it"),
                                 ("fog", fog, "paths start at the camera")):
        (vv.folder / "w.wrl").write_text(world % body)
        asked = ("--transport", "light") if body else ()
        done = vv("w.wrl", "--measure", "out.csv", "--spp", "16", *asked)
        assert done.returncode == 0, done.talk
        assert expected in done.talk, name
        assert (expected == "--transport light follows it") == ("light follows it" in done.talk)
