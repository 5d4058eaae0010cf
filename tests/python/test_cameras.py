"""Tests cameras as matrices, the content of pixels, and the extent of a world."""
import pickle

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")
from xvrml import rt  # noqa: E402

SCENE = """#VRML V2.0 utf8
Viewpoint { position 0 0 9 }
Shape { appearance Appearance { material Material { } } geometry Box { size 2 2 2 } }
Transform { translation 3 0 0 children Shape { geometry Sphere { radius 1 } } }
Transform { translation -3 0 0 children DEF Peak Shape { geometry Cone { } } }
Transform { translation 0 -3 -1 scale 3 1 1 children DEF Slab Group { children [
  Shape { geometry Box { size 2 1 4 } }
  Transform { translation 0 1 0 children Shape { geometry IndexedFaceSet { solid FALSE coord Coordinate { point [ -1 0 0, 1 0 0, 0 1.5 .5 ] }
    coordIndex [ 0 1 2 -1 ] } } } ] } }
"""


@pytest.fixture
def world():
    return xvrml.load(SCENE.encode())


def turned(axis, angle, translation):
    axis = np.array(axis, float) / np.linalg.norm(axis)
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
    matrix[:3, 3] = translation
    return matrix


# A camera at 1 0.5 10 that looks along -z, turned slightly sideways: world to camera, y down.
T = turned((1, 2, 3), 0.1, (0, 0, 0)) @ np.diag([1.0, -1, -1, 1]) @ turned((0, 0, 1), 0,
                                                                           (-1, -0.5, -10))
CAMERAS = {
    "plain": xvrml.Pinhole([[70, 0, 39.5], [0, 70, 29.5], [0, 0, 1]], T),
    "aside": xvrml.Pinhole([[70, 0, 30.2], [0, 70, 40.7], [0, 0, 1]], T),
    "far aside": xvrml.Pinhole([[70, 0, -10], [0, 70, 29.5], [0, 0, 1]], T),
    "not square": xvrml.Pinhole([[90, 0, 41], [0, 55, 28], [0, 0, 1]], T),
    "skewed": xvrml.Pinhole([[70, 6, 36], [0, 80, 31], [0, 0, 1]], T),
    "halves": xvrml.Pinhole([[70, 0, 40], [0, 70, 30], [0, 0, 1]], T, center=0.5),
}


@pytest.mark.parametrize("name", CAMERAS)
def test_pixels_see_what_the_matrices_say(world, name):
    """The position seen in a pixel projects into that pixel. Its z is the distance along the view
    axis."""
    camera = CAMERAS[name]
    image = world.render(size=(80, 60), spp=1, camera=camera, channels=("z", "position", "id"))
    seen = np.isfinite(image["z"])
    assert seen.sum() > 200
    rows, columns = np.nonzero(seen)
    projected = camera.project(image["position"][seen])
    assert np.abs(projected[:, 0] - camera.center - columns).max() < 0.501
    assert np.abs(projected[:, 1] - camera.center - rows).max() < 0.501
    assert np.allclose(projected[:, 2], image["z"][seen], rtol=1e-5)


@pytest.mark.parametrize("name", CAMERAS)
def test_rays_meet_what_the_picture_shows(world, name):
    """The rays of the same camera hit the same nodes at the same distances."""
    camera = CAMERAS[name]
    image = world.render(size=(80, 60), spp=1, camera=camera, channels=("z", "id"))
    assert image.channels == ("rgba", "z", "id")
    caster = world.raycaster()
    hits = caster.cast_rays(camera.rays(80, 60))
    ids, other = image["id"], hits["geometry_ids"]
    same = np.array([[
        image.nodes[i] == (None if g == caster.INVALID_ID else caster.meshes[g].node)
        for i, g in zip(*row)
    ]
                     for row in zip(ids, other)])
    assert same.mean() > 0.96, "all but the outlines"
    inside = same & (ids > 0)
    assert np.allclose(hits["t_hit"][inside], image["z"][inside], rtol=0.1)
    assert np.median(np.abs(hits["t_hit"][inside] / image["z"][inside] - 1)) < 0.01


def test_ids_are_shapes(world):
    """Shapes without names, in one merged object and in a group: each has its own number and node.
    """
    image = world.render(size=(120, 90), spp=1, channels=("id",), fov=60)
    numbers = set(image["id"].ravel().tolist()) - {0}
    nodes = [image.nodes[n] for n in numbers]
    assert len(numbers) == 5 and all(isinstance(node, xvrml.Shape) for node in nodes)
    assert {node.geometry.node_type for node in nodes
           } == {"Box", "Sphere", "Cone", "IndexedFaceSet"}
    assert len(image.nodes) == len(
        image.names) == 6 and image.nodes[0] is None and image.names[0] == ""
    assert image.nodes is image.nodes
    assert sorted(image.names[n] for n in numbers) == ["Peak", "Shape", "Shape", "Slab", "Slab"]
    middle = image.nodes[image["id"][45, 60]]
    assert middle == world.roots[1]
    middle.appearance.material.diffuseColor = (1, 0, 0)
    assert world.render(size=(8, 6), spp=1).array[3, 4, 1] == 0


def test_ids_of_shared_shapes():
    """A shape used several times is one shape, however it is instantiated. Equal geometry is not.
    """
    heights = " ".join(["0"] * 2500)
    world = xvrml.load(("""#VRML V2.0 utf8
Viewpoint { position 0 0 20 fieldOfView 1 }
Transform { translation -6 0 0 rotation 1 0 0 1.57 children DEF A Shape { geometry DEF G ElevationGrid { xDimension 50 zDimension 50
  xSpacing .05 zSpacing .05 solid FALSE height [ %s ] } } }
Transform { translation -2 0 0 rotation 1 0 0 1.57 children USE A }
Transform { translation 2 0 0 rotation 1 0 0 1.57 children Shape { geometry USE G } }
Transform { translation 6 0 0 rotation 1 0 0 1.57 children DEF B Group { children USE A } }
""" % heights).encode())
    image = world.render(size=(160, 60), spp=1, channels=("id",))
    at = lambda x: image.nodes[image["id"][33, int(80 + (x + 1) * 60 / (2 * 20 * np.tan(0.5)))]]
    assert at(-6) == at(-2) == at(6) == world["A"]
    assert at(2) == world.roots[3].children[0] != world["A"]


def test_ids_stay_while_the_world_changes():
    browser = xvrml.Browser(SCENE.encode())
    ids = lambda: (lambda image: {
        image.nodes[n]: n for n in set(image["id"].ravel().tolist()) - {0}
    })(browser.render(size=(120, 90), spp=1, channels="id", fov=60))
    before = ids()
    assert len(before) == 5
    gone = browser.roots[2].children[0]
    browser.roots[2].children = []
    fewer = ids()
    assert gone not in fewer and all(
        before[node] == number for node, number in fewer.items()) and len(fewer) == 4
    browser.roots[2].children = [xvrml.Shape(geometry=xvrml.Box())]
    again = ids()
    assert len(again) == 5 and len(set(again.values())) == 5 and all(
        again[node] == number for node, number in fewer.items())


def test_the_camera_of_a_picture(world):
    image = world.render(size=(80, 60), spp=1, channels=("z", "position"), viewpoint=0)
    camera = image.camera
    assert camera.T == pytest.approx(np.diag([1.0, -1, -1, 1]) +
                                     np.array([[0, 0, 0, 0]] * 2 + [[0, 0, 0, 9], [0, 0, 0, 0]]),
                                     abs=1e-9)
    assert camera.K[0, 2] == 39.5 and camera.K[1, 2] == 29.5
    again = world.render(size=(80, 60), spp=1, channels=("z", "position"), camera=camera)
    assert again.camera is camera and np.allclose(again["z"], image["z"], rtol=1e-5)
    posed = world.render(size=(80, 60),
                         spp=1,
                         channels="z",
                         camera=image.camera.pose @ np.diag([1.0, -1, -1, 1]))
    assert np.allclose(posed["z"], image["z"], rtol=1e-5), "poses look along -z"


def test_the_matrix_of_a_viewpoint_is_its_pose():
    """The matrix includes position and orientation and the Transforms above, but not their scale.
    The same holds in Inlines and for ORTViewpoints."""
    world = xvrml.loads("""#VRML V2.0 utf8
Transform { translation 7 0 0 rotation 0 0 1 .3 scale 2 2 2 children [
  DEF V Viewpoint { position 0 1.5 5 orientation 0 1 0 .5 }
  DEF W Viewpoint { position 1 2 6 orientation 1 0 0 -.2 fieldOfView .5 }
  Transform { translation -1 0 -2 children Shape { geometry Cone { } appearance Appearance { material Material { } } } } ] }
DEF O ORTViewpoint { position 0 0 20 }
""")
    names = [v.name for v in world.viewpoints]
    assert names == ["V", "W", "O"]
    for number, (name, fov) in enumerate(zip(names, (45, np.degrees(0.5), 45))):
        matrix = world.viewpoints[number].matrix
        seen = world.render(size=(40, 30), spp=1, channels="z", viewpoint=name)
        assert matrix == pytest.approx(seen.camera.pose @ np.diag([1.0, -1, -1, 1]), abs=1e-6)
        again = world.render(size=(40, 30), spp=1, channels="z", camera=matrix, fov=fov)
        assert np.isfinite(seen["z"]).any() and np.allclose(again["z"], seen["z"], rtol=1e-4)
        assert np.abs(again.array - seen.array).max() < 1e-3
    assert world.viewpoints[0].matrix[:3, :3] @ world.viewpoints[
        0].matrix[:3, :3].T == pytest.approx(np.eye(3))
    world["V"].position = (0, 0, 0)
    world["V"].orientation = (0, 1, 0, 0)
    assert world.viewpoints[0].matrix[:3, 3] == pytest.approx([7, 0, 0])


def test_a_parallel_view_is_that_of_an_orthoviewpoint():
    """A picture that is wider than the extent shows more at its sides; its height is the extent's."""
    shapes = SCENE[SCENE.index("Shape"):]
    for aside in ("0 0 9", "1 .5 9"):
        given = xvrml.loads("#X3D V3.2 utf8\nPROFILE Interchange\nOrthoViewpoint { position " + aside +
                            " fieldOfView [ -2 -3 2 3 ] } " + shapes)
        asked = xvrml.loads("#VRML V2.0 utf8\nViewpoint { position " + aside + " } " + shapes)
        images = [
            w.render(size=(40, 30), spp=1, channels=("rgba", "z"), **more)
            for w, more in ((given, {}), (asked, {"ortho": 6}))
        ]
        assert np.isfinite(images[0]["z"]).any()
        assert np.array_equal(images[0]["z"], images[1]["z"])
        assert np.array_equal(images[0].array, images[1].array)


def test_pinholes(world):
    camera = CAMERAS["skewed"]
    back = xvrml.Pinhole.from_pose(camera.K, camera.pose)
    assert np.allclose(back.T, camera.T) and back.center == 0
    assert np.allclose(xvrml.Pinhole(camera.K, camera.T[:3]).T, camera.T)
    copy = pickle.loads(pickle.dumps(CAMERAS["halves"]))
    assert np.array_equal(copy.K, CAMERAS["halves"].K) and copy.center == 0.5
    assert not camera.K.flags.writeable and not camera.T.flags.writeable


K = [[70, 0, 39.5], [0, 70, 29.5], [0, 0, 1]]


@pytest.mark.parametrize("wrong", [
    lambda w: xvrml.Pinhole(np.eye(4)),
    lambda w: xvrml.Pinhole("K"),
    lambda w: xvrml.Pinhole([[0, 0, 1], [0, 1, 1], [0, 0, 1]]),
    lambda w: xvrml.Pinhole([[1, 0, 1], [0, 1, 1], [0, 0, 2]]),
    lambda w: xvrml.Pinhole(K, 2 * np.eye(4)),
    lambda w: xvrml.Pinhole(K, np.diag([1, 1, -1, 1])),
    lambda w: xvrml.Pinhole(K, np.full((4, 4), np.nan)),
    lambda w: w.render(camera=xvrml.Pinhole(K), fov=30),
    lambda w: w.render(camera=xvrml.Pinhole(K), fit=True),
    lambda w: w.render(camera=xvrml.Pinhole(K), ortho=3),
    lambda w: w.render(fov=30, ortho=3),
    lambda w: w.render(fit=True, ortho=3),
    lambda w: w.render(ortho=0),
    lambda w: w.render(ortho=float("nan")),
    lambda w: w.render(camera=2 * np.eye(4)),
    lambda w: w.render(camera=np.diag([1, 1, -1, 1])),
    lambda w: w.render(camera=np.eye(5)),
    lambda w: w.render(up="w"),
    lambda w: w.render(background="nothing"),
    lambda w: w.render(background=(1, 2, 3)),
    lambda w: w.render(viewpoint=0, fit=True),
    lambda w: w.render(camera=np.eye(3)),
    lambda w: w.render(camera="front"),
    lambda w: xvrml.Pinhole(K, [[1], [2, 3]]),
    lambda w: xvrml.Pinhole(K, center=np.inf),
    lambda w: xvrml.Pinhole(K).rays(-1, 3),
    lambda w: xvrml.Pinhole(K).project(5),
    lambda w: xvrml.Pinhole(K).project([[1, 2]]),
    lambda w: rt.create_rays_pinhole(60, (0, 0, 0), (0, 0, 0), (0, 1, 0), 4, 3),
    lambda w: rt.create_rays_pinhole(60, (0, 0, 0), (0, 5, 0), (0, 1, 0), 4, 3),
    lambda w: rt.create_rays_pinhole(180, (0, 0, 0), (0, 0, 5), (0, 1, 0), 4, 3),
    lambda w: rt.create_rays_pinhole(60, (0, 0, 0), (0, 5), (0, 1, 0), 4, 3),
    lambda w: rt.create_rays_pinhole(np.eye(3), np.eye(3), 4, 3),
    lambda w: rt.create_rays_pinhole(60, (0, 0, 0), (0, 0, 5), (0, 1, 0), 4, -3),
])
def test_wrong_cameras(world, wrong):
    with pytest.raises(ValueError):
        wrong(world)


def test_open3d_rays():
    """Both forms of create_rays_pinhole give the rays of Open3D: for the form with eye, center and up,
    up is the y axis of the camera, which points along the rows of the picture."""
    width, height, fov = 64, 48, 60
    eye, center, up = np.array([1.0, 2, 9]), np.array([0.5, 0, 0]), np.array([0.1, 1, 0])
    ahead = (center - eye) / np.linalg.norm(center - eye)
    across = np.cross(up, ahead) / np.linalg.norm(np.cross(up, ahead))
    extrinsic = np.eye(4)
    extrinsic[:3, :3] = [across, np.cross(ahead, across), ahead]
    extrinsic[:3, 3] = -extrinsic[:3, :3] @ eye
    focal = width / 2 / np.tan(np.radians(fov) / 2)
    intrinsic = np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1]])
    by_view = rt.create_rays_pinhole(fov_deg=fov,
                                     center=center,
                                     eye=eye,
                                     up=up,
                                     width_px=width,
                                     height_px=height)
    for rays in (rt.create_rays_pinhole(intrinsic, extrinsic, width, height),
                 rt.Raycaster.create_rays_pinhole(intrinsic_matrix=intrinsic,
                                                  extrinsic_matrix=extrinsic,
                                                  width_px=width,
                                                  height_px=height)):
        assert rays.dtype == np.float32 and rays.shape == (height, width, 6)
        assert np.allclose(rays, by_view, atol=1e-5)


def test_bounds(world):
    assert xvrml.World().bounds is None
    low, high = world.bounds
    assert low == pytest.approx([-4, -3.5, -3]) and high == pytest.approx([4, 1, 1])
    world.roots[2].scale = (2, 1, 1)
    assert world.bounds[1][0] == pytest.approx(5)
    assert world.bounds.shape == (2, 3) and world.bounds.dtype == np.float64


def test_models_in_python():
    """A model without a Viewpoint looks as in vv, with the same up axis and background."""
    model = xvrml.load(
        b"#VRML V2.0 utf8\n# kicad\nShape { appearance Appearance { material Material { } } geometry IndexedFaceSet { solid FALSE "
        b"coord Coordinate { point [ 0 0 0, 4 0 0, 0 4 0, 0 0 1 ] } coordIndex [ 0 2 1 -1 0 1 3 -1 0 3 2 -1 ] } }"
    )
    up = lambda **more: model.render(size=(32, 24), spp=1, **more).camera.pose[:3, 1] * -1
    assert np.argmax(up()) == 2 and np.argmax(up(up="y")) == 1 and np.argmin(up(up="-x")) == 0
    clear = model.render(size=(32, 24), spp=1, background="none").array
    white = model.render(size=(32, 24), spp=1, background=(1, 1, 1)).array
    assert clear[0, 0].tolist() == [0, 0, 0, 0] and white[0, 0].tolist() == [1, 1, 1, 1]
    assert np.allclose(white[..., :3], clear[..., :3] + 1 - clear[..., 3:], atol=1e-6)
    near = model.render(size=(32, 24), spp=1, camera=((9, 9, 9), (0, 0, 0)), fit=True, channels="z")
    assert np.isfinite(near["z"]).sum() > 50 and not np.isfinite(near["z"][[0, -1]]).any()


@pytest.mark.parametrize("call, words", [
    (lambda: rt.create_rays_pinhole("60", (0, 0, 0), (0, 0, 5), (0, 1, 0), 4, 3),
     "fov_deg: a number above 0 expected, not the str '60'"),
    (lambda: rt.create_rays_pinhole(),
     "create_rays_pinhole(): fov_deg, center, eye, up, width_px, height_px must be given, or intrinsic"
    ),
    (lambda: rt.create_rays_pinhole(60, up=(0, 1, 0)),
     "create_rays_pinhole(): center, eye, width_px, height_px must be given"),
    (lambda: rt.create_rays_pinhole(60, fov=3), "create_rays_pinhole(): fov is no argument"),
    (lambda: xvrml.Pinhole(K, center="a"), "center: a number expected, not the str 'a'"),
    (lambda: xvrml.Pinhole(K).rays("a", 3), "width: a whole number expected, not the str 'a'"),
])
def test_arguments_of_cameras_of_wrong_types(call, words):
    with pytest.raises(TypeError) as caught:
        call()
    assert words in str(caught.value)


def test_position_target_and_up_are_a_tuple_even_if_they_are_at_right_angles(world):
    view = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    assert np.allclose(world.render(size=(8, 6), spp=1, camera=view).camera.pose[:3, 3], (1, 0, 0))
    many = np.array([[0, 0, 9], [0, 0, 0], [0, 1, 0]])
    assert np.allclose(world.render(size=(8, 6), spp=1, camera=many).camera.pose[:3, 3],
                       (0, 0, 9)), "an array that is no rotation"
