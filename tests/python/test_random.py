"""Random use of the Python package: whatever is assigned and rendered, the result is a value or an
exception."""
import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")
hypothesis = pytest.importorskip("hypothesis")
from hypothesis import strategies as st  # noqa: E402

WORLD = b"""#VRML V2.0 utf8
DEF V Viewpoint { position 0 0 5 }
DEF T Transform { children [
  DEF S Shape { appearance DEF A Appearance { material DEF M Material { } texture DEF P PixelTexture { image 1 1 1 0x80 } } geometry DEF B Box { } }
  DEF S2 Shape { geometry DEF F IndexedFaceSet { coord DEF C Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } coordIndex [ 0 1 2 -1 ] } }
  DEF S3 Shape { geometry DEF E Extrusion { } }
  DEF S4 Shape { geometry DEF G ElevationGrid { xDimension 2 zDimension 2 height [ 0 1 0 1 ] } }
  DEF L PointLight { } ] }
"""
NAMES = ("V", "T", "S", "A", "M", "P", "B", "S2", "F", "C", "S3", "E", "S4", "G", "L")

numbers = st.one_of(st.integers(-(2**40), 2**40), st.floats(allow_nan=True, allow_infinity=True),
                    st.floats(-2, 2), st.integers(-3, 3))
arrays = st.builds(
    lambda rows, width, seed: np.random.default_rng(seed).normal(size=(rows, width)).astype(
        np.float32), st.integers(0, 20), st.integers(1, 5), st.integers(0, 1000))
indices = st.builds(lambda n, seed: np.random.default_rng(seed).integers(-2, 6, n),
                    st.integers(0, 30), st.integers(0, 1000))
values = st.one_of(st.none(), st.booleans(), numbers, st.text(max_size=8), st.binary(max_size=8),
                   arrays, indices, st.lists(numbers, max_size=9),
                   st.lists(st.text(max_size=4), max_size=4), st.tuples(numbers, numbers, numbers),
                   st.tuples(*[st.floats(0, 1)] * 3), st.tuples(*[st.floats(-1, 1)] * 4),
                   st.sampled_from(NAMES).map(lambda n: ("node", n)),
                   st.lists(st.sampled_from(NAMES), max_size=3).map(lambda n: ("nodes", n)))


def assign(world, name, pick, value):
    node = world[name]
    fields = sorted(node.fields) if isinstance(node.fields, dict) else []
    if not fields:
        return
    if isinstance(value, tuple) and len(value) == 2 and value[0] in ("node", "nodes"):
        value = world[value[1]] if value[0] == "node" else [world[n] for n in value[1]]
    field = fields[pick % len(fields)]
    try:
        setattr(node, field, value)
    except (TypeError, ValueError) as error:
        assert f".{field} (" in str(error), error
    else:
        getattr(node, field)
        setattr(node, field, getattr(node, field))


@hypothesis.settings(max_examples=300,
                     deadline=None,
                     derandomize=True,
                     database=None,
                     suppress_health_check=list(hypothesis.HealthCheck))
@hypothesis.given(
    st.lists(st.tuples(st.sampled_from(NAMES), st.integers(0, 40), values), max_size=12))
def test_random_assignments(steps):
    world = xvrml.load(WORLD)
    for name, pick, value in steps:
        assign(world, name, pick, value)
    picture = world.render(size=(8, 6), spp=1, channels=("z", "normal", "id"))
    assert picture.shape == (6, 8, 4) and np.isfinite(picture.array).all()
    xvrml.load(world.to_vrml().encode("utf-8", "surrogateescape"))
