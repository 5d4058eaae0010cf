"""Tests each adapter of xvrml.interop if its package is installed."""
import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")
from xvrml import _placing, interop  # noqa: E402

SMALL = dict(size=(32, 24), spp=1)


@pytest.fixture
def world():
    return xvrml.load(
        b"#VRML V2.0 utf8\nViewpoint { position 0 0 9 } Transform { translation 1 0 0 children DEF B Shape { geometry Box { }"
        b" appearance Appearance { material Material { diffuseColor 1 0 0 } } } } DEF S Shape { geometry Sphere { } }"
    )


def test_trimesh_out(world):
    pytest.importorskip("trimesh")
    scene = interop.to_trimesh(world)
    assert len(scene.geometry) == 2 and np.allclose(scene.bounds, [[-1, -1, -1], [2, 1, 1]],
                                                    atol=0.01)
    box = next(mesh for mesh in scene.geometry.values() if len(mesh.faces) == 12)
    assert box.volume == pytest.approx(8) and box.visual.vertex_colors[0].tolist() == [
        255, 0, 0, 255
    ]


def test_trimesh_in():
    trimesh = pytest.importorskip("trimesh")
    world = xvrml.World()
    world.add(xvrml.Viewpoint(position=(0, 0, 9)))
    shape = world.add(interop.from_trimesh(trimesh.creation.icosphere(), color=(0, 1, 0)))
    array = world.render(**SMALL).array
    assert array[12, 16, 1] > 0.1 and isinstance(shape, xvrml.Shape)
    scene = trimesh.Scene()
    matrix = trimesh.transformations.rotation_matrix(0.7, (1, 2, 3))
    matrix[:3, :3] *= (1, 2, 0.5)
    matrix[:3, 3] = (1, 2, 3)
    scene.add_geometry(trimesh.creation.box(), transform=matrix)
    other = xvrml.World()
    other.add(interop.from_trimesh(scene))
    (mesh,) = other.meshes()
    assert np.allclose(mesh.matrix, matrix, atol=1e-5)
    assert np.allclose(interop.to_trimesh(other).bounds, scene.bounds, atol=1e-4)


@pytest.mark.parametrize("seed", range(5))
def test_any_affine_matrix_is_a_transform(seed):
    random = np.random.default_rng(seed)
    matrix = np.eye(4)
    matrix[:3] = random.normal(size=(3, 4))
    matrix[0] *= np.sign(np.linalg.det(matrix[:3, :3]))  # a Transform cannot mirror
    world = xvrml.World()
    world.add(_placing.placed(xvrml.Shape(geometry=xvrml.Box()), matrix))
    assert np.allclose(world.meshes()[0].matrix, matrix, atol=1e-5)


def test_pyvista_out(world):
    pytest.importorskip("pyvista")
    blocks = interop.to_pyvista(world)
    assert len(blocks) == 2 and blocks["B"].n_cells == 12 and np.allclose(
        blocks["B"].bounds, (0, 2, -1, 1, -1, 1))
    assert blocks["B"].volume == pytest.approx(8, rel=1e-5)


def test_pictures(world):
    pytest.importorskip("PIL")
    image = world.render(**SMALL)
    shown = interop.to_pil(image)
    assert shown.size == (32, 24) and np.array_equal(np.asarray(shown), image.display)
    texture = interop.from_pil(shown)
    assert texture.node_type == "PixelTexture" and np.array_equal(texture.image, image.display)


def test_matplotlib(world):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    image = world.render(**SMALL)
    assert interop.imshow(image).get_array().shape == (24, 32, 3)
    assert interop.imshow(image, "z").get_array().shape == (24, 32)


def test_jupyter_shows_a_picture(world):
    assert world.render(**SMALL)._repr_png_().startswith(b"\x89PNG")
    formatters = pytest.importorskip("IPython.core.formatters")
    assert formatters.PNGFormatter()(world.render(**SMALL)).startswith(b"\x89PNG")
