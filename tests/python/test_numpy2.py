"""Tests that all arrays of the package are right under numpy 2, too: those that go in and those that
come out, of every type. A probe runs under the numpy of the tests and under the newest one; both must
print the same. $OPENRT_NUMPY2 is a folder with a newer numpy; without it, pip installs one into a
folder of the tests. Where that is impossible, the test is skipped."""
import os
import pathlib
import re
import subprocess
import sys

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

from conftest import ROOT  # noqa: E402

PROBE = '''
import hashlib, pickle, sys
import numpy as np
import xvrml
from xvrml import rt

print("numpy", np.__version__, file=sys.stderr)

def tell(name, value):
    """Prints type, shape, strides and numbers of arrays, also those in dicts."""
    if isinstance(value, dict):
        for key in sorted(value):
            tell(f"{name}.{key}", value[key])
        return
    if not isinstance(value, np.ndarray):
        print(name, type(value).__name__, repr(value))
        return
    dense = np.ascontiguousarray(value)
    assert dense.tobytes() == value.tobytes() and len(value.tobytes()) == value.size * value.itemsize
    digest = hashlib.sha256(dense.tobytes()).hexdigest()[:16]
    first = [float(v) for v in dense.ravel()[:6]]
    print(name, value.dtype.str, value.shape, value.strides, digest, first)

def refused(name, call):
    try:
        call()
    except (TypeError, ValueError, OverflowError) as error:
        print(name, "refused:", str(error).split(", not ")[0][:90])
    else:
        print(name, "taken")

NUMBERS = ["bool", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "float16",
           "float32", "float64", "longdouble", ">i4", ">f8", "<u2"]
OTHERS = ["complex64", "S4", "U4", "datetime64[s]", "timedelta64[s]", [("a", "f4"), ("b", "i2")]]

# Fields of nodes: each type of an array, given and read back.
world = xvrml.World()
sets = {
    "Coordinate.point": (lambda v: xvrml.Coordinate(point=v), np.arange(12).reshape(4, 3)),
    "IndexedFaceSet.coordIndex": (lambda v: xvrml.IndexedFaceSet(coordIndex=v), np.arange(6)),
    "ElevationGrid.height": (lambda v: xvrml.ElevationGrid(height=v), np.arange(6)),
    "Color.color": (lambda v: xvrml.Color(color=v), np.arange(6).reshape(2, 3) % 2),
    "TextureCoordinate.point": (lambda v: xvrml.TextureCoordinate(point=v), np.arange(6).reshape(3, 2)),
    "OrientationInterpolator.keyValue": (
        lambda v: xvrml.OrientationInterpolator(keyValue=v), np.arange(8).reshape(2, 4)),
    "PixelTexture.image": (lambda v: xvrml.PixelTexture(image=v), np.arange(24).reshape(2, 4, 3)),
    "Transform.translation": (lambda v: xvrml.Transform(translation=v), np.arange(3)),
    "Box.size": (lambda v: xvrml.Box(size=v), np.arange(1, 4)),
}
for name, (make, numbers) in sets.items():
    field = name.split(".")[1]
    for kind in NUMBERS:
        given = numbers.astype(kind)
        try:
            tell(f"{name} {kind}", getattr(make(given), field))
            tell(f"{name} {kind} turned", getattr(make(np.asfortranarray(given)), field))
        except (TypeError, ValueError) as error:
            print(name, kind, "refused:", str(error)[:90])
    for kind in OTHERS:
        refused(f"{name} {kind}", lambda: make(np.zeros(numbers.shape, kind)))
    refused(f"{name} object", lambda: make(np.full(numbers.shape, None)))
for scalar in (np.float32(0.5), np.float64(0.5), np.int8(1), np.uint64(1)):
    print("Material.shininess", scalar.dtype.str, xvrml.Material(shininess=scalar).shininess)
print("Box solid", xvrml.IndexedFaceSet(solid=np.bool_(False)).solid)

# Fields that are no view of the node: empty ones, bool, double and long ones.
rich = xvrml.loads("""#X3D V4.0 utf8
PROFILE Full
PROTO Holder [
  inputOutput MFBool bits [TRUE FALSE FALSE TRUE]
  inputOutput MFDouble doubles [1 2.5 1e300]
  inputOutput MFVec3d far [1 2 3, 4 5 6.125]
  inputOutput MFVec2d flat [1 2]
  inputOutput MFVec4f four [1 2 3 4]
  inputOutput MFVec2f two [1 2, 3 4]
  inputOutput MFTime times [1 2 1e9]
  inputOutput MFRotation turns [0 1 0 1]
  inputOutput MFColorRGBA colours [1 0 .5 .25]
  inputOutput MFInt32 none []
] { Group { } }
DEF Here Holder { }
Shape { appearance Appearance { texture DEF Picture PixelTexture {
  image 2 2 3 0x010203 0x040506 0x070809 0x0a0b0c } }
  geometry DEF Empty IndexedFaceSet { coord Coordinate { } } }
""", path="rich.x3dv")
for field in ("bits", "doubles", "far", "flat", "four", "two", "times", "turns", "colours", "none"):
    for kind in [None, *NUMBERS, *OTHERS]:
        try:
            if kind is not None:
                setattr(rich["Here"], field, np.asarray(getattr(rich["Here"], field)).clip(0, 1).astype(kind))
            tell(f"{field} {kind}", getattr(rich["Here"], field))
        except (TypeError, ValueError) as error:
            print(field, kind, "refused:", str(error).split(", not ")[0][:90])
tell("image", rich["Picture"].image)
tell("empty", rich["Empty"].coordIndex)

SCENE = """#VRML V2.0 utf8
Viewpoint { position 0 0 5 }
NavigationInfo { headlight FALSE }
PointLight { location 1 2 4 ambientIntensity .5 }
DEF Ball Transform { translation 1 0 0 children Shape {
  appearance Appearance { material DEF Paint Material { diffuseColor .5 .5 .5 } } geometry Sphere { } } }
DEF Cube Transform { translation -1 0 0 children Shape {
  appearance Appearance { material Material { } texture ImageTexture { url "none.png" } } geometry Box { } } }
DEF Clock TimeSensor { loop TRUE }
DEF Way PositionInterpolator { key [0, 1] keyValue [0 0 0, 1 0 0] }
ROUTE Clock.fraction_changed TO Way.set_fraction
"""
world = xvrml.loads(SCENE)
tell("bounds", world.bounds)
for view in world.viewpoints:
    tell("viewpoint", view.matrix)
for i, mesh in enumerate(world.meshes(spheres=6)):
    for member in ("matrix", "vertices", "world_vertices", "faces", "normals", "texcoords", "colors"):
        tell(f"mesh {i} {member}", getattr(mesh, member))
for i, mesh in enumerate(world.meshes(view=np.eye(4, dtype="float32"))):
    tell(f"mesh of a view {i}", mesh.matrix)

channels = ("rgba", "z", "normal", "position", "id", "samples", "error", "trust", "cryptomatte", "albedo", "variance")
picture = world.render(size=(16, 12), spp=4, channels=channels, isa="sse2")
for channel in picture.channels:
    tell(f"channel {channel}", picture[channel])
tell("array", picture.array)
tell("display", picture.display)
tell("as float64", np.asarray(picture, dtype="float64"))
tell("as float16", np.asarray(picture).astype("float16"))
tell("copy", np.array(picture))
tell("error", picture.error)
try:
    tell("denoised", xvrml.denoise(np.asarray(picture)[..., :3].astype("float64")))
except xvrml.RenderError:  # without Open Image Denoise
    print("denoised nothing")
for pose in (np.eye(4), np.eye(4, dtype="float32"), np.eye(4, dtype="int64")):
    pose = pose.copy()
    pose[2, 3] = 5
    tell("pose " + pose.dtype.str, world.render(size=(8, 6), spp=1, camera=pose, isa="sse2").array)
tell("background", world.render(size=(4, 3), spp=1, background=np.array([1, .5, 0]), isa="sse2").array)
K = np.array([[10, 0, 8], [0, 10, 6], [0, 0, 1]], "int32")
camera = xvrml.Pinhole(K, np.eye(4, dtype="float32"))
tell("K", camera.K)
tell("pose of a camera", camera.pose)
tell("rays of a camera", camera.rays(4, 3))
tell("projected", camera.project(np.arange(6, dtype="float32").reshape(2, 3) + 1))

browser = xvrml.Browser(SCENE.encode())
browser.tick(0.5)
tell("camera", browser.camera())
with xvrml.LiveView(browser, size=(12, 8), spp=1, isa="sse2") as view:
    tell("live", view.wait())
    tell("live camera", view.camera)

points = xvrml.Coordinate(point=[(1, 2, 3), (4, 5, 6)])
with points.edit("point") as numbers:
    numbers[0] = (7, 8, 9)
tell("edited", points.point)

sensed = xvrml.loads(SCENE + """ORTSensor { position 0 0 3 direction 0 1 0 across 1 0 0 size 2 1 rows 2 columns 3 }""")
try:
    for reading in sensed.measure(spp=16):
        for one in (reading, pickle.loads(pickle.dumps(reading))):
            for member in ("positions", "values", "half_widths", "trusted", "samples"):
                tell("measured " + member, getattr(one, member))
except (RuntimeError, ValueError) as error:
    print("measure", error)

# Rays: all queries, both precisions, from arrays of each type.
vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]])
triangles = np.array([[0, 1, 2], [0, 4, 0], [0, 1, 3], [1, 2, 3], [0, 2, 3]])
rays = np.array([[[.25, .25, 5, 0, 0, -1], [9, 9, 5, 0, 0, -1]], [[.1, .1, 5, 0, 0, -1], [.25, .25, -5, 0, 0, 1]]])
for kind in NUMBERS:
    try:
        caster = rt.Raycaster()
        caster.add_triangles(vertices.astype(kind), triangles.astype("i4" if "f" in kind or kind in ("bool", "longdouble") else kind))
        caster.add_sphere((3, 0, 0), 1)
        tell(f"rays {kind}", caster.cast_rays((4 * rays).astype(kind)))
        tell(f"list {kind}", caster.list_intersections((4 * rays).astype(kind)))
    except (TypeError, ValueError) as error:
        print("rays", kind, "refused:", str(error)[:90])
caster = rt.Raycaster()
caster.add_triangles(vertices.astype("float64"), triangles)
for precision in ("single", "double"):
    errors = precision == "double"
    tell(f"{precision} cast", caster.cast_rays(rays, precision=precision, errors=errors))
    tell(f"{precision} occluded", caster.test_occlusions(rays, precision=precision))
    tell(f"{precision} count", caster.count_intersections(rays, precision=precision))
    tell(f"{precision} list", caster.list_intersections(rays, precision=precision, errors=errors))
    tell(f"{precision} flat list", caster.list_intersections(rays.reshape(-1, 6), precision=precision))
    tell(f"{precision} closest", caster.compute_closest_points(rays[..., :3], precision=precision, errors=errors))
    tell(f"{precision} distance", caster.compute_distance(rays[..., :3], precision=precision))
    tell(f"{precision} occupancy", caster.compute_occupancy(rays[..., :3], precision=precision))
many = np.repeat(rays.reshape(-1, 6), 1000, 0)
found = caster.list_intersections(many)
assert (np.diff(found["ray_splits"]) == caster.count_intersections(many)).all()
assert (np.repeat(np.arange(len(many)), np.diff(found["ray_splits"])) == found["ray_ids"]).all()
caster.update(matrices=np.stack([np.eye(4)]))
tell("moved", caster.cast_rays(rays))
tell("signed", caster.compute_signed_distance(rays[..., :3]))
for kind in OTHERS:
    refused(f"rays {kind}", lambda: caster.cast_rays(np.zeros((2, 6), kind)))

for kind in ("uint8", "int16", "float16", "float32", "float64"):
    with rt.Context(config="isa=sse2") as context:
        picture = context.texture(np.arange(48).reshape(4, 4, 3).astype(kind))
        shader = context.shader("VRML97", diffuseColor=np.array([1, .5, .25], kind) if kind != "uint8" else (1, .5, .25))
        mesh = context.mesh(vertices.astype(kind), triangles.astype("uint16"), shader=shader,
                            colors=np.ones((5, 3), kind))
        context.instance(mesh, np.eye(4, dtype="float32"))
        context.light(context.shader("VRML97DirectionalLight", direction=(0, 0, -1)))
        context.camera(eye=np.array([0, 0, 5], kind), at=(0, 0, 0))
        tell("picture of a context " + kind, context.render(size=(8, 6), spp=1).array)
tell("pinhole", rt.create_rays_pinhole(60, np.zeros(3, "f4"), np.array([0, 0, 5]), (0, 1, 0), 4, 3))
'''


def newest_numpy(folder):
    """Returns a folder with numpy 2, or None."""
    given = os.environ.get("OPENRT_NUMPY2")
    if given:
        return pathlib.Path(given)
    done = subprocess.run([
        sys.executable, "-m", "pip", "install", "--quiet", "--no-input", "--retries", "0", "--timeout",
        "10", "--disable-pip-version-check", "--only-binary", ":all:", "--target", folder, "numpy>=2"
    ],
                          capture_output=True,
                          timeout=300)
    return folder if done.returncode == 0 else None


def probe(path):
    folders = [str(path)] if path else []
    folders += [str(pathlib.Path(xvrml.__file__).resolve().parents[1])]
    done = subprocess.run([sys.executable, "-W", "error", "-c", PROBE],
                          env={
                              **os.environ, "PYTHONPATH": os.pathsep.join(folders)
                          },
                          capture_output=True,
                          text=True,
                          timeout=300)
    assert done.returncode == 0, done.stderr
    version = re.search(r"numpy (\d+)", done.stderr)[1]
    return int(version), done.stdout


def test_every_array_that_goes_in_or_out_is_the_same_with_the_newest_numpy(tmp_path):
    newest = newest_numpy(tmp_path / "numpy")
    if newest is None:
        pytest.skip("numpy 2 cannot be installed here")
    version, found = probe(newest)
    assert version >= 2
    usual, expected = probe(None)
    assert len(expected.splitlines()) > 500
    different = [(a, b) for a, b in zip(expected.splitlines(), found.splitlines()) if a != b]
    assert not different and len(expected) == len(found), different[:5]


def test_no_array_of_the_bindings_asks_its_descriptor_for_sizes():
    """pybind11 before 2.12 gets 0 from numpy 2 (bindings/python/arrays.h)."""
    asks = re.compile(r"\.(itemsize|nbytes|alignment|index_at)\(\)|py::dtype|py::array\((?!py::module_)|"
                      r"array_t<\w+>[ \w]*\((py::ssize_t\(|\d)")
    for file in sorted((ROOT / "bindings/python").glob("*.cpp")):
        for number, line in enumerate(file.read_text().splitlines(), 1):
            assert not asks.search(line.split("//")[0]), f"{file.name}:{number}: {line}"
