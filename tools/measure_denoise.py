#!/usr/bin/env python3
"""Measures what denoising brings: relMSE and FLIP of raw and of denoised pictures.

measure_denoise.py --out FOLDER [--worlds a,b,FILE.wrl] [--spp 4,16,64] [--reference-spp N]
                   [--size WxH] [--tiles]

Needs the Python package of this project on PYTHONPATH, Open Image Denoise (pip install pyoidn) and
numpy; FLIP also the package flip-evaluator, and --tiles Pillow. Worlds are names from
examples/scenes, "kicad" for examples/kicad/product.wrl, or files. Prints a table, and writes it to
FOLDER/denoise.md. --tiles writes a picture of each world into FOLDER: raw, denoised and reference of
the first number of samples, side by side.

relMSE is the mean of (a - r)^2 / (m^2 + 0.01), where r is the reference and m the mean of its red,
green and blue. The mean is that of all colours, against the reference. References are kept in FOLDER
until the world, the size or their samples change. Seconds are those of a run with all threads: the
machine must have no other work for them.
"""
import argparse
import hashlib
import pathlib
import time

import numpy as np

import xvrml

try:
    import flip_evaluator
except ImportError:
    flip_evaluator = None

ROOT = pathlib.Path(__file__).resolve().parents[1]
SEED, REFERENCE_SEED = 0, 77


def find(name):
    """Returns the file of a world."""
    places = {"kicad": ROOT / "examples/kicad/product.wrl"}
    file = places.get(name, ROOT / f"examples/scenes/{name}.wrl")
    file = file if file.is_file() else pathlib.Path(name)
    if not file.is_file():
        raise SystemExit(f"measure_denoise.py: there is no world {name}")
    return file


def reference(file, world, size, spp, folder):
    """Returns the colours of a picture of many samples, from the folder if it is there."""
    key = hashlib.sha256(file.read_bytes() + repr((size, spp)).encode()).hexdigest()[:16]
    stored = folder / f"{file.stem}-{key}.npy"
    if not stored.exists():
        colours = world.render(size=size, spp=spp, seed=REFERENCE_SEED).array[..., :3]
        np.save(stored, colours)
    return np.load(stored)


def relative_error(colours, true):
    return float(np.mean((colours - true)**2 / (true.mean(axis=2, keepdims=True)**2 + 0.01)))


def as_shown(linear):
    """Returns sRGB values from 0 to 1."""
    v = np.clip(linear, 0, 1)
    return np.where(v <= 0.0031308, 12.92 * v, 1.055 * v**(1 / 2.4) - 0.055).astype(np.float32)


def flip(colours, true):
    """Returns the mean FLIP of what a screen shows; None without the package."""
    if not flip_evaluator:
        return None
    return float(flip_evaluator.evaluate(as_shown(true), as_shown(colours), "LDR",
                                         applyMagma=False)[1])


def write_tiles(pictures, path):
    from PIL import Image
    row = np.concatenate([as_shown(p) for p in pictures], axis=1)
    Image.fromarray((row * 255 + 0.5).astype(np.uint8)).save(path)


def measure(name, options, folder):
    """Returns the rows of a world."""
    file = find(name)
    world = xvrml.load(file)
    size = tuple(map(int, options.size.split("x")))
    true = reference(file, world, size, options.reference_spp, folder)
    rows = []
    for spp in map(int, options.spp.split(",")):
        raw = world.render(size=size, spp=spp, seed=SEED, channels=("albedo", "normal"))
        begin = time.perf_counter()
        denoised = raw.denoised()
        seconds = time.perf_counter() - begin
        pictures = [image.array[..., :3] for image in (raw, denoised)]
        if options.tiles and not rows:
            write_tiles([*pictures, true], folder / f"{file.stem}-{spp}.png")
        rows.append({
            "world": name,
            "samples": spp,
            "errors": [relative_error(p, true) for p in pictures],
            "flip": [flip(p, true) for p in pictures],
            "mean": [100 * (float(p.mean() / true.mean()) - 1) for p in pictures],
            "seconds": (raw.stats["render_seconds"], seconds),
            "by": denoised.stats["denoised_by"],
        })
    return rows


def shown(row):
    error, flips, mean = row["errors"], row["flip"], row["mean"]
    cells = [
        row["world"],
        str(row["samples"]), *(f"{e:.5f}" for e in error), f"{error[0] / error[1]:.1f}",
        *("" if f is None else f"{f:.4f}" for f in flips), *(f"{m:+.2f} %" for m in mean),
        *(f"{s:.2f}" for s in row["seconds"])
    ]
    return "| " + " | ".join(cells) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--out", required=True)
    parser.add_argument("--worlds", default="cornell,chess,kicad,still_life,interior,globe")
    parser.add_argument("--spp", default="4,16,64")
    parser.add_argument("--reference-spp", type=int, default=2048)
    parser.add_argument("--size", default="400x300")
    parser.add_argument("--tiles", action="store_true")
    options = parser.parse_args()
    folder = pathlib.Path(options.out)
    folder.mkdir(parents=True, exist_ok=True)
    lines = [
        "| world | samples | relMSE raw | denoised | times | FLIP raw | denoised | mean raw | "
        "denoised | s to render | to denoise |",
        "|---" * 11 + "|",
    ]
    print(*lines, sep="\n", flush=True)
    by = ""
    for name in options.worlds.split(","):
        for row in measure(name, options, folder):
            lines.append(shown(row))
            print(lines[-1], flush=True)
            by = row["by"]
    lines.append(f"\n{by}, {options.size}, references of {options.reference_spp} samples.")
    (folder / "denoise.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
