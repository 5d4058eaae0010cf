"""Lights and surroundings of X3D in pictures: scopes of lights, EnvironmentLight, cube maps and
TextureBackground, against closed forms and against nodes of VRML97."""
import itertools
import struct

import numpy as np
import pytest

xvrml = pytest.importorskip("xvrml")

HEAD = "#X3D V3.3 utf8\nPROFILE Immersive\nNavigationInfo { headlight FALSE }\n"
HEAD4 = HEAD.replace("3.3", "4.0")
WHITE = "appearance Appearance { material Material { diffuseColor 1 1 1 } }"
MIRROR = """appearance Appearance { material PhysicalMaterial {
  baseColor 1 1 1 metallic 1 roughness 0 } }"""
# Colours of the faces by the direction in which they are seen.
FACES = {
    "front": ((0, 0, -1), (1, 0, 0)),
    "back": ((0, 0, 1), (0, 1, 0)),
    "left": ((-1, 0, 0), (0, 0, 1)),
    "right": ((1, 0, 0), (1, 1, 0)),
    "top": ((0, 1, 0), (1, 0, 1)),
    "bottom": ((0, -1, 0), (0, 1, 1)),
}


def hexadecimal(color):
    return "0x%02X%02X%02X" % tuple(255 * c for c in color)


def composed():
    return "ComposedCubeMapTexture { " + " ".join(
        f"{face} PixelTexture {{ image 1 1 3 {hexadecimal(color)} }}"
        for face, (_, color) in FACES.items()) + " }"


def picture(text, spp=16, size=(30, 10), **options):
    return np.asarray(xvrml.loads(text).render(size=size, spp=spp, **options))


def picture_of_file(folder, text, **options):
    """The same for a world that names pictures in a folder."""
    (folder / "world.x3dv").write_text(text)
    world = xvrml.load(str(folder / "world.x3dv"))
    image = np.asarray(world.render(spp=4, **options))
    assert not world.warnings
    return image


def boxes(lights_left, lights_right):
    """Two white walls, each in a group with lights."""
    groups = "".join(f"""Group {{ children [ {lights}
      Transform {{ translation {x} 0 0 children Shape {{ {WHITE} geometry Box {{ }} }} }} ] }}
      """ for x, lights in ((-2, lights_left), (2, lights_right)))
    return HEAD + "Viewpoint { position 0 0 10 }\n" + groups


def two(text, **options):
    image = picture(text, size=(60, 20), **options)
    # The boxes' middles, seen from 9 in front of their faces with a height of 2 * 10 tan(fov / 2).
    x = 30 + np.array([-1, 1]) * 2 / 9 * 10 / np.tan(.785398 / 2)
    return [image[10, int(i), :3] for i in x]


@pytest.mark.parametrize("light", ("DirectionalLight { direction 0 0 -1 %s }",
                                   "PointLight { location 0 0 9 %s }",
                                   "SpotLight { location 0 0 90 cutOffAngle .3 %s }"))
@pytest.mark.parametrize("is_global", (False, True, None))
def test_global_decides_for_all_lights(light, is_global):
    text = light % ("" if is_global is None else "global " + str(is_global).upper())
    left, right = two(boxes(text, ""))
    everywhere = is_global if is_global is not None else "Directional" not in light
    assert left.min() > .5
    assert (right.max() > .5) == everywhere


def test_global_changes_at_run_time():
    text = boxes("DEF L PointLight { location 0 0 9 global FALSE }", "")
    world = xvrml.loads(text)
    before = np.asarray(world.render(size=(60, 20), spp=4))
    for value in (True, False):
        setattr(world["L"], "global", value)  # a keyword
        now = np.asarray(world.render(size=(60, 20), spp=4))
        fresh = np.asarray(
            xvrml.loads(text.replace("global FALSE",
                                     "global " + str(value).upper())).render(size=(60, 20), spp=4))
        assert (now == fresh).all() and (now == before).all() == (not value)


@pytest.mark.parametrize("version,is_global,reaches", (("3.3", None, True), ("4.0", None, False),
                                                       ("4.0", True, True), ("4.0", False, False)))
def test_inlines_of_x3d_4_keep_their_lights(tmp_path, version, is_global, reaches):
    (tmp_path / "lamp.x3dv").write_text(
        HEAD + "PointLight { location 0 0 9 } Transform { translation -2 0 0 children Shape { " +
        WHITE + " geometry Box { } } }")
    field = "" if is_global is None else "global " + str(is_global).upper()
    (tmp_path / "world.x3dv").write_text(
        HEAD.replace("3.3", version) + f"""Viewpoint {{ position 0 0 10 }}
    Inline {{ url "lamp.x3dv" {field} }}
    Transform {{ translation 2 0 0 children Shape {{ {WHITE} geometry Box {{ }} }} }}""")
    image = np.asarray(xvrml.load(str(tmp_path / "world.x3dv")).render(size=(60, 20), spp=4))
    assert image[10, 24, :3].min() > .3
    assert (image[10, 36, :3].max() > .3) == reaches


def facing(direction, rotation="0 0 1 0", cube=None, more=""):
    """A mirror that shows what lies in a direction to a camera that looks from beside it."""
    cube = cube or composed()
    d = np.array(direction, float)
    # The camera looks along -z at a small mirror at the origin, whose normal halves the angle
    # between the way to the camera and the direction. A mirror cannot turn light to where it came
    # from, so the camera sees -z from the front through a slanted one.
    eye = np.array([0, 0, 1.])
    if d @ eye < -.9:
        eye = np.array([.8, 0, .6])
    half = (d + eye) / np.linalg.norm(d + eye)
    axis = np.cross([0, 0, 1], half)
    angle = np.arccos(np.clip(half[2], -1, 1))
    if np.linalg.norm(axis) < 1e-9:
        axis = np.array([1., 0, 0])
    turn = np.arctan2(eye[0], eye[2])
    at = 10 * eye
    return HEAD4 + f"""
    Viewpoint {{ position {at[0]} {at[1]} {at[2]} orientation 0 1 0 {turn} }}
    EnvironmentLight {{ rotation {rotation} specularTexture {cube} {more} }}
    Background {{ skyColor 0.25 0.25 0.25 }}
    Transform {{ rotation {axis[0]} {axis[1]} {axis[2]} {angle} children Shape {{ {MIRROR}
      geometry IndexedFaceSet {{ solid FALSE coordIndex [ 0 1 2 3 -1 ] coord Coordinate {{ point [
        -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] }} }} }} }}"""


@pytest.mark.parametrize("face", FACES)
def test_a_mirror_shows_the_face_of_its_direction(face):
    direction, color = FACES[face]
    image = picture(facing(direction), size=(21, 21))
    np.testing.assert_allclose(image[10, 10, :3], color, atol=1e-4)
    # Beside the mirror the Background is seen.
    np.testing.assert_array_equal(image[0, 0], picture(HEAD + "Background { skyColor .25 .25 .25 }",
                                                        size=(3, 3))[0, 0])


@pytest.mark.parametrize("rotation,axes", (("0 1 0 1.570796", lambda x, y, z: (z, y, -x)),
                                           ("1 0 0 1.570796", lambda x, y, z: (x, -z, y))))
def test_rotation_turns_the_surroundings(rotation, axes):
    for direction, color in FACES.values():
        image = picture(facing(axes(*direction), rotation), size=(21, 21))
        np.testing.assert_allclose(image[10, 10, :3], color, atol=1e-4)


def test_even_surroundings_are_a_furnace():
    """A white body in surroundings of one radiance has that radiance."""
    faces = " ".join(f"{face} PixelTexture {{ image 1 1 3 0xFFFFFF }}" for face in FACES)
    for texture in (f"specularTexture ComposedCubeMapTexture {{ {faces} }}",
                    f"diffuseTexture ComposedCubeMapTexture {{ {faces} }}", ""):
        text = HEAD4 + f"""EnvironmentLight {{ intensity .5 {texture} }}
        Viewpoint {{ position 0 0 6 }} Shape {{ {WHITE} geometry Sphere {{ }} }}"""
        image = picture(text, spp=256, size=(21, 21))
        np.testing.assert_allclose(image[10, 10, :3], .5, atol=.01)
        assert image[0, 0].max() == 0  # nothing is seen of the light itself


def dds(faces, side=2):
    """A cube map with the faces +x -x +y -y +z -z, each of one colour."""
    header = struct.pack("<4s7I44x", b"DDS ", 124, 0x1007, side, side, 4 * side, 0, 0)
    header += struct.pack("<8I", 32, 0x41, 0, 32, 0xff, 0xff00, 0xff0000, 0xff000000)
    header += struct.pack("<5I", 0x1008, 0xfe00, 0, 0, 0)
    return header + b"".join(bytes([*(255 * c for c in color), 255]) * side**2 for color in faces)


def test_an_image_cube_map_of_dds(tmp_path):
    order = ("right", "left", "top", "bottom", "back", "front")
    file = tmp_path / "sky.dds"
    file.write_bytes(dds([FACES[name][1] for name in order]))
    for direction, color in FACES.values():
        text = facing(direction, cube='ImageCubeMapTexture { url "sky.dds" }')
        image = picture_of_file(tmp_path, text, size=(21, 21))
        np.testing.assert_allclose(image[10, 10, :3], color, atol=1e-4)


@pytest.mark.parametrize("content", (b"", b"DDS ", dds([(1, 1, 1)] * 6)[:-1],
                                     dds([(1, 1, 1)] * 5), dds([(1, 1, 1)] * 6, side=0)),
                         ids=("empty", "header", "short", "five faces", "no pixels"))
def test_damaged_cube_maps_are_a_warning(tmp_path, content):
    file = tmp_path / "sky.dds"
    file.write_bytes(content)
    (tmp_path / "world.x3dv").write_text(
        facing((0, 0, 1), cube='ImageCubeMapTexture { url "sky.dds" }'))
    world = xvrml.load(str(tmp_path / "world.x3dv"))
    image = np.asarray(world.render(size=(21, 21), spp=1))
    assert image[10, 10, :3].max() == 0
    assert sum("no picture" in str(m) for m in world.warnings) == 1


def test_extreme_values_are_finite():
    for fields in ("intensity 1e38 color 1 1 1", "rotation 0 0 0 1", "intensity -1",
                   "color 1e38 -1 0 ", "origin 1e38 0 0 diffuseCoefficients [ 1 2 3 ]"):
        image = picture(HEAD4 + f"""EnvironmentLight {{ {fields} }}
        Viewpoint {{ position 0 0 6 }} Shape {{ {WHITE} geometry Sphere {{ }} }}""",
                        size=(9, 9))
        assert np.isfinite(image).all()


URLS = "frontUrl backUrl leftUrl rightUrl topUrl bottomUrl".split()


def test_texture_background_equals_background(tmp_path):
    from PIL import Image
    random = np.random.default_rng(1)
    for field in URLS:
        Image.fromarray(random.integers(0, 256, (8, 8, 4),
                                        np.uint8), "RGBA").save(tmp_path / f"{field}.png")
    fields = "skyColor [ 0 0 1, 1 0 0 ] skyAngle 1.5 groundColor [ 0 1 0, 1 1 0 ] groundAngle 1"
    pictures = " ".join(f'{field} "{field}.png"' for field in URLS)
    nodes = " ".join(f'{field[:-3]}Texture ImageTexture {{ url "{field}.png" }}'
                     for field in URLS)
    for axis, angle in itertools.product(("0 1 0", "1 0 0"), (0, .7, 2.2)):
        view = f"Viewpoint {{ orientation {axis} {angle} fieldOfView 1.5 }}"
        one, other = (picture_of_file(tmp_path, HEAD + view + node, size=(64, 48))
                      for node in (f"Background {{ {fields} {pictures} }}",
                                   f"TextureBackground {{ {fields} {nodes} }}"))
        np.testing.assert_array_equal(one, other)
        assert len(np.unique(one)) > 100  # the pictures are seen


@pytest.mark.parametrize("node", ("Background", "TextureBackground"))
@pytest.mark.parametrize("transparency", (0, .25, 1))
def test_transparency_of_the_sky_is_in_alpha(node, transparency):
    for sky in ("skyColor 1 .5 1", "skyColor [ 1 .5 1, 1 .5 1 ] skyAngle 1"):
        full, clear = (picture(HEAD + f"{node} {{ {sky} transparency {t} }}", size=(4, 3))
                       for t in (0, transparency))
        np.testing.assert_allclose(clear, full * (1 - transparency), atol=1e-6)


POLISHED = "appearance Appearance { texture %s }"
AROUND = HEAD4 + "Viewpoint { position 0 0 4 } Background { skyColor .25 .25 .25 } "


def ball(appearance, more=""):
    return AROUND + more + "Shape { " + appearance + " geometry Sphere { } }"


def test_a_cube_map_on_a_sphere_is_what_a_mirror_sees():
    """The six colours lie where a mirror shows the same cube map as an EnvironmentLight."""
    mapped = picture(ball(POLISHED % composed()), size=(80, 80), spp=64)
    mirror = picture(ball(MIRROR, f"EnvironmentLight {{ specularTexture {composed()} }} "),
                     size=(80, 80), spp=64)
    inside = np.hypot(*(np.indices((80, 80)) - 39.5)) < 17
    assert mapped[40, 40, :3] == pytest.approx(FACES["back"][1])
    for x, face in ((40 - 12, "left"), (40 + 12, "right")):
        assert mapped[40, x, :3] == pytest.approx(FACES[face][1]), face
    # Rows go up in pictures that are arrays with the upper row first.
    for y, face in ((40 - 12, "top"), (40 + 12, "bottom")):
        assert mapped[y, 40, :3] == pytest.approx(FACES[face][1]), face
    difference = np.abs(mapped - mirror)[inside][:, :3].max(axis=1)
    assert np.mean(difference > .02) < .15  # only edges between colours are noisy
    assert difference.mean() < .02


def test_a_cube_map_has_the_same_bytes_for_any_number_of_threads():
    text = ball(POLISHED % composed())
    one, many = (np.asarray(xvrml.loads(text).render(size=(64, 48), spp=4, threads=n))
                 for n in (1, 4))
    np.testing.assert_array_equal(one, many)


@pytest.mark.parametrize("transport", ("whitted", "path"))
def test_a_generated_cube_map_is_a_mirror_of_the_world(transport):
    """Equal to the stock shader Mirror of the same reflectance."""
    world = """Transform { translation 3 0 3 children Shape { appearance Appearance { material
      Material { diffuseColor 0 0 0 emissiveColor 1 .5 0 } } geometry Box { } } } """
    generated = """appearance Appearance { material Material { diffuseColor .5 1 .25 }
      texture GeneratedCubeMapTexture { } }"""
    stock = """appearance ORTAppearance { shader ORTShader { name "Mirror" file "mirror"
      options "color reflectance %f %f %f" } }"""
    a = picture(ball(generated, world), size=(60, 60), spp=64, transport=transport)
    # sRGB .5 1 .25 as linear numbers
    linear = [((c + .055) / 1.055) ** 2.4 for c in (.5, 1, .25)]
    b = picture(ball(stock % tuple(linear), world), size=(60, 60), spp=64, transport=transport)
    assert a[30, 30, :3] == pytest.approx(b[30, 30, :3], abs=2e-3)
    assert np.abs(a - b).mean() < 5e-3


def test_image_cube_maps_on_a_sphere(tmp_path):
    """Files of six faces and of the whole sphere lie where a mirror sees them in the surroundings."""
    from PIL import Image
    order = ("right", "left", "top", "bottom", "back", "front")
    (tmp_path / "sky.dds").write_bytes(dds([FACES[name][1] for name in order]))
    x, y = np.meshgrid(np.arange(64), np.arange(32))
    smooth = np.stack([np.cos(x * np.pi / 32) * 100 + 128, y * 8, np.sin(x * np.pi / 32) * 99 + 99],
                      axis=-1)
    Image.fromarray(smooth.astype(np.uint8), "RGB").save(tmp_path / "sky.png")
    inside = np.hypot(*(np.indices((40, 40)) - 19.5)) < 7
    for file in ("sky.dds", "sky.png"):
        cube = f'ImageCubeMapTexture {{ url "{file}" }}'
        one, other = (picture_of_file(tmp_path, text, size=(40, 40)) for text in (
            ball(POLISHED % cube),
            ball(MIRROR, f"EnvironmentLight {{ specularTexture {cube} }} ")))
        difference = np.abs(one - other)[inside][:, :3]
        assert difference.mean() < .02, file
        assert one[inside][:, :3].std() > .05, file
