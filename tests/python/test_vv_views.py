"""Tests how vv shows pictures and which part and camera it takes: --exposure, --view, --crop,
--pose, --intrinsics, --depth-along."""
import json
import struct

import pytest
from conftest import read_pfm, read_ppm

np = pytest.importorskip("numpy")
from exr_tools import read_exr, window  # noqa: E402

# A lamp above a floor, a mirror ball, glass, and a lit sky: every transport has something to do.
ROOM = """#VRML V2.0 utf8
NavigationInfo { headlight FALSE }
Viewpoint { position 0 1 8 }
Background { skyColor .2 .3 .4 }
DirectionalLight { direction -.3 -1 -.4 intensity .6 }
DEF Floor Transform { translation 0 -1 0 children Shape {
  appearance Appearance { material Material { diffuseColor .7 .6 .5 } } geometry Box { size 9 .2 9 } } }
DEF Ball Transform { translation -1.2 .2 0 children Shape {
  appearance Appearance { material Material { diffuseColor .2 .5 .9 specularColor .5 .5 .5 shininess .8 } }
  geometry Sphere { radius 1 } } }
DEF Lamp Transform { translation 1.5 1.5 0 children Shape {
  appearance Appearance { material Material { emissiveColor 1 .9 .7 } } geometry Sphere { radius .3 } } }
"""
SIZE = ("--size", "96x72")


@pytest.fixture
def room(vv):
    vv.write("room.wrl", ROOM)
    return vv


def made(vv, *arguments):
    done = vv(*arguments)
    assert done.returncode == 0, done.talk
    return done


def curve(v):
    """The curve of sRGB, as bytes."""
    v = np.clip(v, 0, 1)
    return np.floor(np.where(v <= .0031308, 12.92 * v, 1.055 * v**(1 / 2.4) - .055) * 255 + .5)


def hable(v):
    f = lambda x: (x * (.15 * x + .05) + .004) / (x * (.15 * x + .5) + .06) - 1 / 15
    return f(np.minimum(2 * v, 11.2)) / f(11.2)


# --- exposure and view ---


@pytest.mark.parametrize("arguments,shown", [
    ((), lambda v: v),
    (("--exposure", "1.5"), lambda v: v * 2**1.5),
    (("--exposure", "-2"), lambda v: v / 4),
    (("--view", "filmic"), hable),
    (("--view", "filmic", "--exposure", "2"), lambda v: hable(4 * v)),
])
def test_files_for_screens_have_the_curve(room, arguments, shown):
    made(room, "room.wrl", "-o", "x.ppm", "-o", "x.exr", "-o", "x.pfm", *SIZE, "--spp", "4",
         *arguments)
    attributes, planes = read_exr((room.folder / "x.exr").read_bytes())
    linear = np.stack([planes[k] for k in "RGB"], -1)
    _, _, floats = read_pfm((room.folder / "x.pfm").read_bytes())
    assert np.array_equal(linear, np.array(floats, np.float32)), "EXR and PFM keep the light"
    _, _, rows = read_ppm((room.folder / "x.ppm").read_bytes())
    wanted, got = curve(shown(linear.astype(float))), np.array(rows, float)
    assert np.abs(wanted - got).max() <= 1 and np.abs(wanted - got).mean() < (.01 if arguments else .25)
    assert ("viewCurve" in attributes) == bool(arguments)
    if arguments:
        stops, = struct.unpack("<f", attributes["viewExposure"][1])
        assert stops == (float(arguments[arguments.index("--exposure") + 1])
                         if "--exposure" in arguments else 0)
        assert attributes["viewCurve"][1].endswith(
            b"filmic" if "filmic" in arguments else b"standard")


def test_the_default_has_the_bytes_of_no_option(room):
    made(room, "room.wrl", "-o", "a.png", "-o", "a.exr", *SIZE, "--spp", "2")
    made(room, "room.wrl", "-o", "b.png", "-o", "b.exr", *SIZE, "--spp", "2", "--exposure", "0",
         "--view", "standard")
    for suffix in ("png", "exr"):
        assert (room.folder / f"a.{suffix}").read_bytes() == (room.folder /
                                                              f"b.{suffix}").read_bytes()


def test_a_fitting_exposure_is_said_and_does_not_depend_on_threads(room):
    pictures = []
    for threads in "13":
        done = made(room, "room.wrl", "-o", "x.png", "--stats", "x.json", *SIZE, "--spp", "4",
                    "--exposure", "auto", "--view", "agx", "--threads", threads)
        pictures.append((room.folder / "x.png").read_bytes())
    assert pictures[0] == pictures[1]
    image = json.loads((room.folder / "x.json").read_text())["image"]
    assert image["view"] == "agx" and f"--exposure auto is {image['exposure']:g} " in done.talk
    made(room, "room.wrl", "-o", "y.png", *SIZE, "--spp", "4", f"--exposure={image['exposure']}",
         "--view", "agx")
    assert (room.folder / "y.png").read_bytes() == pictures[0], "the number gives the same picture"


def test_a_sequence_has_the_exposure_of_its_first_picture(vv):
    vv.write(
        "fade.wrl", """#VRML V2.0 utf8
Viewpoint { position 0 0 5 }
NavigationInfo { headlight FALSE }
DEF T TimeSensor { cycleInterval 1 loop TRUE }
DEF I ColorInterpolator { key [ 0, 1 ] keyValue [ .8 .8 .8, .1 .1 .1 ] }
Shape { appearance Appearance { material DEF M Material { } } geometry Box { size 9 9 1 } }
ROUTE T.fraction_changed TO I.set_fraction
ROUTE I.value_changed TO M.emissiveColor
""")
    done = made(vv, "fade.wrl", "-o", "x{frame}.ppm", "-o", "x.gif", "--frames", "0-15/15",
                "--size", "8x8", "--spp", "1", "--exposure", "auto", "--stats", "s.json")
    assert done.talk.count("--exposure auto is") == 1
    first, last = (np.array(read_ppm((vv.folder / f"x{i}.ppm").read_bytes())[2], float)
                   for i in (0, 15))
    assert first.mean() > 1.3 * last.mean(), "it fades, and is not brightened again"
    assert (vv.folder / "x.gif").read_bytes()[:3] == b"GIF"
    assert "exposure" in json.loads((vv.folder / "s.json").read_text())["image"]


# --- crop ---

TRANSPORTS = ("auto", "whitted", "path", "light")


@pytest.mark.parametrize("transport", TRANSPORTS)
def test_a_part_has_the_bytes_of_the_whole(room, transport):
    channels = "z,normal,albedo,position,id,samples,variance,error,trust,reflection"
    common = ("room.wrl", *SIZE, "--spp", "36", "--transport", transport, "--channels", channels)
    made(room, *common, "-o", "whole.exr", "-o", "whole.ppm")
    made(room, *common, "-o", "part.exr", "-o", "part.ppm", "--crop", "30,20,41x33")
    (whole, planes), (part, cut) = (read_exr((room.folder / f"{n}.exr").read_bytes())
                                    for n in ("whole", "part"))
    assert window(whole, "dataWindow") == window(whole, "displayWindow") == (0, 0, 96, 72)
    assert window(part, "dataWindow") == (30, 20, 41, 33)
    assert window(part, "displayWindow") == (0, 0, 96, 72)
    assert planes.keys() == cut.keys() and len(cut) > 20
    for name, plane in planes.items():
        assert plane[20:53, 30:71].tobytes() == cut[name].tobytes(), name
    _, _, rows = read_ppm((room.folder / "whole.ppm").read_bytes())
    width, height, few = read_ppm((room.folder / "part.ppm").read_bytes())
    assert (width, height) == (41, 33) and [row[30:71] for row in rows[20:53]] == few


def test_a_part_at_the_border_behind_a_background(room):
    common = ("room.wrl", *SIZE, "--spp", "5", "--background", "whole.png")
    made(room, "room.wrl", "-o", "whole.png", *SIZE, "--spp", "1", "--camera", "3,5,9:0,0,0")
    made(room, *common, "-o", "a.pfm")
    made(room, *common, "-o", "b.pfm", "--crop", "80,0,16x72")
    rows = read_pfm((room.folder / "a.pfm").read_bytes())[2]
    assert [row[80:] for row in rows] == read_pfm((room.folder / "b.pfm").read_bytes())[2]


def test_a_part_is_less_work(room):
    rays = []
    for crop in ((), ("--crop", "64,48,32x24")):
        made(room, "room.wrl", "-o", "x.png", "--size", "256x192", "--spp", "16", "--stats",
             "x.json", *crop)
        stats = json.loads((room.folder / "x.json").read_text())
        rays.append(stats["rays"]["camera"])
    assert rays[1] * 40 <= rays[0]
    assert stats["image"]["crop"] == [64, 48, 32, 24] and stats["image"]["width"] == 256


def test_parts_of_sequences_and_films(room):
    common = ("room.wrl", "--size", "64x48", "--spp", "2", "--turntable", "2")
    made(room, *common, "-o", "a{frame}.ppm")
    made(room, *common, "-o", "b{frame}.ppm", "-o", "b.gif", "--crop", "10,10,20x16")
    for i in "01":
        rows = read_ppm((room.folder / f"a{i}.ppm").read_bytes())[2]
        assert [row[10:30] for row in rows[10:26]
               ] == read_ppm((room.folder / f"b{i}.ppm").read_bytes())[2]
    assert struct.unpack("<2H", (room.folder / "b.gif").read_bytes()[6:10]) == (20, 16)


def test_a_part_is_compared_with_a_part(room):
    common = ("room.wrl", *SIZE, "--spp", "2", "--crop", "8,8,16x16")
    made(room, *common, "-o", "x.exr")
    done = made(room, *common, "--compare", "x.exr")
    assert "rmse      0\n" in done.text


# --- pose and intrinsics ---

CORNERS = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]


def world_of_points():
    """Small bright spheres at known places."""
    spheres = "".join(
        f"Transform {{ translation {x} {y} {z} children Shape {{ appearance Appearance {{ material "
        f"Material {{ emissiveColor 1 1 1 diffuseColor 0 0 0 }} }} geometry Sphere {{ radius .06 }} }} }}\n"
        for x, y, z in CORNERS)
    return "#VRML V2.0 utf8\nNavigationInfo { headlight FALSE }\nViewpoint { position 0 0 9 }\n" + spheres


def pose_of():
    """A pose in OpenCV's axes: turned about a slanted axis, some way back."""
    axis = np.array([1, 2, .5]) / np.linalg.norm([1, 2, .5])
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    turn = np.eye(3) + np.sin(.5) * k + (1 - np.cos(.5)) * k @ k
    pose = np.eye(4)
    pose[:3, :3] = turn
    pose[:3, 3] = turn @ [.2, -.1, -6]
    return pose


@pytest.mark.parametrize("how", ["opencv:", "", "opengl:", "file", "opengl file"])
def test_points_appear_where_the_matrices_say(vv, how):
    """The centres of light of small spheres are within a 25th of a pixel of the projections; the
    discs are a few pixels wide, so that these sums are as exact as that."""
    vv.write("points.wrl", world_of_points())
    pose, given = pose_of(), pose_of()
    if "opengl" in how:
        given[:3, 1:3] *= -1
    text = ",".join(repr(float(v)) for v in given.ravel())
    if "file" in how:
        vv.write("pose.txt", "\n".join(" ".join(repr(float(v)) for v in row) for row in given))
        text = "pose.txt"
    prefix = "opengl:" if "opengl" in how else how if ":" in how else ""
    fx, fy, cx, cy = 210, 190, 93.25, 66.5
    made(vv, "points.wrl", "-o", "x.pfm", "--size", "180x130", "--spp", "1024", "--intrinsics",
         f"{fx},{fy},{cx},{cy}", "--pose", prefix + text)
    image = np.array(read_pfm((vv.folder / "x.pfm").read_bytes())[2])[:, :, 1]
    rows, columns = np.mgrid[:130, :180]
    found = 0
    for corner in CORNERS:
        x, y, z = pose[:3, :3].T @ (np.array(corner) - pose[:3, 3])
        u, v = fx * x / z + cx, fy * y / z + cy
        near = (np.abs(columns - u) < 6) & (np.abs(rows - v) < 6)
        light = image * near
        assert light.sum() > 2, corner
        assert abs((light * columns).sum() / light.sum() - u) < .04
        assert abs((light * rows).sum() / light.sum() - v) < .04
        found += 1
    assert found == 8


def test_intrinsics_of_an_angle_of_view_change_nothing(room):
    """A principal point in the middle, and the focal length of the Viewpoint's angle."""
    focal = 36 / np.tan(np.pi / 8)
    made(room, "room.wrl", "-o", "a.exr", *SIZE, "--spp", "1", "--channels", "z")
    made(room, "room.wrl", "-o", "b.exr", *SIZE, "--spp", "1", "--channels", "z", "--intrinsics",
         f"{focal},{focal},47.5,35.5")
    a, b = (read_exr((room.folder / f"{n}.exr").read_bytes())[1]["Z"] for n in "ab")
    assert np.isfinite(a).any() and np.allclose(a, b, rtol=1e-4)


# --- depth ---

WALL = """#VRML V2.0 utf8
NavigationInfo { headlight FALSE }
DEF Eye Viewpoint { position 1 2 10 }
DEF Flat OrthoViewpoint { position 1 2 10 fieldOfView [ -4, -3, 4, 3 ] }
Shape { appearance Appearance { material Material { emissiveColor .5 .5 .5 } }
  geometry Box { size 90 90 .5 } }
"""
AWAY = 9.75  # how far the wall's front is from the camera


@pytest.fixture
def wall(vv):
    vv.write("wall.x3dv", WALL.replace("#VRML V2.0 utf8", "#X3D V3.3 utf8\nPROFILE Full"))
    return vv


def depth(vv, *arguments):
    made(vv, "wall.x3dv", "-o", "z.exr", "--size", "64x48", "--spp", "1", "--channels", "z",
         *arguments)
    attributes, planes = read_exr((vv.folder / "z.exr").read_bytes())
    assert attributes["depthAlong"][0] == "string"
    return attributes["depthAlong"][1], planes["Z"]


def angles():
    """The tangents of the pixel centres of the default camera."""
    half = np.tan(np.pi / 8)
    columns, rows = (np.arange(64) + .5 - 32) / 24 * half, (np.arange(48) + .5 - 24) / 24 * half
    return np.meshgrid(columns, rows)


def test_depth_along_the_axis_and_the_ray(wall):
    said, axis = depth(wall)
    assert said == b"axis" and np.allclose(axis, AWAY, rtol=1e-5)
    said, ray = depth(wall, "--depth-along", "ray")
    x, y = angles()
    assert said == b"ray" and np.allclose(ray, AWAY * np.sqrt(1 + x * x + y * y), rtol=2e-5)


def test_depth_of_a_shifted_camera(wall):
    """A principal point far aside: the axis is perpendicular to the picture."""
    inner = ("--intrinsics", "60,50,-10,70")
    assert np.allclose(depth(wall, *inner)[1], AWAY, rtol=1e-5)
    x, y = np.meshgrid((np.arange(64) + 10) / 60, (np.arange(48) - 70) / 50)
    assert np.allclose(depth(wall, *inner, "--depth-along", "ray")[1],
                       AWAY * np.sqrt(1 + x * x + y * y), rtol=2e-5)


def test_depth_of_parallel_rays(wall):
    for along in ("axis", "ray"):
        assert np.allclose(
            depth(wall, "--viewpoint", "Flat", "--depth-along", along)[1], AWAY, rtol=1e-5)


def test_depth_of_lenses_and_panoramas(wall):
    """A panorama sees the wall at the cosine of two angles; a lens moves its rays only a little."""
    common = ("--camera-shader", "Panorama")
    _, axis = depth(wall, *common)
    _, ray = depth(wall, *common, "--depth-along", "ray")
    seen = np.isfinite(ray)
    assert 200 < seen.sum() and np.allclose(axis[seen], AWAY, rtol=1e-4)
    longitude = (np.arange(64) + .5 - 32) / 64 * 2 * np.pi
    latitude = (np.arange(48) + .5 - 24) / 48 * np.pi
    cosines = np.cos(latitude)[:, None] * np.cos(longitude)[None]
    middle = cosines > .5
    assert np.allclose(ray[middle], AWAY / cosines[middle], rtol=1e-3)
    lens = ("--camera-shader", "ThinLens:radius=.1:focus=5")
    assert np.allclose(depth(wall, *lens)[1], AWAY, rtol=1e-5)
    x, y = angles()
    assert np.allclose(depth(wall, *lens, "--depth-along", "ray")[1],
                       AWAY * np.sqrt(1 + x * x + y * y), atol=.1)


# --- what is refused ---

IDENTITY = "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1"


@pytest.mark.parametrize("arguments,words", [
    (("--exposure", "bright"), "--exposure: auto or a number of stops from -32 to 32"),
    (("--exposure", "33"), "--exposure: auto or a number of stops"),
    (("--exposure", "nan"), "--exposure: auto or a number of stops"),
    (("--view", "aces"), "--view: standard, filmic or agx was expected, not \"aces\""),
    (("--view", "agx", "--colour", "vrml97"), "need light that is added linearly"),
    (("--exposure", "1", "--false-colour", "auto"), "cannot be used with"),
    (("--exposure", "auto", "--audit", "4"), "--exposure auto needs -o without --audit"),
    (("--crop", "1,2"), "--crop: X,Y,WxH was expected"),
    (("--crop", "1,2,3x0"), "--crop: X,Y,WxH was expected"),
    (("--crop", "-1,2,3x3"), "--crop: X,Y,WxH was expected"),
    (("--crop", "1.5,2,3x3"), "--crop: X,Y,WxH was expected"),
    (("--crop", "99999999999,2,3x3"), "--crop: X,Y,WxH was expected"),
    (("--crop", "30,2,3x3"), "does not lie within the picture of 32x24 pixels"),
    (("--crop", "2147483647,2147483647,2147483647x1"), "does not lie within"),
    (("--crop", "1,1,3x3", "--error", "5%"), "--crop: with a target error"),
    (("--crop", "0,1,3x3", "--channels", "error"), "--crop: errors at the border"),
    (("--crop", "1,1,3x3", "--audit", "4"), "cannot be used with --crop"),
    (("--intrinsics", "1,2,3"), "--intrinsics: FX,FY,CX,CY was expected"),
    (("--intrinsics", "0,2,3,4"), "--intrinsics: FX,FY,CX,CY was expected"),
    (("--intrinsics", "1,inf,3,4"), "--intrinsics: FX,FY,CX,CY was expected"),
    (("--intrinsics", "9,9,3,4", "--fov", "30"), "--intrinsics says what the camera sees"),
    (("--pose", "1,2,3"), "--pose: 16 numbers"),
    (("--pose", IDENTITY.replace("1", "2", 1)), "must turn and move only"),
    (("--pose", IDENTITY.replace("1", "-1", 1)), "must turn and move only"),
    (("--pose", IDENTITY[:-1] + "2"), "must turn and move only"),
    (("--pose", IDENTITY, "--fit"), "cannot be used with --fit"),
    (("--pose", IDENTITY, "--camera", "1,2,3:0,0,0"), "only one of --camera and --pose"),
    (("--pose", IDENTITY, "--viewpoint", "0"), "--viewpoint cannot be used with"),
    (("--depth-along", "z"), "--depth-along: "),
])
def test_wrong_options_are_named(vv, arguments, words):
    done = vv("box.wrl", "-o", "x.png", "--size", "32x24", "--spp", "1", *arguments)
    assert done.returncode == 2 and words in done.talk, done.talk
    assert not (vv.folder / "x.png").exists()


def test_wrong_poses_in_files(vv):
    for content, words in ((b"1 2 3", "16 numbers were expected"),
                           (b"\0" * 5000, "16 numbers were expected"),
                           (IDENTITY.encode() + b" 1", "16 numbers were expected"),
                           (IDENTITY.replace("1", "2").encode(), "must turn and move only")):
        vv.write("pose", content)
        done = vv("box.wrl", "-o", "x.png", "--pose", "pose")
        assert done.returncode == 3 and words in done.talk and "pose" in done.talk, done.talk
    for missing in ("nothing", "."):
        done = vv("box.wrl", "-o", "x.png", "--pose", missing)
        assert done.returncode == 3 and "cannot read" in done.talk, done.talk


@pytest.mark.parametrize("arguments", [("--exposure", "auto"), ("--crop", "1,1,2x2")])
def test_the_window_refuses_what_it_has_not(vv, arguments):
    done = vv("serve", "box.wrl", *arguments)
    assert done.returncode == 2 and "needs -o" in done.talk
