#!/usr/bin/env python3
"""Prints what worlds of many small parts cost: seconds of each stage, processor time, and bytes a
part. The worlds are n boxes as separate Shapes of which many are equal, as separate Shapes that all
differ, and as one Shape with n - 1 USEs.

tools/bench_parts.py --vv build/release/bin/vv [--parts 100000 ...] [--kinds separate used]
    [--keep FOLDER]
"""
import argparse
import json
import pathlib
import resource
import subprocess
import tempfile

KINDS = ("separate", "different", "used")
STAGES = ("parse", "start", "map", "build", "render", "total")


def write_world(path, parts, kind):
    with open(path, "w", encoding="ascii") as file:
        file.write("#VRML V2.0 utf8\n")
        for i in range(parts):
            green = i * 1e-6 if kind == "different" else i % 100 / 100
            size = .5 + (i * 1e-6 if kind == "different" else 0)
            shape = ("Shape { appearance Appearance { material Material { diffuseColor "
                     f".5 {green:.6f} .5 }} }} geometry Box {{ size {size:.6f} .5 .5 }} }}")
            if kind == "used":
                shape = "USE S" if i > 0 else "DEF S " + shape
            file.write(f"Transform {{ translation {i % 1000} {i // 1000} 0 children {shape} }}\n")


def measure(vv, world, folder):
    """Returns the statistics of one run, and its processor time."""
    statistics = folder / "stats.json"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([
        vv, world, "-q", "--size", "320x240", "--spp", "1", "--limit", "worldBytes=64000000000",
        "-o", folder / "parts.png", "--stats", statistics
    ],
                   check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    processor = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    return json.loads(statistics.read_text()), processor


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vv", default="build/release/bin/vv")
    parser.add_argument("--parts", type=int, nargs="+", default=[100_000])
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    parser.add_argument("--keep", type=pathlib.Path, help="keep worlds and pictures in this folder")
    arguments = parser.parse_args()
    print("| world | parts | " + " | ".join(STAGES) + " | processor | bytes a part |")
    print("| --- " * (len(STAGES) + 4) + "|")
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for kind in arguments.kinds:
            for parts in arguments.parts:
                world = folder / f"{kind}_{parts}.wrl"
                if not world.exists():
                    write_world(world, parts, kind)
                statistics, processor = measure(arguments.vv, world, folder)
                seconds = [f"{statistics['time'][stage]:.2f}" for stage in STAGES]
                bytes_a_part = statistics["memory"]["peak_rss"] / parts
                print(
                    f"| {kind} | {parts:,} | {' | '.join(seconds)} | {processor:.2f} "
                    f"| {bytes_a_part:,.0f} |",
                    flush=True)


if __name__ == "__main__":
    main()
