"""Tests xvrml.picture, show and to_world (xvrml.figures), and points and lines that have a size."""
import types

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")
from xvrml import figures  # noqa: E402

SMALL = dict(size=(64, 48), spp=16)
CAMERA = "Viewpoint { position 0 0 10 } NavigationInfo { headlight FALSE } "
LAMP = "DirectionalLight { direction 0 -1 0 } "
POINT = """Shape { geometry PointSet { coord Coordinate { point 0 1 0 } }
 appearance Appearance { material Material { emissiveColor .8 .8 .8 } } } """
BALL = """Transform { translation 0 1 0 children Shape { geometry Sphere { radius .5 }
 appearance Appearance { material Material { diffuseColor .8 .8 .8 } } } } """
FLOOR = """Transform { translation 0 -1 0 children Shape { geometry Box { size 8 .1 8 }
 appearance Appearance { material Material { } } } }"""


def world_of(*parts):
    return xvrml.loads("#VRML V2.0 utf8\n" + "".join(parts))


def test_a_point_with_a_size_is_lit_as_a_ball_and_casts_its_shadow():
    point = world_of(CAMERA, LAMP, POINT, FLOOR).render(point_size=1, **SMALL)
    ball = world_of(CAMERA, LAMP, BALL, FLOOR).render(**SMALL)
    thin = world_of(CAMERA, LAMP, POINT, FLOOR).render(**SMALL)
    assert np.abs(point.array - ball.array)[..., :3].mean() < 2e-4
    assert np.abs(thin.array - ball.array)[..., :3].mean() > 1e-3


def test_a_line_with_a_width_is_as_thick_as_a_cylinder():
    line = """Shape { geometry IndexedLineSet { coord Coordinate { point [ 0 -9 0, 0 9 0 ] } coordIndex [ 0 1 ] }
 appearance Appearance { material Material { emissiveColor .5 .5 .5 } } }"""
    rod = """Shape { geometry Cylinder { radius 1 height 18 }
 appearance Appearance { material Material { diffuseColor .5 .5 .5 } } }"""
    lamp = "DirectionalLight { direction 0 0 -1 }"
    a = world_of(CAMERA, lamp, line).render(line_width=2, **SMALL)
    b = world_of(CAMERA, lamp, rod).render(**SMALL)
    assert np.abs(a.array - b.array)[..., :3].mean() < 0.003


def test_sizes_are_options_of_vv(vv):
    text = "#VRML V2.0 utf8\n" + CAMERA + LAMP + POINT
    (vv.folder / "point.wrl").write_text(text)
    done = vv("point.wrl", "-o", "vv.exr", "--point-size", "1.5", "--line-width", ".1", "--size",
              "64x48", "--spp", "2")
    assert done.returncode == 0, done.talk
    picture = xvrml.loads(text).render(size=(64, 48), spp=2, point_size=1.5, line_width=0.1,
                                       channels="rgba")
    picture.save(vv.folder / "python.exr")
    assert (vv.folder / "python.exr").read_bytes() == (vv.folder / "vv.exr").read_bytes()
    for wrong in ("-1", "0", "nan", "1e19"):
        assert vv("point.wrl", "-o", "no.png", "--point-size", wrong).returncode == 2
    for wrong in (-1, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="point_size: a diameter"):
            xvrml.loads(text).render(point_size=wrong, **SMALL)


def test_points_follow_events():
    world = world_of(CAMERA, LAMP, POINT.replace("Coordinate", "DEF C Coordinate"))
    upper, lower = np.s_[:24, :, :3], np.s_[24:, :, :3]
    before = world.render(point_size=1, **SMALL).array
    assert before[upper].max() > 0.1 and before[lower].max() == 0
    world["C"].point = [(0, -1, 0)]
    after = world.render(point_size=1, **SMALL).array
    assert after[upper].max() == 0 and after[lower].max() > 0.1


def test_scans_in_coordinates_of_the_earth_keep_their_precision():
    cloud = np.random.default_rng(2).random((200, 3))
    near = xvrml.picture(cloud, size=(64, 48), spp=4).array[..., 3].mean()
    far = xvrml.picture(cloud + [500000, 4000000, 100], size=(64, 48), spp=4).array[..., 3].mean()
    assert near > 0.01 and far == pytest.approx(near, rel=0.02)


def test_clouds_and_heights():
    cloud = np.random.default_rng(1).normal(size=(50, 3))
    world = xvrml.to_world(cloud, values=np.arange(50), cmap=lambda t: np.stack([t, t, 1 - t], 1))
    (mesh,) = world.meshes()
    assert mesh.kind == "points" and np.allclose(mesh.colors[0, :3], (0, 0, 1))
    assert np.allclose(mesh.colors[-1, :3], (1, 1, 0))
    heights = np.arange(12.0).reshape(3, 4)
    (mesh,) = xvrml.to_world(heights, spacing=(2, 5)).meshes()
    assert np.allclose(mesh.vertices.min(0), (0, 0, 0))
    assert np.allclose(mesh.vertices.max(0), (6, 11, 10))
    picture = xvrml.picture(cloud, size=(32, 24), spp=1)
    assert picture.array.shape[:2] == (24, 32) and picture.array[..., :3].std() > 0.01


def test_values_that_are_no_numbers_are_grey():
    colors = figures.map_colors([0, np.nan, 10], lambda t: np.stack([t] * 3, 1), (0, 10))
    assert colors.tolist() == [[0, 0, 0], [0.5, 0.5, 0.5], [1, 1, 1]]


@pytest.mark.parametrize("thing, options, message", [
    (object(), {}, "a file, a World, a Node, a mesh"),
    (np.zeros((2, 2, 2)), {}, "shape \\(n, 3\\), for points"),
    (np.zeros((4, 3)), dict(values=[1, 2]), "one for each of the 4 points"),
    (np.zeros((4, 3)), dict(values=[1] * 4, colors=np.zeros((4, 3))), "one of them"),
    (np.full((4, 4), np.nan), {}, "finite heights"),
    (np.zeros((1, 4)), {}, "at least 2 x 2"),
])
def test_what_cannot_be_shown_is_said(thing, options, message):
    options.setdefault("cmap", lambda t: np.stack([t] * 3, 1))
    if not isinstance(thing, np.ndarray):
        options = {}
    with pytest.raises((TypeError, ValueError), match=message):
        xvrml.to_world(thing, **options)


def test_worlds_and_nodes_have_their_own_colours():
    world = world_of(BALL)
    assert xvrml.to_world(world) is world
    assert len(xvrml.to_world(xvrml.Shape(geometry=xvrml.Box())).meshes()) == 1
    with pytest.raises(TypeError, match="color"):
        xvrml.to_world(world, color=(1, 0, 0))


def test_open3d():
    """The classes of Open3D have these members."""
    square = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
    mesh = types.SimpleNamespace(vertices=square, triangles=np.array([(0, 1, 2), (0, 2, 3)]),
                                 vertex_colors=np.tile([(0.1, 0.2, 0.3)], (4, 1)),
                                 vertex_normals=np.tile([(0, 0, 1.0)], (4, 1)))
    world = xvrml.to_world(xvrml.interop.from_open3d(mesh))
    (drawn,) = world.meshes()
    assert drawn.kind == "triangles" and len(drawn.faces) == 2
    assert np.allclose(drawn.colors[:, :3], (0.1, 0.2, 0.3)) and np.allclose(drawn.normals, (0, 0, 1))
    lines = types.SimpleNamespace(points=square, lines=np.array([(0, 1), (2, 3)]),
                                  colors=np.array([(1, 0, 0), (0, 1, 0)], float))
    (drawn,) = xvrml.to_world(xvrml.interop.from_open3d(lines)).meshes()
    assert drawn.kind == "lines"
    cloud = types.SimpleNamespace(points=square, colors=np.zeros((0, 3)))
    (drawn,) = xvrml.to_world(xvrml.interop.from_open3d(cloud)).meshes()
    assert drawn.kind == "points"
    with pytest.raises(ValueError, match="points expected"):
        xvrml.interop.from_open3d(types.SimpleNamespace(points=np.zeros((0, 3)), colors=()))


def test_a_plotter_of_pyvista():
    pyvista = pytest.importorskip("pyvista")
    plotter = pyvista.Plotter(off_screen=True)
    ball = pyvista.Sphere()
    plotter.add_mesh(ball, scalars=ball.points[:, 2], cmap="plasma")
    plotter.add_mesh(pyvista.Cube(center=(1, 0, 0)), color="red")
    plotter.camera_position = [(3, 4, 5), (0, 0, 0), (0, 1, 0)]
    world = xvrml.to_world(plotter)
    first, second = world.meshes()
    assert first.colors is not None and first.colors[:, 0].std() > 0.1
    assert np.allclose(second.node.appearance.material.diffuseColor, (1, 0, 0))
    matrix = np.array(world.viewpoints[0].matrix)
    assert np.allclose(matrix[:3, 3], (3, 4, 5))
    assert np.allclose(matrix[:3, 2] * np.sqrt(50), (3, 4, 5), atol=1e-4), "it looks at the origin"


def test_data_sets_of_pyvista():
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.ImageData(dimensions=(3, 3, 3))
    grid.cell_data["c"] = np.arange(8.0)
    (mesh,) = xvrml.to_world(grid, cmap=lambda t: np.stack([t, t, t], 1)).meshes()
    assert mesh.kind == "triangles" and mesh.colors is not None
    kinds = {m.kind for m in xvrml.to_world(pyvista.MultiBlock([pyvista.Line(), grid])).meshes()}
    assert kinds == {"lines", "triangles"}


def test_what_pyvista_holds_besides_meshes():
    pyvista = pytest.importorskip("pyvista")
    plotter = pyvista.Plotter(off_screen=True)
    plotter.add_mesh(pyvista.Line(), pbr=True)
    plotter.add_mesh(pyvista.MultiBlock([pyvista.Sphere()]))
    plotter.add_volume(np.zeros((3, 3, 3)))
    plotter.add_mesh(pyvista.Sphere().strip())
    assert sorted(m.kind for m in xvrml.to_world(plotter).meshes()) == [
        "lines", "triangles", "triangles"
    ]
    low, high = pyvista.Plane(), pyvista.Plane(center=(0, 0, 1))
    low["v"], high["v"] = np.zeros(low.n_points), np.ones(high.n_points)
    blocks = pyvista.MultiBlock([low, high, pyvista.Cube()])
    grey = lambda t: np.stack([t, t, t], 1)  # noqa: E731
    first, second, third = xvrml.to_world(blocks, scalars="v", cmap=grey).meshes()
    assert first.colors[:, 0].max() == 0 and second.colors[:, 0].min() == 1 and third.colors is None


QUARTERS = np.zeros((8, 8, 3), np.uint8)  # red and blue above, green and black below
QUARTERS[:4, :4, 0] = QUARTERS[:4, 4:, 2] = QUARTERS[4:, :4, 1] = 200


def test_textures_of_a_plotter():
    """Rows of VTK begin at the bottom; a colour multiplies a texture."""
    pyvista = pytest.importorskip("pyvista")
    plotter = pyvista.Plotter(off_screen=True)
    plotter.add_mesh(pyvista.Plane(), texture=pyvista.Texture(QUARTERS))
    plotter.add_mesh(pyvista.Plane(center=(2, 0, 0)), texture=pyvista.Texture(QUARTERS),
                     color=(1.0, 1.0, 0.5), pbr=True)
    world = xvrml.to_world(plotter)
    first, second = world.meshes()
    assert np.array_equal(first.node.appearance.texture.image, QUARTERS)
    assert np.allclose(second.node.appearance.texture.image, QUARTERS * (1, 1, 0.5), atol=1)
    assert tuple(second.node.appearance.material.baseColor) == (1, 1, 1)
    first.node.appearance.material = None  # unlit, so the colours are those of the texture
    image = world.render(size=(40, 40), spp=1, camera=((0, 0, 3), (0, 0, 0)), fov=15).display
    for (row, column), color in {(10, 10): 0, (10, 30): 2, (30, 10): 1}.items():
        assert np.argmax(image[row, column]) == color and image[row, column].max() > 150
    assert image[30, 30].max() < 10


def _trimesh(**members):
    """Returns what looks like an object of trimesh; the classes have these members."""
    return types.SimpleNamespace(is_watertight=False, **members)


def test_paths_and_clouds_of_trimesh():
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    line = types.SimpleNamespace(color=(255, 0, 0, 255), discrete=lambda xy, scale: xy[[0, 1]])
    arc = types.SimpleNamespace(color=None, discrete=lambda xy, scale: xy[[1, 2, 3]])
    text = types.SimpleNamespace(color=None, discrete=lambda xy, scale: xy[:0])
    path = _trimesh(entities=[line, text, arc], vertices=square, scale=1.4)
    shape = xvrml.interop.from_trimesh(path)
    assert shape.geometry.coordIndex.tolist() == [0, 1, -1, 2, 3, 4, -1]
    assert np.allclose(shape.geometry.color.color, [(1, 0, 0), (0.8, 0.8, 0.8)])
    assert not shape.geometry.colorPerVertex
    assert xvrml.interop.from_trimesh(path, color=(0, 1, 0)).geometry.color is None
    assert xvrml.interop.from_trimesh(_trimesh(entities=[], vertices=square)) is not None
    cloud = _trimesh(vertices=np.eye(3), colors=np.full((3, 4), 255, np.uint8))
    scene = types.SimpleNamespace(geometry={"path": path, "cloud": cloud},
                                  graph=_Graph(path=np.eye(4), cloud=np.eye(4)))
    world = xvrml.to_world(scene)
    assert sorted(mesh.kind for mesh in world.meshes()) == ["lines", "points"]


class _Graph(dict):

    @property
    def nodes_geometry(self):
        return list(self)

    def __getitem__(self, name):
        return super().__getitem__(name), name


def test_textures_of_trimesh():
    PIL = pytest.importorskip("PIL.Image")
    square = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
    material = types.SimpleNamespace(baseColorTexture=PIL.fromarray(QUARTERS),
                                     baseColorFactor=np.array([255, 255, 127, 255], np.uint8))
    visual = types.SimpleNamespace(kind="texture", material=material, uv=square[:, :2])
    mesh = _trimesh(vertices=square, faces=np.array([(0, 1, 2), (0, 2, 3)]), visual=visual)
    shape = xvrml.interop.from_trimesh(mesh)
    assert np.allclose(shape.appearance.texture.image, QUARTERS * (1, 1, 127 / 255), atol=0.5)
    assert np.allclose(shape.geometry.texCoord.point, square[:, :2])
    assert xvrml.interop.from_trimesh(mesh, color=(1, 0, 0)).appearance.texture is None
    material = types.SimpleNamespace(image=None)
    visual = types.SimpleNamespace(kind="texture", material=material, uv=None)
    mesh = _trimesh(vertices=square, faces=np.array([(0, 1, 2)]), visual=visual)
    assert xvrml.interop.from_trimesh(mesh).appearance.texture is None


def test_a_real_path_of_trimesh():
    trimesh = pytest.importorskip("trimesh")
    path = trimesh.load_path(np.array([[[0, 0, 0], [1, 0, 0]], [[0, 2, 1], [1, 2, 1]]], float))
    (mesh, ) = xvrml.to_world(path).meshes()
    assert mesh.kind == "lines"
    scene = trimesh.Scene([trimesh.creation.box(), path])
    assert sorted(m.kind for m in xvrml.to_world(scene).meshes()) == ["lines", "triangles"]


def test_a_window_gets_a_file_by_its_name(monkeypatch, tmp_path):
    program = tmp_path / "vv"
    program.write_text('#!/bin/sh\necho "$@" > "$0.args"\n')
    program.chmod(0o755)
    monkeypatch.setenv("OPENRT_VV", str(program))
    (tmp_path / "w.wrl").write_text("#VRML V2.0 utf8\n" + BALL)
    assert xvrml.show(tmp_path / "w.wrl").wait() == 0
    assert (tmp_path / "vv.args").read_text().split() == [str(tmp_path / "w.wrl")]


def test_a_window_gets_the_world_and_the_sizes(monkeypatch, tmp_path):
    program = tmp_path / "vv"
    program.write_text('#!/bin/sh\necho "$@" > "$0.args"\ncat > "$0.world"\n')
    program.chmod(0o755)
    monkeypatch.setenv("OPENRT_VV", str(program))
    assert xvrml.show(np.eye(3), point_size=0.2, size=(300, 200)).wait() == 0
    assert sorted((tmp_path / "vv.args").read_text().split()) == sorted(
        "- --size 300x200 --point-size 0.2".split())
    assert "PointSet" in (tmp_path / "vv.world").read_text()
    with pytest.raises(TypeError, match="spp"):
        xvrml.show(np.eye(3), spp=4)
