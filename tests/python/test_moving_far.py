"""Near things stay in the picture when something far away moves with them."""
import pytest

WORLD = """#VRML V2.0 utf8
DEF T TimeSensor {{ cycleInterval 10 loop TRUE startTime 0 }}
DEF P PositionInterpolator {{ key [ 0 1 ] keyValue [ 0 0 0, 0 .5 0 ] }}
DEF M Transform {{ children [
  Shape {{ appearance DEF A Appearance {{ material Material {{ diffuseColor .8 .4 .2 }} }}
          geometry Box {{ }} }}
  Transform {{ translation 1.5 1 0 children Shape {{ appearance USE A geometry Sphere {{ radius .4 }} }} }}
  {far}
] }}
ROUTE T.fraction_changed TO P.set_fraction
ROUTE P.value_changed TO M.set_translation
"""


@pytest.mark.parametrize("away", ["6e7", "1e8", "1e12"])
def test_what_is_far_away_changes_nothing(vv, away):
    shape = "Shape { appearance USE A geometry Box { } }"
    worlds = {
        "near": "",
        "far": f"Transform {{ translation {away} 0 0 children {shape} }}",
        "huge": f"Transform {{ translation 0 0 {away} scale {away} {away} 1 children {shape} }}"
    }
    pictures = {}
    for name, far in worlds.items():
        (vv.folder / f"{name}.wrl").write_text(WORLD.format(far=far))
        done = vv(f"{name}.wrl", "--time", "2", "-o", f"{name}.png", "--size", "80x60", "--spp",
                  "1", "--transport", "direct")
        assert done.returncode == 0, done.talk
        pictures[name] = (vv.folder / f"{name}.png").read_bytes()
    assert pictures["far"] == pictures["near"]
    assert pictures["huge"] == pictures["near"]
