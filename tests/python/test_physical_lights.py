"""Tests how lights of X3D shine on a PhysicalMaterial (docs/worlds.md): an intensity is an irradiance, 1/pi of
what a Material gets. Other light is the same for both, and glTF agrees in both directions."""
import base64
import json
import math
import struct

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

HEAD = "#X3D V4.0 utf8\nPROFILE Full\nNavigationInfo { headlight FALSE }\nViewpoint { position 0 0 2 }\n"
WALL = "geometry Rectangle2D { size 9 9 } }\n"
FIELDS = "baseColor 0.5 0.5 0.5 metallic 0 roughness 1"
PHYSICAL = "Shape { appearance Appearance { material PhysicalMaterial { " + FIELDS + " } } " + WALL
# The same surface of a class that takes lights as a Material does.
CLASS = ('Shape { appearance ORTAppearance { material PhysicalMaterial { ' + FIELDS +
         ' } shader ORTShader { name "Physical" } } ' + WALL)
LIGHTS = {
    "sun": "DirectionalLight { direction 0.3 0 -1 intensity 0.7 }",
    "lamp": "PointLight { location 0 0 3 attenuation 0 0 1 intensity 5 }",
    "spot": "SpotLight { location 0 0 3 direction 0 0 -1 intensity 0.8 beamWidth 1 cutOffAngle 1.2 }",
    "many": " ".join(f"PointLight {{ location {x} 0 3 intensity 0.02 }}" for x in range(-20, 20))
}


def middle(text, folder=None, spp=16, **options):
    """Returns the radiance in the middle of a picture. folder: holds the files that the text names."""
    if folder:
        (folder / "world.x3dv").write_text(text)
    world = xvrml.load(str(folder / "world.x3dv")) if folder else xvrml.loads(text)
    image = np.asarray(world.render(size=(9, 9), spp=spp, fov=10, **options))
    return image[4, 4, :3].astype(float)


@pytest.mark.parametrize("transport", ["whitted", "path", "light"])
@pytest.mark.parametrize("light", LIGHTS)
def test_an_intensity_is_an_irradiance(light, transport):
    options = {"transport": transport, "spp": 256 if light == "many" else 4}
    physical = middle(HEAD + LIGHTS[light] + PHYSICAL, **options)
    whole = middle(HEAD + LIGHTS[light] + CLASS, **options)
    assert physical[0] > .01
    assert physical * math.pi == pytest.approx(whole, rel=1e-4 if light != "many" else .05)


def test_a_white_material_is_pi_times_as_bright():
    light = "DirectionalLight { intensity 0.5 }"
    matt = "Shape { appearance Appearance { material Material { diffuseColor 1 1 1 } } " + WALL
    white = PHYSICAL.replace("0.5 0.5 0.5", "1 1 1")
    assert middle(HEAD + light + matt) == pytest.approx(.5, abs=1e-5)
    # The layer over the base sends some of the light elsewhere.
    assert middle(HEAD + light + white) == pytest.approx(.5 / math.pi, rel=.12)


@pytest.mark.parametrize("more", [
    "EnvironmentLight { color 1 1 1 intensity 1 }",
    'ORTLight { shader ORTShader { name "Luminaire" options [ "1f lumen 100" "3f location 0 0 3" ] } }',
    "Transform { translation 0 0 3 rotation 1 0 0 3.14159 children Shape { appearance Appearance { "
    "material UnlitMaterial { emissiveColor 1 1 1 } } geometry Rectangle2D { size 2 2 } } }"
])
def test_other_light_is_the_same(more):
    options = {"transport": "path", "spp": 256}
    physical, whole = (middle(HEAD + more + wall, **options) for wall in (PHYSICAL, CLASS))
    assert physical[0] > 0 and physical == pytest.approx(whole, rel=1e-5)


def test_the_headlight_is_a_light_of_x3d():
    head = HEAD.replace("headlight FALSE", "headlight TRUE")
    assert middle(head + PHYSICAL) * math.pi == pytest.approx(middle(head + CLASS), rel=1e-4)


def test_models_without_lights_stay_as_bright():
    """The lights that vv gives a model shine on all materials alike."""
    head = "#X3D V4.0 utf8\nPROFILE Full\n"
    matt = "Shape { appearance Appearance { material Material { diffuseColor 0.5 0.5 0.5 } } " + WALL
    assert middle(head + PHYSICAL)[0] == pytest.approx(middle(head + matt)[0], rel=.25)


def caustic(wall):
    """A lamp behind a mirror that sends its light to the wall."""
    mirror = ("Transform { translation 0 2.5 1 rotation 1 0 0 1.5708 children Shape { appearance ORTAppearance { "
              'shader ORTShader { name "Mirror" } } geometry Rectangle2D { size 4 4 solid FALSE } } }\n')
    screen = ("Transform { translation 0 0.6 1 rotation 1 0 0 1.5708 children Shape { appearance Appearance { material "
              "Material { diffuseColor 0 0 0 } } geometry Rectangle2D { size 3 0.4 solid FALSE } } }\n")
    lamp = "PointLight { location 0 1.2 1 attenuation 0 0 1 intensity 3 }\n"
    return middle(HEAD + lamp + mirror + screen + wall, transport="light", spp=1024)


def test_light_by_way_of_a_mirror_has_the_same_unit():
    physical, whole = caustic(PHYSICAL), caustic(CLASS)
    assert whole[0] > 0 and physical * math.pi == pytest.approx(whole, rel=.02)


def lights_of(path):
    document = json.loads(path.read_text())
    return [light["intensity"] for light in document["extensions"]["KHR_lights_punctual"]["lights"]]


@pytest.mark.parametrize("wall,factor", [(PHYSICAL, 1), (PHYSICAL.replace("PhysicalMaterial { " + FIELDS, "Material { "), math.pi)])
def test_lights_survive_gltf(tmp_path, wall, factor):
    text = HEAD + "DirectionalLight { direction 0 0 -1 intensity 0.5 }\n" + wall
    world = xvrml.loads(text)
    world.save(str(tmp_path / "a.gltf"))
    assert lights_of(tmp_path / "a.gltf") == pytest.approx([.5 * factor], rel=1e-6)
    # glTF has no NavigationInfo: the Inline is in a world without a headlight.
    again = middle(HEAD + 'Inline { url "a.gltf" }', tmp_path)
    assert again == pytest.approx(middle(text), rel=1e-3)


def test_surfaces_of_gltf_without_reflection_take_irradiances(tmp_path):
    (tmp_path / "a.gltf").write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "extensionsUsed": ["KHR_materials_specular"],
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0},
                       "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [-9, -9, 0], "max": [9, 9, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + base64.b64encode(
            struct.pack("<9f", -9, -9, 0, 9, -9, 0, 0, 9, 0)).decode()}]
    }))
    light = "DirectionalLight { direction 0.6 0 -0.8 intensity 0.5 }\n"
    seen = middle(HEAD + light + 'Inline { url "a.gltf" }', tmp_path)
    assert seen == pytest.approx(.5 * .8 / math.pi, rel=1e-5)


def test_a_mixed_world_says_what_changes(tmp_path):
    world = xvrml.loads(HEAD + LIGHTS["sun"] + PHYSICAL + PHYSICAL.replace("PhysicalMaterial { " + FIELDS, "Material { "))
    world.save(str(tmp_path / "a.gltf"))
    assert lights_of(tmp_path / "a.gltf") == pytest.approx([.7 * math.pi], rel=1e-6)


def test_every_frame_has_the_same_light(vv):
    """A frame that keeps the shaders of the one before takes the lights as the first one did."""
    (vv.folder / "w.x3dv").write_text(HEAD + LIGHTS["sun"] + PHYSICAL)
    done = vv("w.x3dv", "-o", "f{frame}.pfm", "--frames", "0-2", "--size", "8x8", "--spp", "1", "-q")
    assert done.returncode == 0, done.talk
    light = [np.frombuffer((vv.folder / f"f{n}.pfm").read_bytes()[-8 * 8 * 12:], "<f4") for n in range(3)]
    assert light[0].mean() > 0.04
    for later in light[1:]:
        assert later.mean() == pytest.approx(light[0].mean(), rel=1e-4)
