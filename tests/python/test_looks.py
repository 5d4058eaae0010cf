"""Tests how models are shown that do not say how: one look in pictures of vv, in its window and in
Python (docs/decisions/0040-models.md), and what vv says about pictures that are too bright."""
import base64
import inspect
import json
import re
import struct
import zlib

import pytest

from conftest import HEADER, read_ppm
from xserver import display

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

GREY = (158, 166, 173)  # the backdrop, 0.62 0.65 0.68
SIZE = (64, 48)
SPP = ("--size", "64x48", "--spp", "4")
PLAIN = HEADER + "Shape { appearance Appearance { material Material { diffuseColor .8 .2 .1 } } geometry Box { } }"
METAL = """#X3D V4.0 utf8
PROFILE Full
Shape { appearance Appearance { material PhysicalMaterial { metallic 1 roughness .3 } } geometry Box { } }
"""


@pytest.fixture
def models(vv):
    vv.write("plain.wrl", PLAIN)
    vv.write("metal.x3dv", METAL)
    return vv


def corner(png):
    """Returns the first pixel of a PNG file, which has no neighbours to differ from."""
    place, packed = 8, b""
    while place < len(png):
        length, kind = struct.unpack(">I4s", png[place:place + 8])
        packed += png[place + 8:place + 8 + length] if kind == b"IDAT" else b""
        place += 12 + length
    return tuple(zlib.decompress(packed)[1:4])


def load(vv, name):
    return xvrml.load(vv.folder / name)


def shown(vv, name, *options):
    """Returns the bytes of the PNG file that vv writes."""
    done = vv(name, "-o", "shown.png", *SPP, *options)
    assert done.returncode == 0, done.talk
    return (vv.folder / "shown.png").read_bytes()


def saved(vv, world, **options):
    world.render(size=SIZE, spp=4, **options).save(vv.folder / "saved.png")
    return (vv.folder / "saved.png").read_bytes()


@pytest.mark.parametrize("name", ["plain.wrl", "metal.x3dv"])
def test_python_shows_a_model_as_vv_does(models, name):
    assert saved(models, load(models, name)) == shown(models, name)


def test_the_backdrop_is_what_screens_show_and_programs_do_not_read(models):
    picture = load(models, "plain.wrl").render(size=SIZE, spp=4)
    assert tuple(picture.display[0, 0]) == GREY and tuple(picture.array[0, 0]) == (0, 0, 0, 0)
    alone = shown(models, "plain.wrl")
    assert shown(models, "plain.wrl", "-o", "beside.exr", "-o", "beside.ppm") == alone
    assert read_ppm((models.folder / "beside.ppm").read_bytes())[2][0][0] == (0, 0, 0)
    models("plain.wrl", "-o", "alone.exr", *SPP)
    assert (models.folder / "alone.exr").read_bytes() == (models.folder / "beside.exr").read_bytes()


def test_a_live_view_in_python_has_the_same_look(models):
    with xvrml.LiveView(load(models, "plain.wrl"), size=SIZE, spp=4) as view:
        assert tuple(view.wait()[0, 0]) == GREY


@pytest.mark.parametrize("name", ["plain.wrl", "metal.x3dv"])
def test_the_window_has_the_same_look(models, name):
    models.write("keys.txt", "0.5 save window.png\n0.6 quit\n")
    with display():
        done = models(name, "--input", "keys.txt", *SPP)
    assert done.returncode == 0, done.talk
    expected = corner(shown(models, name))
    found = corner((models.folder / "window.png").read_bytes())
    assert max(abs(a - b) for a, b in zip(found, expected)) <= 12 and min(found) > 80


def test_keys_of_the_window_brighten_the_picture_and_its_command(models):
    models.write("keys.txt", "0.3 key =\n0.4 key =\n0.5 key -\n0.6 key C\n0.7 save window.png\n0.8 quit\n")
    with display():
        done = models("plain.wrl", "--input", "keys.txt", *SPP)
    assert done.returncode == 0, done.talk
    assert "--exposure=0.5 --view standard" in done.text + done.talk
    plain = corner(shown(models, "plain.wrl"))
    brighter = corner(shown(models, "plain.wrl", "--exposure", "0.5"))
    assert corner((models.folder / "window.png").read_bytes()) == brighter > plain


def test_shaders_by_rules_leave_a_model_its_studio(models):
    world = load(models, "plain.wrl")
    world.set_shader("*", "Metal")
    here = shown(models, "plain.wrl", "--shader", "*=Metal")
    assert saved(models, world) == here
    world = load(models, "plain.wrl")
    world.set_shader("*", "Metal")
    array = world.render(size=SIZE, spp=4).array
    assert array[..., 3].min() == 1 and array[..., :3].min() > 0.02  # surroundings everywhere


@pytest.mark.parametrize("options, python", [(("--background", "black"), dict(background="black")),
                                             (("--studio", "#ffddaa"), dict(studio="#ffddaa")),
                                             (("--from", "front"), dict(from_="front")),
                                             (("--preset", "product"), dict(preset="product")),
                                             (("--preset", "technical", "--spp", "4"),
                                              dict(preset="technical")),
                                             (("--preset", "pcb", "--spp", "4"), dict(preset="pcb"))])
def test_options_of_the_look_are_the_same_in_python(models, options, python):
    assert saved(models, load(models, "metal.x3dv"), **python) == shown(models, "metal.x3dv", *options)


def test_the_look_can_be_refused_in_python(models):
    for world in ("plain.wrl", "metal.x3dv"):
        picture = load(models, world).render(size=SIZE, spp=1, studio=False)
        assert tuple(picture.display[0, 0]) == (0, 0, 0) and picture.array[0, 0, 3] == 0


def test_a_preset_gives_its_shaders_once(models):
    world = load(models, "plain.wrl")
    first = saved(models, world, preset="pcb")
    text = world.to_vrml()
    assert saved(models, world, preset="pcb") == first and world.to_vrml() == text


@pytest.mark.parametrize("options, words", [
    (dict(preset="metal"), "preset: 'pcb', 'product', 'studio', 'technical' expected, not 'metal'"),
    (dict(studio="none"), "studio: a colour (a name such as white"),
    (dict(studio="white", background="none"), "not with a background other than a colour"),
    (dict(from_="behind"), "from_: one of three-quarter, above, front"),
    (dict(from_="front", fit=True), "from_: not with camera, viewpoint or fit"),
])
def test_wrong_looks(models, options, words):
    with pytest.raises(ValueError, match=re.escape(words)):
        load(models, "plain.wrl").render(size=(4, 3), **options)


def test_a_studio_that_nobody_asked_for_keeps_highlights(models):
    """A white matt ball is not burnt out, and the backdrop is the grey of other models."""
    models.write("white.x3dv",
                 METAL + "Transform { translation 3 0 0 children Shape { appearance Appearance {"
                 " material PhysicalMaterial { baseColor .95 .95 .95 metallic 0 } } geometry Sphere { } } }")
    world = load(models, "white.x3dv")
    picture = world.render(size=SIZE, spp=16)
    assert picture.view == "filmic" and (picture.display.min(2) == 255).mean() < 0.005
    corner = picture.display[:4, :4].reshape(-1, 3).mean(0)
    assert np.abs(corner - GREY).max() < 16
    assert shown(models, "white.x3dv") != shown(models, "white.x3dv", "--view", "standard")


def margins(lit):
    rows, columns = np.flatnonzero(lit.any(1)), np.flatnonzero(lit.any(0))
    height, width = lit.shape
    return columns[0], width - 1 - columns[-1], rows[0], height - 1 - rows[-1]


@pytest.mark.parametrize("size", [(160, 80), (80, 160), (120, 120)])
def test_a_model_fills_nine_tenths_of_a_still_and_is_in_its_middle(size):
    world = xvrml.loads(HEADER + "Shape { geometry Box { size 4 1 2 } }")
    left, right, top, bottom = margins(world.render(size=size, spp=1).array[..., 3] > 0)
    assert abs(left - right) <= 2 and abs(top - bottom) <= 2
    assert min((left + right) / size[0], (top + bottom) / size[1]) <= 0.11
    assert min(left, right, top, bottom) > 0


def test_a_turntable_still_stays_in_the_picture(models):
    done = models("plain.wrl", "--turntable", "4", "-o", "turn.ppm", "--size", "60x60", "--spp", "1")
    assert done.returncode == 0, done.talk
    for n in range(4):
        rows = read_ppm((models.folder / f"turn-{n:04}.ppm").read_bytes())[2]
        assert min(margins(np.array(rows).any(2))) > 0


def test_a_white_picture_says_what_helps(models):
    models.write("bright.wrl", HEADER + "Viewpoint { } NavigationInfo { headlight FALSE } Background { skyColor 1 1 1 }"
                 "Shape { appearance Appearance { material Material { emissiveColor 1 1 1 } } geometry Box { size 20 20 1 } }")
    done = models("bright.wrl", "-o", "b.png", *SPP, "--exposure", "3")
    assert re.search(r"\d+ % of the pixels are brighter than white: --exposure auto", done.talk)
    for options in ((), ("--exposure", "auto"), ("--exposure", "3", "--view", "filmic")):
        assert "brighter than white" not in models("bright.wrl", "-o", "b.png", *SPP, *options).talk
    assert "brighter" not in models("bright.wrl", "-o", "b.exr", *SPP, "--exposure", "3").talk
    assert "brighter" not in models("bright.wrl", "-o", "b.png", *SPP, "-q", "--exposure", "3").talk


def test_an_option_without_its_value_does_not_take_the_next_one(models):
    done = models("plain.wrl", "--exposure", "--size", "64x48", "-o", "x.png")
    assert done.returncode == 2
    assert "--exposure: a value was expected: EV|auto, not the option --size" in done.talk
    assert models("plain.wrl", "--exposure", "-1", "-o", "x.png", *SPP).returncode == 0


def test_a_check_tells_details_of_one_kind_once(models):
    faces = "Shape { geometry IndexedFaceSet { coord Coordinate { point [0 0 0, 1 0 0, 0 1 0] } coordIndex [0 0 0 -1, 0 1 2 -1] } }\n"
    models.write("many.wrl", HEADER + 30 * faces)
    few, all_of_them = models("many.wrl", "--check"), models("many.wrl", "--check", "-v")
    notes = [line for line in few.talk.splitlines() if ": note:" in line]
    everything = [line for line in all_of_them.talk.splitlines() if ": note:" in line]
    assert len(everything) >= 30 and len(notes) == 1
    assert "more like this; -v shows all" in notes[0]
    assert few.returncode == all_of_them.returncode


def test_files_of_other_formats_are_named(vv):
    vv.write("cut.3ds", b"MM\xff\x00\x00\x00\x02\x00\x0a\x00\x00\x00\x03\x00\x00\x00")
    vv.write("scene.usdz", b"PK\x03\x04" + 22 * b"\0" + b"\x0a\0\0\0scene.usdc" + 50 * b"\0")
    assert "a 3D Studio mesh" in vv("cut.3ds", "-o", "x.png").talk
    assert "a USD package (.usdz)" in vv("scene.usdz", "-o", "x.png").talk


@pytest.mark.parametrize("function", [
    xvrml.load, xvrml.World.render, xvrml.Browser.pick, xvrml.Picture.matte,
    xvrml.Browser.create_node
])
def test_functions_have_signatures(function):
    assert inspect.signature(function).parameters


def test_signatures_have_names_and_defaults():
    parameters = inspect.signature(xvrml.World.render).parameters
    assert parameters["size"].default == (800, 600) and parameters["spp"].default is None
    assert parameters["crop"].kind is inspect.Parameter.KEYWORD_ONLY


def model_with_cameras(*places, yfov=0.6, light=False, moves=False):
    """Returns a glTF file with a tetrahedron from -2 to 2 and cameras on the z axis, or 9 beside it. moves:
    an animation moves the first camera."""
    points = np.array([[-2, -2, -2], [2, -2, 2], [-2, 2, 2], [2, 2, -2]], np.float32)
    index = np.array([0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2], np.uint16)
    times = np.array([0, 1, 0, 0, 4, 0, 0, 5], np.float32)
    data = base64.b64encode(points.tobytes() + index.tobytes() + times.tobytes()).decode()
    model = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(places) + 1 + light))}],
        "nodes": [{"mesh": 0}, *({"camera": 0, "translation": [0, 0, z], "name": f"View{z}"} for z in places)],
        "cameras": [{"type": "perspective", "name": "Eye", "perspective": {"yfov": yfov, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": 104, "uri": "data:application/octet-stream;base64," + data}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24},
                        {"buffer": 0, "byteOffset": 72, "byteLength": 32}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                       "min": [-2, -2, -2], "max": [2, 2, 2]},
                      {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"},
                      {"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                      {"bufferView": 2, "byteOffset": 8, "componentType": 5126, "count": 2, "type": "VEC3"}]
    }  # yapf: disable
    if light:
        model["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}
        model["nodes"].append({"extensions": {"KHR_lights_punctual": {"light": 0}}})
    if moves:
        model["animations"] = [{"samplers": [{"input": 2, "output": 3}],
                                "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}]}]  # yapf: disable
    return json.dumps(model)


NOTE = 'vv: the file\'s camera "Eye" does not show all of the model, this view does; --viewpoint 0 looks through that camera'


@pytest.mark.parametrize("cameras, leftOut", [
    ({"places": [4]}, True), ({"places": [4], "yfov": 0.05}, True), ({"places": [-9]}, True), ({"places": [30]}, False),
    ({"places": [1]}, False), ({"places": [4, 5]}, False), ({"places": [4], "light": True}, False),
    ({"places": [4], "moves": True}, False)
])  # yapf: disable
def test_a_camera_of_a_gltf_file_that_cuts_the_model_is_left_out(vv, cameras, leftOut):
    """One that sees all of the model or stands in it is taken, and so are one of several, one that moves and one
    of a file with lights."""
    vv.write("model.gltf", model_with_cameras(*cameras.pop("places"), **cameras))
    done = vv("model.gltf", "-o", "a.png", *SPP)
    assert (NOTE in done.talk) == leftOut and done.returncode == 0
    assert "camera" not in vv("model.gltf", "-o", "a.png", *SPP, "-q").talk
    alone = shown(vv, "model.gltf")
    assert (alone != shown(vv, "model.gltf", "--viewpoint", "0")) == leftOut
    assert saved(vv, load(vv, "model.gltf")) == alone
    assert saved(vv, load(vv, "model.gltf"), viewpoint=0) == shown(vv, "model.gltf", "--viewpoint", "Eye")
    if leftOut:
        picture = load(vv, "model.gltf").render(size=(60, 60), spp=1, studio=False)
        assert min(margins(picture.array[..., 3] > 0)) > 0


@pytest.mark.parametrize("options", [("--viewpoint", "Eye"), ("--from", "top"), ("--fit", ), ("--camera", "0,0,3:0,0,0"),
                                     ("--viewpoint", "all"), ("--camera-shader", "Panorama")])
def test_a_view_that_is_named_is_taken(vv, options):
    vv.write("model.gltf", model_with_cameras(4))
    done = vv("model.gltf", "-o", "a.png", *SPP, *options)
    assert done.returncode == 0 and "camera" not in done.talk, done.talk


@pytest.mark.parametrize("cameras, told", [({"places": [4]}, True), ({"places": []}, False),
                                           ({"places": [4], "light": True}, False)])  # yapf: disable
def test_writing_a_model_says_whether_its_look_changes(vv, cameras, told):
    vv.write("model.gltf", model_with_cameras(*cameras.pop("places"), **cameras))
    before = corner(shown(vv, "model.gltf"))
    for name in ("model.x3dv", "model.wrl"):
        assert ("the backdrop of vv" in vv("model.gltf", "--write", name).talk) == told
        assert (corner(shown(vv, name)) != before) == told
    world = xvrml.load(vv.folder / "model.gltf")
    world.save(vv.folder / "model.x3d")
    assert any("the backdrop of vv" in warning.message for warning in world.warnings) == told


def test_a_camera_is_left_out_in_all_pictures_of_a_run(vv):
    vv.write("model.gltf", model_with_cameras(4))
    assert vv("model.gltf", "--turntable", "3", "-o", "turn.ppm", "--size", "60x60", "--spp", "1").talk.count(NOTE) == 1
    for n in range(3):
        rows = read_ppm((vv.folder / f"turn-{n:04}.ppm").read_bytes())[2]
        assert min(margins(np.array(rows).any(2))) > 0


def test_the_window_leaves_the_camera_out_as_well(vv):
    vv.write("model.gltf", model_with_cameras(4))
    vv.write("keys.txt", "0.5 save window.png\n0.6 quit\n")
    with display():
        done = vv("model.gltf", "--input", "keys.txt", *SPP)
    assert done.returncode == 0 and done.talk.count(NOTE) == 1, done.talk
    assert (vv.folder / "window.png").read_bytes() == shown(vv, "model.gltf")


@pytest.mark.parametrize("shape", ["Sphere { }", "Cylinder { radius 2 height 2 }", "Cone { }"])
def test_a_round_model_fills_nine_tenths_as_well(shape):
    world = xvrml.loads(HEADER + "Shape { geometry " + shape + " }")
    left, right, top, bottom = margins(world.render(size=(120, 90), spp=1).array[..., 3] > 0)
    assert abs(left - right) <= 3 and abs(top - bottom) <= 3
    assert 0 < min(left, right, top, bottom) and min((left + right) / 120, (top + bottom) / 90) <= 0.12


@pytest.mark.parametrize("shape", ["Cone { bottomRadius .3 height 2 }", "Cone { bottomRadius .05 height 9 }",
                                   "IndexedLineSet { coord Coordinate { point [ 0 1 0, .1 -1 0, -.1 -1 .1 ] } "
                                   "coordIndex [ 0 1 2 -1 ] }"])  # yapf: disable
def test_the_eye_stands_away_from_a_tip_that_points_at_it(shape):
    world = xvrml.loads(HEADER + "Shape { geometry " + shape + " }")
    lit = world.render(size=(120, 90), spp=4, from_="top", studio=False).array[..., 3] > 0
    assert min(margins(lit)) > 0 and 0 < lit.mean() < .5


def test_a_parallel_view_is_fitted_alike_with_and_without_a_script(vv):
    vv.write("world.x3dv", "#X3D V3.3 utf8\nPROFILE Immersive\nOrthoViewpoint { fieldOfView [ -100 -100 100 100 ] }\n"
             "Transform { translation 3 0 0 children Shape { geometry Sphere { radius 10 } } }\n")
    vv.write("keys.txt", "0.1 end\n")
    vv.write("frame.txt", "0.1 key F\n0.2 end\n")
    vv.write("back.txt", "0.1 key F\n0.2 key Home\n3 end\n")

    def framed(*options):
        done = vv("world.x3dv", "-o", "a.ppm", *SPP, *options)
        assert done.returncode == 0, done.talk
        return margins(np.array(read_ppm((vv.folder / "a.ppm").read_bytes())[2]).any(2))

    fitted = framed("--fit")
    assert 0 < min(fitted) <= 4
    for options in (("--fit", "--input", "keys.txt"), ("--from", "front"), ("--from", "front", "--input", "keys.txt"),
                    ("--input", "frame.txt")):  # yapf: disable
        assert max(abs(a - b) for a, b in zip(framed(*options), fitted)) <= 1, options
    assert framed("--input", "back.txt") == framed()


@pytest.mark.parametrize("name", ["metal.x3dv", "box.wrl"])
def test_false_colours_of_a_model_are_those_of_its_look(vv, name):
    vv.write("metal.x3dv", "#X3D V4.0 utf8\nPROFILE Full\nShape { appearance Appearance { material PhysicalMaterial "
             "{ metallic 1 baseColor 1 .8 .3 } } geometry Sphere { } }\n")
    vv.write("box.wrl", HEADER + "Shape { appearance Appearance { material Material { } } geometry Box { } }\n")
    vv.write("on.txt", "0.1 key L\n0.2 end\n")
    vv.write("keys.txt", "0.2 end\n")
    given = ("--false-colour", "auto")
    assert shown(vv, name, "--input", "on.txt") == shown(vv, name, *given, "--input", "keys.txt")
    assert shown(vv, name, *given, "--input", "on.txt") == shown(vv, name, "--input", "keys.txt")
