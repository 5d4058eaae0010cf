"""Tests the output of tools/export_mitsuba.py for our worlds, rendered by Mitsuba if it is
installed. Also the plots of the benchmark."""
import pathlib
import sys
import xml.etree.ElementTree as xml

import pytest

from conftest import HEADER, find_vv

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import export_mitsuba  # noqa: E402
import plot_svg  # noqa: E402


def exported(world, folder):
    replay = find_vv().parent / "openrt-replay"
    if not replay.exists():
        pytest.skip("openrt-replay is not built")
    remarks = export_mitsuba.export(world, folder, (32, 24), find_vv(), replay, (64, 32))
    return xml.parse(folder / "scene.xml").getroot(), remarks


def test_the_cornell_box(vv, tmp_path):
    scene, remarks = exported(ROOT / "examples/scenes/cornell.wrl", tmp_path / "out")
    assert remarks == []
    shapes = scene.findall("shape")
    assert [s.get("type") for s in shapes].count("ply") == len(shapes) >= 6
    lamps = [s for s in shapes if s.find("emitter") is not None]
    assert len(lamps) == 1 and lamps[0].find("emitter/rgb").get("value") == "17.0 12.0 4.0"
    ply = (tmp_path / "out" / lamps[0].find("string").get("value")).read_bytes()
    assert b"element vertex 4\n" in ply and b"element face 2\n" in ply
    sensor = scene.find("sensor")
    assert abs(float(sensor.find("float[@name='fov']").get("value")) - 39.534) < 0.01
    assert scene.find("emitter") is None, "there is no sky"


def test_surfaces_spheres_and_skies(vv, tmp_path):
    vv.write(
        "world.wrl", HEADER + """Background { skyColor 0 0 1 } NavigationInfo { headlight FALSE }
      Transform { translation 1 2 3 scale 2 2 2 children Shape { geometry Sphere { radius .5 }
        appearance ORTAppearance { shader ORTShader { name "Glass" file "glass" options "1f index 1.25" } } } }
      Shape { geometry Box { } appearance ORTAppearance { shader ORTShader { name "Metal" file "metal" options "1f roughness .3" } } }
      Shape { geometry Cone { } appearance ORTAppearance { shader ORTShader { name "Wood" file "wood" } } }"""
    )
    scene, remarks = exported(vv.folder / "world.wrl", tmp_path / "out")
    sphere = scene.find("shape[@type='sphere']")
    assert [float(sphere.find("point").get(k)) for k in "xyz"] == [1, 2, 3]
    assert float(sphere.find("float").get("value")) == 1
    kinds = {b.get("type") for b in scene.iter("bsdf")}
    assert kinds == {"dielectric", "twosided", "roughconductor", "diffuse"}
    assert remarks == ["Wood: no counterpart, grey instead"]
    width, height, values = export_mitsuba.read_pfm(tmp_path / "out/around.pfm")
    assert (width, height) == (64, 32) and scene.find("emitter").get("type") == "envmap"
    assert abs(max(values) - 1) < 1e-6 and max(values[0::3]) == 0, "blue all around"


def test_the_same_light_in_mitsuba(vv, tmp_path):
    mitsuba = pytest.importorskip("mitsuba")
    mitsuba.set_variant("scalar_rgb")
    exported(ROOT / "examples/scenes/cornell.wrl", tmp_path / "out")
    theirs = mitsuba.render(mitsuba.load_file(str(tmp_path / "out/scene.xml")), spp=64)
    vv(ROOT / "examples/scenes/cornell.wrl", "-o", "x.pfm", "--size", "32x24", "--spp", "64")
    ours = export_mitsuba.read_pfm(vv.folder / "x.pfm")[2]
    assert abs(float(theirs.array.numpy().mean()) / (sum(ours) / len(ours)) - 1) < 0.05


def test_plots():
    text = plot_svg.log_plot("A & B", "seconds", "error", {
        "one": [(0.1, 0.5), (1, 0.05)],
        "two": [(0.3, 0.2, 0.1, 0.4)]
    })
    root = xml.fromstring(text)
    circles = root.findall("{http://www.w3.org/2000/svg}circle")
    assert len(circles) == 3 and all(0 <= float(c.get("cx")) <= plot_svg.WIDTH for c in circles)
    assert float(circles[0].get("cy")) < float(circles[1].get("cy")), "less error is lower"
