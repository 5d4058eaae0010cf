"""Worlds in VRML 1.0: Python and vv see the VRML97 graph that they become."""
import gzip
import json

import pytest

xvrml = pytest.importorskip("xvrml")

OLD = """#VRML V1.0 ascii
Separator {
  DEF Front PerspectiveCamera { position 0 0 8 }
  DEF Paint Material { diffuseColor 1 0 0 }
  DEF Ball Sphere { }
  Translation { translation 3 0 0 }
  USE Ball
}
"""


def test_the_graph():
    world = xvrml.load(OLD.encode())
    assert world.warnings == []
    assert world["Front"].type == "Viewpoint"
    assert world["Ball"].geometry.type == "Sphere"
    world["Paint"].diffuseColor = 0, 1, 0
    picture = world.render(size=(32, 24), spp=1, seed=1)
    assert picture.shape == (24, 32, 4)


def test_gzip_and_errors(tmp_path):
    path = tmp_path / "old.wrl"
    path.write_bytes(gzip.compress(OLD.encode()))
    assert xvrml.load(path)["Ball"].type == "Shape"
    path.write_text("#VRML V1.0 ascii\nSeparator {\n  Cube { width wide }\n}\n")
    (problem,) = xvrml.load(path).warnings
    assert (problem.severity, problem.line, problem.column) == ("error", 3, 16)
    with pytest.raises(xvrml.ParseError):
        xvrml.load(b"#VRML V3.0 ascii\n")


def test_vv(vv):
    vv.write("old.wrl", OLD)
    assert "file        VRML 1.0\n" in vv("old.wrl", "--info").stdout.decode()
    facts = json.loads(vv("old.wrl", "--info", "--json").stdout)
    assert facts["file"]["encoding"] == "VRML 1.0"
    assert vv("old.wrl", "--check").returncode == 0
    assert vv("old.wrl", "--write", "new.wrl").returncode == 0
    text = (vv.folder / "new.wrl").read_text()
    assert text.startswith("#VRML V2.0 utf8") and "DEF Ball Shape" in text and "USE Ball" in text
    assert vv("new.wrl", "--check").returncode == 0
    vv.write("new_world.wrl", "#VRML V2.0 utf8\nInline { url \"old.wrl\" }\n")
    assert vv("new_world.wrl", "-o", "a.png", "--size", "32x24", "--spp", "1").returncode == 0
