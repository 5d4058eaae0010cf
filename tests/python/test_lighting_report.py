"""Tests what lighting engineers hand in: glare ratings, maintenance factors, and the page of --measure."""
import math
import re

import numpy as np
import pytest
from conftest import ROOT

xvrml = pytest.importorskip("xvrml")

HEAD = "#VRML V2.0 utf8\nNavigationInfo { headlight FALSE }\n"
EVEN = """IESNA:LM-63-2002
TILT=NONE
1 -1 1 2 1 1 2 %s
1 1 100
0 180
0
100 100
"""
LAMP = """ORTLight { shader ORTShader { name "Luminaire" file "luminaire"
  options [ "file profile even.ies", "3f direction 0 -1 0", %s ] } }
"""
SPHERE = """Shape { appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse"
  options "color reflectance .5 .5 .5" } } geometry Sphere { radius 2 } }
""".replace("Sphere { radius 2 }", "ORTQuadric { coefficients [ 1 1 1 0 0 0 0 0 0 -4 ] solid FALSE "
            "low -2.1 -2.1 -2.1 high 2.1 2.1 2.1 }")


@pytest.fixture
def room(vv):

    def make(text, size=".3 .6 0"):
        (vv.folder / "even.ies").write_text(EVEN % size)
        (vv.folder / "room.wrl").write_text(HEAD + text)
        return vv

    return make


def guth(above):
    """The position index of a source so many degrees straight above the line of sight."""
    return math.exp((35.2 - 1.22) * 1e-3 * above + 21e-5 * above**2)


# In a matt sphere about an even lamp the walls have one luminance, wherever one stands.
EYE, CANDELA, RADIUS, REFLECTANCE = (0, -.8, 1.5), 100, 2, .5
BACKGROUND = (REFLECTANCE / (1 - REFLECTANCE) * CANDELA / RADIUS**2) / math.pi


def rating(area, candela=CANDELA, background=BACKGROUND):
    square = .8**2 + 1.5**2
    index = guth(math.degrees(math.atan(.8 / 1.5)))
    return 8 * math.log10(.25 / background * candela**2 / (area * square * index**2))


def observer(more=""):
    return 'DEF Eye ORTSensor { quantity "UGR" position %g %g %g direction 0 0 -1 %s }\n' % (EYE +
                                                                                        (more, ))


def measured(vv, **given):
    given = {"spp": 256, "depth": 64, **given}
    return xvrml.load(vv.folder / "room.wrl").measure(**given)


@pytest.mark.parametrize("size, area", [(".3 .6 0", .18 * .8 / 1.7),
                                        ("-.4 -.4 0", math.pi * .04 * .8 / 1.7),
                                        (".3 .6 .1", .18 * .8 / 1.7 + .1 * .6 * 1.5 / 1.7)])
def test_a_luminaire_in_a_sphere_has_the_rating_of_the_closed_form(room, size, area):
    # horizontal angle 0 is towards +x: the length .6 lies along x, across the view
    (eye, ) = measured(room(SPHERE + LAMP % '"3f reference 1 0 0"' + observer(), size), spp=4096)
    assert (eye.quantity, eye.unit) == ("UGR", "")
    value, half = float(eye.values[0, 0]), float(eye.half_widths[0, 0])
    assert abs(value - rating(area)) < 1.6 * half + .01, (value, rating(area), half)
    assert half < .1 and eye.trusted.all()


def test_intervals_of_ratings_hold(room):
    vv = room(SPHERE + LAMP % "" + observer("size 1e-5 1e-5 columns 20 rows 20"))
    (grid, ) = measured(vv, spp=64)
    expected = rating(.18 * .8 / 1.7)
    held = np.abs(grid.values - expected) <= grid.half_widths
    assert .91 < held.mean() < .99, held.mean()
    assert grid.half_widths.max() < 2


def test_a_hidden_luminaire_glares_no_more(room):
    plate = """Transform { translation 0 -.4 .75 children Shape { appearance ORTAppearance {
      shader ORTShader { name "Diffuse" file "diffuse" } } geometry Box { size .1 .1 .1 } } }"""
    (eye, ) = measured(room(SPHERE + LAMP % "" + plate + observer()))
    assert eye.values[0, 0] == 0


def test_a_luminaire_that_cannot_be_rated_is_named(room):
    vv = room(SPHERE + "DEF Spot " + LAMP % "" + observer(), "0 0 0")
    done = vv("room.wrl", "--measure", "-", "--spp", "16")
    assert done.returncode == 4 and "Spot" in done.talk and "no luminous opening" in done.talk
    vv = room("Transform { scale 2 2 2 children " + LAMP % "" + "}" + observer())
    done = vv("room.wrl", "--measure", "-", "--spp", "16")
    assert done.returncode == 4 and "scaled" in done.talk, done.talk
    vv = room("Transform { children " + LAMP.replace("even.ies", "gone.ies") % "" + "}" + observer())
    assert "cannot be read" in vv("room.wrl", "--measure", "-", "--spp", "16").talk


def test_openings_of_eulumdat_files_are_read(vv):
    """The eye of lit_room.wrl with a rating: both files have openings of 600 mm."""
    for name in ("panel.ldt", "wing.ldt"):
        (vv.folder / name).write_bytes((ROOT / "examples/optics" / name).read_bytes())
    text = (ROOT / "examples/optics/lit_room.wrl").read_text()
    (vv.folder / "room.wrl").write_text(
        text + 'DEF Eye ORTSensor { quantity "UGR" position 2.9 1.2 0 direction -1 0 0 }\n')
    eye = measured(vv, spp=1024)[-1]
    assert 10 < eye.values[0, 0] < 28 and eye.half_widths[0, 0] < .5
    done = vv("room.wrl", "--measure", "-", "--spp", "256")
    assert re.search(r"Eye: UGR [\d.]+ \+- [\d.]+ \(95 %\)", done.talk), done.talk


def test_a_maintenance_factor_leaves_a_share_of_the_light(room):
    sensor = "ORTSensor { position 0 -1 0 }"
    lux = [
        float(measured(room(LAMP % more + sensor))[0].values[0, 0])
        for more in ("", '"1f maintenance .8"', '"1f maintenance .8" "1f lumen 1000"')
    ]
    assert lux[0] == pytest.approx(100, rel=1e-5)
    assert lux[1] == pytest.approx(80, rel=1e-5)
    assert lux[2] == pytest.approx(.8 * 1000 / (4 * math.pi), rel=1e-4)


def page_of(vv, *options):
    done = vv("room.wrl", "--measure", "light.html", "--spp", "64", *options)
    assert done.returncode == 0, done.talk
    return (vv.folder / "light.html").read_text()


GRID = "DEF Desk ORTSensor { position 0 -1 0 size 2 1 columns 8 rows 4 }\n"


def test_the_page_has_grids_luminaires_and_the_command(room):
    vv = room(SPHERE + "DEF Lamp " + LAMP % '"1f maintenance .8"' + GRID + observer())
    page = page_of(vv)
    assert page.count("<svg") == 1 and page.count("<h2>") == 4
    for text in ("room.wrl", "Desk: illuminance", "Eye: UGR", "uniformity", "8 x 4, all trusted",
                 "even.ies", "<td class=n>1005<td class=n>0.8", "--measure light.html --spp 64"):
        assert text in page, text
    assert "<script" not in page and "http:" not in page.replace("http://www.w3.org/2000/svg", "")
    # the numbers of the page are those of the file for programs
    (desk, _) = xvrml.load(vv.folder / "room.wrl").measure(spp=64)
    assert "%.4g" % desk.values.mean() in page
    numbers = re.findall(r'fill="#333">([\d.]+)\??</text>', page)
    assert len(numbers) == 32
    assert float(numbers[0]) == pytest.approx(desk.values[0, 0], abs=.6)


def test_isolines_are_where_the_light_has_their_value(room):
    """A lamp over a large plane: isolines are circles about its foot."""
    vv = room(LAMP % "" + "ORTSensor { position 0 -1 0 size 4 4 columns 40 rows 40 }\n")
    page = page_of(vv)
    labels = [float(x) for x in re.findall(r'paint-order="stroke">([\d.]+)</text>', page)]
    paths = re.findall(r'stroke-width="1" d="([^"]+)"', page)
    assert len(labels) == len(paths) >= 4
    scale = 640 / 4
    # the drawing is at most 480 high: circles are ellipses then
    height = float(re.search(r'viewBox="0 0 \d+ (\d+)"', page).group(1)) / 4
    for level, path in zip(labels, paths):
        radius = math.sqrt((100 / level)**(2 / 3) - 1)  # I h / d^3 = level at h = 1
        for x, y in re.findall(r"[ML]([\d.]+) ([\d.]+)", path):
            at = math.hypot(float(x) / scale - 2, float(y) / height - 2)
            assert at == pytest.approx(radius, abs=.03), level


def test_a_page_shows_hostile_names_as_they_are(room):
    evil = "<script>alert(1)</script>&\\\"'"
    vv = room(LAMP.replace("even.ies", "a<b>.ies") % "" +
              'ORTSensor { description "%s" size 1 1 columns 3 rows 3 }' % evil)
    page = page_of(vv)
    assert "<script" not in page and "&lt;script&gt;" in page and "a&lt;b&gt;.ies" in page


def test_large_grids_make_pages_of_a_bounded_size(room):
    vv = room(LAMP % "" + "ORTSensor { position 0 -1 0 size 4 4 columns 1000 rows 500 }\n")
    done = vv("room.wrl", "--measure", "light.html", "--spp", "1", "-q")
    assert done.returncode == 0, done.talk
    page = (vv.folder / "light.html").read_text()
    assert page.count("<rect") < 96 * 96 + 20 and len(page) < 3e6


def test_pictures_show_luminaires_with_the_luminance_of_their_files(tmp_path):
    """A disc of 100 cd from all sides, also in a scaled node: I / A in the coordinates of the node."""
    (tmp_path / "even.ies").write_text(EVEN % "-.4 -.4 0")
    world = tmp_path / "seen.wrl"
    expected = 100 / (math.pi * .2**2 * math.cos(math.radians(40)))

    def seen(lamp, scale=1):
        at = 3 * math.cos(math.radians(40)), 3 * math.sin(math.radians(40))
        world.write_text(HEAD + f"""Viewpoint {{ position 0 0 {at[1]} orientation 1 0 0 {math.radians(50)} }}
Transform {{ translation 0 {at[0]} 0 scale {scale} {scale} {scale} children {lamp} }}""")
        return xvrml.load(world).render(size=(3, 3), spp=4, fov=.5).array[1, 1]

    assert seen(LAMP % "")[:3] == pytest.approx([expected] * 3, rel=1e-3)
    assert seen(LAMP % "", 2)[:3] == pytest.approx([expected] * 3, rel=1e-3)
    assert seen(LAMP % '"1f maintenance .5"')[:3] == pytest.approx([expected / 2] * 3, rel=1e-3)
    assert not seen(LAMP % '"1i shown 0"').any()
