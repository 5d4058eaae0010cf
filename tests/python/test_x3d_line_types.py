"""The dashes of LineProperties in pictures (ISO/IEC 19775-1 12.4.3): where they are, in pixels."""
import itertools

import numpy as np
import pytest

xvrml = pytest.importorskip("xvrml")

HEAD = """#X3D V3.3 utf8
PROFILE Full
NavigationInfo { headlight FALSE }
"""
FLAT = HEAD + "OrthoViewpoint { fieldOfView [ -4, -1, 4, 1 ] position 0 0 10 }\n"
# Dashes and gaps in turn, in pixels.
TYPES = {2: (9, 7), 3: (2, 2), 4: (8, 3, 2, 3), 5: (6, 2, 2, 2, 2, 2), 9: (16, 16),
         10: (16, 4, 8, 4), 11: (18, 4, 6, 4), 12: (24, 8), 13: (12, 4, 4, 4, 4, 4)}


def lines(points, linetype, count=None, more=""):
    return f"""Shape {{ appearance Appearance {{ material Material {{ emissiveColor 1 1 1 {more} }}
      lineProperties DEF L LineProperties {{ linetype {linetype} linewidthScaleFactor 4 }} }}
      geometry LineSet {{ vertexCount [ {count or len(points)} ] coord Coordinate {{ point [
      {", ".join("%r %r %r" % tuple(p) for p in points)} ] }} }} }}"""


def row(text, size=(80, 20), line=10):
    """Returns the brightness of the pixels of a row."""
    world = text if isinstance(text, xvrml.World) else xvrml.loads(text, "a.x3dv")
    return np.asarray(world.render(size=size, spp=1, colour="vrml97"))[line, :, 0]


def pattern(lengths, count, begin=0):
    """Returns count pixels of a pattern."""
    cells = itertools.chain.from_iterable([1 - i % 2] * n for i, n in enumerate(lengths))
    repeated = itertools.cycle(list(cells))
    return list(itertools.islice(repeated, begin, begin + count))


@pytest.mark.parametrize("linetype", TYPES)
def test_dashes_have_their_lengths_in_pixels(linetype):
    found = row(FLAT + lines([(-4, 0, 0), (4, 0, 0)], linetype))
    assert list(found) == pattern(TYPES[linetype], 80)


@pytest.mark.parametrize("linetype", (1, 6, 7, 8, 14, 15, 16, 99))
def test_other_types_are_solid_and_told_of(linetype):
    world = xvrml.loads(FLAT + lines([(-4, 0, 0), (4, 0, 0)], linetype), "a.x3dv")
    assert list(row(world)) == [1] * 80
    assert any("linetype" in str(w) for w in world.warnings) == (linetype != 1)


def test_the_pattern_goes_on_along_a_polyline_and_begins_anew_with_the_next():
    points = [(-4, 0, 0), (-3.5, 0, 0), (-3.4, 0, 0), (0, 0, 0)]
    other = [(0, 0, 0), (4, 0, 0)]
    found = list(row(FLAT + lines(points + other, 2, "4 2")))
    assert found == pattern(TYPES[2], 40) + pattern(TYPES[2], 40)


def test_the_pattern_covers_what_is_behind_once():
    found = row(FLAT + lines([(-4, 0, 0), (4, 0, 0)], 2, more="transparency .5"))
    assert np.allclose(found, np.array(pattern(TYPES[2], 80)) / 2, atol=1e-5)


def runs(values):
    return [(key, len(list(group))) for key, group in itertools.groupby(values)]


def test_dashes_of_a_line_that_recedes_are_as_long_in_the_picture():
    text = HEAD + "Viewpoint { position 0 0 10 }\n" + lines([(-4, 0, 0), (60, 0, -40)], 2)
    middle = runs(row(text, (200, 150), 75))[1:-1]
    assert len(middle) > 8
    for value, length in middle[1:-1]:
        assert abs(length - (9 if value else 7)) <= 1, middle


def test_a_line_from_behind_the_viewer_has_dashes_in_front():
    text = HEAD + "Viewpoint { position 0 1 10 }\n" + lines([(0, 0, 30), (0, 0, -200)], 2)
    world = xvrml.loads(text, "a.x3dv")
    column = np.asarray(world.render(size=(100, 100), spp=1, colour="vrml97"))[52:, 50, 0]
    found = runs(column)[1:-1]
    assert len(found) >= 3
    for value, length in found:
        assert abs(length - (9 if value else 7)) <= 1, found


def test_events_change_the_type():
    world = xvrml.loads(FLAT + lines([(-4, 0, 0), (4, 0, 0)], 1), "a.x3dv")
    for linetype in (3, 1, 12):
        world["L"].linetype = linetype
        assert list(row(world)) == pattern(TYPES.get(linetype, (1, )), 80)


def test_threads_and_cameras_make_no_difference():
    text = HEAD + "Viewpoint { position 0 0 10 }\n" + lines([(-4, -3, 0), (9, 5, -9)], 5)
    world = xvrml.loads(text, "a.x3dv")
    one = np.asarray(world.render(size=(90, 60), spp=4, threads=1))
    world.render(size=(30, 60), spp=1)
    again = np.asarray(world.render(size=(90, 60), spp=4, threads=3))
    assert (one == again).all() and one.any()


@pytest.mark.parametrize("points", [((-3, 1, 3), (5, 1, -10)), ((-4, 1, 0), (4, 1.3, 0))])
@pytest.mark.parametrize("width, scale", [(3, 1), (1, 3)])
def test_a_transparent_line_in_perspective_covers_what_is_behind_it_once(points, width, scale):
    world = xvrml.loads(f"""{HEAD}
Viewpoint {{ position 0 0 10 }}
Shape {{ appearance Appearance {{ material Material {{ emissiveColor 1 1 1 transparency .5 }}
    lineProperties LineProperties {{ linewidthScaleFactor {width} }} }}
  geometry LineSet {{ vertexCount 2 coord Coordinate {{ point [
    {", ".join("%r %r %r" % p for p in points)} ] }} }} }}""", "a.x3dv")
    picture = np.asarray(world.render(size=(320 * scale, 240 * scale), spp=1, colour="vrml97"))
    red = picture[..., 0]
    assert (red > 0).sum() > 200
    assert set(np.unique(red.round(3)).tolist()) == {0, 0.5}
