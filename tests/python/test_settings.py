"""Compares the quality settings of the library's table (rtGetQualityInfo) with the options of vv,
with the parameters of World.render and xvrml.rt.Context.render, and with the stubs of these."""
import ast
import ctypes
import pathlib
import re
import sys

import pytest

xvrml = pytest.importorskip("xvrml")
np = pytest.importorskip("numpy")
from xvrml import rt  # noqa: E402
from xvrml._arguments import _signature  # noqa: E402

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cluster"))
import openrt_c  # noqa: E402

# Settings that vv and Python choose themselves or leave to the engine.
HIDDEN = {"replicates", "progressive", "frames_in_flight", "tile", "view", "measure", "patience"}
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
    words = vv("--help", "all").text.split()
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


@pytest.fixture
def doors(box):
    """Returns the functions that render small pictures with settings: of a World and of a
    Context."""
    world, context = xvrml.load(box), rt.Context(threads=1)
    context.camera(eye=(0, 0, 5), at=(0, 0, 0))
    return [
        lambda **given: world.render(**{
            "size": (4, 4),
            "spp": 1,
            **given
        }), lambda **given: context.render(**{
            "size": (4, 4),
            "spp": 1,
            **given
        })
    ]


@pytest.mark.parametrize("setting, value, expected", [
    ("spp", 0, "spp: 1 to 65536 expected, not 0"),
    ("spp", 2**31, "spp: 1 to 65536 expected, not 2147483648"),
    ("depth", 2**31, "depth: 0 to 10000 expected, not 2147483648"),
    ("seed", -1, "seed: 0 to 2147483647 expected, not -1"),
    ("seed", 2**31, "seed: 0 to 2147483647 expected, not 2147483648"),
    ("error", 1.5, "error: 0 to 1 expected, not 1.5"),
    ("time_limit", float("nan"), "time_limit: 0 to 1000000 expected, not nan"),
])
def test_python_names_setting_range_and_value(doors, setting, value, expected):
    for render in doors:
        with pytest.raises(ValueError) as wrong:
            render(**{setting: value})
        assert str(wrong.value) == expected


def test_fractions_of_numpy_are_no_whole_numbers(doors):
    for render in doors:
        for value in (1.7, np.float16(1.5), np.float32(1.7), np.float64(1.7), np.array(2.9)):
            for setting in ("spp", "depth", "seed"):
                with pytest.raises(TypeError, match=f"{setting}: a whole number"):
                    render(**{setting: value})
            with pytest.raises((TypeError, ValueError), match="size|whole"):
                render(size=(value, 4))
        for value in (2, np.int64(2), np.uint8(2), np.array(2)):
            render(spp=value, depth=value, seed=value, size=(value, 4))


def test_shadows_are_true_or_false(doors):
    for render in doors:
        for value in (float("nan"), 1j, None, 2**64, 2, 1.0, "on"):
            with pytest.raises(TypeError, match="shadows: True or False expected"):
                render(shadows=value)
        for value in (True, False, 0, 1, np.True_, np.int64(0)):
            render(shadows=value)


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
        assert done.returncode == 2, done.talk
        assert re.search("a number (from|of at least) 0 ", done.talk), done.talk
