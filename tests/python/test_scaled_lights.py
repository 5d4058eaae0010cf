"""Tests lamps of glTF in scaled nodes: no scale changes a light's intensity or range (KHR_lights_punctual), in
pictures, in what is written, and in what is read again."""
import base64
import json
import math
import struct

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

HEAD = "#X3D V4.0 utf8\nPROFILE Full\nNavigationInfo { headlight FALSE }\nViewpoint { position 0 0 2 }\n"
CANDELA, HEIGHT = 12, 2.5
SCALES = [(.001, .001, .001), (1, 1, 1), (1000, 1000, 1000), (2, 1, 1), (.01, 5, 300), (-1, 1, 1), (-2, -2, -2),
          (3, -.5, 1), (1, 0, 1)]


def lit_wall(folder, light, node, above=None):
    """Writes a matt wall at z = 0, and a lamp that a node holds; above: the node around it."""
    nodes = [{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}, **node}]
    if above:
        nodes.append({"children": [1], **above})
    (folder / "a.gltf").write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, len(nodes) - 1]}], "nodes": nodes,
        "extensionsUsed": ["KHR_materials_specular", "KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"intensity": CANDELA, **light}]}},
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0},
                       "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [-9, -9, 0], "max": [9, 9, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + base64.b64encode(
            struct.pack("<9f", -9, -9, 0, 9, -9, 0, 0, 9, 0)).decode()}]
    }))


def picture(folder, name="a.gltf"):
    """Returns the radiances of 9 x 9 pixels. glTF has no NavigationInfo, so an Inline shows the file."""
    (folder / "w.x3dv").write_text(HEAD + f'Inline {{ url "{name}" }}')
    image = xvrml.load(str(folder / "w.x3dv")).render(size=(9, 9), spp=1, fov=30, transport="whitted")
    return np.asarray(image)[..., 0].astype(float)


def expected(distance=HEIGHT, candela=CANDELA):
    return candela / distance**2 / math.pi


@pytest.mark.parametrize("scale", SCALES, ids=str)
@pytest.mark.parametrize("light", [{"type": "point"}, {"type": "spot", "spot": {"outerConeAngle": .7}}], ids=("point", "spot"))
def test_no_scale_changes_a_lamp(tmp_path, light, scale):
    lit_wall(tmp_path, light, {"translation": [0, 0, HEIGHT]})
    plain = picture(tmp_path)
    assert plain[4, 4] == pytest.approx(expected(), rel=1e-3)
    lit_wall(tmp_path, light, {"translation": [0, 0, HEIGHT], "scale": scale})
    # A lamp that looks along z looks the other way if z is mirrored.
    if light["type"] == "spot" and scale[2] < 0:
        assert picture(tmp_path)[4, 4] == 0
    else:
        assert picture(tmp_path) == pytest.approx(plain, rel=2e-3)


@pytest.mark.parametrize("scale", [(.001, .001, .001), (1000, 1000, 1000), (.5, 2, 4)], ids=str)
def test_a_scale_above_moves_a_lamp_and_changes_nothing_else(tmp_path, scale):
    lit_wall(tmp_path, {"type": "point"}, {"translation": [0, 0, HEIGHT / scale[2]], "rotation": [.2, .3, .1, .927]},
             {"scale": scale})
    assert picture(tmp_path)[4, 4] == pytest.approx(expected(), rel=1e-3)


def test_a_lamp_under_shear_shines_alike_in_all_directions(tmp_path):
    """A turned node within an uneven one has no axes of its own."""
    lit_wall(tmp_path, {"type": "point"}, {"translation": [0, 0, HEIGHT / 5], "rotation": [.5, .5, .5, .5]},
             {"scale": [.1, 2, 5], "rotation": [0, 0, .6, .8]})
    sheared = picture(tmp_path)
    lit_wall(tmp_path, {"type": "point"}, {"translation": [0, 0, HEIGHT]})
    assert sheared == pytest.approx(picture(tmp_path), rel=2e-3)


@pytest.mark.parametrize("scale", [(.001, .001, .001), (1000, 1000, 1000), (.5, 2, 4)], ids=str)
def test_the_range_is_in_metres(tmp_path, scale):
    for metres, lit in ((HEIGHT * 1.01, True), (HEIGHT * .99, False)):
        lit_wall(tmp_path, {"type": "point", "range": metres}, {"translation": [0, 0, HEIGHT], "scale": scale})
        assert (picture(tmp_path)[4, 4] > 0) == lit


def test_the_axis_of_a_spot_is_the_z_axis_of_its_node(tmp_path):
    """Half a turn about y, then an uneven scale: the direction is that of the scaled axis."""
    turn = [0, math.sin(.2), 0, math.cos(.2)]
    lit_wall(tmp_path, {"type": "spot", "spot": {"innerConeAngle": .05, "outerConeAngle": .06}},
             {"rotation": turn}, {"translation": [4 * math.tan(.4), 0, 2], "scale": [2, 1, 1]})
    assert picture(tmp_path)[4, 4] > 0


@pytest.mark.parametrize("scale", [.001, 1, 1000])
@pytest.mark.parametrize("lamp", ["PointLight { location 0 0 3 attenuation 0 0 1 intensity 5 radius 40 }",
                                  "SpotLight { location 0 0 3 direction 0.1 0 -1 attenuation 0 0 2 intensity 9 beamWidth 0.3 cutOffAngle 0.6 }"])
def test_worlds_of_any_size_survive_gltf(tmp_path, lamp, scale):
    wall = "Shape { appearance Appearance { material PhysicalMaterial { metallic 0 } } geometry Rectangle2D { size 9 9 } }"
    view = HEAD.replace("position 0 0 2", f"position 0 0 {2 * scale}")
    text = view + f"Transform {{ scale {scale} {scale} {scale} children [ {lamp} {wall} ] }}"

    def seen(world):
        return np.asarray(world.render(size=(9, 9), spp=1, transport="whitted"))[..., 0].astype(float)

    world = xvrml.loads(text)
    before = seen(world)
    assert before[4, 4] > .01
    for generation in range(2):
        name = f"g{generation}.gltf"
        world.save(str(tmp_path / name))
        (tmp_path / f"w{generation}.x3dv").write_text(view + f'Inline {{ url "{name}" }}')
        world = xvrml.load(str(tmp_path / f"w{generation}.x3dv"))
        assert seen(world) == pytest.approx(before, rel=2e-3, abs=1e-6)


def test_messages_say_what_gltf_cannot_hold(vv):
    (vv.folder / "w.x3dv").write_text(
        HEAD + "Transform { scale 1 2 1 children PointLight { attenuation 0 0 1 } }\nShape { geometry Box { } }")
    done = vv("w.x3dv", "--write", "a.gltf")
    assert done.returncode == 0 and "an uneven scale is above it" in done.talk, done.talk
