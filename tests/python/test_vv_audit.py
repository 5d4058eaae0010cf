"""Tests vv --audit and --compare: pictures against references."""
import re

import pytest


def value(text, name):
    match = re.search(r"^%s +([-+.0-9e]+)" % name, text, re.MULTILINE)
    assert match, text
    return float(match.group(1))


def test_a_picture_compared_with_itself_and_with_another(vv):
    assert vv("box.wrl", "-o", "ref.exr", "--size", "24x16", "-q").returncode == 0
    same = vv("box.wrl", "--compare", "ref.exr", "--size", "24x16", "-q")
    assert same.returncode == 0, same.talk
    for name in ("rmse", "relmse", "bias", "largest"):
        assert value(same.text, name) == 0
    other = vv("box.wrl", "--compare", "ref.exr", "--size", "24x16", "--seed", "5", "-q")
    assert other.returncode == 0 and 0 < value(other.text, "rmse") < .1


def test_references_that_are_none(vv):
    assert vv("box.wrl", "-o", "ref.exr", "-o", "ref.png", "--size", "24x16", "-q").returncode == 0
    for arguments, expected in (
        (("--compare", "none.exr"), "none.exr"),
        (("--compare", "ref.png"), "ref.png"),
        (("--compare", "ref.exr", "--size", "25x16"), "24x16"),
    ):
        done = vv("box.wrl", "-q", *arguments)
        assert done.returncode == 3 and expected in done.talk, done.talk
    assert vv("box.wrl", "--audit", "--time-limit", "1").returncode == 2
    assert vv("box.wrl", "--audit", "1").returncode == 2


def test_an_audit_says_whether_the_error_bars_hold(vv):
    done = vv("box.wrl", "--audit", "6", "--size", "24x16", "--spp", "32", "-q")
    assert done.returncode in (0, 4), done.talk
    assert done.text.startswith("6 pictures of 32 samples")
    assert 0 <= value(done.text, "trusted") <= 100
    assert ("the error bars hold" in done.text) == (done.returncode == 0)
    given = vv("box.wrl", "-o", "ref.exr", "--size", "24x16", "--spp", "256", "--channels",
               "rgba,error,trust", "-q")
    assert given.returncode == 0
    done = vv("box.wrl", "--audit", "3", "--compare", "ref.exr", "--size", "24x16", "--spp", "32",
              "-q")
    assert "ref.exr with its own error bars" in done.text


# The light itself is exact there: what varies is which surface a sample meets.
CORNER = """#VRML V2.0 utf8
Viewpoint { position 0 1.5 4 }
NavigationInfo { headlight FALSE }
DirectionalLight { direction .3 -1 -.5 }
DEF WHITE Shape { appearance Appearance { material Material { diffuseColor .8 .8 .8 } }
  geometry Box { size 8 .1 8 } }
Transform { translation 0 .6 0 rotation 0 1 0 .5 children Shape {
  appearance Appearance { material Material { diffuseColor .3 .3 .3 } } geometry Box { } } }
Transform { translation 0 2 -4 rotation 1 0 0 1.5707963 children USE WHITE }
"""


def test_an_audit_of_direct_light_holds(vv):
    vv.write("corner.wrl", CORNER)
    done = vv("corner.wrl", "--audit", "8", "--transport", "direct", "--colour", "vrml97", "--size", "48x48",
              "--spp", "64", "-q")
    assert done.returncode == 0, done.talk
    assert value(done.text, "bounds") > .99, done.text
    assert .92 < value(done.text, "coverage") < .98, done.text


ROOM = """#VRML V2.0 utf8
Viewpoint { position 0 1.5 6 orientation 1 0 0 -.15 }
NavigationInfo { headlight FALSE }
Shape { appearance Appearance { material Material { diffuseColor .8 .6 .6 } }
  geometry Box { size 8 .1 8 } }
Transform { translation 0 3 0 children Shape {
  appearance Appearance { material Material { diffuseColor 0 0 0 emissiveColor 1 1 1 } }
  geometry Box { size 3 .1 3 } } }
Transform { translation 0 2 0 children Shape { %s geometry Box { size 9 .02 9 } } }
"""
PANE = "appearance Appearance { material Material { diffuseColor 0 0 0 transparency .5 } }"
BLIND = 'appearance ORTAppearance { shader ORTShader { name "BlindVeil" file "faulty" } }'


def audit_of(vv, sheet, *arguments):
    vv.write("room.wrl", ROOM % sheet)
    done = vv("room.wrl", "--audit", "6", "--transport", "path", "--size", "24x16", "--spp", "64", "-q",
              *arguments)
    assert done.returncode in (0, 4), done.talk
    found = re.search(r"^all light +(\S+) \+- (\S+) .* more in (\d+) of (\d+) tiles", done.text,
                      re.MULTILINE)
    assert found, done.text
    return done, *(float(word) for word in found.groups())


def test_an_audit_finds_the_light_behind_a_pane(vv):
    done, more, interval, tiles, count = audit_of(vv, PANE)
    assert "light samples miss light" not in done.text, done.text
    assert abs(more) < 2.5 * interval < .3 and tiles == 0 and count == 2, done.text


def test_an_audit_reports_light_that_light_samples_miss(vv):
    """Paths pass the sheet, but light samples do not: the lamp behind it is missing in pictures and
    in their reference alike."""
    plugins = vv.program.parent.parent / "tests/plugins"
    if not (plugins / "faulty.so").exists():
        pytest.skip("the test plug-ins were not built")
    done, more, interval, tiles, count = audit_of(vv, BLIND, "--shader-path", plugins)
    assert done.returncode == 4 and "do not hold: light samples miss light" in done.text
    assert more > 5 * interval > 0 and tiles > 0, done.text


def test_an_audit_of_another_transport_has_no_pictures_without_light_samples(vv):
    done = vv("box.wrl", "--audit", "3", "--size", "8x8", "--transport", "whitted", "-q")
    assert "all light" not in done.text and "trusted" in done.text
