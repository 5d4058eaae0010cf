"""Lines that pass the plane of the eye look like the part of them that is before it. All points are
exact in single precision, so that the compared lines are parts of each other."""
import numpy as np
import pytest

xvrml = pytest.importorskip("xvrml")

BESIDE = np.array([-.25, -.25, 10])  # where the lines pass the eye
AHEAD = np.array([1 / 64, 1 / 128, -1])
CLIP = BESIDE + AHEAD / 16  # outside of the picture


def draw(points, colors):

    def rows(values):
        return ", ".join(" ".join(f"{float(x):.9g}" for x in row) for row in values)

    assert np.array_equal(np.float32(points), points)
    world = xvrml.loads(f"""#VRML V2.0 utf8
NavigationInfo {{ headlight FALSE }}
Background {{ skyColor 0 0 0 }}
Viewpoint {{ position 0 0 10 }}
Shape {{ geometry IndexedLineSet {{ coordIndex [ 0 1 ]
  coord Coordinate {{ point [ {rows(points)} ] }} color Color {{ color [ {rows(colors)} ] }} }} }}"""
                       )
    return np.asarray(world.render(size=(160, 120), spp=16).array)[..., :3]


# The part behind the eye neither covers the picture nor makes noise.
@pytest.mark.parametrize("reach", (2**4, 2**7, 2**10, 2**20, 2**24))
def test_the_part_behind_the_eye_is_not_seen(reach):
    white = np.ones((2, 3))
    for front in (2**4, 2**10, 2**20, 2**24):
        ends = [BESIDE + front * AHEAD, BESIDE - reach * AHEAD]
        expected = draw([ends[0], CLIP], white)
        assert 100 < np.count_nonzero(expected[..., 0]) < 400
        for line in (ends, ends[::-1]):
            assert np.abs(draw(line, white) - expected).sum() < .02 * expected.sum()


# A line that is drawn in parts has the colours of the whole.
def test_colors_change_along_the_whole_line():
    front, back = BESIDE + 16 * AHEAD, BESIDE - 48 * AHEAD
    ends = [front, back]
    short = draw([BESIDE + 16 * AHEAD, CLIP], [(0, 0, 0), (1, 0, 0)])[..., 0]
    long = draw(ends, [(0, 0, 0), (1, 0, 0)])[..., 0]
    share = (16 - 1 / 16) / 64
    lit = short > 1e-3
    assert np.count_nonzero(lit) > 100
    assert np.median(long[lit] / short[lit]) == pytest.approx(share, rel=.02)
    turned = draw(ends[::-1], [(1, 0, 0), (0, 0, 0)])[..., 0]
    assert np.abs(turned - long).sum() < .02 * long.sum()
