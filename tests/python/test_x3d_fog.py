"""LocalFog of X3D in pictures: which shapes it hides, beside Fog, against closed forms."""
import math

import numpy as np
import pytest

xvrml = pytest.importorskip("xvrml")

HEAD = """#X3D V3.3 utf8
PROFILE Full
NavigationInfo { headlight FALSE }
OrthoViewpoint { fieldOfView [ -3, -1, 3, 1 ] position 0 0 10 }
"""
RED = """Shape { appearance Appearance { material Material { emissiveColor 1 0 0 } }
  geometry Rectangle2D { size 1 1 } }"""
FAR = 10  # from the eye to the squares


def at(x, content):
    return f"Transform {{ translation {x} 0 0 children [ {content} ] }}\n"


def colors(text, **options):
    """Returns the colours of the squares at x = -2, 0, 2."""
    world = text if isinstance(text, xvrml.World) else xvrml.loads(HEAD + text, "a.x3dv")
    image = np.asarray(
        world.render(size=(60, 20), spp=1, colour="vrml97", **options))
    return [image[10, x, :3] for x in (10, 30, 50)]


def seen(fog, share):
    """The colour of a red square of which fog hides a share."""
    return np.array([1, 0, 0]) * (1 - share) + np.array(fog) * share


BLUE = "LocalFog { color 0 0 1 visibilityRange 20 }"


def test_it_hides_its_siblings_and_what_is_below_them():
    text = at(-2, BLUE + RED) + at(0, RED) + f"Group {{ children [ {at(2, RED)} {BLUE} ] }}"
    left, middle, right = colors(text)
    for color in (left, right):
        assert np.allclose(color, seen((0, 0, 1), .5), atol=1e-4)
    assert np.allclose(middle, (1, 0, 0), atol=1e-4)


def test_the_nearest_replaces_all_others():
    """A LocalFog around the group, another one in it, and the Fog that the viewer is bound to."""
    inner = at(0, "LocalFog { color 0 1 0 visibilityRange 40 }" + RED)
    text = ("Fog { color 1 1 1 visibilityRange 20 }\n" +
            f"Group {{ children [ {BLUE} {at(-2, RED)} {inner} ] }}\n" + at(2, RED))
    for color, wanted in zip(colors(text), (((0, 0, 1), .5), ((0, 1, 0), .25), ((1, 1, 1), .5))):
        assert np.allclose(color, seen(*wanted), atol=1e-4)


def test_one_that_is_not_enabled_counts_for_nothing_and_clear_air_counts():
    around = "Group {{ children [ {} {} {} ] }}".format(
        BLUE, at(-2, "LocalFog { color 0 1 0 enabled FALSE visibilityRange 1 }" + RED),
        at(0, "LocalFog { color 0 1 0 visibilityRange 0 }" + RED))
    left, middle, _ = colors(around)
    assert np.allclose(left, seen((0, 0, 1), .5), atol=1e-4)
    assert np.allclose(middle, (1, 0, 0), atol=1e-4)


def test_at_the_top_level_it_takes_the_place_of_the_fog():
    text = "Background { skyColor 0 1 0 }\nFog { color 1 1 1 visibilityRange 11 }\n" + BLUE
    image = colors(text + at(-2, RED) + at(0, RED))
    assert np.allclose(image[0], seen((0, 0, 1), .5), atol=1e-4)
    assert np.allclose(image[2], (0, 1, 0), atol=1e-4), "the sky stays as it is"


def test_distances_are_those_of_its_own_coordinates():
    text = (f"Transform {{ scale 2 2 2 children [ {BLUE} " +
            f"Transform {{ scale .5 .5 .5 children [ {at(-2, RED)} ] }} ] }}")
    assert np.allclose(colors(text)[0], seen((0, 0, 1), .25), atol=1e-4)


def test_the_exponential_type_and_a_wrong_one():
    fog = BLUE.replace("LocalFog {", 'LocalFog { fogType "EXPONENTIAL"')
    share = 1 - math.exp(-FAR / (20 - FAR))
    assert np.allclose(colors(at(-2, fog + RED))[0], seen((0, 0, 1), share), atol=1e-4)
    world = xvrml.loads(HEAD + at(-2, fog.replace("EXP", "SEXP") + RED), "a.x3dv")
    assert np.allclose(colors(world)[0], seen((0, 0, 1), .5), atol=1e-4)
    assert any("neither LINEAR nor EXPONENTIAL" in str(w) for w in world.warnings)


def test_of_several_in_one_group_the_last_one_that_is_enabled_counts():
    fogs = ("LocalFog { color 0 1 0 visibilityRange 20 }" + BLUE +
            "LocalFog { color 1 1 1 enabled FALSE visibilityRange 20 }")
    assert np.allclose(colors(at(-2, fogs + RED))[0], seen((0, 0, 1), .5), atol=1e-4)


def test_a_group_that_is_used_twice_has_fog_at_one_place_alone():
    text = ("Group { children [ " + BLUE + at(-2, "DEF G Group { children [ " + RED + " ] }") +
            " ] }\n" + at(2, "USE G"))
    left, _, right = colors(text)
    assert np.allclose(left, seen((0, 0, 1), .5), atol=1e-4)
    assert np.allclose(right, (1, 0, 0), atol=1e-4)


@pytest.mark.parametrize("field,value", (("enabled", False), ("color", (0, 1, 0)),
                                         ("visibilityRange", 40), ("fogType", "EXPONENTIAL")))
def test_events_change_it_as_if_it_had_stood_so_in_the_file(field, value):
    text = HEAD + at(-2, BLUE.replace("LocalFog", "DEF F LocalFog") + RED) + at(0, RED)
    world = xvrml.loads(text, "a.x3dv")
    before = colors(world)
    setattr(world["F"], field, value)
    after = colors(world)
    assert not np.allclose(before[0], after[0]) and (before[1] == after[1]).all()
    fresh = xvrml.loads(text, "a.x3dv")
    setattr(fresh["F"], field, value)
    assert (np.array(colors(fresh)) == np.array(after)).all()
    setattr(world["F"], field, getattr(xvrml.loads(text, "a.x3dv")["F"], field))
    assert (np.array(colors(world)) == np.array(before)).all()


def test_it_moves_with_its_group_and_goes_with_it():
    text = f"DEF T Transform {{ translation -2 0 0 children [ {BLUE} {RED} ] }}\n" + at(2, RED)
    world = xvrml.loads(HEAD + text, "a.x3dv")
    colors(world)
    world["T"].translation = (0, 0, 0)
    assert np.allclose(colors(world)[1], seen((0, 0, 1), .5), atol=1e-4)
    world["T"].children = [world["T"].children[1]]
    assert np.allclose(colors(world)[1], (1, 0, 0), atol=1e-4)


def test_mirrors_show_it_over_the_whole_way():
    """A mirror at 45 degrees: the square is 10 + 2 away along the ray."""
    mirror = """Transform { rotation 0 1 0 .785398 children Shape { appearance Appearance {
      material PhysicalMaterial { baseColor 1 1 1 metallic 1 roughness 0 } }
      geometry Rectangle2D { size 1 1 } } }"""
    square = f"Transform {{ translation 2 0 0 rotation 0 1 0 -1.570796 children [ {BLUE} {RED} ] }}"
    text = HEAD.replace("V3.3", "V4.0") + mirror + square
    image = colors(xvrml.loads(text, "a.x3dv"))
    assert np.allclose(image[1], seen((0, 0, 1), 12 / 20), atol=2e-2)
