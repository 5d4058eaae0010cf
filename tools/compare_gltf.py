"""compare_gltf.py: draws ten small glTF models beside a path tracer that has the BRDF of the
specification (tools/gltf/reference.py). Writes the models, a strip for each (ours, reference,
difference times 10) and the table of docs/accuracy.md into a folder.

    PYTHONPATH=build/release/python python3 tools/compare_gltf.py [--vv build/release/bin/vv] [--out build/gltf]

Without --vv the package draws. Exits with 1 if a model differs by more than noise."""

import argparse
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image

from gltf import models, reference, scene

T95 = {4: 3.182, 8: 2.365, 16: 2.131, 32: 2.040}  # Student's t for so many repetitions
BIAS, SHARE = 0.005, 0.01  # what a model that agrees may differ by in the mean, and in pixels


def read_pfm(path):
    head, size, scale, data = path.read_bytes().split(b"\n", 3)
    assert head == b"PF" and float(scale) < 0
    width, height = map(int, size.split())
    return np.frombuffer(data, "<f4").reshape(height, width, 3)[::-1].astype(float)


def draw_with_program(vv, path, size, spp, seeds):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder, "picture.pfm")
        for seed in seeds:
            subprocess.run([vv, path, "-o", out, "--size", f"{size[0]}x{size[1]}", "--spp", str(spp), "--seed", str(seed), "--transport", "path", "--viewpoint", "0",
                            "--headlight", "off", "-q"], check=True)
            yield read_pfm(out)


def draw_with_package(path, size, spp, seeds):
    import xvrml
    world = xvrml.load(path)
    for seed in seeds:
        picture = world.render(size=size, spp=spp, seed=seed, transport="path", headlight="off", viewpoint=0, studio=False)
        yield picture.array[..., :3].astype(float)


def compare(path, size=(64, 48), spp=64, reference_spp=32, repeats=8, vv=None):
    """Returns a dict of the pictures and the numbers of a table's line."""
    from xvrml import rt
    seeds = range(1, repeats + 1)
    ours = np.stack(list(draw_with_program(vv, path, size, spp, seeds) if vv else draw_with_package(path, size, spp, seeds)))
    tracer = reference.Tracer(scene.Scene(path), rt)
    truth = np.stack([tracer.picture(size, reference_spp, seed) for seed in seeds])
    return {"ours": ours.mean(axis=0), "truth": truth.mean(axis=0), **numbers(ours, truth)}


def numbers(ours, truth):
    """ours, truth: repetitions of a picture with other random numbers (repeats, height, width, 3)."""
    n = len(ours)
    a, b = ours.mean(axis=0), truth.mean(axis=0)
    variance = (ours.var(axis=0, ddof=1) + truth.var(axis=0, ddof=1)) / n
    each = (ours.mean(axis=(1, 2, 3)) - truth.mean(axis=(1, 2, 3))) / b.mean()
    weight = 1 / (b**2 + 1e-3)
    return {"mean": each.mean(), "interval": T95[n] * each.std(ddof=1) / np.sqrt(n), "relmse": ((a - b)**2 * weight).mean(),
            "noise": (variance * weight).mean(),
            "share": (np.abs(a - b) > 4 * np.sqrt(variance) + 1e-3 * b + 1e-5).any(axis=-1).mean()}


def agrees(line):
    return abs(line["mean"]) - line["interval"] <= BIAS and line["share"] <= SHARE


def strip(line, scale=5):
    def encoded(linear):
        x = np.clip(linear, 0, 1)
        return np.round(255 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * x**(1 / 2.4) - 0.055)).astype(np.uint8)

    parts = [line["ours"], line["truth"], 10 * np.abs(line["ours"] - line["truth"])]
    image = Image.fromarray(np.concatenate([encoded(part) for part in parts], axis=1))
    return image.resize((image.width * scale, image.height * scale), Image.NEAREST)


def row(name, line):
    return (f"| {name} | {100 * line['mean']:+.2f} +- {100 * line['interval']:.2f} % | {line['relmse']:.1e} ({line['noise']:.1e}) | "
            f"{100 * line['share']:.2f} % | {'agrees' if agrees(line) else 'DIFFERS'} |")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--vv", help="draw with this program instead of the package")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("build/gltf"))
    parser.add_argument("--only", nargs="*", choices=list(models.MODELS), default=list(models.MODELS))
    parser.add_argument("--spp", type=int, default=32)
    parser.add_argument("--reference-spp", type=int, default=24)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    lines = ["| model | mean difference | relMSE (of noise) | pixels beyond 4 standard errors | |", "| --- | --- | --- | --- | --- |"]
    print("\n".join(lines), flush=True)
    good = True
    for name in options.only:
        line = compare(models.write(name, options.out), spp=options.spp, reference_spp=options.reference_spp, vv=options.vv)
        strip(line).save(options.out / f"{name}.png")
        lines.append(row(name, line))
        print(lines[-1], flush=True)
        good &= agrees(line)
    (options.out / "table.md").write_text("\n".join(lines) + "\n")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
