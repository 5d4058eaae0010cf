#!/usr/bin/env python3
"""Measures how much pictures differ between the instruction sets of Embree's kernels. It renders
each world with every instruction set that this machine has, with the same seed, and prints a row of
a Markdown table for each set beside the best one:

    pixels     share of the pixels in which any bit of a colour differs
    mean       mean difference of a colour value, divided by the mean colour value
    largest    largest difference of a colour value, divided by the mean colour value
    of noise   root mean square difference, divided by that of two seeds

The row `again` renders the best one twice; its numbers must be 0 (exit code 1 if they are not).

PYTHONPATH=build/release/python tests/bench/instruction_sets.py [--size 160x120] [--spp 16] [WORLD...]
"""
import argparse
import pathlib
import sys

import numpy as np

import xvrml

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples/scenes"
WORLDS = ("still_life", "cornell", "interior", "caustic", "chess")


def instruction_sets(world):
    """Returns the instruction sets that this machine has, best first. The message that refuses
    another one lists them."""
    try:
        world.render(size=(1, 1), spp=1, isa="none")
    except ValueError as refused:
        return str(refused).partition("has: ")[2].partition(", not")[0].split(", ")
    raise RuntimeError("an unknown instruction set is accepted")


def rms(difference):
    return float(np.sqrt(np.mean(np.square(difference, dtype=np.float64))))


def row(name, isa, picture, best, noise):
    """Prints one row; returns whether the two pictures have the same bytes."""
    difference = np.abs(picture - best)
    mean = float(best.mean()) or 1
    pixels = float((picture.view(np.uint32) != best.view(np.uint32)).any(axis=-1).mean())
    print(f"| {name} | {isa} | {100 * pixels:.2f} % | {difference.mean() / mean:.1e} | "
          f"{difference.max() / mean:.1e} | {rms(difference) / noise if noise else 0:.1e} |")
    return pixels == 0


def compare(path, size, spp):
    """Prints the rows of a world; returns whether the best instruction set repeats its bytes."""
    world = xvrml.load(path)
    best, *others = instruction_sets(world)

    def render(isa, seed=0):
        picture = world.render(size=size, spp=spp, seed=seed, isa=isa, channels="rgba")
        return np.ascontiguousarray(picture.array[..., :3])

    reference = render(best)
    noise = rms(render(best, seed=1) - reference)
    same = row(path.stem, f"{best} again", render(best), reference, noise)
    for isa in others:
        row(path.stem, isa, render(isa), reference, noise)
    return same


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("worlds",
                        nargs="*",
                        type=pathlib.Path,
                        default=[EXAMPLES / f"{name}.wrl" for name in WORLDS])
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--spp", type=int, default=16)
    given = parser.parse_args()
    width, height = map(int, given.size.split("x"))
    print("| world | instruction set | pixels | mean | largest | of noise |")
    print("| --- | --- | --- | --- | --- | --- |")
    same = [compare(path, (width, height), given.spp) for path in given.worlds]
    sys.exit(0 if all(same) else "the same instruction set has given two pictures")


if __name__ == "__main__":
    main()
