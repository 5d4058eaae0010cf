#!/usr/bin/env python3
"""Measures how long the first picture of a world takes by the z-buffer and by rays.

bench_fast_view.py [--size WxH] [--rounds N] [--triangles N,N...] [WORLD...]

Needs the package xvrml on PYTHONPATH. Each round reads every world anew for each of the two, so
that nothing is kept; the table has the medians. Worlds without a name are the scenes of examples/
and meshes with these numbers of triangles. Run it on an idle machine.
"""
import argparse
import pathlib
import statistics
import tempfile
import time

import numpy
import xvrml

ROOT = pathlib.Path(__file__).resolve().parents[1]
SCENES = ["still_life.wrl", "chess.wrl", "board.wrl", "car.wrz"]


def write_mesh(path, triangles):
    """Writes a binary PLY file: a wavy square."""
    side = max(2, round((triangles / 2)**0.5))
    x, y = numpy.meshgrid(numpy.linspace(-1, 1, side + 1), numpy.linspace(-1, 1, side + 1))
    z = 0.1 * numpy.sin(9 * x) * numpy.cos(7 * y)
    points = numpy.stack([x, y, z], axis=-1).reshape(-1, 3).astype("<f4")
    corner = (numpy.arange(side)[:, None] * (side + 1) + numpy.arange(side)).reshape(-1)
    a, b, c, d = corner, corner + 1, corner + side + 2, corner + side + 1
    faces = numpy.zeros(2 * side * side, dtype=[("n", "u1"), ("i", "<i4", 3)])
    faces["n"] = 3
    faces["i"] = numpy.concatenate([numpy.stack([a, b, c], 1), numpy.stack([a, c, d], 1)])
    header = ("ply\nformat binary_little_endian 1.0\n"
              f"element vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
              f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    path.write_bytes(header.encode() + points.tobytes() + faces.tobytes())


def measure(path, size, **options):
    """Returns the seconds of reading, the seconds from there to the picture, and the picture."""
    begin = time.monotonic()
    world = xvrml.load(path)
    read = time.monotonic()
    image = world.render(size=size, **options)
    return read - begin, time.monotonic() - read, image


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--size", default="200x150")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--triangles", default="100000,1000000")
    parser.add_argument("worlds", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    size = tuple(int(side) for side in options.size.split("x"))
    with tempfile.TemporaryDirectory() as folder:
        worlds = options.worlds or [ROOT / "examples/scenes" / name for name in SCENES]
        if not options.worlds:
            for triangles in map(int, options.triangles.split(",")):
                worlds.append(pathlib.Path(folder) / f"mesh_{triangles}.ply")
                write_mesh(worlds[-1], triangles)
        print("| world | triangles | rays over z-buffer | z-buffer, ms | rays, ms | reading, ms |")
        print("| --- | --- | --- | --- | --- | --- |")
        for path in worlds:
            times = {"read": [], "raster": [], "rays": []}
            for _ in range(options.rounds):
                read, raster, _image = measure(path, size, raster=True)
                _read, rays, image = measure(path, size, spp=1)
                for name, seconds in (("read", read), ("raster", raster), ("rays", rays)):
                    times[name].append(1000 * seconds)
            read, raster, rays = (statistics.median(times[name])
                                  for name in ("read", "raster", "rays"))
            print(f"| {path.name} | {image.stats['triangles']:,} | {rays / raster:.1f} | "
                  f"{raster:.0f} | {rays:.0f} | {read:.0f} |")


if __name__ == "__main__":
    main()
