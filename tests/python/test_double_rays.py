"""Ray queries with precision="double": which triangles and spheres a ray crosses is that of exact
rational arithmetic, and no number is farther from the truth than its bound. Bad arrays get one
sentence."""
import math
import pathlib
import sys
from fractions import Fraction

import numpy as np
import pytest
from exact_geometry import soup

rt = pytest.importorskip("xvrml").rt

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
from rational_rays import cross, crossings, dot, minus, moved, rational  # noqa: E402


def turn(random):
    q = np.linalg.qr(random.normal(size=(3, 3)))[0]
    return q * np.sign(np.linalg.det(q))


def matrix_of(linear, move):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = linear, move
    return matrix


def places(random):
    """Returns named matrices: all kinds that bodies are placed by, also extreme ones."""
    return {
        "as it is": np.eye(4),
        "moved": matrix_of(np.eye(3), random.normal(size=3)),
        "turned": matrix_of(turn(random), random.normal(size=3)),
        "mirrored": matrix_of(turn(random) @ np.diag((1, -1, 1)), random.normal(size=3)),
        "scaled": matrix_of(turn(random) @ np.diag((.01, 3, 700)), random.normal(size=3)),
        "sheared": matrix_of(random.normal(size=(3, 3)), random.normal(size=3)),
        "flat": matrix_of(turn(random) @ np.diag((1, 1, 1e-9)), random.normal(size=3)),
        "tiny": matrix_of(turn(random) * 1e-12, random.normal(size=3)),
    }


def rays_at(random, points, count):
    """Returns rays in double through vertices, edges and faces, near and far."""
    share = random.dirichlet(np.ones(3), count) * random.choice((0, 1), (count, 3), p=(.3, .7))
    share /= np.maximum(share.sum(1, keepdims=True), 1e-9)
    to = np.einsum("ik,ikj->ij", share, points[random.integers(len(points), size=(count, 3))])
    some = random.random(count) < .3  # exactly at a vertex, if the differences are exact
    to[some] = points[random.integers(len(points), size=np.count_nonzero(some))]
    size = np.ptp(points, 0).max() + 1e-300
    start = points.mean(0) + random.normal(size=(count, 3)) * size * random.choice(
        (.1, 1, 1e3, 1e6), (count, 1))
    along = np.eye(3)[random.integers(3, size=count)] * size
    grid = random.random(count) < .3
    start[grid] = to[grid] - 2 * along[grid]
    direction = np.where(grid[:, None], along, to - start)
    direction *= random.choice((1, 1e-9, 1e6), (count, 1))
    return np.concatenate([start, direction], 1)[np.abs(direction).max(1) > 0]


def within(value, truth, bound):
    return abs(Fraction(float(value)) - truth) <= Fraction(float(bound))


def check_hit(found, i, at, ray, offset):
    """Checks the numbers of hit i against the truth."""
    assert within(found["t_hit"][i], at.t, found["t_errors"][i])
    assert within(found["primitive_uvs"][i, 0], at.u, found["uv_errors"][i])
    assert within(found["primitive_uvs"][i, 1], at.v, found["uv_errors"][i])
    for k in range(3):
        assert within(found["points"][i, k], at.point[k], found["point_errors"][i])
    # A bound that says nothing is none.
    assert found["t_errors"][i] <= 1e-13 * abs(found["t_hit"][i])
    assert found["uv_errors"][i] <= 2e-11
    length = math.sqrt(float(dot(at.normal, at.normal)))
    if length > 1e-150:
        want = np.array([float(x) for x in at.normal]) / length
        assert abs(abs(want @ found["primitive_normals"][i]) - 1) < 1e-6
    size = max(abs(x) for x in [*ray[:3], *map(float, at.point), offset])
    assert found["point_errors"][i] <= 1e-12 * size


@pytest.mark.parametrize("kind", ["lattice", "far", "slivers", "random"])
@pytest.mark.parametrize("offset", [0, 1, 1e3, 1e6])
def test_every_number_is_within_its_bound_of_the_truth(kind, offset):
    random = np.random.default_rng([len(kind), int(offset)])
    ties = checked = 0
    for name, matrix in places(random).items():
        points, triangles = soup(random, kind)
        matrix[:3, 3] += offset
        caster = rt.Raycaster(threads=2)
        caster.add_triangles(points, triangles, matrix)
        exact = [rational(row) for row in matrix[:3]]
        corners = [moved(exact, rational(p)) for p in points]
        world = np.array([[float(x) for x in p] for p in corners])
        rays = rays_at(random, world, 10)
        for near, far in ((0, math.inf), (.5, 2.)):
            ends = dict(tnear=near, tfar=far, precision="double")
            counts = caster.count_intersections(rays, **ends)
            occluded = caster.test_occlusions(rays, **ends)
            found = caster.list_intersections(rays, errors=True, **ends)
            first = caster.cast_rays(rays, errors=True, **ends)
            for i, ray in enumerate(rays):
                wanted = crossings(ray, corners, triangles, near, far)
                begin, end = found["ray_splits"][i:i + 2]
                assert counts[i] == len(wanted), name
                assert occluded[i] == bool(wanted)
                assert sorted(found["primitive_ids"][begin:end]) == sorted(wanted)
                assert np.all(np.diff(found["t_hit"][begin:end]) >= 0)
                for k in range(begin, end):
                    at = wanted[found["primitive_ids"][k]]
                    check_hit(found, k, at, ray, offset)
                    ties += at.tie
                    checked += 1
                if wanted:
                    nearest = min(wanted.values(), key=lambda at: at.t)
                    assert within(first["t_hit"][i], nearest.t, first["t_errors"][i])
                    for k in range(3):
                        assert within(first["points"][i, k], nearest.point[k],
                                      first["point_errors"][i])
                else:
                    assert np.isinf(
                        first["t_hit"]
                        [i]) and first["primitive_ids"][i] == caster.INVALID_ID and np.isnan(
                            first["points"][i]).all()
    assert checked > 100 and (ties > 0 or kind != "lattice")


def test_many_bodies_at_once():
    """More bodies and triangles than are tried without boxes, also at the same places."""
    random = np.random.default_rng(9)
    caster = rt.Raycaster()
    corners, all_triangles, body, of = [], [], [], []
    for number in range(12):
        points, triangles = soup(random, ("lattice", "random")[number % 2])
        matrix = matrix_of(turn(random), random.integers(-3, 4, 3) + 1e5)
        if number % 3 == 0:
            matrix[:3, :3] = np.eye(3)
        caster.add_triangles(points, triangles, matrix)
        exact = [rational(row) for row in matrix[:3]]
        all_triangles += (triangles + len(corners)).tolist()
        corners += [moved(exact, rational(p)) for p in points]
        body += [number] * len(triangles)
        of += range(len(triangles))
    world = np.array([[float(x) for x in p] for p in corners])
    rays = rays_at(random, world, 25)
    found = caster.list_intersections(rays, precision="double", errors=True)
    first = caster.cast_rays(rays, precision="double", errors=True)
    for i, ray in enumerate(rays):
        wanted = crossings(ray, corners, all_triangles)
        rows = slice(*found["ray_splits"][i:i + 2])
        assert sorted(zip(found["geometry_ids"][rows], found["primitive_ids"][rows])) == sorted(
            (body[n], of[n]) for n in wanted)
        if wanted:
            nearest = min(at.t for at in wanted.values())
            assert within(first["t_hit"][i], nearest, first["t_errors"][i])


def test_the_bound_says_so_where_two_bodies_nearly_touch():
    """The order of two surfaces that are nearer together than the last place is left open, and the
    bound of the first hit covers both."""
    caster = rt.Raycaster(threads=1)
    square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
    random, gap = np.random.default_rng(5), 2.0**-40
    linear = turn(random)
    for shift in (0, gap):
        caster.add_triangles(square, [[0, 1, 2], [0, 2, 3]],
                             matrix_of(linear, linear[:, 2] * shift + 1e6))
    to = linear @ np.array([.3, .2, 0]) + 1e6
    rays = np.concatenate([to - linear[:, 2] * 7, linear[:, 2]])[None]
    hits = caster.cast_rays(rays, precision="double", errors=True)
    assert abs(hits["t_hit"][0] - 7) <= 1e-8 and 0 < hits["t_errors"][0] <= 1e-8


def test_rays_are_not_rounded_to_float():
    caster = rt.Raycaster(threads=1)
    caster.add_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]],
                         matrix_of(np.eye(3), (1e6, 1e6, 0)))
    step = 2.0**-30
    rays = np.array([[1e6 + x, 1e6 + .5, 3, 0, 0, -1] for x in (-step, step, .5 - step, .5 + step)])
    assert caster.count_intersections(rays, precision="double").tolist() == [0, 1, 1, 0]
    hits = caster.cast_rays(rays, precision="double", tfar=3 - 2.0**-50)
    assert not np.isfinite(hits["t_hit"]).any()
    hits = caster.cast_rays(rays, precision="double", tfar=3)
    assert np.isfinite(hits["t_hit"]).tolist() == [False, True, True, False]
    assert hits["primitive_uvs"][1].tolist() == [step, .5]
    caster.add_sphere((1e6, 5, 0), 1)
    points = [[1e6 + 1 + x, 5, 0] for x in (step, -step)]
    assert caster.compute_occupancy(points, precision="double").tolist() == [0, 1]


@pytest.mark.parametrize("offset", [0, 1e3, 1e6])
def test_spheres_are_within_their_bounds(offset):
    random = np.random.default_rng(3)
    tangents = 0
    for radius in (1, 1e-3, 700):
        center = random.integers(-3, 4, 3) + offset
        caster = rt.Raycaster(threads=1)
        caster.add_sphere(center, radius)
        r = float(np.float32(radius))
        direction = random.normal(size=(60, 3))
        start = center + random.normal(size=(60, 3)) * r * random.choice((.3, 3, 1e4), (60, 1))
        to = center + random.normal(size=(60, 3)) * r * .5
        direction = to - start
        along = np.array([[0, 0, 1.]] * 20)  # touches the sphere, or passes it by an ulp
        side = center + np.array([[1, 0, 0]]) * r
        beside = np.repeat(side, 20, 0) - along * 4
        beside[5:10, 0] = np.nextafter(beside[5:10, 0], -np.inf)
        beside[10:, 0] = np.nextafter(beside[10:, 0], np.inf)
        rays = np.concatenate([np.hstack([start, direction]), np.hstack([beside, along])])
        found = caster.list_intersections(rays, precision="double", errors=True)
        for i, ray in enumerate(rays):
            o, d = rational(ray[:3] * 1.), rational(ray[3:])
            o = minus(o, rational(center))
            a, b, c = dot(d, d), dot(o, d), dot(o, o) - Fraction(r)**2
            value = lambda t: (a * t + 2 * b) * t + c
            middle, begin, end = -b / a, *found["ray_splits"][i:i + 2]
            tangents += b * b == a * c
            wanted = 0 if b * b <= a * c else 2 if middle > 0 and c > 0 else 1 if c < 0 or (
                c == 0 and middle > 0) else 0
            assert end - begin == wanted
            for k in range(begin, end):
                t, e = Fraction(found["t_hit"][k]), Fraction(found["t_errors"][k])
                low, high = value(t - e), value(t + e)
                # A root of its own side lies between.
                assert low * high <= 0 and (t - e <= middle or t + e >= middle)
                assert e <= Fraction(1e-13) * t
    assert tangents >= 5


def test_no_rays_and_no_bodies():
    caster = rt.Raycaster(threads=1)
    hits = caster.cast_rays(np.zeros((2, 3, 6)), precision="double", errors=True)
    assert hits["t_hit"].shape == (2, 3) and np.isinf(hits["t_hit"]).all()
    caster.add_sphere((0, 0, 0), 1)
    hits = caster.cast_rays(np.zeros((0, 6)), precision="double", errors=True)
    assert {
        k: v.shape for k, v in hits.items()
    } == {
        "t_hit": (0,),
        "geometry_ids": (0,),
        "primitive_ids": (0,),
        "primitive_uvs": (0, 2),
        "primitive_normals": (0, 3),
        "points": (0, 3),
        "t_errors": (0,),
        "uv_errors": (0,),
        "point_errors": (0,)
    }
    assert all(hits[k].dtype == np.float64 for k in hits if not k.endswith("ids"))


def test_single_precision_is_as_before():
    caster = rt.Raycaster(threads=1)
    caster.add_sphere((0, 0, 0), 1)
    hits = caster.cast_rays([[0, 0, 3., 0, 0, -1]])
    assert list(hits) == [
        "t_hit", "geometry_ids", "primitive_ids", "primitive_uvs", "primitive_normals"
    ]
    assert hits["t_hit"].dtype == np.float32


def test_rays_that_cannot_be_traced_hit_nothing():
    caster = rt.Raycaster(threads=1)
    caster.add_sphere((0, 0, 0), 1)
    good = [0, 0, 3, 0, 0, -1]
    bad = [[math.nan, *good[1:]], [*good[:5], math.nan], [math.inf, *good[1:]],
           [*good[:5], -math.inf], [0, 0, 3, 0, 0, 0], [0, 0, 3, 0, 0, -1.1e18],
           [0, 0, 1.1e18, 0, 0, -1], [1e308] * 6]
    rays = np.array([good, *bad])
    assert caster.count_intersections(rays, precision="double").tolist() == [2] + [0] * len(bad)
    assert np.isfinite(caster.cast_rays(
        rays, precision="double")["t_hit"]).tolist() == [True] + [False] * len(bad)
    assert caster.list_intersections(rays, precision="double")["ray_ids"].tolist() == [0, 0]
    # Numbers of any size within these limits.
    for scale in (1e18, 1e-300, 5e-324):
        assert caster.count_intersections([0, 0, 3, 0, 0, -scale], precision="double") == 2
    assert caster.count_intersections([0, 0, 1e18, 0, 0, -1], precision="double") == 2


def test_arrays_of_any_layout():
    caster = rt.Raycaster(threads=1)
    caster.add_sphere((0, 0, 0), 1)
    rays = np.zeros((4, 5, 6))
    rays[..., 2], rays[..., 5], rays[..., 0] = 3, -1, np.linspace(0, .9, 5)
    want = caster.cast_rays(rays, precision="double")["t_hit"]
    for same in (np.asfortranarray(rays), rays[::1, ::-1][:, ::-1], rays.astype(">f8"),
                 rays.tolist(), np.ascontiguousarray(rays.T).T, rays.astype(np.longdouble)):
        assert np.array_equal(caster.cast_rays(same, precision="double")["t_hit"], want)
    assert caster.cast_rays(np.array([0, 0, 3, 0, 0, -1]), precision="double")["t_hit"] == 2


@pytest.mark.parametrize("call, text", [
    (lambda c: c.cast_rays([[0, 0, 1, 0, 0, -1]], precision="half"), "'single' or 'double'"),
    (lambda c: c.cast_rays([[0, 0, 1, 0, 0, -1]], precision=None), "'single' or 'double'"),
    (lambda c: c.test_occlusions([[0, 0, 1, 0, 0, -1]], precision=2), "'single' or 'double'"),
    (lambda c: c.compute_occupancy([[0, 0, 1]], precision="x"), "'single' or 'double'"),
    (lambda c: c.cast_rays([[0, 0, 1, 0, 0, -1]], errors=True), "precision='double' only"),
    (lambda c: c.cast_rays(np.zeros((3, 5)), precision="double"), r"shape \(..., 6\) expected"),
    (lambda c: c.cast_rays(3, precision="double"), r"shape \(..., 6\) expected"),
    (lambda c: c.list_intersections([[0] * 6], tnear=-1, precision="double"), "0 <= tnear"),
    (lambda c: c.list_intersections([[0] * 6], tnear=math.nan, precision="double"), "0 <= tnear"),
    (lambda c: c.cast_rays([[0] * 6], tnear=2, tfar=1, precision="double"), "tnear <= tfar"),
])
def test_what_is_wrong_is_said(call, text):
    with pytest.raises(ValueError, match=text):
        call(rt.Raycaster(threads=1))
    for bad in ("rays", [["a"] * 6], np.zeros((2, 6), complex), object()):
        with pytest.raises((TypeError, ValueError), match="rays: numbers of shape"):
            rt.Raycaster(threads=1).cast_rays(bad, precision="double")


def test_vertices_in_double_are_numbered_as_they_are_stored():
    """Triangles that have no area as float32, but do about the middle of their mesh."""
    caster = rt.Raycaster(threads=1)
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]) * .25 + 1e8 + .1
    caster.add_triangles(corners, [[0, 1, 1], [0, 1, 2], [1, 3, 2]])
    rays = [[1e8 + .1 + x, 1e8 + .1 + x, 1e8 + 5, 0, 0, -1] for x in (.2, .05)]
    assert caster.cast_rays(rays, precision="double")["primitive_ids"].tolist() == [2, 1]
    caster.update(0, vertices=corners + .5, triangles=[[1, 3, 2], [2, 2, 2], [0, 1, 2]])
    rays = np.array(rays) + [.5, .5, 0, 0, 0, 0]
    assert caster.cast_rays(rays, precision="double")["primitive_ids"].tolist() == [0, 2]


def test_bodies_far_smaller_than_their_distance_lose_nothing():
    """Bodies that single precision cannot find: rays aimed at their vertices, and rays beside."""
    random = np.random.default_rng(12)
    for size in (1e-3, 1e-9, 1e-13):
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
        faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        cut = np.concatenate([faces, faces + 4, faces + 8, faces + 12])  # more than are tried alone
        points = np.concatenate([corners + 2 * i for i in range(4)])
        matrix = matrix_of(turn(random) * size, random.normal(size=3) * 1e6)
        caster = rt.Raycaster(threads=1)
        caster.add_triangles(points, cut, matrix)
        exact = [rational(row) for row in matrix[:3]]
        world = [moved(exact, rational(p)) for p in points]
        to = np.array([[float(x) for x in p] for p in world])
        to = np.concatenate([to, matrix[:3, 3] + random.normal(size=(10, 3)) * 30 * size])
        start = matrix[:3, 3] + random.normal(size=to.shape) * 1e5
        rays = np.concatenate([start, to - start], 1)
        counts = caster.count_intersections(rays, precision="double")
        assert counts.tolist() == [len(crossings(ray, world, cut)) for ray in rays]
        assert not np.any(counts % 2)
