"""Compares the quality settings of the library's table (rtGetQualityInfo) with the options of vv,
with the parameters of World.render and xvrml.rt.Context.render, and with the stubs of these."""
import ast
import ctypes
import pathlib
import sys

import pytest

xvrml = pytest.importorskip("xvrml")
pytest.importorskip("numpy")
from xvrml import rt  # noqa: E402
from xvrml._arguments import _signature  # noqa: E402

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cluster"))
import openrt_c  # noqa: E402

# Settings that vv and Python choose themselves or leave to the engine.
HIDDEN = {"replicates", "progressive", "frames_in_flight", "tile"}
# Settings with another name than in the table.
RENAMED = {"samples": "spp"}
# Settings that vv has and World.render lacks, or World.render has and Context.render lacks.
WITHOUT = {"World": {"energy_cut"}, "Context": {"energy_cut", "clamp"}}


class Info(ctypes.Structure):
    """RTqualityInfo of openrt/frame.h."""
    _fields_ = [("size", ctypes.c_size_t), ("quality", ctypes.c_uint32), ("name", ctypes.c_char_p),
                ("isReal", ctypes.c_int),
                ("minimum", ctypes.c_double), ("maximum", ctypes.c_double),
                ("default", ctypes.c_double), ("zeroIsAuto", ctypes.c_int),
                ("choices", ctypes.c_char_p), ("text", ctypes.c_char_p)]

    def parameter(self):
        """Returns the type and the default of a parameter of Python, as texts."""
        if self.choices == b"off on":
            return "bool", str(bool(self.default))
        if self.choices:
            return "str", repr(self.choices.decode().split()[int(self.default - self.minimum)])
        return ("float", repr(self.default)) if self.isReal else ("int", str(int(self.default)))


def settings():
    """Returns the rows of the table that vv and Python may offer: {name: row}."""
    library = openrt_c.build() / "lib/libopenrt.so"
    if not library.exists():
        pytest.skip("no shared library in this build")
    get = ctypes.CDLL(str(library)).rtGetQualityInfo
    get.argtypes = [ctypes.c_int, ctypes.POINTER(Info)]
    rows = {}
    while True:
        row = Info(size=ctypes.sizeof(Info))
        if not get(len(rows), ctypes.byref(row)):
            break
        rows[row.name.decode()] = row
    assert set(rows) > HIDDEN
    return {name: row for name, row in rows.items() if name not in HIDDEN}


def stub(module, name):
    """Returns the parameters of the method `render` of a class in a stub: {name: type}."""
    path = pathlib.Path(xvrml.__file__).with_name(f"{module}.pyi")
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.ClassDef) and node.name == name:
            method = next(
                m for m in node.body if isinstance(m, ast.FunctionDef) and m.name == "render")
            found = [*method.args.args, *method.args.kwonlyargs]
            return {a.arg: ast.unparse(a.annotation) for a in found if a.arg != "self"}
    raise LookupError(name)


def test_vv_has_an_option_for_each_setting(vv):
    words = vv("--help").text.split()
    for name in settings():
        assert "--" + RENAMED.get(name, name).replace("_", "-") in words


@pytest.mark.parametrize("owner, module", [(xvrml.World, "__init__"), (rt.Context, "rt")])
def test_parameters_and_stubs_are_those_of_the_table(owner, module):
    text = owner.render.__doc__
    names, _ = _signature(text)
    names.pop("self")
    typed = stub(module, owner.__name__)
    assert list(typed) == list(names)
    for name, row in settings().items():
        if name in RENAMED or name in WITHOUT[owner.__name__]:
            continue
        kind, default = row.parameter()
        assert f" {name}: {kind} = {default}" in text, name
        assert typed[name] == kind, name
    for name in WITHOUT[owner.__name__]:
        assert name not in names, f"{name} is named as missing, but is there"


@pytest.mark.parametrize("option, values", [
    ("--clamp", ("0", "1", "3.4e38")),
    ("--time-limit", ("0", "1000000")),
    ("--error", ("0", "0%", "1", "100%")),
    ("--energy-cut", ("0", "0.0", "0%", "1", "100%")),
])
def test_vv_accepts_the_whole_range_of_the_table(vv, option, values):
    for value in values:
        done = vv("box.wrl", "-o", "x.png", "--size", "4x4", "--spp", "1", option, value)
        assert done.returncode == 0, done.talk
    for value in ("-1", "nan", "inf", "1e39"):
        done = vv("box.wrl", "-o", "x.png", "--size", "4x4", "--spp", "1", option, value)
        assert done.returncode == 2 and "a number from 0 to " in done.talk, done.talk
