#!/usr/bin/env python3
"""Measures the picture of a KiCad board that a CI job waits for: seconds of one cold run, and its
difference (FLIP) from its own picture with many samples.

bench_board.py --vv PROGRAM --out FOLDER [--board FILE] [--preset NAME] [--size WxH] [--threads N]
               [--reference-spp N] [--keep] [OPTIONS OF VV...]

Needs numpy, Pillow and flip-evaluator (pip install --target FOLDER flip-evaluator, then
PYTHONPATH=FOLDER). FLIP is 0 for equal pictures; it assumes the viewing distance of its default,
67 pixels a degree. The reference has other sample positions. Run it on an idle machine.
"""
import argparse
import os
import pathlib
import subprocess
import time

try:
    import flip_evaluator
    import numpy
    from PIL import Image
except ImportError as missing:
    raise SystemExit(f"bench_board.py: {missing}. It needs numpy, Pillow and flip-evaluator: "
                     "pip install --target FOLDER flip-evaluator, then PYTHONPATH=FOLDER")

ROOT = pathlib.Path(__file__).resolve().parents[1]
BOARD = ROOT / "examples/kicad/blinker.wrl"


def draw(options, more, target):
    """Draws the board; returns the seconds from the start of the process to its end."""
    command = [
        options.vv, options.board, "--preset", options.preset, "--size", options.size, "--threads",
        options.threads, "-o", target, *more
    ]
    begin = time.monotonic()
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    seconds = time.monotonic() - begin
    if done.returncode:
        raise SystemExit(f"bench_board.py: {done.stderr.strip()}")
    return seconds


def picture(path):
    return numpy.asarray(Image.open(path).convert("RGB"), dtype=numpy.float32) / 255


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--vv", required=True, type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--board", type=pathlib.Path, default=BOARD)
    parser.add_argument("--preset", default="pcb")
    parser.add_argument("--size", default="800x600")
    parser.add_argument("--threads", default=2, type=int)
    parser.add_argument("--reference-spp", default=1024, type=int)
    parser.add_argument("--keep", action="store_true", help="keep the reference of an earlier run")
    options, more = parser.parse_known_args()
    options.out.mkdir(parents=True, exist_ok=True)
    quick, good = options.out / "board.png", options.out / "reference.png"
    before = os.getloadavg()[0]
    seconds = draw(options, more, quick)
    if not options.keep or not good.exists():
        draw(options, [*more, "--spp", options.reference_spp, "--seed", 1], good)
    error, value, _ = flip_evaluator.evaluate(picture(good), picture(quick), "LDR",
                                              applyMagma=False)
    map_ = numpy.clip(numpy.asarray(error)[..., 0] * 4, 0, 1)
    Image.fromarray((map_ * 255).astype(numpy.uint8)).save(options.out / "flip.png")
    print(f"{options.size}, {options.threads} threads, load {before:.1f} before: {seconds:.1f} s, "
          f"FLIP {value:.4f} to {options.reference_spp} samples")


if __name__ == "__main__":
    main()
