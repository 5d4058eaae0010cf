"""Closest points with precision="double": no number is farther from the truth than its bound. The
truth is that of exact rational arithmetic."""
import math
import pathlib
import sys
from fractions import Fraction

import numpy as np
import pytest

rt = pytest.importorskip("xvrml").rt

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
from rational_rays import cross, dot, minus, moved, rational  # noqa: E402

from test_double_rays import matrix_of, places, soup, turn  # noqa: E402


def closest_on_segment(point, a, b):
    """Returns the share of the way from a to b."""
    way = minus(b, a)
    return min(max(dot(minus(point, a), way) / dot(way, way), Fraction(0)), Fraction(1))


def closest(point, a, b, c):
    """Returns the square of the true distance, and u and v of the true place; None for a triangle
    without area."""
    ab, ac, ap = minus(b, a), minus(c, a), minus(point, a)
    normal = cross(ab, ac)
    area = dot(normal, normal)
    if area == 0:
        return None
    u, v = dot(cross(ap, ac), normal) / area, dot(cross(ab, ap), normal) / area
    if min(u, v, 1 - u - v) >= 0:
        return dot(ap, normal)**2 / area, u, v
    s, t, w = (closest_on_segment(point, p, q) for p, q in ((a, b), (a, c), (b, c)))
    found = []
    for u, v in ((s, Fraction(0)), (Fraction(0), t), (1 - w, w)):
        way = [x - u * y - v * z for x, y, z in zip(ap, ab, ac)]
        found.append((dot(way, way), u, v))
    return min(found)


def is_root(value, square, error):
    """Returns whether a number is no farther from the root of a square than its error."""
    low, high = Fraction(value) - Fraction(error), Fraction(value) + Fraction(error)
    return max(low, Fraction(0))**2 <= square <= high**2


def query_points(random, corners, count):
    """Returns points on, near and far from the triangles: at corners, above edges and faces."""
    share = random.dirichlet(np.ones(3), count) * random.choice((0, 1), (count, 3), p=(.3, .7))
    share /= np.maximum(share.sum(1, keepdims=True), 1e-9)
    on = np.einsum("ik,ikj->ij", share, corners[random.integers(len(corners), size=(count, 3))])
    on[::4] = corners[random.integers(len(corners), size=len(on[::4]))]
    away = random.normal(size=(count, 3)) * np.ptp(corners, 0).max() * random.choice(
        (0, 1e-9, .1, 1, 1e3, 1e5), (count, 1))
    grid = random.random(count) < .3
    away[grid] *= np.eye(3)[random.integers(3, size=np.count_nonzero(grid))]
    return on + away


@pytest.mark.parametrize("kind", ["lattice", "far", "slivers", "random"])
@pytest.mark.parametrize("offset", [0, 1e3, 1e6])
def test_every_number_is_within_its_bound_of_the_truth(kind, offset):
    random = np.random.default_rng([len(kind), int(offset), 7])
    for name, matrix in places(random).items():
        points, triangles = soup(random, kind)
        matrix[:3, 3] += offset
        caster = rt.Raycaster(threads=2)
        caster.add_triangles(points, triangles, matrix)
        exact = [rational(row) for row in matrix[:3]]
        corners = [moved(exact, rational(p)) for p in points]
        world = np.array([[float(x) for x in p] for p in corners])
        asked = query_points(random, world, 12)
        found = caster.compute_closest_points(asked, precision="double", errors=True)
        for i, point in enumerate(asked):
            true = [closest(rational(point), *(corners[k] for k in t)) for t in triangles]
            square = min(t[0] for t in true if t)
            assert is_root(found["distances"][i], square, found["distance_errors"][i]), name
            # A bound that says nothing is none. Two surfaces may lie close together.
            assert found["distance_errors"][i] <= 1e-12 * max(found["distances"][i], 1e-300)
            _, u, v = true[found["primitive_ids"][i]]
            got, bound = found["primitive_uvs"][i], found["uv_errors"][i]
            assert abs(Fraction(got[0]) - u) <= Fraction(bound)
            assert abs(Fraction(got[1]) - v) <= Fraction(bound)
            assert bound <= 2e-11
            a, b, c = (corners[k] for k in triangles[found["primitive_ids"][i]])
            place = [x + u * (y - x) + v * (z - x) for x, y, z in zip(a, b, c)]
            bound = found["point_errors"][i]
            for k in range(3):
                assert abs(Fraction(found["points"][i, k]) - place[k]) <= Fraction(bound)
            assert bound <= 1e-10 * np.abs(world).max()


def test_spheres():
    random = np.random.default_rng(3)
    for offset in (0, 1e3, 1e6):
        caster, center, radius = rt.Raycaster(threads=1), random.normal(size=3) + offset, 1.75
        caster.add_sphere(center, radius)
        points = center + random.normal(size=(60, 3)) * random.choice((.01, 1, 1e5), (60, 1))
        points[0] = center
        found = caster.compute_closest_points(points, precision="double", errors=True)
        for i, point in enumerate(points):
            way = minus(rational(point), rational(center))
            low, high = (Fraction(found["distances"][i]) +
                         sign * Fraction(found["distance_errors"][i]) for sign in (-1, 1))
            square, r = dot(way, way), Fraction(radius)
            outside = square >= r * r
            ends = (r + low, r + high) if outside else (r - high, r - low)
            assert max(ends[0], 0)**2 <= square <= ends[1]**2
            assert found["distance_errors"][i] <= 1e-14 * (1 + abs(offset) +
                                                           np.abs(points[i]).max())
            place = minus(rational(found["points"][i]), rational(center))
            off = abs(math.sqrt(float(dot(place, place))) - radius)
            assert off <= 2 * found["point_errors"][i] <= 1e-7 * (1 + abs(offset))


def test_many_triangles_answer_as_each_alone():
    """Trees of boxes lose nothing: the same distances as from pieces too small for a tree."""
    random = np.random.default_rng(8)
    vertices = random.normal(size=(400, 3)).astype(np.float32)
    triangles = random.integers(0, 400, (600, 3))
    for matrix in (np.eye(4), matrix_of(turn(random) @ np.diag(
        (.01, 1, 30)), (1e6, 2e6, -1e6)), matrix_of(turn(random) * 1e-9, (1e3, 0, 0))):
        whole, pieces = rt.Raycaster(threads=1), rt.Raycaster(threads=1)
        whole.add_triangles(vertices, triangles, matrix)
        for k in range(0, 600, 10):
            pieces.add_triangles(vertices, triangles[k:k + 10], matrix)
        size = np.linalg.norm(matrix[:3, :3], 2)
        points = matrix[:3, 3] + random.normal(size=(150, 3)) * size * random.choice(
            (.1, 1, 10, 1e4), (150, 1))
        a, b = (c.compute_closest_points(points, precision="double", errors=True)
                for c in (whole, pieces))
        assert np.all(
            np.abs(a["distances"] - b["distances"]) <= a["distance_errors"] + b["distance_errors"])
        assert np.all(a["distance_errors"] <= 1e-12 * a["distances"])


def test_the_radius_and_what_has_no_closest_point():
    caster = rt.Raycaster(threads=1)
    caster.add_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    points = [[.25, .25, 2], [.25, .25, 2.0000001], [np.nan, 0, 0], [np.inf, 0, 0], [2e18, 0, 0]]
    found = caster.compute_closest_points(points, radius=2, precision="double")
    assert found["distances"].tolist() == [2] + [np.inf] * 4
    assert found["points"][0].tolist() == [.25, .25, 0] and np.isnan(found["points"][1:]).all()
    assert found["points"].dtype == found["distances"].dtype == np.float64
    assert list(found) == [
        "points", "distances", "geometry_ids", "primitive_ids", "primitive_uvs", "primitive_normals"
    ]
    assert found["primitive_normals"][0].tolist() == [0, 0, 1]
    assert caster.compute_distance([0, 0, -3], precision="double") == 3
    assert rt.Raycaster().compute_distance([[0, 0, 1]], precision="double").tolist() == [np.inf]


def test_signed_distances_far_from_the_origin():
    vertices = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32)
    sides = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6),
             (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
    caster, matrix = rt.Raycaster(threads=1), np.eye(4)
    matrix[:3, 3] = 1e7, -2e7, 3e7
    caster.add_triangles(vertices, sides, matrix)
    points = matrix[:3, 3] + [[.5, .5, .25], [.5, .5, -.125], [.5, .5, 0], [2, 1, 1]]
    assert caster.compute_signed_distance(points, precision="double").tolist() == [-.25, .125, 0, 1]


def test_what_is_wrong_is_said():
    caster = rt.Raycaster(threads=1)
    for wrong, text in ((dict(precision="half"), "'single' or 'double'"),
                        (dict(errors=True), "precision='double' only"), (dict(radius=0,
                                                                              precision="double"),
                                                                         "radius: above 0"),
                        (dict(radius=math.nan, precision="double"), "radius: above 0")):
        with pytest.raises(ValueError, match=text):
            caster.compute_closest_points([[0, 0, 0]], **wrong)
    with rt.Context(threads=1) as context:
        context.instance(context.sphere(1), np.diag((1, 1, 2, 1)))
        with pytest.raises(rt.Error, match="different scales along its axes"):
            context.compute_closest_points([[0, 0, 5]], precision="double")
