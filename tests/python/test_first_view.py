"""Tests that the first view of a model without a viewpoint shows something: where it would see nothing but backs,
which are not drawn, it looks from the other side."""
import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

HEAD = "#VRML V2.0 utf8\n"
LOOK = "appearance Appearance { material Material { emissiveColor 1 1 1 } } "
SQUARE = LOOK + "geometry IndexedFaceSet { %s coordIndex [ 0 1 2 3 ] coord Coordinate { point [ %s ] } }"
XY = "-1 -1 %g, 1 -1 %g, 1 1 %g, -1 1 %g" % (0, 0, 0, 0)
YX = "-1 1 0, 1 1 0, 1 -1 0, -1 -1 0"       # faces -z
DOWN = "-1 0 -1, 1 0 -1, 1 0 1, -1 0 1"     # faces -y
UP = "-1 0 1, 1 0 1, 1 0 -1, -1 0 -1"


def shape(points, fields=""):
    return "Shape { " + SQUARE % (fields, points) + " }\n"


def seen(text):
    """Returns how many pixels of the first view show the shape, whose light is 1."""
    image = np.asarray(xvrml.loads(HEAD + text).render(size=(40, 40), spp=1))
    return int((image[..., 0] > .95).sum())


WALLS = shape("-1 -1 1, -1 1 1, 1 1 1, 1 -1 1") + shape("1 -1 1, 1 1 1, 1 1 -1, 1 -1 -1")  # face away from front and right


@pytest.mark.parametrize("text", [
    shape(XY), shape(YX), shape(DOWN), shape(UP), shape(YX, "solid FALSE"), shape(XY, "ccw FALSE"),
    "Transform { scale -1 1 1 children " + shape(XY) + " }", "Transform { rotation 0 1 0 3.14159 children " + shape(XY) + " }",
    shape(DOWN) + shape(YX.replace(" 0,", " 3,")), WALLS
])
def test_something_is_seen(text):
    assert seen(text) > 100


def test_a_closed_body_is_seen_from_the_same_side():
    body = shape(XY).split("geometry")[0] + "geometry IndexedFaceSet { %s coordIndex [ 0 2 1 -1 0 1 3 -1 1 2 3 -1 2 0 3 ] " \
        "coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0, 0 0 1 ] } } }"
    one, two = (np.asarray(xvrml.loads(HEAD + body % sides).render(size=(40, 40), spp=4)) for sides in ("", "solid FALSE"))
    np.testing.assert_array_equal(one, two)
