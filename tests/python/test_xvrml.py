"""Tests the Python package: worlds, nodes through the field tables, pictures."""
import ast
import collections.abc
import io
import os
import pathlib
import re
import signal

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

HEADER = "#VRML V2.0 utf8\n"
EVERYTHING = HEADER + """
PROTO Everything [
  exposedField SFBool aBool TRUE
  exposedField SFColor aColor 0.25 0.5 0.75
  exposedField SFFloat aFloat 1.5
  exposedField SFImage anImage 2 2 3 0xFF0000 0x00FF00 0x0000FF 0xFFFFFF
  exposedField SFInt32 anInt -7
  exposedField SFNode aNode NULL
  exposedField SFRotation aRotation 0 1 0 0.5
  exposedField SFString aString "text"
  exposedField SFTime aTime 12.25
  exposedField SFVec2f aVec2f 1 2
  exposedField SFVec3f aVec3f 1 2 3
  exposedField MFColor colors [ 1 0 0, 0 1 0 ]
  exposedField MFFloat floats [ 1, 2.5 ]
  exposedField MFInt32 ints [ 1, -2, 3 ]
  exposedField MFNode nodes [ ]
  exposedField MFRotation rotations [ 1 0 0 0.5 ]
  exposedField MFString strings [ "a", "b" ]
  exposedField MFTime times [ 1, 2 ]
  exposedField MFVec2f points2 [ 1 2, 3 4 ]
  exposedField MFVec3f points3 [ 1 2 3, 4 5 6 ]
  eventIn SFBool anEvent
] { Group { } }
DEF All Everything { }
DEF Other Group { }
"""


def world(text=EVERYTHING):
    return xvrml.load((text if text.startswith("#") else HEADER + text).encode())


# Loading ----------------------------------------------------------------------------------------


def test_sources(box):
    data = box.read_bytes()
    for source in (box, str(box), os.fsencode(box).decode(), data, bytearray(data),
                   memoryview(data), io.BytesIO(data), io.StringIO(data.decode()), open(box, "rb"),
                   open(box)):
        w = xvrml.load(source)
        assert w.names == ("Back", "Cube", "Paint", "Place", "Thing")
        if hasattr(source, "close"):
            source.close()
    assert xvrml.load(box).path == str(box)


def test_sources_that_are_none(tmp_path):
    with pytest.raises(FileNotFoundError):
        xvrml.load(tmp_path / "missing.wrl")
    for source in (None, 5, ["a"]):
        with pytest.raises(TypeError):
            xvrml.load(source)


def test_parse_error(tmp_path):
    path = tmp_path / "old.wrl"
    path.write_text("#VRML V3.0 utf8\nGroup { }\n")
    with pytest.raises(xvrml.ParseError, match="not VRML97") as caught:
        xvrml.load(path)
    assert caught.value.file == str(path) and caught.value.line == 1 and caught.value.column >= 1
    assert isinstance(caught.value, ValueError)
    with pytest.raises(xvrml.ParseError):
        xvrml.load(b"")


def test_warnings():
    w = world("Shape {\n  geometry Box { sise 1 2 3 }\n}\n")
    (problem,) = w.warnings
    assert (problem.severity, problem.line, problem.column) == ("error", 3, 18)
    assert "sise" in problem.message and ":3:18: error: " in str(problem)


def test_limits():
    deep = "Group { children " * 50 + "Shape { }" + " }" * 50
    assert not world(deep).warnings
    limited = None
    try:
        limited = xvrml.load((HEADER + deep).encode(), limits={"nesting": 10}).warnings
    except xvrml.ParseError as error:
        limited = [error]
    assert "nesting" in str(limited[0])
    with pytest.raises(ValueError, match="did you mean nesting"):
        xvrml.load(HEADER.encode(), limits={"nestin": 10})
    with pytest.raises(ValueError, match="whole number"):
        xvrml.load(HEADER.encode(), limits={"nesting": -1})


def test_names():
    w = world()
    assert set(w) == {"All", "Other"
                     } and len(w) == 2 and "All" in w and "Any" not in w and 5 not in w
    with pytest.raises(KeyError, match="did you mean Other"):
        w["Othr"]
    with pytest.raises(TypeError, match="DEF name"):
        w[0]
    assert w["All"] == w["All"] and w["All"] != w["Other"] and hash(w["All"]) == hash(w["All"])
    assert [n.node_type for n in w.roots] == ["Everything", "Group"]


# Fields -----------------------------------------------------------------------------------------


def test_get_every_type():
    n = world()["All"]
    assert n.aBool is True
    assert n.aColor == (0.25, 0.5, 0.75)
    assert n.aFloat == 1.5
    assert n.anImage.tolist() == [[[0, 0, 255], [255, 255, 255]],
                                  [[255, 0, 0], [0, 255, 0]]], "first row at the top"
    assert n.anInt == -7
    assert n.aNode is None
    assert n.aRotation == (0, 1, 0, 0.5)
    assert n.aString == "text"
    assert n.aTime == 12.25
    assert n.aVec2f == (1, 2)
    assert n.aVec3f == (1, 2, 3)
    assert n.colors.tolist() == [[1, 0, 0], [0, 1, 0]] and n.colors.dtype == np.float32
    assert n.floats.tolist() == [1, 2.5]
    assert n.ints.tolist() == [1, -2, 3] and n.ints.dtype == np.int32
    assert n.nodes == ()
    assert n.rotations.tolist() == [[1, 0, 0, 0.5]]
    assert n.strings == ("a", "b")
    assert n.times.tolist() == [1, 2] and n.times.dtype == np.float64
    assert n.points2.tolist() == [[1, 2], [3, 4]]
    assert n.points3.tolist() == [[1, 2, 3], [4, 5, 6]]


VALUES = {
    "aBool": [False, np.bool_(False)],
    "aColor": [(1, 0, 0.5), [0, 1, 0], np.array([0.5, 0.5, 0.5])],
    "aFloat": [2, 2.5, np.float32(3), np.int64(4)],
    "anImage": [np.zeros((2, 3, 4), np.uint8), [[1, 2], [3, 4]],
                np.arange(6).reshape(3, 2, 1)],
    "anInt": [5, -(2**31), 2**31 - 1, np.int8(3)],
    "aRotation": [(1, 0, 0, 3.0)],
    "aString": ["", "ä€𝄞", 'quote " and \\'],
    "aTime": [0, 1e9 + 0.125],
    "aVec2f": [(3, 4)],
    "aVec3f": [(3, 4, 5), np.arange(3)],
    "colors": [[(1, 1, 1)], np.zeros((0, 3)), []],
    "floats": [[1, 2, 3], np.linspace(0, 1, 5), []],
    "ints": [[1, 2], np.arange(3, dtype=np.uint8),
             range(4), []],
    "rotations": [[(0, 0, 1, 1)], []],
    "strings": [["x"], ("y", "z"), []],
    "times": [[0.5], []],
    "points2": [np.ones((4, 2)), []],
    "points3": [np.ones((1000, 3)),
                np.ones((6, 3))[::2],
                np.ones((3, 3), order="F"), []],
}


@pytest.mark.parametrize("field", VALUES)
def test_set(field):
    n = world()["All"]
    for value in VALUES[field]:
        setattr(n, field, value)
        got = getattr(n, field)
        if isinstance(got, np.ndarray):
            expected = np.asarray(value)
            if field == "anImage" and expected.ndim == 2:
                expected = expected[:, :, None]
            assert got.size == expected.size and (got.size == 0 or
                                                  np.array_equal(got, expected.astype(got.dtype)))
        elif isinstance(got, tuple):
            assert got == tuple(value)
        else:
            assert got == value


WRONG = [
    ("aBool", 1, TypeError),
    ("aBool", "TRUE", TypeError),
    ("aBool", None, TypeError),
    ("aColor", (1, 2), ValueError),
    ("aColor", "red", TypeError),
    ("aColor", 1, ValueError),
    ("aColor", (1, float("nan"), 0), ValueError),
    ("aFloat", "1", TypeError),
    ("aFloat", None, TypeError),
    ("aFloat", True, TypeError),
    ("aFloat", float("inf"), ValueError),
    ("aFloat", 1e300, ValueError),
    ("aFloat", 1j, TypeError),
    ("aFloat", (1,), TypeError),
    ("anImage", np.zeros((2, 2, 5), np.uint8), ValueError),
    ("anImage", np.full((1, 1), 256), ValueError),
    ("anImage", np.zeros((2, 2)), TypeError),
    ("anImage", "x", TypeError),
    ("anInt", 1.0, TypeError),
    ("anInt", 2**31, ValueError),
    ("anInt", 10**30, ValueError),
    ("anInt", True, TypeError),
    ("aNode", "Group", TypeError),
    ("aNode", 0, TypeError),
    ("aRotation", (0, 1, 0), ValueError),
    ("aString", b"bytes", TypeError),
    ("aString", 5, TypeError),
    ("aString", None, TypeError),
    ("aTime", "now", TypeError),
    ("aTime", float("nan"), ValueError),
    ("aVec2f", (1, 2, 3), ValueError),
    ("aVec3f", (1, 2), ValueError),
    ("aVec3f", (1, 2, "x"), TypeError),
    ("aVec3f", [(1, 2, 3)], ValueError),
    ("aVec3f", (1, (2, 3), 4), (ValueError, TypeError)),
    ("colors", (1, 0, 0), ValueError),
    ("colors", [(1, 2)], ValueError),
    ("colors", [(1, 2, 3), (1, 2)], (ValueError, TypeError)),
    ("floats", [[1, 2]], ValueError),
    ("floats", 1, ValueError),
    ("floats", ["a"], TypeError),
    ("floats", None, TypeError),
    ("ints", [1.5], TypeError),
    ("ints", [2**31], ValueError),
    ("ints", [[1]], ValueError),
    ("ints", np.uint64([2**63]), ValueError),
    ("nodes", [1], TypeError),
    ("nodes", 5, TypeError),
    ("nodes", "ab", TypeError),
    ("strings", "word", TypeError),
    ("strings", [1], TypeError),
    ("strings", None, TypeError),
    ("points3", np.ones((3, 2)), ValueError),
    ("points3", np.ones((2, 3, 1)), ValueError),
    ("points3", [[1, 2, np.inf]], ValueError),
    ("points3", {
        "a": 1
    }, TypeError),
    ("points3", object(), TypeError),
]


@pytest.mark.parametrize("field, value, error",
                         WRONG,
                         ids=[f"{f}-{i}" for i, (f, _, _) in enumerate(WRONG)])
def test_wrong_values_change_nothing(field, value, error):
    n = world()["All"]
    before = getattr(n, field)
    with pytest.raises(error, match=rf"Everything\.{field} \({n.fields[field]}\): .* expected"):
        setattr(n, field, value)
    after = getattr(n, field)
    assert np.array_equal(before, after) if isinstance(before, np.ndarray) else before == after


def test_ranges():
    w = world(
        "Shape { appearance Appearance { material DEF M Material { } } geometry DEF S Sphere { } }")
    for value in (-0.1, 1.1):
        with pytest.raises(ValueError, match=r"transparency.*in \[0,1\]"):
            w["M"].transparency = value
    with pytest.raises(ValueError, match="diffuseColor"):
        w["M"].diffuseColor = (2, 0, 0)
    with pytest.raises(ValueError):
        w["S"].radius = 0
    group = xvrml.Group(bboxSize=(-1, -1, -1))
    with pytest.raises(ValueError, match=r"in \[0,inf\) or -1, not -2"):
        group.bboxSize = (-2, -2, -2)


def test_numbers_of_more_than_64_bits():
    for whole in (2**64 - 1, 2**64 - 2**31 + 3, 2**31):
        with pytest.raises(ValueError, match=f"not {whole}"):
            xvrml.IndexedFaceSet(coordIndex=np.array([whole], "u8"))
    assert list(xvrml.IndexedFaceSet(coordIndex=np.array([2**31 - 1], "u8")).coordIndex)
    for field, value in (("translation", (10**400, 0, 0)), ("scaleOrientation", (10**400, 0, 0,
                                                                                 0))):
        with pytest.raises(ValueError, match="not a number beyond 1e308"):
            xvrml.Transform(**{field: value})
    with pytest.raises(ValueError, match="not a number beyond 1e308"):
        xvrml.Material(transparency=10**400)


def test_axes_of_rotations_are_normalised():
    w = world(
        "DEF A Transform { } DEF O OrientationInterpolator { } DEF E Transform { rotation 0 5 0 1 }"
    )
    a, o = w["A"], w["O"]
    for runs in (False, True):
        if runs:
            w.time = 1
        a.rotation = (0, 5, 0, 1)
        assert a.rotation == w["E"].rotation == (0, 1, 0, 1)
        o.keyValue = [(0, 5, 0, 1), (3, 0, 4, 9)]
        assert np.allclose(o.keyValue, [(0, 1, 0, 1), (0.6, 0, 0.8, 9)])
        a.rotation = (0, 0, 0, 2)  # no rotation, as in a file
        assert a.rotation == (0, 0, 0, 2)
        with pytest.raises(ValueError, match="not infinity or NaN"):
            a.rotation = (0, float("inf"), 0, 1)
    assert np.allclose(xvrml.Transform(rotation=(3, 0, 4, 1)).rotation, (0.6, 0, 0.8, 1))


def test_nodes_as_values():
    w = world()
    n, other = w["All"], w["Other"]
    n.aNode = other
    assert n.aNode == other
    n.nodes = [other, other]
    assert n.nodes == (other, other)
    n.aNode = None
    assert n.aNode is None
    with pytest.raises(ValueError, match="same world"):
        n.aNode = world()["Other"]
    shapes = world(
        "DEF S Shape { appearance Appearance { material DEF M Material { } } geometry DEF B Box { } }"
    )
    with pytest.raises(ValueError, match="geometry.*Material"):
        shapes["S"].geometry = shapes["M"]
    shapes["S"].geometry = None
    shapes["S"].geometry = shapes["B"]


def test_null_keeps_its_place_where_it_has_one():
    w = world("DEF S Switch { choice [ NULL Group { } ] } DEF L LOD { level [ NULL Group { } ] } "
              "DEF R Script { field MFNode m [ NULL Group { } ] } DEF G Group { }")
    for name, field in (("S", "choice"), ("L", "level"), ("R", "m")):
        before = getattr(w[name], field)
        assert before[0] is None and len(before) == 2
        setattr(w[name], field, before)
        assert getattr(w[name], field) == before
    n = world()["All"]
    n.nodes = [None]
    assert n.nodes == (None,)
    with pytest.raises(TypeError, match="a sequence of Nodes expected"):
        w["G"].children = [None]


class Made(collections.abc.Sequence):
    """A sequence that makes each item when it is asked for it, and does not keep it."""

    def __init__(self, make, length):
        self.make, self.length, self.made = make, length, 0

    def __len__(self):
        return self.length

    def __getitem__(self, i):
        if i >= self.length:
            raise IndexError
        self.made += 1
        return self.make(i)


def test_items_that_exist_only_while_they_are_read():
    lines = [f"line {i} of a text that does not fit into a short string" for i in range(50)]
    assert xvrml.Text(string=Made(lambda i: "".join(lines[i]), 50)).string == tuple(lines)
    assert xvrml.Text(string=np.array(lines)).string == tuple(lines)
    nodes = Made(lambda i: xvrml.Transform(translation=(i, 0, 0)), 500)
    children = xvrml.Group(children=nodes).children
    assert [n.translation[0] for n in children] == list(range(500))
    assert nodes.made == 500


def test_arrays_are_read_only():
    n = world()["All"]
    with pytest.raises(ValueError, match="read-only"):
        n.points3[0, 0] = 5
    with pytest.raises(TypeError):
        n.aVec3f[0] = 5


def test_fields_that_are_not():
    n = world()["All"]
    with pytest.raises(AttributeError, match="did you mean aFloat"):
        n.aFlot
    with pytest.raises(AttributeError):
        n.aFlot = 1
    for event in ("anEvent", "set_aFloat"):
        with pytest.raises(AttributeError):
            setattr(n, event, True)
    assert not hasattr(n, "nothing")


def test_node_description():
    w = world()
    n = w["All"]
    assert n.node_type == n.type == "Everything" and n.def_name == "All"
    assert n.fields["points3"] == "MFVec3f" and len(n.fields) == 20 and "anEvent" not in n.fields
    assert set(n.fields) < set(dir(n))
    assert repr(n).startswith("<DEF All Everything")
    info = world("DEF N NavigationInfo { }")["N"]
    assert info.type == ("WALK", "ANY"), "a field called type is the field"
    assert info.node_type == "NavigationInfo"


def test_a_node_keeps_its_world():
    n = world()["All"]
    assert n.strings == ("a", "b")
    n.strings = ["c"]
    assert n.strings == ("c",)


def test_text_that_is_not_utf8():
    w = xvrml.load(HEADER.encode() + b'DEF T Text { string "\xff\xfe" }')
    if "T" in w:
        w["T"].string = w["T"].string
        assert w["T"].string == ("\udcff\udcfe",)


def test_writing(tmp_path):
    w = world()
    w["All"].aVec3f = (7, 8, 9)
    w.save(tmp_path / "out.wrl")
    again = xvrml.load(tmp_path / "out.wrl")
    assert again["All"].aVec3f == (7, 8, 9) and again.to_vrml() == w.to_vrml()
    with pytest.raises(OSError):
        w.save(tmp_path / "no/such/folder.wrl")


def test_worlds_too_deep_to_write():
    node = xvrml.Group()
    for _ in range(20000):
        node = xvrml.Group(children=[node])
    w = xvrml.World()
    w.add(node)
    with pytest.raises(ValueError, match="nested more than 2500 deep"):
        w.to_vrml()


# The package ------------------------------------------------------------------------------------


def test_package():
    assert re.fullmatch(r"\d+\.\d+\.\d+", xvrml.__version__)
    folder = pathlib.Path(xvrml.__file__).parent
    assert (folder / "py.typed").exists() and (folder / "__init__.pyi").exists()
    stub = (folder / "__init__.pyi").read_text() + (folder / "nodes.pyi").read_text()
    for name in xvrml.__all__:
        assert name in stub
    for described in ast.parse((folder / "__init__.pyi").read_text()).body:
        # the attributes of errors are those of instances
        if isinstance(described, ast.ClassDef) and not described.name.endswith("Error"):
            there = {name for name in vars(getattr(xvrml, described.name)) if name[0] != "_"}
            members = {f.name for f in described.body if isinstance(f, ast.FunctionDef)}
            members |= {f.target.id for f in described.body if isinstance(f, ast.AnnAssign)}
            assert {name for name in members if name[0] != "_"} == there, described.name
    assert signal.getsignal(
        signal.SIGINT) is signal.default_int_handler, "importing leaves signals alone"
