"""Tests pictures of the z-buffer: vv --preview-raster, World.render(raster=True), live views."""
import pytest
from conftest import HEADER, ROOT

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")
from live_view_tools import steps  # noqa: E402

SIZE = ("--size", "48x36")
NOTE = b"fast view: a z-buffer picture"

# Matt things under a lamp, which rays without shadows show in the same colours.
MATT = HEADER + """
Viewpoint { position 0 2 8 orientation 1 0 0 -.2 }
NavigationInfo { headlight FALSE }
Background { skyColor [ .2 .4 .8, .9 .9 .9 ] skyAngle 1.57 }
PointLight { location 3 5 4 attenuation 1 .05 0 }
DirectionalLight { direction -1 -1 -1 intensity .4 color 1 .8 .6 }
Transform { translation -1.5 0 0 children Shape { geometry Sphere { }
  appearance DEF Red Appearance { material Material { diffuseColor .8 .2 .1 } } } }
Transform { translation 1.5 0 0 rotation 0 1 0 .6 children Shape { geometry Box { }
  appearance Appearance { material Material { }
    texture PixelTexture { image 2 2 3 0xff0000 0x00ff00 0x0000ff 0xffffff } } } }
Transform { translation 0 -1.2 0 children Shape { geometry Box { size 12 .1 12 }
  appearance Appearance { material Material { diffuseColor .6 .6 .5 } } } }
"""

SHINY = HEADER + """
Viewpoint { position 0 0 6 }
Transform { rotation 1 1 0 .7 children Shape { geometry Cylinder { }
  appearance Appearance { material Material {
    diffuseColor .1 .3 .7 specularColor .8 .8 .8 shininess .3 emissiveColor .05 0 0 } } } }
Transform { translation 2 0 0 children Shape { geometry Cone { }
  appearance Appearance { material Material { diffuseColor .2 .7 .2 } } } }
Transform { translation -2.5 0 -1 children Shape {
  geometry IndexedFaceSet { solid FALSE
    coord Coordinate { point [ -1 -1 0, 1 -1 0, 0 1 0 ] } coordIndex [ 0 1 2 -1 ]
    color Color { color [ 1 0 0, 0 1 0, 0 0 1 ] } } } }
"""

GROUPS = HEADER + """#
Viewpoint { position 0 0 10 }
Fog { color .5 .5 .6 visibilityRange 30 }
Group { children [
  SpotLight { location 0 3 5 direction 0 -.5 -1 cutOffAngle .5 beamWidth .2 }
  Transform { translation 0 0 -1 children Shape { geometry Box { size 8 8 .1 }
    appearance Appearance { material Material { diffuseColor .9 .9 .9 } } } } ] }
Transform { translation 3 0 2 scale 1 2 .5 children Shape { geometry Sphere { }
  appearance Appearance { material Material { diffuseColor .3 .3 .9 } } } }
"""


@pytest.mark.parametrize("text", [MATT, SHINY, GROUPS])
def test_it_looks_as_rays_do_without_shadows(vv, text):
    vv.write("world.wrl", text)
    world = xvrml.load(vv.folder / "world.wrl")
    options = {"size": (120, 90), "studio": False}
    fast = world.render(raster=True, **options).array
    rays = world.render(spp=16, transport="direct", shadows=False, **options).array
    difference = np.abs(fast - rays)
    # Rays have soft edges; between the edges colours agree.
    assert np.median(difference) < 0.01
    assert (difference.max(axis=-1) > 0.05).mean() < 0.08
    assert difference.mean() < 0.02


def test_files_say_what_they_are(vv):
    vv.write("world.wrl", MATT)
    names = ["out.png", "out.exr", "out.jpg", "out.ppm"]
    done = vv("world.wrl", "--preview-raster", *SIZE, *[a for n in names for a in ("-o", n)])
    assert done.returncode == 0, done.talk
    for name in names:
        assert NOTE in (vv.folder / name).read_bytes(), name
    done = vv("world.wrl", "--preview-raster", *SIZE, "-o", "out.pfm")
    assert done.returncode == 2 and "PFM files cannot say that they are fast views" in done.talk
    assert vv("world.wrl", *SIZE, "--spp", "1", "-o", "rays.png").returncode == 0
    assert NOTE not in (vv.folder / "rays.png").read_bytes()


@pytest.mark.parametrize("option", [("--error", "5%"), ("--channels", "z"), ("--spp", "4"),
                                    ("--stats", "s.json"), ("--audit", "2"),
                                    ("--transport", "path"), ("--environment", "sky.hdr")])
def test_what_needs_rays_is_refused(vv, option):
    vv.write("world.wrl", MATT)
    done = vv("world.wrl", "--preview-raster", "-o", "out.png", *option)
    assert done.returncode == 2, done.talk
    assert "--preview-raster draws without rays: it cannot be used with" in done.talk
    assert not (vv.folder / "out.png").exists()


def test_it_needs_a_picture(vv):
    vv.write("world.wrl", MATT)
    done = vv("world.wrl", "--preview-raster")
    assert done.returncode == 2 and "--preview-raster needs -o" in done.talk


def test_threads_do_not_change_it(vv):
    for threads in (1, 2):
        done = vv(ROOT / "examples/scenes/chess.wrl", "--preview-raster", *SIZE, "--threads",
                  str(threads), "-o", f"{threads}.exr")
        assert done.returncode == 0, done.talk
    assert (vv.folder / "1.exr").read_bytes() == (vv.folder / "2.exr").read_bytes()


def test_sequences_and_viewpoints(vv):
    vv.write("world.wrl", HEADER + """
DEF Clock TimeSensor { loop TRUE cycleInterval 2 }
DEF Path PositionInterpolator { key [ 0, 1 ] keyValue [ -2 0 0, 2 0 0 ] }
DEF Place Transform { children Shape { geometry Box { size 1 1 1 }
  appearance Appearance { material Material { } } } }
ROUTE Clock.fraction_changed TO Path.set_fraction
ROUTE Path.value_changed TO Place.translation
Viewpoint { position 0 0 8 }
Viewpoint { position 0 0 16 }
""")
    done = vv("world.wrl", "--preview-raster", *SIZE, "--frames", "0-30/15", "-o", "f.exr")
    assert done.returncode == 0, done.talk
    pictures = [path.read_bytes() for path in sorted(vv.folder.glob("f*.exr"))]
    assert len(pictures) == 3 and len(set(pictures)) == 3
    done = vv("world.wrl", "--preview-raster", *SIZE, "--viewpoint", "all", "-o", "v.exr")
    assert done.returncode == 0, done.talk
    assert len(list(vv.folder.glob("v*.exr"))) == 2


def test_a_crop_has_the_bytes_of_the_whole(vv):
    vv.write("world.wrl", MATT)
    world = xvrml.load(vv.folder / "world.wrl")
    whole = world.render(size=(48, 36), raster=True).array
    part = world.render(size=(48, 36), raster=True, crop=(8, 6, 20, 10)).array
    assert np.array_equal(part, whole[6:16, 8:28])


def test_in_python(vv):
    vv.write("world.wrl", MATT)
    world = xvrml.load(vv.folder / "world.wrl")
    image = world.render(size=(48, 36), raster=True)
    assert image.note.startswith("fast view")
    assert image.array.shape[:2] == (36, 48)
    assert vv("world.wrl", "--preview-raster", *SIZE, "-o", "vv.exr").returncode == 0
    image.save(vv.folder / "python.exr")
    assert (vv.folder / "python.exr").read_bytes() == (vv.folder / "vv.exr").read_bytes()
    assert not world.render(size=(48, 36), spp=1).note, "it holds for one picture"
    for wrong in ({"spp": 4}, {"error": 0.1}, {"channels": "z"}):
        with pytest.raises(ValueError, match="raster: it draws without rays"):
            world.render(raster=True, **wrong)


def test_pinholes_with_other_principal_points(vv):
    """A point appears where the Pinhole says."""
    vv.write("world.wrl", HEADER + """
Shape { appearance Appearance { material Material { emissiveColor 1 1 1 } }
  geometry PointSet { coord Coordinate { point .3 .2 -4 } } }""")
    world = xvrml.load(vv.folder / "world.wrl")
    camera = xvrml.Pinhole([[60, 0, 30], [0, 80, 10], [0, 0, 1]],
                           np.diag([1., -1, -1, 1]))
    image = world.render(size=(64, 48), camera=camera, raster=True, background="none").array
    x, y = camera.project([[.3, .2, -4]])[0][:2]
    rows, columns = np.nonzero(image[..., 0])
    assert [len(rows), abs(columns[0] - x) <= 1, abs(rows[0] - y) <= 1] == [1, True, True]


def test_a_live_view_of_a_large_world_begins_with_the_fast_view():
    side = 330  # 217,800 triangles
    world = xvrml.loads("""#VRML V2.0 utf8
Viewpoint { position 0 0 3 }
Transform { rotation 1 0 0 1.2 translation -1 1 0 children Shape {
  appearance Appearance { material Material { diffuseColor .2 .8 .4 } }
  geometry ElevationGrid { solid FALSE xDimension %d zDimension %d xSpacing .006 zSpacing .006
    height [ %s ] } } }""" % (side + 1, side + 1, "0 " * (side + 1)**2))
    seen = []
    with xvrml.LiveView(world, size=(64, 48), spp=4) as view:

        def finished():
            seen.append(view.facts.get("samples"))
            return view.facts.get("finished") and not view.facts["preview"]

        steps(view, finished)
        assert 0 in seen, "the fast view has no samples"
        assert view.facts["samples"] == 4
