"""Hatching of FillProperties in pictures (ISO/IEC 19775-1 12.4.2): where its lines are, in pixels."""
import numpy as np
import pytest

xvrml = pytest.importorskip("xvrml")

HEAD = """#X3D V4.0 utf8
PROFILE Full
NavigationInfo { headlight FALSE }
"""
# A picture of 64x64 pixels of a plane that faces the camera: pixel (x, y) is the place (x, -y).
FLAT = HEAD + "OrthoViewpoint { fieldOfView [ -32, -32, 32, 32 ] position 0 0 100 }\n"
PLANE = "IndexedFaceSet { solid FALSE coord Coordinate { point [ -99 -99 0, 99 -99 0, 99 99 0, -99 99 0 ] } " \
        "coordIndex [ 0 1 2 3 -1 ] }"


def plane(style, more="", material="Material { emissiveColor 0 0 0 }"):
    return f"""Shape {{ geometry {PLANE} appearance Appearance {{ material {material}
      fillProperties DEF F FillProperties {{ hatchStyle {style} {more} }} }} }}\n"""


def picture(text, size=(64, 64), **how):
    world = text if isinstance(text, xvrml.World) else xvrml.loads(text, "a.x3dv")
    return np.asarray(world.render(size=size, **{"spp": 1, "colour": "vrml97", **how}))[..., :3]


def lines(style):
    """Returns which of the 64x64 pixels are on lines, for the styles that only have stripes."""
    y, x = np.mgrid[0:64, 0:64]
    up = -1 - y  # the row below the place 0 is row -1
    return {1: up % 4 == 0, 2: x % 4 == 0, 5: (x % 4 == 0) | (up % 4 == 0)}[style]


@pytest.mark.parametrize("style", (1, 2, 5))
def test_stripes_are_whole_pixels(style):
    assert np.array_equal(picture(FLAT + plane(style))[..., 0] > .5, lines(style))


def test_slopes_have_their_names():
    rising, falling = (picture(FLAT + plane(style), spp=16)[..., 0] for style in (3, 4))
    # One pixel to the right and one up is on the same line.
    assert np.allclose(rising[1:, :-1], rising[:-1, 1:], atol=.3)
    assert np.allclose(falling[:-1, :-1], falling[1:, 1:], atol=.3)
    assert not np.allclose(rising[:-1, :-1], rising[1:, 1:], atol=.3)


def test_every_style_has_a_pattern_of_its_own_that_repeats_after_32_pixels():
    seen = {}
    for style in range(1, 20):
        found = picture(FLAT + plane(style), spp=16)[..., 0]
        assert .04 < found.mean() < .6, style
        repeated = picture(FLAT + plane(style), spp=256)[..., 0]
        assert np.abs(repeated[:32, :32] - repeated[32:, 32:]).max() < .25, style
        seen[found.tobytes()] = style
    assert len(seen) == 19


def test_lines_are_where_the_camera_sees_the_face_at_any_distance_and_slant():
    for more in ("", "Transform { translation 0 0 -40 rotation 0 1 0 .5 children [ {} ] }"):
        shape = plane(2)
        found = picture(HEAD + "Viewpoint { position 0 0 60 }\n" + (more.replace("{}", shape) or shape))
        assert np.array_equal(found[..., 0] > .5, lines(2))


def test_crops_and_threads_have_the_same_pattern():
    world = FLAT + plane(14)
    whole = picture(world, spp=4)
    assert np.array_equal(whole, picture(world, spp=4, threads=1))
    assert np.array_equal(whole, picture(world, spp=4, threads=3))
    assert np.array_equal(whole[20:40, 5:35], picture(world, spp=4, crop=(5, 20, 30, 20)))


def test_a_picture_does_not_depend_on_views_before_it():
    """A hatched face that glows is no lamp for light samples, whose shares another view would set."""
    text = HEAD + "DEF A Viewpoint { description \"A\" position 0 0 60 } DEF B Viewpoint " \
        "{ description \"B\" position 9 3 30 }\n" + plane(4, "hatchColor 1 1 0",
                                                       "Material { emissiveColor 0 0 .5 }") \
        + "Transform { translation 0 0 20 children Shape { appearance Appearance { material Material { } } " \
        "geometry Sphere { radius 6 } } }\n"
    one, other = xvrml.loads(text, "a.x3dv"), xvrml.loads(text, "a.x3dv")
    picture(other, viewpoint="B", transport="path")
    assert np.array_equal(picture(one, viewpoint="A", transport="path", spp=4),
                          picture(other, viewpoint="A", transport="path", spp=4))


def test_a_face_that_is_not_filled_is_seen_through_and_lets_light_pass():
    behind = "Transform { translation 0 0 -5 children Shape { appearance Appearance { material Material " \
             "{ emissiveColor 0 1 0 } } geometry " + PLANE + " } }\n"
    found = picture(FLAT + plane(2, "filled FALSE hatchColor 1 0 0") + behind)
    assert np.array_equal(found[..., 0] > .5, lines(2))
    assert np.array_equal(found[..., 1] > .5, ~lines(2))
    # A lamp before the lines lights the wall between them. The camera looks along the light.
    wall = "DirectionalLight { direction 0 0 -1 } Transform { translation 0 0 -5 children Shape { appearance " \
           "Appearance { material Material { diffuseColor 1 1 1 } } geometry " + PLANE + " } }\n"
    lit = picture(FLAT + plane(2, "filled FALSE hatchColor 1 0 0") + wall)
    assert np.array_equal(lit[..., 2] > .5, ~lines(2))


def test_a_mirror_shows_the_lines_that_lie_on_the_face():
    """The wall stands at the right and the mirror faces the camera: what the mirror shows of the wall
    is hatched, in the wall's places and not in those of the mirror."""
    mirror = "Shape { appearance ORTAppearance { shader ORTShader { name \"Mirror\" file \"mirror\" } } geometry IndexedFaceSet " \
             "{ solid FALSE coord Coordinate { point [ -20 -20 0, 20 -20 0, 20 20 0, -20 20 0 ] } " \
             "coordIndex [ 0 1 2 3 -1 ] } }\n"
    wall = "Transform { translation 0 0 100 children " + plane(2, "hatchColor 1 0 0") + " }\n"
    world = HEAD + "Viewpoint { position 0 0 50 }\n" + mirror + wall
    found = picture(world, spp=4)[16:48, 16:48, 0]
    assert .05 < found.mean() < .6
    # The wall behind the camera is seen upside down through it: columns of a width of their own.
    assert np.allclose(found, found[:1], atol=.6)


def test_the_colour_does_not_depend_on_light_and_lights_nothing_twice():
    dark, bright = (picture(FLAT + lamp + plane(5, "hatchColor 1 .5 0", "Material { diffuseColor 0 0 0 }"))
                    for lamp in ("", "DirectionalLight { direction 0 0 -1 }"))
    assert np.array_equal(dark, bright)
    direct, path = (picture(FLAT + plane(5, "filled FALSE hatchColor 1 .5 0"), transport=transport, spp=4)
                    for transport in ("direct", "path"))
    assert np.allclose(direct, path, atol=1e-6)
