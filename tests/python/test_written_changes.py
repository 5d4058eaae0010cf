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
