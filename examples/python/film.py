"""Renders a world's first seconds as numbered pictures and prints what one of its nodes sends.
Usage: film.py WORLD FOLDER [SECONDS]."""
import pathlib
import sys
from typing import Tuple

import xvrml


def main(path: str, folder: str, seconds: float = 2) -> None:
    world = xvrml.load(path)
    for problem in world.warnings:
        print(problem, file=sys.stderr)
    for node in world.roots:
        if isinstance(node, xvrml.Transform):

            def moved(value: Tuple[float, float, float], time: float) -> None:
                print(f"{time:6.2f} s: {value}")

            world.on((node, "translation"), moved)
    for number, image in enumerate(world.animate(0, seconds, fps=10, size=(160, 120), spp=4)):
        image.save(pathlib.Path(folder) / f"frame{number:04}.png")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], *map(float, sys.argv[3:]))
