"""Exports of vv --write and World.save: glTF, STL, PLY and OBJ. The files are checked by gltf_check.py,
which shares nothing with the writer."""
import os
import pathlib
import random
import re
import struct

import pytest
from conftest import HEADER, ROOT
from exports import export, node
from gltf_check import document_of, problems_of

SCENES = sorted((ROOT / "examples").rglob("*.wr[lz]"))
CORPUS = pathlib.Path(os.environ.get("OPENRT_CORPUS", ROOT.parent / "shared/corpus"))

WORLD = HEADER + """
DEF Front Viewpoint { position 0 0 6 description "front" fieldOfView 0.6 }
DirectionalLight { direction 0 -1 -1 intensity 0.8 color 1 0.5 0 }
PointLight { location 0 3 0 attenuation 0 0 1 intensity 0.5 radius 50 }
DEF Outer Transform { translation 1 2 3 rotation 0 1 0 0.5 scale 2 2 2 children [
  DEF Ball Shape { appearance DEF Red Appearance { material DEF RedPaint Material {
    diffuseColor 0.5 0 0 specularColor 1 1 1 shininess 0.5 } } geometry DEF Round Sphere { radius 0.5 } }
  DEF Inner Transform { center 1 0 0 rotation 0 0 1 1.5708 children Shape {
    appearance Appearance { texture PixelTexture { image 2 2 3 0xff0000 0x00ff00 0x0000ff 0xffffff repeatS FALSE }
      textureTransform TextureTransform { scale 2 3 translation 0.5 0 } }
    geometry IndexedFaceSet { solid FALSE coord Coordinate { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0 ] }
      coordIndex [ 0 1 2 3 -1 ] } } }
] }
DEF Again Transform { translation -2 0 0 children USE Outer }
DEF Skewed Transform { scale 1 2 1 scaleOrientation 0 0 1 0.7 children Shape {
  appearance USE Red geometry USE Round } }
Shape { geometry IndexedLineSet { coord Coordinate { point [ 0 0 0, 1 1 1, 2 0 0 ] } coordIndex [ 0 1 2 -1 ]
  color Color { color [ 1 0 0, 0 1 0, 0 0 1 ] } } }
Shape { appearance Appearance { material Material { emissiveColor 0 1 0 } }
  geometry PointSet { coord Coordinate { point [ 0 0 0, 1 1 1 ] } } }
Shape { appearance Appearance { material Material { transparency 0.25 } }
  geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } coordIndex [ 0 1 2 -1 ]
    color Color { color [ 0.5 0.5 0.5, 1 0 0, 0 1 0 ] } } }
DEF Clock TimeSensor { cycleInterval 4 loop TRUE }
DEF Path PositionInterpolator { key [ 0 0.5 1 ] keyValue [ 0 0 0, 0 1 0, 0 0 0 ] }
DEF Turn OrientationInterpolator { key [ 0 1 ] keyValue [ 0 0 1 0, 0 0 1 3 ] }
ROUTE Clock.fraction_changed TO Path.set_fraction
ROUTE Clock.fraction_changed TO Turn.set_fraction
ROUTE Path.value_changed TO Inner.set_translation
ROUTE Turn.value_changed TO Inner.rotation
DEF Button TouchSensor { }
ROUTE Button.touchTime TO Clock.startTime
Fog { }
Background { skyColor 0 0 1 }
"""


def test_names_places_and_instances(vv):
    document, _, talk = export(vv, WORLD)
    outer = [one for one in document["nodes"] if one.get("name") == "Outer"]
    assert len(outer) == 2 and outer[0]["scale"] == [2, 2, 2] and outer[0]["translation"] == [1, 2, 3]
    again = node(document, "Again")
    assert document["nodes"][again["children"][0]]["name"] == "Outer"
    balls = {one["mesh"] for one in document["nodes"] if one.get("name") == "Ball"}
    skewed = node(document, "Skewed")  # three nodes say what one cannot
    inner = document["nodes"][document["nodes"][skewed["children"][0]]["children"][0]]
    assert len(balls) == 1 and inner["mesh"] == balls.pop()
    assert document["asset"]["generator"].startswith("vv ")
    assert "Fog, Background" in talk or "Background, Fog" in talk, talk
    assert "ROUTE" in talk and "TouchSensor" in talk, talk


def test_materials(vv):
    document, _, _ = export(vv, WORLD)
    red = next(one for one in document["materials"] if one.get("name") == "Red")
    assert red["pbrMetallicRoughness"]["baseColorFactor"] == pytest.approx([0.21404, 0, 0, 1], abs=1e-5)
    assert red["pbrMetallicRoughness"]["metallicFactor"] == 0
    assert red["pbrMetallicRoughness"]["roughnessFactor"] == pytest.approx((2 / 66)**0.25)
    textured = next(one for one in document["materials"] if "baseColorTexture" in one["pbrMetallicRoughness"])
    assert "KHR_materials_unlit" in textured["extensions"] and textured["doubleSided"]
    moved = textured["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"]
    # s t -> 2 (s + 0.5), 3 t; v counts from the top
    assert moved["scale"] == [2, 3] and moved["offset"] == pytest.approx([1, -2])
    assert document["samplers"][0]["wrapS"] == 33071 and document["samplers"][0]["wrapT"] == 10497
    clear = next(one for one in document["materials"] if one.get("alphaMode") == "BLEND")
    assert clear["pbrMetallicRoughness"]["baseColorFactor"] == [1, 1, 1, 0.75]


def test_colours_of_vertices_are_linear(vv):
    document, checker, _ = export(vv, WORLD)
    colors = [p["attributes"]["COLOR_0"] for m in document["meshes"] for p in m["primitives"]
              if "COLOR_0" in p["attributes"] and p.get("mode", 4) == 4]
    assert any(v == pytest.approx([0.21404] * 3, abs=1e-5) for v in checker.vectors(colors[0]))


def test_colours_that_nothing_shows_are_left_out(vv):
    """In VRML97 a picture replaces the colours of vertices."""
    faces = """geometry DEF G IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } coordIndex [ 0 1 2 -1 ]
  color Color { color [ 1 0 0, 0 1 0, 0 0 1 ] } } }"""
    textured = f"Shape {{ appearance Appearance {{ texture PixelTexture {{ image 1 1 3 0xff8000 }} }} {faces}"
    export(vv, HEADER + textured)  # the checker finds accessors that are not used
    document, checker, _ = export(vv, HEADER + textured + "Shape { geometry USE G }")
    primitives = [mesh["primitives"][0] for mesh in document["meshes"]]
    colors, = [one["attributes"]["COLOR_0"] for one in primitives if "COLOR_0" in one["attributes"]]
    assert [list(c) for c in checker.vectors(colors)] == [[1, 0, 0], [0, 1, 0], [0, 0, 1]]


def test_lights_and_cameras(vv):
    document, _, _ = export(vv, WORLD)
    sun, lamp = document["extensions"]["KHR_lights_punctual"]["lights"]
    assert sun["intensity"] == pytest.approx(0.8 * 3.14159265) and sun["color"] == pytest.approx([1, 0.21404, 0], abs=1e-5)
    assert lamp["intensity"] == pytest.approx(0.5 * 3.14159265) and lamp["range"] == 50
    assert document["cameras"][0]["perspective"]["yfov"] == pytest.approx(0.6)
    assert node(document, "Front")["translation"] == [0, 0, 6] and document["cameras"][0]["name"] == "front"


def test_animations(vv):
    document, checker, _ = export(vv, WORLD)
    animation, = document["animations"]
    assert animation["name"] == "Clock" and len(animation["channels"]) == 4  # two fields at two places
    moves = next(c for c in animation["channels"] if c["target"]["path"] == "translation")
    sampler = animation["samplers"][moves["sampler"]]
    assert list(checker.arrays[sampler["input"]]) == [0, 2, 4]
    # the field and center: the node turns about (1, 0, 0), from where its content moves back
    assert [list(v) for v in checker.vectors(sampler["output"])] == [[1, 0, 0], [1, 1, 0], [1, 0, 0]]
    target = document["nodes"][moves["target"]["node"]]
    assert target["name"] == "Inner" and document["nodes"][target["children"][0]]["translation"] == [-1, 0, 0]


def test_curves_move_as_in_the_world(vv):
    world = """#X3D V3.3 utf8
PROFILE Full
DEF Clock TimeSensor { cycleInterval 4 loop TRUE }
DEF Path SplinePositionInterpolator { key [ 0 0.25 1 ] keyValue [ 0 0 0, 2 1 0, 0 3 1 ] }
DEF Turn SquadOrientationInterpolator { key [ 0 0.5 1 ] keyValue [ 0 1 0 0, 1 0 0 1, 0 0 1 2 ] }
DEF Body Transform { children Shape { geometry Box { } } }
ROUTE Clock.fraction_changed TO Path.set_fraction
ROUTE Clock.fraction_changed TO Turn.set_fraction
ROUTE Path.value_changed TO Body.set_translation
ROUTE Turn.value_changed TO Body.set_rotation
"""
    document, checker, talk = export(vv, world)
    assert "ROUTE" not in talk, talk
    animation, = document["animations"]
    for path, most in (("translation", 0.02), ("rotation", 0.005)):
        channel, = [one for one in animation["channels"] if one["target"]["path"] == path]
        sampler = animation["samplers"][channel["sampler"]]
        times, values = checker.arrays[sampler["input"]], checker.vectors(sampler["output"])
        for at in (0.3, 0.8, 1.7, 3.1):
            still, _, _ = export(vv, world, "still.glb", "--time", str(at))
            right = next(i for i, time in enumerate(times) if time >= at)
            t = (at - times[right - 1]) / (times[right] - times[right - 1])
            now = [(1 - t) * a + t * b for a, b in zip(values[right - 1], values[right])]
            wanted = node(still, "Body")[path]
            side = -1 if path == "rotation" and sum(a * b for a, b in zip(now, wanted)) < 0 else 1
            assert [side * x for x in now] == pytest.approx(wanted, abs=most), (path, at)


def test_animations_in_prototypes(vv):
    document, _, _ = export(vv, HEADER + """
PROTO Door [ eventIn SFFloat open exposedField SFVec3f place 0 0 0 ] {
  DEF T Transform { translation IS place children Shape { geometry Box { } } }
  DEF I OrientationInterpolator { key [ 0 1 ] keyValue [ 0 1 0 0, 0 1 0 1 ] set_fraction IS open }
  ROUTE I.value_changed TO T.rotation
}
DEF A Door { place 1 0 0 } DEF B Door { place 5 0 0 }
DEF C TimeSensor { } ROUTE C.fraction_changed TO B.open
""")
    animation, = document["animations"]
    channel, = animation["channels"]
    assert document["nodes"][channel["target"]["node"]]["translation"] == [5, 0, 0]


def test_text_with_files_beside_it(vv):
    binary, _, _ = export(vv, WORLD)
    text, _, _ = export(vv, WORLD, "two words.gltf")
    assert text["buffers"][0]["uri"] == "two_words.bin" and text["images"][0]["uri"] == "two_words_0.png"
    for kind in ("nodes", "meshes", "materials", "accessors", "animations", "cameras"):
        assert text[kind] == binary[kind], kind
    done = vv("in.wrl", "--write", "gltf:-", "-q")
    (vv.folder / "alone.gltf").write_bytes(done.stdout)
    alone, problems, _ = document_of(vv.folder / "alone.gltf")
    assert problems == [] and alone["buffers"][0]["uri"].startswith("data:") and alone["meshes"] == binary["meshes"]
    done = vv("in.wrl", "--write", "glb:-", "-q")
    assert done.stdout == (vv.folder / "out.glb").read_bytes() and done.talk == ""


def test_pictures_are_not_recoded_or_replaced(vv):
    picture = (ROOT / "examples/scenes/globe.png").read_bytes()
    vv.write("out_0.png", picture)
    world = HEADER + """Shape { appearance Appearance { texture DEF T ImageTexture { url "out_0.png" } } geometry Box { } }
Shape { appearance Appearance { material Material { } texture ImageTexture { url "out_0.png" } } geometry Box { } }"""
    document, _, _ = export(vv, world, "out.gltf")
    name, = [image["uri"] for image in document["images"]]
    assert name == "out_0_2.png" and (vv.folder / name).read_bytes() == picture
    document, checker, _ = export(vv, world)
    view = document["bufferViews"][document["images"][0]["bufferView"]]
    assert checker.buffers[0][view["byteOffset"]:view["byteOffset"] + view["byteLength"]] == picture


def test_same_world_same_bytes(vv):
    export(vv, WORLD, "a.glb")
    export(vv, WORLD, "b.glb")
    assert (vv.folder / "a.glb").read_bytes() == (vv.folder / "b.glb").read_bytes()


def test_the_time_is_that_of_the_option(vv):
    document, _, _ = export(vv, WORLD, "out.glb", "--time", "1")
    assert node(document, "Inner")["translation"] == pytest.approx([1, 0.5, 0])


def test_shaders(vv):
    document, _, talk = export(vv, HEADER + "".join(f"""Transform {{ translation {x} 0 0 children Shape {{
  appearance DEF A{x} ORTAppearance {{ shader ORTShader {{ name "{name}" file "{name.lower()}" options [ {options} ] }} }}
  geometry Box {{ size 1 2 3 }} }} }}
""" for x, (name, options) in enumerate((("Glass", '"1f index 1.7" "3f absorption 2 1 0" "1f abbe 40"'), ("Metal", ""),
                                         ("Mirror", '"3f reflectance .5 .6 .7"'), ("RoughGlass", '"1f roughness .25"'),
                                         ("Marble", ""), ("Nowhere", "")))))
    glass, metal, mirror, rough, marble, nowhere = document["materials"]
    more = glass["extensions"]
    assert more["KHR_materials_transmission"]["transmissionFactor"] == 1 and more["KHR_materials_ior"]["ior"] == pytest.approx(1.7)
    assert more["KHR_materials_volume"]["attenuationDistance"] == pytest.approx(0.5)
    assert more["KHR_materials_volume"]["attenuationColor"] == pytest.approx([0.36788, 0.60653, 1], abs=1e-4)
    assert more["KHR_materials_volume"]["thicknessFactor"] == 1
    assert more["KHR_materials_dispersion"]["dispersion"] == pytest.approx(0.5)
    assert metal["pbrMetallicRoughness"]["metallicFactor"] == 1
    assert metal["pbrMetallicRoughness"]["baseColorFactor"][0] == pytest.approx(0.913, abs=2e-3)
    assert mirror["pbrMetallicRoughness"]["baseColorFactor"] == pytest.approx([0.5, 0.6, 0.7, 1])
    assert rough["pbrMetallicRoughness"]["roughnessFactor"] == pytest.approx(0.5)
    assert "Marble becomes a matt surface" in talk and "no plug-in has the shader Nowhere" in talk, talk
    assert marble and nowhere


def test_an_export_has_no_viewer(vv):
    document, _, talk = export(vv, HEADER + """Viewpoint { position 0 0 100 }
LOD { range [ 10 ] level [ DEF Fine Shape { geometry Box { } } DEF Coarse Shape { geometry Sphere { } } ] }
Switch { whichChoice 1 choice [ DEF No Shape { geometry Box { } } DEF Yes Shape { geometry Cone { } } ] }
DEF Sign Billboard { children Shape { geometry Box { } } }""")
    names = {one.get("name") for one in document["nodes"]}
    assert "Fine" in names and "Yes" in names and not names & {"Coarse", "No"}
    assert "rotation" not in node(document, "Sign")
    for text in ("an LOD has its finest level alone", "a Switch has its present choice", "a Billboard does not turn"):
        assert text in talk, talk


def test_looks_of_a_switch_are_variants(vv):
    shapes = """DEF Body Switch { whichChoice 1 choice [
  Shape { appearance DEF Red Appearance { material Material { diffuseColor 1 0 0 } } geometry DEF G Box { } }
  Shape { appearance DEF Wood Appearance { texture PixelTexture { image 1 1 3 0x804020 } } geometry USE G }
  Shape { appearance Appearance { material DEF Blue Material { } } geometry USE G }
  Shape { geometry USE G } ] }
Transform { translation 3 0 0 children Switch { whichChoice 0 choice [
  Shape { appearance USE Red geometry DEF H Cone { } } Shape { appearance USE Wood geometry USE H } ] } }"""
    document, _, talk = export(vv, HEADER + shapes)
    assert "a Switch" not in talk, talk
    names = [one["name"] for one in document["extensions"]["KHR_materials_variants"]["variants"]]
    assert names == ["Red", "Wood", "Blue", "Body 3"]
    body, cone = [mesh["primitives"][0] for mesh in document["meshes"]]
    for primitive, shown, looks in ((body, "Wood", names), (cone, "Red", ["Red", "Wood"])):
        assert document["materials"][primitive["material"]]["name"] == shown
        mappings = primitive["extensions"]["KHR_materials_variants"]["mappings"]
        mapped = {names[v]: mapping["material"] for mapping in mappings for v in mapping["variants"]}
        assert list(sorted(mapped)) == sorted(looks) and mapped[shown] == primitive["material"]
        assert "TEXCOORD_0" in primitive["attributes"]
    document, _, _ = export(vv, HEADER + shapes.replace("DEF Wood Appearance", "DEF Red Appearance").replace("USE Wood", "USE Red"))
    names = [one["name"] for one in document["extensions"]["KHR_materials_variants"]["variants"]]
    assert names == ["Red", "Red 1", "Blue", "Body 3"]
    other = shapes.replace("geometry USE G }\n  Shape { geometry", "geometry Sphere { } }\n  Shape { geometry")
    document, _, talk = export(vv, HEADER + other)
    assert "a Switch has its present choice" in talk, talk
    assert len(document["extensions"]["KHR_materials_variants"]["variants"]) == 2


HOSTILE = {
    "no shapes": "Group { }",
    "nothing": "",
    "not finite": """Transform { translation 1e38 0 0 scale 1e38 1 1 children Transform { translation 1e38 0 0 scale 1e38 1 1
  children Shape { geometry Box { } } } } Transform { scale 0 1 1 children Shape { geometry Box { } } }""",
    "infinite points": "Shape { geometry PointSet { coord Coordinate { point [ 1e39 0 0, 1 1 1 ] } } }",
    "empty faces": "Shape { geometry IndexedFaceSet { } } Shape { geometry IndexedLineSet { } } Shape { geometry Text { } }",
    "normals without length": """Shape { geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] }
  coordIndex [ 0 1 2 ] normal Normal { vector [ 0 0 0, 0 0 0, 0 0 0 ] } } }""",
    "bad light": "SpotLight { direction 0 0 0 cutOffAngle 9 beamWidth 9 intensity 1e30 attenuation 0 0 0 }",
    "bad view": "Viewpoint { fieldOfView 9 orientation 0 0 0 1 position 1e39 0 0 }",
    "bad keys": """DEF T TimeSensor { cycleInterval 1e-9 } DEF P PositionInterpolator { key [ 1 0.5 0.5 0 ]
  keyValue [ 0 0 0, 1e38 0 0, 1 1 1, 2 2 2 ] } DEF X Transform { } ROUTE T.fraction_changed TO P.set_fraction
  ROUTE P.value_changed TO X.translation ROUTE P.value_changed TO X.set_translation""",
    "names": "DEF \xe9\xff Transform { children DEF \"quoted Shape { geometry Box { } } }",
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_worlds(vv, name):
    vv.write("in.wrl", (HEADER + HOSTILE[name]).encode("latin-1"))
    for suffix in ("glb", "gltf", "stl", "ply", "obj"):
        done = vv("in.wrl", "--write", "out." + suffix)
        assert done.returncode == 0, done.talk
    assert problems_of(vv.folder / "out.glb") == [] and problems_of(vv.folder / "out.gltf") == []
    for file in ("out.obj", "out.mtl"):
        assert b"nan" not in (vv.folder / file).read_bytes() and b"inf" not in (vv.folder / file).read_bytes()


NASTY = ("0", "-1", "1e38", "-1e38", "1e39", "1e-45", "-0.0", "65536", "2147483647", "0.9999999")


@pytest.mark.parametrize("first", range(0, 60, 15))
def test_numbers_of_any_size(vv, first):
    for seed in range(first, first + 15):
        dice = random.Random(seed)
        world = re.sub(r"(?<![\w.])-?[0-9.]+(?![\w.])",
                       lambda m: dice.choice(NASTY) if dice.random() < 0.1 else m.group(), WORLD.split("\n", 1)[1])
        vv.write("in.wrl", HEADER + world)
        assert vv("in.wrl", "--write", "out.glb", "-q").returncode == 0, seed
        assert problems_of(vv.folder / "out.glb") == [], seed
        for suffix in ("stl", "ply", "obj"):
            assert vv("in.wrl", "--write", "out." + suffix, "-q").returncode == 0, seed


def test_deep_nesting(vv):
    """Prototypes nest deeper than a file may."""
    protos = "PROTO P0 [ ] { Shape { geometry Box { } } }\n"
    for i in range(12):
        protos += f"PROTO P{i + 1} [ ] {{ {'Transform { children ' * 200} P{i} {{ }} {'}' * 200} }}\n"
    document, _, _ = export(vv, HEADER + protos + "P12 { }")
    assert len(document["nodes"]) >= 2400


def test_files_that_cannot_be_written(vv):
    vv.write("in.wrl", WORLD)
    assert vv("in.wrl", "--write", "no/such/out.glb").returncode == 1
    assert vv("in.wrl", "--write", "glb:").returncode == 2
    assert vv("in.wrl", "--write", "glb:in.wrl").returncode == 1
    assert vv.leftovers() == []


# Other formats ------------------------------------------------------------------------------------


def test_stl(vv):
    export(vv, WORLD)
    done = vv("in.wrl", "--write", "out.stl")
    data = (vv.folder / "out.stl").read_bytes()
    count, = struct.unpack_from("<I", data, 80)
    assert len(data) == 84 + 50 * count and count > 2 and b"metres" in data[:80]
    assert "lines and points (2 times)" in done.talk, done.talk
    for i in range(0, count, 97):
        n = struct.unpack_from("<3f", data, 84 + 50 * i)
        assert abs(sum(x * x for x in n) - 1) < 1e-4 or n == (0, 0, 0)  # a triangle without an area
    assert vv("out.stl", "-o", "a.png", "--size", "16x12", "--spp", "1").returncode == 0


def test_mirrored_shapes_stay_outside_out(vv):
    vv.write("in.wrl", HEADER + "Transform { scale -1 1 1 translation 3 0 0 children Shape { geometry Box { } } }")
    assert vv("in.wrl", "--write", "out.stl").returncode == 0
    data = (vv.folder / "out.stl").read_bytes()
    count, = struct.unpack_from("<I", data, 80)
    assert count == 12
    for i in range(count):
        numbers = struct.unpack_from("<12f", data, 84 + 50 * i)
        middle = [sum(numbers[3 + axis::3]) / 3 - (3 if axis == 0 else 0) for axis in range(3)]
        assert sum(n * m for n, m in zip(numbers[:3], middle)) > 0


def test_ply(vv):
    export(vv, WORLD)
    assert vv("in.wrl", "--write", "out.ply").returncode == 0
    header = (vv.folder / "out.ply").read_bytes().split(b"end_header\n")[0]
    assert b"format binary_little_endian 1.0" in header and b"property float nx" in header and b"metres" in header
    done = vv("out.ply", "-o", "a.png", "--size", "16x12", "--spp", "1")
    assert done.returncode == 0 and "error" not in done.talk, done.talk
    vv.write("in.wrl", HEADER + """Shape { geometry PointSet { coord Coordinate { point [ 0 0 0, 1 2 3 ] }
  color Color { color [ 1 0 0, 0 0 1 ] } } }""")
    assert vv("in.wrl", "--write", "cloud.ply").returncode == 0
    data = (vv.folder / "cloud.ply").read_bytes().split(b"end_header\n")[1]
    assert data == struct.pack("<3f3B", 0, 0, 0, 255, 0, 0) + struct.pack("<3f3B", 1, 2, 3, 0, 0, 255)


def test_obj(vv):
    export(vv, WORLD)
    assert vv("in.wrl", "--write", "out.obj").returncode == 0
    text, library = [(vv.folder / name).read_text() for name in ("out.obj", "out.mtl")]
    assert "metres" in text and "mtllib out.mtl" in text and "usemtl Red" in text
    red = library.split("newmtl Red\n")[1].split("\n")
    assert [float(x) for x in red[0].split()[1:]] == pytest.approx([0.5, 0, 0]) and "Ns 64" in red
    assert "\nd 0.75\n" in library
    assert "map_Ke out_0.png" in library  # a picture without a material is not lit
    done = vv("out.obj", "-o", "a.png", "--size", "16x12", "--spp", "1")
    assert done.returncode == 0 and "error" not in done.talk, done.talk
    assert "materials are left out" in vv("in.wrl", "--write", "obj:-").talk


def test_python(vv):
    xvrml = pytest.importorskip("xvrml")
    vv.write("in.wrl", WORLD)
    world = xvrml.load(vv.folder / "in.wrl")
    before = len(world.warnings)
    world.save(vv.folder / "python.glb")
    assert problems_of(vv.folder / "python.glb") == []
    assert any("Fog" in str(warning) for warning in world.warnings[before:])
    assert vv("in.wrl", "--write", "vv.glb").returncode == 0
    assert (vv.folder / "vv.glb").read_bytes() == (vv.folder / "python.glb").read_bytes()
    with pytest.raises(OSError):
        world.save(vv.folder / "no/such/folder.glb")


# Many worlds -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("scene", SCENES, ids=[path.stem for path in SCENES])
def test_examples_are_right(vv, scene):
    done = vv(scene, "--write", "out.glb", "-q")
    assert done.returncode == 0, done.talk
    assert problems_of(vv.folder / "out.glb") == []


def corpus_worlds():
    worlds = sorted(CORPUS.rglob("*.wrl")) if CORPUS.is_dir() else []
    small = [path for path in worlds if path.stat().st_size < 200_000]
    return small[::max(1, len(small) // 60)]


def test_worlds_of_others_are_right(vv):
    worlds = corpus_worlds()
    if not worlds:
        pytest.skip("there is no corpus")
    bad, written = {}, 0
    for path in worlds:
        (vv.folder / "out.glb").unlink(missing_ok=True)
        done = vv(path, "--write", "out.glb", "-q")
        if done.returncode == 3:  # a broken file
            continue
        assert done.returncode == 0, (path, done.talk)
        written += 1
        if problems := problems_of(vv.folder / "out.glb"):
            bad[str(path)] = problems
    assert bad == {} and written > 20
