#!/usr/bin/env python3
"""Counts sparks: pixels that a single bright path has made bright, and that another seed lacks.

measure_sparks.py [--worlds a,b,FILE.wrl] [--spp N] [--size WxH] [--time T] [--threads N]

Needs the Python package of this project on PYTHONPATH, and numpy. Worlds are names from
examples/scenes, or files; names are tried with .wrl and .wrz.

A bright pixel has a grey above five times the median of its 5x5 pixels and above a twentieth of the
picture's median. It is a spark if the same pixel of another seed is not bright. So edges of lamps and
highlights, which both pictures have, are not sparks. Prints a table: bright pixels and sparks of both
seeds in the mean, and the share of pixels whose error bars are trusted, which is that of a third
picture, because error bars change the samples. Seconds are processor time of a picture without error
bars.
"""
import argparse
import pathlib
import time

import numpy as np

import xvrml

ROOT = pathlib.Path(__file__).resolve().parents[1]
SEEDS = (1, 2)
HEAD = ("| world | bright pixels | of these sparks | pixels trusted | seconds |\n"
        "| --- | --- | --- | --- | --- |")


def find(name):
    """Returns the file of a world."""
    for place in (ROOT / f"examples/scenes/{name}.wrl", ROOT / f"examples/scenes/{name}.wrz",
                  pathlib.Path(name)):
        if place.is_file():
            return place
    raise SystemExit(f"measure_sparks.py: there is no world {name}")


def median_around(grey):
    """Returns the median of the 5x5 pixels around each pixel; edges are repeated."""
    height, width = grey.shape
    wide = np.pad(grey, 2, mode="edge")
    return np.median([wide[y:y + height, x:x + width] for y in range(5) for x in range(5)], axis=0)


def bright_pixels(colours):
    grey = colours.mean(axis=2)
    return grey > np.maximum(5 * median_around(grey), np.median(grey) / 20)


def measure(name, options):
    world = xvrml.load(find(name))
    world.time = options.time
    arguments = {"size": options.size, "spp": options.spp, "threads": options.threads}
    before = time.process_time()
    bright = [
        bright_pixels(world.render(seed=seed, **arguments).array[..., :3]) for seed in SEEDS
    ]
    seconds = (time.process_time() - before) / len(SEEDS)
    trusted = world.render(seed=SEEDS[0], channels=("error", "trust"), **arguments)["trust"]
    count = np.mean([b.sum() for b in bright])
    sparks = np.mean([(bright[0] & ~bright[1]).sum(), (bright[1] & ~bright[0]).sum()])
    return (f"| {name} | {count:g} of {bright[0].size} | {sparks:g} "
            f"| {100 * np.mean(trusted > 0):.0f} % | {seconds:.1f} |")


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--worlds", default="globe,headlight_studio,car,chess")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--size",
                        type=lambda s: tuple(map(int, s.split("x"))),
                        default=(300, 200),
                        help="default 300x200")
    parser.add_argument("--time", type=float, default=.4, help="of the worlds, in seconds")
    parser.add_argument("--threads", type=int, default=0, help="0: all")
    return parser.parse_args()


def main():
    options = parse()
    print(HEAD)
    for name in options.worlds.split(","):
        print(measure(name, options), flush=True)


if __name__ == "__main__":
    main()
