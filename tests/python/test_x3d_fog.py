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
BLUE = "LocalFog { color 0 0 1 visibilityRange 20 }"
CLEAR = np.array((1, 0, 0))
LEFT, MIDDLE, RIGHT = -1.95, .05, 2.05  # x of the pixels that are looked at


def at(x, content):
    return f"Transform {{ translation {x} 0 0 children [ {content} ] }}\n"


def colors(text):
    """Returns the colours of squares at x = -2, 0, 2."""
    world = text if isinstance(text, xvrml.World) else xvrml.loads(HEAD + text, "a.x3dv")
    image = np.asarray(world.render(size=(60, 20), spp=1, colour="vrml97"))
    return [image[10, x, :3] for x in (10, 30, 50)]


def distance(x):
    """From the viewer to the middle of a pixel, on the plane z = 0."""
    return math.hypot(x, .05, 10)


def hidden(x, fog=(0, 0, 1), visible=20):
    """Returns the colour of a red square in linear fog."""
    share = distance(x) / visible
    return CLEAR * (1 - share) + np.array(fog) * share


def near(found, wanted):
    assert np.allclose(found, wanted, atol=1e-4), (found, wanted)


def test_it_hides_its_siblings_and_what_is_below_them():
    left, middle, right = colors(
        at(-2, BLUE + RED) + at(0, RED) + f"Group {{ children [ {at(2, RED)} {BLUE} ] }}")
    near(left, hidden(LEFT))
    near(middle, CLEAR)
    near(right, hidden(RIGHT))


def test_the_nearest_replaces_all_others():
    """A LocalFog around the group, another one in it, and the Fog that the viewer is bound to."""
    inner = at(0, "LocalFog { color 0 1 0 visibilityRange 40 }" + RED)
    left, middle, right = colors("Fog { color 1 1 1 visibilityRange 20 }\n"
                                 f"Group {{ children [ {BLUE} {at(-2, RED)} {inner} ] }}\n" +
                                 at(2, RED))
    near(left, hidden(LEFT))
    near(middle, hidden(MIDDLE, (0, 1, 0), 40))
    near(right, hidden(RIGHT, (1, 1, 1)))


def test_one_that_is_not_enabled_counts_for_nothing_and_clear_air_counts():
    left, middle, _ = colors("Group { children [ " + BLUE + at(
        -2, "LocalFog { color 0 1 0 enabled FALSE visibilityRange 1 }" + RED) +
                             at(0, "LocalFog { color 0 1 0 visibilityRange 0 }" + RED) + " ] }")
    near(left, hidden(LEFT))
    near(middle, CLEAR)


def test_at_the_top_level_it_takes_the_place_of_the_fog():
    left, _, sky = colors("Background { skyColor 0 1 0 }\nFog { color 1 1 1 visibilityRange 11 }\n" +
                          BLUE + at(-2, RED) + at(0, RED))
    near(left, hidden(LEFT))
    near(sky, (0, 1, 0))


def test_distances_are_those_of_its_own_coordinates():
    text = (f"Transform {{ scale 2 2 2 children [ {BLUE} " +
            f"Transform {{ scale .5 .5 .5 children [ {at(-2, RED)} ] }} ] }}")
    near(colors(text)[0], hidden(LEFT, visible=40))


def test_the_exponential_type_and_a_wrong_one():
    fog = BLUE.replace("LocalFog {", 'LocalFog { fogType "EXPONENTIAL"')
    clear = math.exp(-distance(LEFT) / (20 - distance(LEFT)))
    near(colors(at(-2, fog + RED))[0], (clear, 0, 1 - clear))
    world = xvrml.loads(HEAD + at(-2, fog.replace("EXP", "SEXP") + RED), "a.x3dv")
    near(colors(world)[0], hidden(LEFT))
    assert any("neither LINEAR nor EXPONENTIAL" in str(w) for w in world.warnings)


@pytest.mark.parametrize("between", ("", at(2, "LocalFog { visibilityRange 5 }" + RED)))
def test_the_last_one_of_a_group_that_is_enabled_counts(between):
    text = HEAD + at(
        -2, "LocalFog { color 0 1 0 visibilityRange 20 }" + between + BLUE.replace(
            "LocalFog", "DEF F LocalFog") +
        "LocalFog { color 1 1 1 enabled FALSE visibilityRange 20 }" + RED)
    world = xvrml.loads(text, "a.x3dv")
    near(colors(world)[0], hidden(LEFT))
    world["F"].enabled = False
    near(colors(world)[0], hidden(LEFT, (0, 1, 0)))
    world["F"].enabled = True
    near(colors(world)[0], hidden(LEFT))


def test_a_group_that_is_used_twice_has_fog_at_one_place_alone():
    text = ("Group { children [ " + BLUE + at(-2, "DEF G Group { children [ " + RED + " ] }") +
            " ] }\n" + at(2, "USE G"))
    left, _, right = colors(text)
    near(left, hidden(LEFT))
    near(right, CLEAR)


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
    near(colors(world)[1], hidden(MIDDLE))
    world["T"].children = [world["T"].children[1]]
    near(colors(world)[1], CLEAR)


def test_mirrors_show_it_over_the_whole_way():
    """A mirror at 45 degrees: the square is 10 + 2 away along the ray."""
    mirror = """Transform { rotation 0 1 0 .785398 children Shape { appearance Appearance {
      material PhysicalMaterial { baseColor 1 1 1 metallic 1 roughness 0 } }
      geometry Rectangle2D { size 1 1 } } }"""
    square = f"Transform {{ translation 2 0 0 rotation 0 1 0 -1.570796 children [ {BLUE} {RED} ] }}"
    world = xvrml.loads(HEAD.replace("V3.3", "V4.0") + mirror + square, "a.x3dv")
    near(colors(world)[1], (1 - 12 / 20, 0, 12 / 20))


# FogCoordinate (24.4.3): x of vertices, and the geometry of a red strip from x = -3 to 3.
STRIP = "coord Coordinate { point [ -3 -1 0, 3 -1 0, 3 1 0, -3 1 0 ] }"
GEOMETRIES = {
    "QuadSet": f"QuadSet {{ {STRIP} %s }}",
    "IndexedFaceSet": f"IndexedFaceSet {{ coordIndex [ 0 1 2 3 -1 ] {STRIP} %s }}",
    "IndexedTriangleSet": f"IndexedTriangleSet {{ index [ 0 1 2 0 2 3 ] {STRIP} %s }}",
    "TriangleFanSet": f"TriangleFanSet {{ fanCount 4 {STRIP} %s }}",
    "ElevationGrid": "ElevationGrid { xDimension 2 zDimension 2 xSpacing 6 zSpacing 2 "
                     "height [ 0 0 0 0 ] solid FALSE %s }",
    "LineSet": "LineSet { vertexCount 2 coord Coordinate { point [ -3 .05 0, 3 .05 0 ] } %s }",
}


def strip(name, depth):
    """Returns a group with a strip, whose fog coordinate is 0 at the left and 1 at the right."""
    shape = f"""Shape {{ appearance Appearance {{ material Material {{ emissiveColor 1 0 0 }}
      lineProperties LineProperties {{ linewidthScaleFactor 9 }} }}
      geometry {GEOMETRIES[name] % ('fogCoord DEF D FogCoordinate { depth [ ' + depth + ' ] }')} }}"""
    if name == "ElevationGrid":
        shape = f"Transform {{ rotation 1 0 0 1.5707963 translation -3 1 0 children [ {shape} ] }}"
    return f"Group {{ children [ {BLUE} {shape} ] }}"


DEPTHS = {"ElevationGrid": "0 1 0 1", "LineSet": "0 1"}


@pytest.mark.parametrize("name", GEOMETRIES)
def test_a_fog_coordinate_is_the_share_of_the_fog(name):
    shares = [(x + 3) / 6 for x in (LEFT, MIDDLE, RIGHT)]
    for found, share in zip(colors(strip(name, DEPTHS.get(name, "0 1 1 0"))), shares):
        near(found, CLEAR * (1 - share) + np.array((0, 0, share)))


def test_without_fog_it_has_no_effect_and_without_depths_the_distance_counts():
    for found in colors(strip("QuadSet", "0 1 1 0").replace(BLUE, "")):
        near(found, CLEAR)
    for found, x in zip(colors(strip("QuadSet", "")), (LEFT, MIDDLE, RIGHT)):
        near(found, hidden(x))


def test_the_last_depth_holds_for_all_further_points():
    world = xvrml.loads(HEAD + strip("QuadSet", ".25"), "a.x3dv")
    for found in colors(world):
        near(found, (.75, 0, .25))
    assert not world.warnings


def test_depths_change_as_if_they_had_stood_so_in_the_file():
    world = xvrml.loads(HEAD + strip("QuadSet", "0 0 0 0"), "a.x3dv")
    near(colors(world)[1], CLEAR)
    world["D"].depth = [1, 1, 1, 1]
    near(colors(world)[1], (0, 0, 1))


def test_faces_that_are_cut_or_cross_themselves_keep_their_fog():
    cut = strip("QuadSet", "0 1 1 0").replace(
        "children [", "children [ ClipPlane { plane 1 0 0 1 }", 1)
    left, middle, _ = colors(cut)
    near(left, (0, 0, 0))
    share = (MIDDLE + 3) / 6
    near(middle, CLEAR * (1 - share) + np.array((0, 0, share)))
    bow = strip("IndexedFaceSet", "1 1 1 1").replace("[ 0 1 2 3 -1 ]", "[ 0 2 1 3 -1 ]").replace(
        "IndexedFaceSet {", "IndexedFaceSet { convex FALSE solid FALSE")
    near(colors(bow)[2], (0, 0, 1))
