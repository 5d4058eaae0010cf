#!/usr/bin/env python3
"""Casts rays at vertices and edges of closed meshes and counts what goes wrong: rays from inside
that leave, occlusion that is lost, and crossings that do not add up. Exits with 1 if any does.

PYTHONPATH=build/release/python tools/check_rays.py [--rays 10000000] [--seed 1]
    [--precision single|double] [--exact 0]

The meshes are an icosphere and a grid of boxes, at offsets 0, 1, 1e3 and 1e6, under five matrices:
none, moved, turned, mirrored and scaled. precision: that of the queries, and of the rays. exact:
how many rays of each case are also compared with exact rational arithmetic (precision double).
"""
import argparse
import sys
from fractions import Fraction

import numpy as np

from rational_rays import crossings, moved, rational
from xvrml import rt

CHUNK = 250_000


def icosphere(levels):
    """Returns vertices and triangles of a closed sphere of radius 1: 10 * 4^levels + 2 vertices."""
    g = (1 + 5**.5) / 2
    corners = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g),
               (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4),
             (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8),
             (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    vertices, triangles = np.array(corners, float), np.array(faces)
    for _ in range(levels):
        edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), 1)
        pairs, number = np.unique(edges, axis=0, return_inverse=True)
        middle = len(vertices) + number.reshape(-1, 3)
        vertices = np.concatenate([vertices, vertices[pairs].mean(1)])
        a, b, c = triangles.T
        ab, bc, ca = middle.T
        triangles = np.concatenate(
            [np.stack(t, 1) for t in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
    return vertices / np.linalg.norm(vertices, axis=1)[:, None], triangles


def boxes(cells, size=1.0, duplicated=False):
    """Returns the surface of a block of boxes from -1 to 1. Every second box is left out, so that
    boxes share edges and vertices but no face. duplicated: each box has vertices of its own."""
    unit = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    sides = np.array([(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3),
                      (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)])
    at = np.stack(np.meshgrid(*3 * [np.arange(cells)], indexing="ij"), -1).reshape(-1, 3)
    at = at[at.sum(1) % 2 == 0]
    vertices = (at[:, None] + unit).reshape(-1, 3) * 2 / cells - 1
    triangles = (8 * np.arange(len(at))[:, None, None] + sides).reshape(-1, 3)
    if not duplicated:
        vertices, number = np.unique(vertices, axis=0, return_inverse=True)
        triangles = number.reshape(-1)[triangles]
    return vertices * size, triangles


def matrices():
    """Returns named matrices: none, moved, turned, mirrored, and scaled."""
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    out = {"as it is": np.eye(4)}
    for name, linear, move in (("moved", np.eye(3), (.37, -1.21, 2.5)), ("turned", turn, (0, 0, 0)),
                               ("mirrored", turn @ np.diag(
                                   (1, 1, -1)), (1, 0, -.5)), ("scaled", turn @ np.diag(
                                       (.3, 2, 5)), (-.2, .1, .4))):
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = linear, move
        out[name] = matrix
    return out


def placed(vertices, matrix, offset, number=np.float32):
    """Returns the matrix moved by the offset, and the vertices that it gives, rounded."""
    matrix = matrix.copy()
    matrix[:3, 3] += offset
    return matrix, (vertices @ matrix[:3, :3].T + matrix[:3, 3]).astype(number)


def aimed(points, triangles, count, random, edges):
    """Returns `count` places of the mesh: vertices, or places on edges."""
    corner = triangles[random.integers(len(triangles), size=count)]
    if not edges:
        return points[corner[:, 0]]
    share = random.random((count, 1))
    return points[corner[:, 0]] * (1 - share) + points[corner[:, 1]] * share


def from_inside(count, offset, matrix, points, triangles, random, edges):
    """Returns rays from near the middle of a ball through its vertices or edges."""
    inner = random.normal(size=(count, 3)) * .15
    start = (inner @ matrix[:3, :3].T + matrix[:3, 3]).astype(points.dtype)
    to = aimed(points.astype(float), triangles, count, random, edges)
    return np.concatenate([start, (to - start).astype(points.dtype)], 1)


def along_axes(count, matrix, points, triangles, random, edges):
    """Returns rays from far outside along the axes of the boxes, as voxelisers ask: through
    vertices, along edges and in the planes of faces."""
    to = aimed(points.astype(float), triangles, count, random, edges)
    axis = np.eye(3)[random.integers(3, size=count)] * random.choice((-1, 1), count)[:, None]
    direction = (axis @ matrix[:3, :3].T).astype(points.dtype)
    start = (to - 16 * direction.astype(float)).astype(points.dtype)
    return np.concatenate([start, direction], 1)


def check(caster, rays, odd, precision="single"):
    """Returns how many answers of cast_rays, of test_occlusions, and how many parities are wrong. A
    ray from outside may touch a mesh at a vertex alone, so that only what is hit too much counts."""
    count = caster.count_intersections(rays, precision=precision)
    wrong = np.count_nonzero(count % 2 != odd)
    hit = np.isfinite(caster.cast_rays(rays, precision=precision)["t_hit"])
    occluded = caster.test_occlusions(rays, precision=precision)
    if not odd:
        hit, occluded = ~hit | (count > 0), ~occluded | (count > 0)
    return np.count_nonzero(~hit), np.count_nonzero(~occluded), wrong


def near_ray(ray, points, triangles):
    """Returns the triangles that a ray may cross: those whose balls it touches, with a margin of far
    more than double precision rounds."""
    corners = points[triangles] - ray[:3]
    middle = corners.mean(1)
    along = ray[3:] / np.linalg.norm(ray[3:])
    distance = np.linalg.norm(np.cross(middle, along), axis=1)
    radius = np.linalg.norm(corners - middle[:, None], axis=2).max(1)
    margin = 1e-9 * np.abs(corners).max() + 1e-12 * np.abs(points).max()
    return np.flatnonzero(distance <= radius * (1 + 1e-6) + margin)


def check_exactly(caster, rays, vertices, triangles, matrix):
    """Returns how many rays have another list of crossings, or another nearest hit, than exact
    rational arithmetic finds, or a t farther from the truth than its bound. vertices: floats."""
    found = caster.list_intersections(rays, precision="double", errors=True)
    nearest = caster.cast_rays(rays, precision="double", errors=True)
    points = vertices.astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
    exact, wrong = [rational(row) for row in matrix[:3]], 0
    for i, ray in enumerate(rays):
        some = near_ray(ray, points, triangles)
        places = {k: moved(exact, rational(vertices[k])) for k in np.unique(triangles[some])}
        true = {some[n]: at.t for n, at in crossings(ray, places, triangles[some]).items()}
        rows = slice(*found["ray_splits"][i:i + 2])
        got = dict(zip(found["primitive_ids"][rows].tolist(), found["t_hit"][rows].tolist()))
        bounds = dict(zip(found["primitive_ids"][rows].tolist(), found["t_errors"][rows].tolist()))
        good = got.keys() == true.keys() and len(got) == rows.stop - rows.start and all(
            abs(Fraction(got[n]) - t) <= Fraction(bounds[n]) for n, t in true.items())
        if good and true:
            t, bound = nearest["t_hit"][i], nearest["t_errors"][i]
            good = abs(Fraction(t) - min(true.values())) <= Fraction(bound)
        elif good:
            good = np.isinf(nearest["t_hit"][i])
        wrong += not good
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("--rays", type=int, default=10_000_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--levels", type=int, default=6)
    parser.add_argument("--precision", choices=["single", "double"], default="single")
    parser.add_argument("--exact", type=int, default=0)
    arguments = parser.parse_args()
    double = arguments.precision == "double"
    if arguments.exact and not double:
        parser.error("--exact needs --precision double")
    random = np.random.default_rng(arguments.seed)
    ball, grid = icosphere(arguments.levels), boxes(12)
    if double:  # such vertices are kept as they are
        ball, grid = (
            (vertices.astype(np.float32), triangles) for vertices, triangles in (ball, grid))
    cases = [(*case, edges) for case in ((ball, True), (grid, False)) for edges in (False, True)]
    cases = [(*case, offset, name, matrix)
             for case in cases
             for offset in (0, 1, 1e3, 1e6)
             for name, matrix in matrices().items()]
    share = -(-arguments.rays // len(cases))
    bad = 0
    print("mesh  aimed at   offset   matrix        rays   nearest     occluded        parity"
          "    not as rational")
    for (vertices, triangles), inside, edges, offset, name, matrix in cases:
        matrix, points = placed(vertices, matrix, offset, np.float64 if double else np.float32)
        caster = rt.Raycaster()
        caster.add_triangles(vertices, triangles, matrix)
        sums = np.zeros(4, int)
        for begin in range(0, share, CHUNK):
            count = min(CHUNK, share - begin)
            rays = from_inside(count, offset, matrix, points, triangles,
                               random, edges) if inside else along_axes(
                                   count, matrix, points, triangles, random, edges)
            sums[:3] += check(caster, rays, int(inside), arguments.precision)
            if begin == 0:
                sums[3] = check_exactly(caster, rays[:arguments.exact], vertices, triangles, matrix)
        bad += sums.sum()
        print(
            f"{'ball' if inside else 'boxes':5} {'edges' if edges else 'vertices':8} {offset:8g}"
            f"   {name:8} {share:9} {sums[0]:8} {sums[1]:13} {sums[2]:13} {sums[3]:18}",
            flush=True)
    answers = (3 * share + min(arguments.exact, share)) * len(cases)
    print(f"{bad} of {answers} answers are wrong")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
