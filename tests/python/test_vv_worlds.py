"""Tests third-party worlds on vv's command line: the clock since 1970, --epoch, --compat,
--old-world, and what --explain reports."""
import json

import pytest
from conftest import HEADER, SMALL

# A white box that a timer moves away from the middle.
TIMED = HEADER + """
Viewpoint { position 0 0 8 }
DEF Place Transform { children Shape { appearance Appearance { material Material { emissiveColor 1 1 1 } } geometry Box {} } }
DEF Clock TimeSensor { cycleInterval 4 %s }
DEF Way PositionInterpolator { key [ 0 1 ] keyValue [ 2 0 0, 2 0 0 ] }
ROUTE Clock.fraction_changed TO Way.set_fraction
ROUTE Way.value_changed TO Place.translation
"""
# Prints the time of each event.
TELLS = HEADER + """
DEF Clock TimeSensor { loop TRUE }
DEF Tell Script { eventIn SFTime tick url "vrmlscript: function tick(t) { print('at ' + t); }" }
ROUTE Clock.time TO Tell.tick
"""
# A Script without directOutput, and a colour texture on a green material.
OLD = HEADER + """
Viewpoint { position 0 0 8 }
DEF Place Transform { children Shape {
  appearance Appearance { texture PixelTexture { image 1 1 3 0xFF80FF } material Material { diffuseColor 0 1 0 } }
  geometry Box {} } }
DEF Move Script { field SFNode place USE Place
  url "vrmlscript: function initialize() { place.translation = new SFVec3f(2, 0, 0); }" }
"""


def middle(rows):
    return rows[len(rows) // 2][len(rows[0]) // 2]


@pytest.mark.parametrize("fields, moves", [("loop TRUE startTime 0 stopTime 1", False),
                                           ("loop TRUE startTime 1 stopTime 0", True),
                                           ("loop TRUE", True), ("startTime 1", False),
                                           ("", False)])
def test_times_are_seconds_since_1970(vv, fields, moves):
    vv.write("timed.wrl", TIMED % fields)
    for time in ("0", "0.5", "1.5"):
        assert (middle(vv.picture("--time", time, world="timed.wrl"))[0] == 0) == moves, time


def test_the_epoch_can_be_chosen(vv):
    vv.write("timed.wrl", TIMED % "loop TRUE startTime 2000000000")
    assert middle(vv.picture(world="timed.wrl"))[0] > 0
    assert middle(vv.picture("--epoch", "1999999999", world="timed.wrl"))[0] > 0
    assert middle(vv.picture("--epoch", "1999999999", "--time", "1", world="timed.wrl"))[0] == 0
    assert middle(vv.picture("--epoch", "now", world="timed.wrl")) is not None
    assert vv("timed.wrl", "--epoch", "soon", "-o", "a.ppm").returncode == 2


@pytest.mark.parametrize("options, times", [((), [0]),
                                            (("--time", "0.1"), [0, 1 / 30, 2 / 30, 0.1]),
                                            (("--frames", "0-2"), [0, 1 / 30, 2 / 30])])
def test_a_script_is_told_each_time_once(vv, options, times):
    vv.write("tells.wrl", TELLS)
    output = "a-{frame}.ppm" if "--frames" in options else "a.ppm"
    done = vv("tells.wrl", "-v", *options, "-o", output, *SMALL)
    told = [float(line.split("at ")[-1]) for line in done.talk.splitlines() if " at 17" in line]
    assert told == pytest.approx([1729728000 + t for t in times], abs=1e-6), done.talk


def test_old_habits_are_off_and_explained(vv):
    vv.write("old.wrl", OLD)
    assert middle(vv.picture(world="old.wrl"))[0] > 0  # not moved
    talk = vv("old.wrl", "--explain").text
    assert "compat scripts off: 1 Script holds nodes without directOutput TRUE" in talk and "compat textures off: 1 appearance" in talk
    assert "--compat scripts" in talk and "--compat textures" in talk
    on = vv("old.wrl", "--explain", "--compat", "scripts,textures").text
    assert "compat scripts on" in on and "compat textures on" in on
    compat = json.loads(vv("old.wrl", "--explain", "--json", "--compat", "scripts").text)["compat"]
    assert compat == {
        "scripts": {
            "on": True,
            "affected": 1
        },
        "textures": {
            "on": False,
            "affected": 1
        }
    }
    vv.write("plain.wrl", TIMED % "")
    assert "compat" not in vv("plain.wrl", "--explain").text


def test_old_habits_can_be_had(vv):
    vv.write("old.wrl", OLD)
    assert middle(vv.picture("--compat", "scripts", world="old.wrl")) == (0, 0, 0)
    red, green, blue = middle(vv.picture("--compat", "textures", world="old.wrl"))
    assert red == blue == 0 and green > 50
    assert vv.picture("--old-world", world="old.wrl") == \
        vv.picture("--compat", "scripts,textures", "--colour", "vrml97", "--shadows", "off", world="old.wrl")
    done = vv("old.wrl", "--compat", "all", "-o", "a.ppm")
    assert done.returncode == 2 and "scripts or textures" in done.talk


def test_refused_events_name_the_switch(vv):
    vv.write("old.wrl", OLD)
    assert "--compat scripts allows it" in vv("old.wrl", "-o", "a.ppm", *SMALL).talk
