"""Raycaster.update(): bodies that move and change their shape. Every query answers as a new
Raycaster of the same bodies would, in both precisions; bad arrays change nothing and get one
sentence."""
import threading

import numpy as np
import pytest

xvrml = pytest.importorskip("xvrml")
rt = xvrml.rt

TETRA = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def poses(random, count):
    """Returns random placements (count, 4, 4), also mirrored and scaled ones."""
    matrices = np.tile(np.eye(4), (count, 1, 1))
    matrices[:, :3, :3] = np.linalg.qr(random.normal(size=(count, 3, 3)))[0]
    matrices[:, :3, :3] *= random.uniform(.5, 2, (count, 1, 1))
    matrices[:, :3, 3] = random.uniform(-5, 5, (count, 3))
    return matrices


def answers(caster, rays):
    """Returns what all queries say, as a dict of arrays."""
    out = {}
    for precision in ("single", "double"):
        options = dict(precision=precision, errors=precision == "double")
        for name, query in (("cast", caster.cast_rays), ("list", caster.list_intersections)):
            for key, array in query(rays, **options).items():
                out[precision, name, key] = array
        out[precision, "count"] = caster.count_intersections(rays, precision=precision)
        out[precision, "occluded"] = caster.test_occlusions(rays, precision=precision)
    out["closest"] = caster.compute_distance(rays[:, :3])
    return out


def expect_same(found, wanted):
    assert found.keys() == wanted.keys()
    for key, array in found.items():
        if "double" in key:
            assert np.array_equal(array, wanted[key], equal_nan=True), key
        elif array.dtype.kind == "f":  # what rests is rounded to float otherwise than what moves
            assert np.allclose(array, wanted[key], rtol=1e-4, atol=1e-4, equal_nan=True), key


def rays_through(random, count=300):
    start = random.uniform(-9, 9, (count, 3))
    return np.concatenate([start, random.uniform(-4, 4, (count, 3)) - start], 1)


def caster_of(shapes, matrices):
    caster = rt.Raycaster(threads=2)
    for (vertices, faces), matrix in zip(shapes, matrices):
        caster.add_triangles(vertices, faces, matrix)
    return caster


def test_moved_and_deformed_bodies_are_where_a_new_scene_has_them():
    random = np.random.default_rng(1)
    shapes, matrices = [(TETRA, FACES)] * 20, poses(random, 20)
    caster, rays = caster_of(shapes, matrices), rays_through(random)
    expect_same(answers(caster, rays), answers(caster_of(shapes, matrices), rays))
    for step in range(6):
        if step < 3:
            matrices = poses(random, 20)
            caster.update(matrices=matrices)
        else:
            some = random.choice(20, 5, replace=False)
            matrices[some] = poses(random, 5)
            caster.update(some, matrices=matrices[some])
        if step % 2:
            number = int(random.integers(20))
            shapes[number] = (TETRA + random.normal(size=(4, 3)).astype(np.float32) * .2, FACES)
            caster.update(number, vertices=shapes[number][0])
        if step == 4:  # other triangles, one of which has no area, and a place
            vertices = random.normal(size=(9, 3))
            faces = np.array([[0, 0, 1], [0, 1, 2], [3, 4, 5], [6, 7, 8]])
            shapes[7], matrices[7] = (vertices, faces), poses(random, 1)[0]
            caster.update(7, matrices=matrices[7], vertices=vertices, triangles=faces)
        expect_same(answers(caster, rays), answers(caster_of(shapes, matrices), rays))
    assert caster.meshes[7][1].shape == (4, 3)
    assert set(caster.list_intersections(rays)["primitive_ids"]) <= {0, 1, 2, 3}


def test_parity_stays_right_while_bodies_move():
    """Every ray from outside enters closed bodies as often as it leaves them, also if it is aimed at
    vertices and edges."""
    random = np.random.default_rng(2)
    matrices = poses(random, 30)
    caster = caster_of([(TETRA, FACES)] * 30, matrices)
    for _ in range(5):
        matrices = poses(random, 30)
        caster.update(matrices=matrices)
        corners = (matrices[:, None, :3, :3] @ TETRA[None, :, :, None])[..., 0]
        corners = (corners + matrices[:, None, :3, 3]).reshape(-1, 3)
        to = np.concatenate([corners, (corners[::2] + corners[1::2]) / 2])
        start = np.array([20, 1, 2]) + random.normal(size=to.shape)
        rays = np.concatenate([start, to - start], 1)
        for precision in ("single", "double"):
            assert not np.any(caster.count_intersections(rays, precision=precision) % 2)


def test_a_sphere_moves():
    caster = rt.Raycaster(threads=1)
    caster.add_sphere((0, 0, 0), 1)
    matrix = np.eye(4)
    matrix[:3, 3] = 0, 0, -5
    caster.update(0, matrices=matrix)
    for precision in ("single", "double"):
        assert caster.cast_rays([0, 0, 3, 0, 0, -1], precision=precision)["t_hit"] == 7


WORLD = """#VRML V2.0 utf8
DEF Move Transform { children Shape { geometry Box {} } }
DEF Faces Shape { geometry DEF Set IndexedFaceSet {
  coord DEF Points Coordinate { point [ 5 0 0, 6 0 0, 5 1 0 ] } coordIndex [ 0 1 2 -1 ] } }
Shape { geometry Sphere { radius .5 } }
Shape { geometry IndexedLineSet { coord USE Points coordIndex [ 0 1 2 -1 ] } }
"""


def test_the_meshes_of_a_world():
    world = xvrml.loads(WORLD)
    caster, rays = world.raycaster(), rays_through(np.random.default_rng(3))
    for step in range(4):
        world["Move"].translation = (step, -step, .5)
        world["Points"].point = [(5 - step, 0, 0), (6, step, 0), (5, 1, step / 4)]
        if step == 3:  # a single one of them
            single, = [mesh for mesh in world.meshes(spheres=0) if mesh.node == world["Faces"]]
            caster.update(single)
        caster.update(world.meshes(spheres=0))
        expect_same(answers(caster, rays), answers(world.raycaster(), rays))
    world["Set"].coordIndex = [0, 2, 1, -1]
    caster.update(world.meshes(spheres=0))
    with pytest.raises(ValueError, match="other shapes are drawn now"):
        caster.update(world.meshes(spheres=0)[:1])
    lines = [mesh for mesh in world.meshes(spheres=0) if mesh.kind not in ("triangles", "sphere")]
    with pytest.raises(ValueError, match="0 bodies come from the Shape"):
        caster.update(lines[0])
    with pytest.raises(TypeError, match="give nothing else"):
        caster.update(world.meshes(spheres=0), matrices=np.eye(4))


NAN = np.full((4, 4), np.nan)
FLIPPED = np.eye(4)
FLIPPED[3, 0] = 2


@pytest.mark.parametrize("arguments, error, text", [
    ({}, TypeError, "matrices or vertices must be given"),
    ({
        "which": 3,
        "matrices": np.eye(4)
    }, ValueError, "3 is no body: there are 3, from 0 on"),
    ({
        "which": -1,
        "matrices": np.eye(4)
    }, ValueError, "-1 is no body"),
    ({
        "which": [0, 2**40],
        "matrices": [np.eye(4)] * 2
    }, ValueError, "is no body"),
    ({
        "which": 1.5,
        "matrices": np.eye(4)
    }, TypeError, "numbers of bodies expected"),
    ({
        "which": "all",
        "matrices": np.eye(4)
    }, TypeError, "which: numbers"),
    ({
        "which": [[0]],
        "matrices": np.eye(4)
    }, ValueError, "which: numbers"),
    ({
        "matrices": np.eye(4)
    }, ValueError, r"matrices: numbers of shape \(3, 4, 4\) expected"),
    ({
        "matrices": np.zeros((3, 3, 4))
    }, ValueError, r"shape \(3, 4, 4\) expected"),
    ({
        "matrices": [np.eye(4), np.eye(4), NAN]
    }, ValueError, "all of them finite"),
    ({
        "matrices": [np.eye(4), np.eye(4), FLIPPED]
    }, ValueError, "a last row of 0 0 0 1 expected"),
    ({
        "matrices": "here"
    }, TypeError, "matrices: numbers"),
    ({
        "which": 0,
        "matrices": np.eye(4, dtype=complex)
    }, TypeError, "matrices: numbers"),
    ({
        "vertices": TETRA
    }, ValueError, "give its number, not 3"),
    ({
        "which": 0,
        "triangles": FACES
    }, TypeError, "matrices or vertices"),
    ({
        "which": 0,
        "matrices": np.eye(4),
        "triangles": FACES
    }, TypeError, "vertices must be given"),
    ({
        "which": 2,
        "vertices": TETRA
    }, ValueError, "was not made by add_triangles"),
    ({
        "which": 0,
        "vertices": TETRA[:, :2]
    }, ValueError, r"shape \(n, 3\) expected"),
    ({
        "which": 0,
        "vertices": TETRA[:3]
    }, ValueError, "3 is no vertex: there are 3"),
    ({
        "which": 0,
        "vertices": TETRA * np.nan
    }, ValueError, "within 1e38 expected"),
    ({
        "which": 0,
        "vertices": TETRA.astype(float) * 1e39
    }, ValueError, "within 1e38 expected"),
    ({
        "which": 0,
        "vertices": TETRA,
        "triangles": FACES + .5
    }, ValueError, "whole numbers"),
    ({
        "which": 0,
        "vertices": TETRA,
        "triangles": [[0, 1, -1]]
    }, ValueError, "is no vertex"),
    ({
        "which": 0,
        "vertices": ["a"]
    }, (TypeError, ValueError), "vertices"),
])
def test_wrong_arguments_change_nothing(arguments, error, text):
    random = np.random.default_rng(4)
    caster, rays = rt.Raycaster(threads=1), rays_through(random, 50)
    matrices = poses(random, 2)
    for matrix in matrices:
        caster.add_triangles(TETRA, FACES, matrix)
    caster.add_sphere((1, 2, 3), .5)
    before = answers(caster, rays)
    with pytest.raises(error, match=text):
        caster.update(**arguments)
    after = answers(caster, rays)
    for key, array in before.items():
        assert np.array_equal(after[key], array, equal_nan=True)


def test_arrays_of_any_layout_and_no_bodies():
    caster = caster_of([(TETRA, FACES)] * 2, [np.eye(4)] * 2)
    matrices = np.tile(np.eye(4), (2, 1, 1))
    matrices[:, 0, 3] = 10, 20
    for same in (np.asfortranarray(matrices), matrices.tolist(), matrices.astype(">f8"),
                 matrices.astype(np.float32), matrices[::-1][::-1]):
        caster.update(matrices=np.tile(np.eye(4), (2, 1, 1)))
        caster.update(matrices=same)
        hits = caster.cast_rays([[10.1, .1, 5, 0, 0, -1], [20.1, .1, 5, 0, 0, -1],
                                 [.1, .1, 5, 0, 0, -1]])
        assert hits["geometry_ids"].tolist() == [0, 1, caster.INVALID_ID]
    caster.update([], matrices=np.zeros((0, 4, 4)))
    rt.Raycaster(threads=1).update(matrices=np.zeros((0, 4, 4)))
    singular = np.diag((1., 0, 1, 1))
    caster.update(0, matrices=singular)  # draws nothing
    assert caster.count_intersections([.1, .1, 5, 0, 0, -1]) == 0
    caster.update(0, matrices=np.eye(4))
    assert caster.count_intersections([.1, .1, 5, 0, 0, -1], precision="double") == 2


def test_instances_of_a_context_move_at_once():
    with rt.Context(threads=1) as context, rt.Context(threads=1) as other:
        body = context.mesh(TETRA, FACES)
        places = [context.instance(body, user_data=i, dynamic=True) for i in range(3)]
        matrices = np.tile(np.eye(4), (3, 1, 1))
        matrices[:, 0, 3] = 10, 20, 30
        context.move_instances(places, matrices)
        rays = [[x + .1, .1, 5, 0, 0, -1] for x in (10, 20, 30)]
        assert context.cast_rays(rays)["geometry_ids"].tolist() == [0, 1, 2]
        points = context.cast_rays(rays, precision="double")["points"]
        assert np.allclose(points, [(x + .1, .1, .8) for x in (10, 20, 30)], rtol=0, atol=1e-7)
        context.mesh(TETRA * 2, FACES, replaces=body)
        assert context.cast_rays(rays)["t_hit"].max() < 4
        with pytest.raises(ValueError, match=r"matrices: numbers of shape \(3, 4, 4\) expected"):
            context.move_instances(places, matrices[:2])
        with pytest.raises(ValueError, match="one of another context"):
            other.move_instances(places, matrices)
        with pytest.raises(ValueError, match="an object of another context"):
            other.mesh(TETRA, FACES, replaces=body)
        with pytest.raises(TypeError, match="replaces: an Object or None expected"):
            context.mesh(TETRA, FACES, replaces=3)
        with pytest.raises(TypeError, match="instances: Instances expected"):
            context.move_instances([1, 2, 3], matrices)


def test_queries_and_updates_of_several_threads():
    """A hit belongs to the bodies before an update or after it. The shapes have triangles without
    area at different places, so that ids of the one are wrong for the other."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], float)
    shapes = {4: [[0, 1, 1]] * 4 + [[0, 1, 2]], 0: [[0, 1, 2], [0, 0, 1]]}
    caster = rt.Raycaster(threads=1)
    for _ in range(20):
        caster.add_triangles(corners, shapes[0])
    rays, wrong, done = np.array([[.2, .2, 5, 0, 0, -1.]] * 50), [], threading.Event()

    def ask(precision):
        while not done.is_set():
            try:
                for hits in (caster.cast_rays(rays, precision=precision),
                             caster.list_intersections(rays, precision=precision)):
                    wrong.extend(set(hits["primitive_ids"].tolist()) - set(shapes))
            except Exception as error:  # pylint: disable=broad-except
                wrong.append(error)

    threads = [threading.Thread(target=ask, args=(p,)) for p in ("single", "double")]
    for thread in threads:
        thread.start()
    for step in range(150):
        caster.update(step % 20, vertices=corners, triangles=shapes[4 * (step // 20 % 2)])
        caster.update(matrices=np.tile(np.eye(4), (20, 1, 1)))
    done.set()
    for thread in threads:
        thread.join()
    assert not wrong, wrong[:3]
