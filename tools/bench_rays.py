#!/usr/bin/env python3
"""Compares ray queries from numpy: xvrml.rt's cast_rays, raw Embree (tests/bench/raw_rays.cpp, one
rtcIntersect1 per ray), and Open3D and embreex if they are installed. All use the same mesh and the
same rays, in alternating rounds; the best round of each counts.

PYTHONPATH=build/release/python tools/bench_rays.py --raw build/release/lib/libraw_rays.so
    [--rays 2000000] [--threads 2] [--pattern incoherent|pinhole|lidar|grid]
"""
import argparse
import ctypes
import os
import time

import numpy as np


def terrain(edge):
    """Returns the mesh of tests/bench/openrt_rays.cpp: 2 edge^2 triangles over 10 x 10 units."""
    u, v = np.meshgrid(np.linspace(-5, 5, edge + 1), np.linspace(-5, 5, edge + 1))
    y = 0.4 * np.sin(3 * u) * np.cos(2 * v) + 0.02 * np.sin(40 * u + 30 * v)
    vertices = np.stack([u, y, v], -1).reshape(-1, 3).astype(np.float32)
    i = (np.arange(edge)[:, None] * (edge + 1) + np.arange(edge)).ravel()
    triangles = np.concatenate(
        [np.stack([i, i + edge + 1, i + 1], -1),
         np.stack([i + 1, i + edge + 1, i + edge + 2], -1)], 1)
    return vertices, triangles.reshape(-1, 3).astype(np.uint32)


def incoherent(count):
    """Returns rays from random points near the terrain in random directions; nine tenths hit it."""
    random = np.random.default_rng(1)
    rays = np.empty((count, 6), np.float32)
    rays[:, :3] = random.uniform((-5, 0, -5), (5, 3, 5), (count, 3))
    rays[:, 3:] = random.uniform((-5, -0.5, -5), (5, 0.5, 5), (count, 3)) - rays[:, :3]
    return rays


def bundle(count, pattern):
    """Returns rays whose neighbours run side by side: of a camera, a lidar's scan lines, a grid."""
    width = int(np.sqrt(count * 1.6))
    y, x = np.divmod(np.arange(count), width)
    u, v = x / width - 0.5, y * width / count - 0.5
    rays = np.zeros((count, 6), np.float32)
    if pattern == "pinhole":
        rays[:, :3] = 0, 4, 7
        rays[:, 3:] = np.stack([u, 0.6 * v - 0.6, np.full(count, -1)], -1)
    elif pattern == "lidar":
        around, down = 2 * np.pi * u, -0.4 + 0.4 * v
        rays[:, 1] = 2
        rays[:, 3:] = np.stack(
            [np.cos(around) * np.cos(down),
             np.sin(down),
             np.sin(around) * np.cos(down)], -1)
    else:
        rays[:, :3] = np.stack([9.8 * u, np.full(count, 5), 9.8 * v], -1)
        rays[:, 4] = -1
    return rays


def raw_caster(path, vertices, triangles, threads, robust):
    library = ctypes.CDLL(os.path.abspath(path))
    library.raw_scene.restype, library.raw_cast.restype = ctypes.c_void_p, ctypes.c_double

    def pointer(array):
        return ctypes.c_void_p(array.ctypes.data)

    scene = library.raw_scene(pointer(vertices), ctypes.c_size_t(len(vertices)), pointer(triangles),
                              ctypes.c_size_t(len(triangles)), int(robust))

    def cast(rays):
        n = len(rays)
        t, primitive = np.empty(n, np.float32), np.empty(n, np.uint32)
        uv, normal = np.empty((n, 2), np.float32), np.empty((n, 3), np.float32)
        library.raw_cast(ctypes.c_void_p(scene), pointer(rays), ctypes.c_size_t(n), threads,
                         pointer(t), pointer(primitive), pointer(uv), pointer(normal))
        return t

    return cast


def contenders(arguments, vertices, triangles):
    if arguments.raw:
        yield "raw Embree, robust", raw_caster(arguments.raw, vertices, triangles,
                                               arguments.threads, True)
        yield "raw Embree, default", raw_caster(arguments.raw, vertices, triangles,
                                                arguments.threads, False)
    if not arguments.without_ours:
        from xvrml import rt
        caster = rt.Raycaster(arguments.threads)
        caster.add_triangles(vertices, triangles)
        yield "xvrml.rt", lambda rays: caster.cast_rays(rays)["t_hit"]
    try:
        import open3d as o3d
        scene = o3d.t.geometry.RaycastingScene(nthreads=arguments.threads)
        scene.add_triangles(o3d.core.Tensor(vertices), o3d.core.Tensor(triangles))
        yield "Open3D " + o3d.__version__, lambda rays: scene.cast_rays(
            o3d.core.Tensor(rays), nthreads=arguments.threads)["t_hit"].numpy()
    except ImportError as error:
        print("Open3D:", error)
    try:
        from embreex import rtcore_scene
        from embreex.mesh_construction import TriangleMesh
        other = rtcore_scene.EmbreeScene()
        TriangleMesh(other, vertices[triangles])
        yield "embreex (one thread)", lambda rays: other.run(np.ascontiguousarray(rays[:, :3]),
                                                             np.ascontiguousarray(rays[:, 3:]),
                                                             output=True)["tfar"]  # 1e37: no hit
    except ImportError as error:
        print("embreex:", error)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rays", type=int, default=2_000_000)
    parser.add_argument("--edge", type=int, default=636, help="of the terrain: 2 edge^2 triangles")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--raw", help="libraw_rays.so of the build")
    parser.add_argument("--pattern",
                        choices=["incoherent", "pinhole", "lidar", "grid"],
                        default="incoherent")
    parser.add_argument("--without-ours", action="store_true")
    arguments = parser.parse_args()
    vertices, triangles = terrain(arguments.edge)
    pattern = arguments.pattern
    rays = incoherent(arguments.rays) if pattern == "incoherent" else bundle(
        arguments.rays, pattern)
    casters = list(contenders(arguments, vertices, triangles))
    best, answers = {}, {}
    for _ in range(arguments.rounds):
        for name, cast in casters:
            begin = time.perf_counter()
            answers[name] = cast(rays)
            best[name] = min(best.get(name, 1e9), time.perf_counter() - begin)
    base = best[casters[0][0]]
    print(
        f"{len(triangles)} triangles, {len(rays)} rays, {arguments.threads} threads, best of {arguments.rounds}"
    )
    print(
        "| | Mrays/s | time of the first / its time | rays with the same answer |\n| --- | --- | --- | --- |"
    )
    reference = answers[casters[0][0]]
    for name, _ in casters:
        same = np.isclose(answers[name], reference, rtol=1e-4,
                          atol=1e-5) | ((answers[name] > 1e30) & np.isinf(reference))
        print(
            f"| {name} | {len(rays) / best[name] / 1e6:.2f} | {base / best[name]:.2f} | {same.mean():.4%} |"
        )


if __name__ == "__main__":
    main()
