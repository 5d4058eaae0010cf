"""Tests that a written file which looks different is no surprise: vv and Python say what changes
(docs/worlds.md)."""
import pytest

xvrml = pytest.importorskip("xvrml")

HEAD3 = "#X3D V3.3 utf8\nPROFILE Full\n"
HEAD4 = "#X3D V4.0 utf8\nPROFILE Full\n"
TEXTURED = ("Shape { appearance Appearance { material Material { diffuseColor 1 0 0 } "
            "texture PixelTexture { image 1 1 3 0xFFFFFF } } geometry Box { } }\n")

CASES = {
    "texture": (HEAD3 + TEXTURED + TEXTURED, "a.wrl", "the look of 2 textured appearances changes"),
    "texture in X3D": ("#VRML V2.0 utf8\n" + TEXTURED, "a.x3dv", "multiply diffuseColor in X3D"),
    "unit": ("#X3D V3.3 utf8\nPROFILE Full\nUNIT length inch 0.0254\nInline { }\n", "a.wrl", "(inch) is lost"),
    "lights of Inlines": (HEAD4 + "Inline { }\n", "a.wrl", "so will those of 1 Inline"),
    "bright": (HEAD4 + "PointLight { intensity 4 }\n", "a.wrl", "1 light will be weaker"),
}
SILENT = {
    "white": (HEAD3 + TEXTURED.replace("1 0 0", "1 1 1"), "a.wrl"),
    "same standard": (HEAD3 + TEXTURED, "a.x3d"),
    "unit without Inlines": ("#X3D V3.3 utf8\nPROFILE Full\nUNIT length inch 0.0254\nGroup { }\n", "a.wrl"),
    "bright in X3D 4": (HEAD4 + "PointLight { intensity 4 }\nInline { }\n", "a.x3dv"),
}


def saved(tmp_path, text, name):
    world = xvrml.loads(text)
    before = len(world.warnings)
    world.save(str(tmp_path / name))
    return [str(warning) for warning in world.warnings[before:]]


@pytest.mark.parametrize("case", CASES)
def test_changes_are_said(case, tmp_path, vv):
    text, name, said = CASES[case]
    assert any(said in one for one in saved(tmp_path, text, name))
    vv.write("world.x3dv", text)
    done = vv("world.x3dv", "--write", name)
    assert done.returncode == 0 and said in done.talk


@pytest.mark.parametrize("case", SILENT)
def test_nothing_is_said_without_a_change(case, tmp_path):
    text, name = SILENT[case]
    assert saved(tmp_path, text, name) == []


def test_quiet_says_nothing(vv):
    vv.write("world.x3dv", CASES["texture"][0])
    assert "changes" not in vv("world.x3dv", "--write", "a.wrl", "-q").talk


# A Script that counts how often it has begun: the text of a count of 1 would be counted on from there.
COUNTING = HEAD3 + """DEF S Script { mustEvaluate TRUE directOutput TRUE initializeOnly SFInt32 count 0
  initializeOnly SFNode place DEF T Transform { }
  url "ecmascript: function initialize() { count++; place.translation = new SFVec3f(count, 0, 0); }" }
USE T
"""


def test_a_text_has_the_world_before_its_scripts_begin(vv):
    """So that a Script begins with the same fields when the text is read."""
    vv.write("world.x3dv", COUNTING)
    for name in ("a.x3dv", "a.wrl"):
        assert vv("world.x3dv", "--write", name).returncode == 0
        text = (vv.folder / name).read_text()
        assert "count 0" in text and "translation" not in text.replace("place.translation", "")
    # The values of -D are written, also if only a world that runs can take it.
    assert "translation 0 7 0" in vv("world.x3dv", "-D", "T.translation=0 7 0", "--write", "x3dv:-").text
    vv.write("event.x3dv", HEAD3 + "DEF T TouchSensor { }\nPROTO P [ inputOutput SFFloat r 1 ] "
             "{ Shape { geometry Sphere { radius IS r } } }\nDEF Q P { }\n")
    assert "r 5" in vv("event.x3dv", "-D", "Q.r=5", "--write", "x3dv:-").text


def test_programs_that_name_files_are_said_where_the_folder_changes(vv, tmp_path):
    text = HEAD3 + """Script { url "ecmascript: function initialize() {
  Browser.loadURL(new MFString('b.wrl'), new MFString('target=x')); }" }\n"""
    vv.write("world.x3dv", text)
    (vv.folder / "other").mkdir()
    assert "1 Script will look for its files" in vv("world.x3dv", "--write", "other/a.x3dv").talk
    assert "Script will look" not in vv("world.x3dv", "--write", "a.x3dv").talk
    world = xvrml.load(vv.folder / "world.x3dv")
    world.save(str(tmp_path / "other/b.x3dv"))
    assert "will look for its files" in str(world.warnings[-1])
