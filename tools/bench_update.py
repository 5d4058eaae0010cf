#!/usr/bin/env python3
"""Measures what a step of moving bodies costs beside a new scene, for each kind of query that
follows: processor time of the update and of a few rays, as a share of that of a new Raycaster and
the same rays. Both take turns, so that the load of the machine hardly matters.

PYTHONPATH=build/release/python tools/bench_update.py [--bodies 1000] [--triangles 200] [--rounds 10]
"""
import argparse
import time

import numpy as np

from xvrml import rt


def ball(triangles):
    """Returns a wavy ball of about this many triangles."""
    rows = max(int((triangles / 4)**.5), 2)
    turn, height = np.meshgrid(np.linspace(0, 2 * np.pi, 2 * rows + 1),
                               np.linspace(0, np.pi, rows + 1))
    radius = 1 + .1 * np.sin(5 * turn) * np.sin(height)
    vertices = radius[..., None] * np.stack(
        [np.sin(height) * np.cos(turn),
         np.sin(height) * np.sin(turn),
         np.cos(height)], -1)
    corner = np.arange(vertices[..., 0].size).reshape(height.shape)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
    faces = np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
    return vertices.reshape(-1, 3), faces


def places(random, count):
    matrices = np.tile(np.eye(4), (count, 1, 1))
    matrices[:, :3, :3] = np.linalg.qr(random.normal(size=(count, 3, 3)))[0]
    matrices[:, :3, 3] = random.uniform(-1, 1, (count, 3)) * 2 * count**(1 / 3)
    return matrices


def scene(shape, matrices):
    caster = rt.Raycaster()
    for matrix in matrices:
        caster.add_triangles(*shape, matrix)
    return caster


def seconds(work):
    start = time.process_time()
    work()
    return time.process_time() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("--bodies", type=int, default=1000)
    parser.add_argument("--triangles", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=10)
    options = parser.parse_args()
    random, shape = np.random.default_rng(1), ball(options.triangles)
    rays = random.normal(size=(16, 6))
    queries = {
        "cast_rays": lambda caster: caster.cast_rays(rays),
        "count_intersections": lambda caster: caster.count_intersections(rays),
        "cast_rays, precision='double'": lambda caster: caster.cast_rays(rays, precision="double"),
    }
    print(f"{options.bodies} bodies of {len(shape[1])} triangles")
    for name, query in queries.items():
        caster = scene(shape, places(random, options.bodies))
        for _ in range(2):  # the first update makes what moves dynamic
            caster.update(matrices=places(random, options.bodies))
            query(caster)
        ratios = []
        for _ in range(options.rounds):
            matrices = places(random, options.bodies)

            def update():
                caster.update(matrices=matrices)
                query(caster)

            ratios.append(seconds(lambda: query(scene(shape, matrices))) / seconds(update))
        print(f"{name}: a new scene takes {np.median(ratios):.0f} times as long as an update "
              f"(from {min(ratios):.0f} to {max(ratios):.0f})")


if __name__ == "__main__":
    main()
