"""Tests xvrml.rt: contexts, pictures without VRML, and ray and point queries against brute force
over all triangles."""
import gc
import threading

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")
from xvrml import rt  # noqa: E402

SQUARE = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
FACES = np.array([[0, 1, 2], [0, 2, 3]])


def test_a_picture():
    with rt.Context(threads=1) as context:
        red = context.shader("VRML97", diffuseColor=(1, 0, 0))
        assert red.parameters["diffuseColor"][0] == "color"
        place = context.instance(context.mesh(SQUARE, FACES, shader=red))
        context.light(context.shader("VRML97DirectionalLight", direction=(0, 0, -1)))
        context.camera(eye=(0, 0, 5), at=(0, 0, 0))
        image = context.render(size=(32, 24), spp=1)
        assert isinstance(image,
                          xvrml.Picture) and image.array[12, 16, 0] > 0.1 > image.array[12, 16, 1]
        assert image["z"][12, 16] == pytest.approx(5, abs=1e-4)
        red["diffuseColor"] = (0, 1, 0)
        assert context.render(size=(32, 24), spp=1).array[12, 16, 1] > 0.1
        matrix = np.eye(4)
        matrix[0, 3] = 100
        place.matrix = matrix
        assert not context.render(size=(32, 24), spp=1).array[..., :3].any()
        place.matrix, place.visible = np.eye(4), False
        assert not context.render(size=(32, 24), spp=1).array[..., :3].any()
    assert context.closed
    with pytest.raises(RuntimeError, match="closed"):
        context.render()


def test_textures_have_their_first_row_at_the_top():
    with rt.Context(threads=1) as context:
        pixels = np.array([[[255, 0, 0]], [[0, 0, 255]]], np.uint8)
        texture = context.texture(pixels, filter="nearest", wrap="clamp")
        shader = context.shader("VRML97", texture=texture, emissiveColor=(1, 1, 1)) if "texture" in context.shader("VRML97").parameters \
            else None
        if shader is None:
            pytest.skip("the shader has no parameter of this name")
        context.instance(
            context.mesh(SQUARE, FACES, texcoords=[[0, 0], [1, 0], [1, 1], [0, 1]], shader=shader))
        context.light(context.shader("VRML97DirectionalLight", direction=(0, 0, -1)))
        context.camera(eye=(0, 0, 3), at=(0, 0, 0))
        array = context.render(size=(32, 32), spp=1).array
        assert array[10, 16, 0] > array[10, 16, 2] and array[22, 16, 2] > array[22, 16, 0]


def test_textures_are_mirrored_or_end_at_a_border():
    pixels = np.array([[[255, 0, 0], [0, 0, 255]]], np.uint8)
    # The colours are those beyond the left edge of the picture, whose first pixel is red.
    for wrap, expected in (("repeat", (0, 0, 1)), ("clamp", (1, 0, 0)), ("mirror", (1, 0, 0)),
                           ("border", (0, 1, 0))):
        with rt.Context(threads=1) as context:
            texture = context.texture(pixels, filter="nearest", wrap=wrap, border=(0, 1, 0, 1))
            shader = context.shader("VRML97", texture=texture, lit=0)
            context.instance(
                context.mesh(SQUARE, FACES, texcoords=[[-0.25, 0.5]] * 4, shader=shader))
            context.camera(eye=(0, 0, 3), at=(0, 0, 0))
            array = context.render(size=(8, 8), spp=1).array
            assert array[4, 4, :3] == pytest.approx(expected, abs=1e-3), wrap
    with rt.Context(threads=1) as context:
        with pytest.raises(ValueError, match="'mirror'"):
            context.texture(pixels, wrap="mirrored")
        for wrong in ((0, 0, 0, 2), (0, 0, float("nan"), 0)):
            with pytest.raises((ValueError, RuntimeError), match="0 to 1"):
                context.texture(pixels, wrap="border", border=wrong)


def test_what_is_wrong_is_said():
    context = rt.Context(threads=1)
    other = rt.Context(threads=1)
    surface = context.shader("VRML97")
    mesh = context.mesh(SQUARE, FACES)
    for wrong, error in ((lambda: context.shader("Nothing"),
                          rt.Error), (lambda: surface.__setitem__("diffuseColour", 1), KeyError),
                         (lambda: surface.__setitem__("diffuseColor", (1, 2)),
                          ValueError), (lambda: context.mesh(SQUARE, [[0, 1, 9]]), ValueError),
                         (lambda: context.mesh(SQUARE[:, :2]),
                          ValueError), (lambda: context.mesh(SQUARE, FACES, normals=SQUARE[:2]),
                                        ValueError), (lambda: other.instance(mesh), ValueError),
                         (lambda: context.mesh(SQUARE, FACES, shader=other.shader("VRML97")),
                          ValueError), (lambda: context.mesh(np.full((3, 3), np.nan)),
                                        ValueError), (lambda: context.sphere(-1), ValueError),
                         (lambda: context.render(size=(0, 4)), ValueError), (lambda: context.camera(
                             (0, 0, 0),
                             (0, 0, 0)), ValueError), (lambda: context.cast_rays(np.zeros(
                                 (4, 5))), ValueError),
                         (lambda: context.cast_rays(np.zeros((4, 6)), tnear=-1), ValueError),
                         (lambda: context.compute_closest_points([[0, 0, 0]], radius=0),
                          ValueError), (lambda: context.instance(mesh, np.eye(3)),
                                        ValueError), (lambda: rt.Context(-1), ValueError),
                         (lambda: rt.Context(config="backend=none"), (rt.Error, ValueError))):
        with pytest.raises(error):
            wrong()
    assert context.cast_rays([[0, 0, 1, 0, 0,
                               -1]])["t_hit"].tolist() == [np.inf], "nothing is placed yet"


@pytest.mark.parametrize("call, words", [
    (lambda c: rt.Raycaster(threads="a"),
     "Raycaster(): threads: a whole number expected, not the str 'a'"),
    (lambda c: rt.Context(threads="a"),
     "Context(): threads: a whole number expected, not the str 'a'"),
    (lambda c: c.camera(eye="a", at=(0, 0, 0)),
     "camera(): eye: 3 numbers expected, not the str 'a'"),
    (lambda c: c.camera(eye=(0, 1), at=(0, 0, 0)),
     "camera(): eye: 3 numbers expected, not the tuple (0, 1)"),
    (lambda c: c.render(size="a"), "render(): size: 2 whole numbers expected, not the str 'a'"),
    (lambda c: c.render(progress=3), "progress: True, False, None or a function expected"),
    (lambda c: c.render(channels=5), "channels: a name or several expected"),
    (lambda c: c.mesh("a"), "vertices: numbers of shape (n, 3) expected, not the str 'a'"),
    (lambda c: c.mesh(SQUARE, shader=5), "shader: a Shader or None expected, not the int 5"),
    (lambda c: c.group([5]), "parts: pairs of an Object and its matrix expected, not the int 5"),
    (lambda c: c.instance(c.sphere(1), "m"), "matrix: a 4x4 matrix expected, not the str 'm'"),
    (lambda c: setattr(c.instance(c.sphere(1)), "visible", "a"),
     "Instance.visible: True or False expected, not the str 'a'"),
    (lambda c: c.texture("a"),
     "pixels: an array of shape (height, width, components) expected, not the str 'a'"),
    (lambda c: c.cast_rays("a"), "rays: numbers of shape (..., 6) expected, not the str 'a'"),
    (lambda c: c.shader("VRML97", transparency="a"),
     "VRML97.transparency: a number expected, not the str 'a'"),
    (lambda c: c.shader("VRML97", diffuseColor="a"),
     "VRML97.diffuseColor: 3 numbers (red, green, blue) expected, not the str 'a'"),
    (lambda c: c.light(c.shader("VRML97DirectionalLight"), scope=5),
     "scope: an Instance or None expected, not the int 5"),
    (lambda c: rt.Raycaster().add_sphere(
        (0, 0, 0), "a"), "add_sphere(): radius: a number above 0 expected, not the str 'a'"),
    (lambda c: rt.Raycaster().add_sphere("a", 1),
     "add_sphere(): center: 3 numbers expected, not the str 'a'"),
    (lambda c: rt.Raycaster().add_mesh(5),
     "add_mesh(): mesh: a Mesh of World.meshes() expected, not the int 5"),
    (lambda c: rt.Raycaster().add_triangles(SQUARE, "a"),
     "add_triangles(): triangles: numbers of shape (n, 3) expected, not the str 'a'"),
])
def test_arguments_of_wrong_types_are_named(call, words):
    with pytest.raises(TypeError) as caught:
        call(rt.Context(threads=1))
    assert words in str(caught.value) and "incompatible" not in str(caught.value)


@pytest.mark.parametrize("call, words", [
    (lambda c: rt.Raycaster().add_sphere(
        (0, 0), 1), "add_sphere(): center: 3 numbers expected, not of shape (2,)"),
    (lambda c: rt.Raycaster().add_triangles(SQUARE, [[0, 1.5, 2]]),
     "add_triangles(): triangles: whole numbers expected, not 1.5"),
    (lambda c: rt.Raycaster().add_triangles(SQUARE, [[0, 1, 9]]),
     "add_triangles(): triangles: 9 is no vertex: there are 4"),
    (lambda c: c.mesh(SQUARE, [[0, 1.5, 2]]),
     "faces: whole numbers of shape (n, 3) expected, not 1.5"),
    (lambda c: c.mesh(SQUARE, [[0, np.nan, 2]]),
     "faces: whole numbers of shape (n, 3) expected, not nan"),
    (lambda c: c.cast_rays(np.zeros(
        (4, 5))), "rays: numbers of shape (..., 6) expected, not of shape (4, 5)"),
    (lambda c: rt.Raycaster().compute_occupancy([[0, 0, 0]], nsamples=0),
     "nsamples: a whole number from 1 to 65535 expected, not 0"),
])
def test_wrong_numbers_are_named(call, words):
    with pytest.raises(ValueError) as caught:
        call(rt.Context(threads=1))
    assert words in str(caught.value)


def test_whole_numbers_may_be_written_as_floats():
    caster = rt.Raycaster(threads=1)
    assert caster.add_triangles(SQUARE, FACES.astype(float)) == 0 and caster.add_triangles(
        SQUARE.tolist(), FACES.tolist()) == 1
    assert caster.cast_rays([[0.1, 0, 1, 0, 0, -1]])["t_hit"].tolist() == [1]
    assert rt.Context(threads=1).mesh(SQUARE, FACES.astype(np.float32)).id > 0


def test_things_outlive_the_name_of_their_context():
    mesh = rt.Context(threads=1).mesh(SQUARE, FACES)
    gc.collect()
    mesh.delete()
    with pytest.raises((rt.Error, ValueError)):
        mesh.delete()


# Queries ----------------------------------------------------------------------------------------


def brute(triangles, rays):
    """Returns t of every triangle for every ray, infinite if it is not hit; in double precision."""
    o, d = rays[:, None, :3], rays[:, None, 3:]
    a, e1, e2 = triangles[None, :,
                          0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    p = np.cross(d, e2[None])
    det = (e1[None] * p).sum(-1)
    s = o - a
    u = (s * p).sum(-1) / det
    q = np.cross(s, e1[None])
    v = (d * q).sum(-1) / det
    t = (e2[None] * q).sum(-1) / det
    return np.where((u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0), t, np.inf), u, v


@pytest.fixture
def cloud():
    random = np.random.default_rng(5)
    vertices = (random.normal(size=(100, 1, 3)) + random.normal(size=(100, 3, 3)) * 0.3).reshape(
        -1, 3).astype(np.float32)
    return vertices, np.arange(300).reshape(-1, 3)


def test_rays_by_sums_over_all_triangles(cloud):
    vertices, triangles = cloud
    caster = rt.Raycaster(threads=1)
    assert caster.add_triangles(vertices, triangles) == 0
    rays = np.random.default_rng(6).normal(size=(20, 15, 6)).astype(np.float32)
    hits = caster.cast_rays(rays)
    t, u, v = brute(vertices[triangles].astype(float), rays.reshape(-1, 6).astype(float))
    nearest = t.argmin(1)
    rows = np.arange(len(t))
    expected = t[rows, nearest].reshape(20, 15)
    assert set(hits) == {
        "t_hit", "geometry_ids", "primitive_ids", "primitive_uvs", "primitive_normals"
    }
    assert np.allclose(hits["t_hit"], expected, rtol=1e-4,
                       atol=1e-5) and np.isfinite(expected).sum() > 30
    met = np.isfinite(hits["t_hit"])
    assert (hits["geometry_ids"][met] == 0).all() and (hits["geometry_ids"][~met]
                                                       == caster.INVALID_ID).all()
    assert (hits["primitive_ids"].ravel()[met.ravel()] == nearest[met.ravel()]).all()
    uv = np.stack([u, v], -1)[rows, nearest].reshape(20, 15, 2)
    assert np.allclose(hits["primitive_uvs"][met], uv[met], atol=1e-3)
    corners = vertices[triangles[hits["primitive_ids"][met]]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.allclose(normals / np.linalg.norm(normals, axis=1)[:, None],
                       hits["primitive_normals"][met],
                       atol=1e-3)
    assert (caster.test_occlusions(rays) == met).all()
    assert (caster.test_occlusions(rays, tfar=1e-6) == False).all()  # noqa: E712
    counts = np.isfinite(t).sum(1).reshape(20, 15)
    assert (caster.count_intersections(rays) == counts).mean() > 0.99
    all_hits = caster.list_intersections(rays)
    splits = all_hits["ray_splits"]
    assert splits[-1] == len(
        all_hits["t_hit"]) and (np.diff(splits) == caster.count_intersections(rays).ravel()).all()
    for ray in range(300):
        part = slice(splits[ray], splits[ray + 1])
        assert (all_hits["ray_ids"][part] == ray).all() and (np.diff(all_hits["t_hit"][part])
                                                             >= 0).all()


def test_an_instance_has_a_fog_of_its_own():
    """A glowing square 8 before the camera, in linear fog that hides everything at 10."""
    with rt.Context(threads=1) as context:
        glow = context.shader("VRML97", diffuseColor=(0, 0, 0), emissiveColor=(1, 0, 0))
        placed = context.instance(context.mesh(SQUARE, FACES, shader=glow))
        context.camera(eye=(0, 0, 8), at=(0, 0, 0), height=.01)
        air = context.shader("VRML97Environment", fogType=1, fogRange=10, fogColor=(0, 0, 1))

        def seen():
            return context.render(size=(2, 2), spp=1).array[0, 0, :3]

        assert np.allclose(seen(), (1, 0, 0))
        placed.fog = air
        assert np.allclose(seen(), (.2, 0, .8), atol=1e-4)
        placed.fog = None
        assert np.allclose(seen(), (1, 0, 0))
        with pytest.raises(rt.Error, match="environment"):
            placed.fog = glow


def test_triangles_without_area_keep_their_numbers():
    caster = rt.Raycaster(threads=1)
    caster.add_triangles(SQUARE, [[0, 0, 1], [0, 1, 2], [1, 1, 1], [0, 2, 3]])
    hits = caster.cast_rays([[0.5, -0.5, 1, 0, 0, -1], [-0.5, 0.5, 1, 0, 0, -1]])
    assert hits["primitive_ids"].tolist() == [1, 3]


def test_surfaces_without_facets():
    """Rays meet quadrics and aspheres where their equations say."""
    with rt.Context(threads=1) as context:
        context.instance(context.cylinder(2, -1, 1, name=7), user_data=1)
        hits = context.cast_rays([[9, .5, 0, -1, 0, 0], [9, 1.5, 0, -1, 0, 0]])
        assert hits["t_hit"].tolist() == [7, np.inf]
        assert np.allclose(hits["primitive_normals"][0], (1, 0, 0))
    with rt.Context(threads=1) as context:
        context.instance(context.cone(2, 1, -1, 1))
        assert context.cast_rays([[9, 0, 0, -1, 0, 0]])["t_hit"][0] == pytest.approx(7.5)
    with rt.Context(threads=1) as context:
        ellipsoid = (1 / 4, 1, 1 / 9, 0, 0, 0, 0, 0, 0, -1)
        context.instance(context.quadric(ellipsoid, (-2, -1, -3), (2, 1, 3)))
        rays = [[9, 0, 0, -1, 0, 0], [0, 9, 0, 0, -1, 0], [0, 0, 9, 0, 0, -1]]
        assert np.allclose(context.cast_rays(rays)["t_hit"], (7, 8, 6))
        assert context.count_intersections(rays).tolist() == [2, 2, 2]
    with rt.Context(threads=1) as context:
        context.instance(context.asphere(1 / 4, 2, conic=-1, terms=(.01, .002), inner_radius=.5))
        x = np.array([.4, .6, 1.5, 2.1])
        rays = np.column_stack([x, 0 * x, 0 * x + 9, 0 * x, 0 * x, 0 * x - 1])
        expected = np.where((x > .5) & (x < 2), 9 - (x**2 / 8 + .01 * x**4 + .002 * x**6), np.inf)
        assert np.allclose(context.cast_rays(rays)["t_hit"], expected, rtol=1e-6)


def test_closest_points_are_refused_on_surfaces_without_facets():
    with rt.Context(threads=1) as context:
        context.instance(context.cylinder(1, -1, 1))
        with pytest.raises(rt.Error, match="quadric"):
            context.compute_closest_points([[0, 0, 5]])


def test_front_and_back_of_surfaces_without_facets():
    with rt.Context(threads=1) as context:

        def normal(ccw):
            thing = context.instance(context.asphere(0, 1, ccw=ccw))
            hit = context.cast_rays([[0, 0, 5, 0, 0, -1]])
            thing.delete()
            return hit["primitive_normals"][0].tolist()

        assert normal(True) == [0, 0, 1] and normal(False) == [0, 0, -1]


@pytest.mark.parametrize("wrong", [
    lambda c: c.cylinder(-1, 0, 1), lambda c: c.cylinder(1, 1, 0), lambda c: c.cone(0, 0, 0, 1),
    lambda c: c.quadric((0,) * 10, (-1, -1, -1), (1, 1, 1)), lambda c: c.quadric(
        (1,) * 10, (1, 1, 1),
        (-1, -1, -1)), lambda c: c.asphere(1, 2), lambda c: c.asphere(np.nan, 1),
    lambda c: c.asphere(0, 1, terms=[0] * 9), lambda c: c.asphere(0, 1, inner_radius=2)
])
def test_surfaces_that_make_no_sense_are_refused(wrong):
    with rt.Context(threads=1) as context:
        with pytest.raises(ValueError):
            wrong(context)
        with pytest.raises(TypeError):
            context.quadric((1, 2), (-1, -1, -1), (1, 1, 1))


def test_closest_points(cloud):
    vertices, triangles = cloud
    caster = rt.Raycaster(threads=1)
    caster.add_sphere((10, 0, 0), 2)
    ball = caster.compute_closest_points([[10, 5, 0], [10, 0, 1]])
    assert np.allclose(ball["distances"], [3, 1]) and np.allclose(ball["points"],
                                                                  [[10, 2, 0], [10, 0, 2]])
    number = caster.add_triangles(vertices, triangles)
    queries = np.random.default_rng(7).normal(size=(50, 3)).astype(np.float32)
    found = caster.compute_closest_points(queries)
    w = np.stack(np.meshgrid(np.linspace(0, 1, 40), np.linspace(0, 1, 40)), -1).reshape(-1, 2)
    w = w[w.sum(1) <= 1]
    corners = vertices[triangles].astype(float)
    samples = (corners[:, None, 0] * (1 - w.sum(1))[None, :, None] +
               corners[:, None, 1] * w[None, :, :1] + corners[:, None, 2] * w[None, :, 1:]).reshape(
                   -1, 3)
    best = np.sqrt(((queries[:, None] - samples[None])**2).sum(-1).min(1))
    assert (found["distances"] <= best + 1e-5).all() and (found["distances"] > best - 0.03).all()
    assert (found["geometry_ids"] == number).all()
    on = corners[found["primitive_ids"]]
    u, v = found["primitive_uvs"].T
    assert np.allclose(on[:, 0] * (1 - u - v)[:, None] + on[:, 1] * u[:, None] +
                       on[:, 2] * v[:, None],
                       found["points"],
                       atol=1e-4)
    near = caster.compute_closest_points(queries + 1000, radius=1)
    assert np.isnan(near["points"]).all() and (near["geometry_ids"] == caster.INVALID_ID).all()
    assert np.allclose(caster.compute_distance(queries), found["distances"])


def test_inside_and_outside():
    world = xvrml.World()
    world.add(
        xvrml.Transform(translation=(0, 0, 3),
                        children=[xvrml.Shape(geometry=xvrml.Box(size=(2, 2, 2)))]))
    caster = world.raycaster()
    queries = [[0, 0, 3], [0.5, 0, 3], [0, 0, 0]]
    assert caster.compute_occupancy(queries, nsamples=3).tolist() == [1, 1, 0]
    assert np.allclose(caster.compute_signed_distance(queries, nsamples=3), [-1, -0.5, 2])
    assert isinstance(caster.meshes[0].node, xvrml.Shape)


def test_pinhole_rays_are_those_of_the_camera():
    rays = rt.create_rays_pinhole(90,
                                  center=(0, 0, 0),
                                  eye=(0, 0, 5),
                                  up=(0, 1, 0),
                                  width_px=4,
                                  height_px=2)
    # as in Open3D: the first row is the lowest, and columns go from right to left
    assert rays.shape == (2, 4, 6) and np.allclose(
        rays[0, 0, 3:], [0.75, -0.25, -1]) and np.allclose(rays[1, 3, 3:], [-0.75, 0.25, -1])


def test_empty_and_hostile_rays(cloud):
    caster = rt.Raycaster(threads=1)
    caster.add_triangles(*cloud)
    assert caster.cast_rays(np.zeros(
        (0, 6)))["t_hit"].shape == (0,) and caster.cast_rays(np.zeros(
            (3, 0, 6)))["primitive_uvs"].shape == (3, 0, 2)
    rays = np.array([[np.nan] * 6, [0, 0, 0, 0, 0, 0], [np.inf, 0, 0, 1, 0, 0], [1e30] * 6],
                    np.float32)
    assert np.isinf(caster.cast_rays(rays)["t_hit"]).all() and caster.count_intersections(
        rays).tolist() == [0] * 4
    assert np.isnan(caster.compute_closest_points([[np.nan, 0, 0]])["points"]).all()
    one = caster.cast_rays(np.array([0, 0, 9, 0, 0, -1], np.float64))
    assert one["t_hit"].shape == ()


def test_threads_take_turns(cloud):
    caster = rt.Raycaster()
    caster.add_triangles(*cloud)
    rays = np.random.default_rng(8).normal(size=(20_000, 6)).astype(np.float32)
    expected = caster.cast_rays(rays)["t_hit"]
    results = [None] * 4

    def work(i):
        results[i] = caster.cast_rays(rays)["t_hit"]

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for result in results:
        assert np.array_equal(result, expected)
