#!/usr/bin/env python3
"""Compares speed and error of our transports, and of Mitsuba 3 if it is installed, on four worlds.

bench_render.py --out FOLDER [--full] [--docs] [--again] [--vv PROGRAM] [--mitsuba PYTHON] [--scenes a,b]

`make bench-render` runs it. FOLDER gets render.csv (a row for each renderer, world and number of
samples), one plot per world (SVG) and render.md. --docs writes the last two to docs/. The reference
of a world is a long render with the transport named below, in two halves. Their difference measures
its own noise, which is subtracted from the errors. Mitsuba's Python is $MITSUBA_PYTHON or this one.
"""
import argparse
import array
import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import export_mitsuba  # noqa: E402
from export_mitsuba import ROOT, read_pfm  # noqa: E402
from plot_svg import log_plot  # noqa: E402

SIZE = (160, 120)
SAMPLES = (2, 4, 16, 64, 256, 1024)  # a single sample would lie at the pixel's centre
T95 = {1: 12.71, 2: 4.30, 3: 3.18, 4: 2.78, 5: 2.57, 6: 2.45, 7: 2.36}  # Student's t, 95 %

# World: title, our transports (the first makes the reference), whether every surface has an exact counterpart in Mitsuba
SCENES = {
    "cornell": ("Cornell box", ("path", "light"), True),
    "headlight": ("Headlight", ("light", "path"), True),
    "interior": ("Interior lit through glass", ("path", "light"), True),
    "board": ("Circuit board under an environment", ("path",), False),
}


class Budget:
    """Seconds for a reference, and for a picture; slower pictures get no more samples."""

    def __init__(self, full):
        self.reference, self.picture, self.seeds = (600, 60, 6) if full else (30, 3, 3)


# Pictures ---------------------------------------------------------------------------------------


def ours(vv, scene, folder, transport, seed, *more):
    """Returns the floats of a picture, its seconds and the transport used; None if this build lacks
    the transport."""
    world = ROOT / f"examples/scenes/{scene}.wrl"
    picture, stats = folder / "x.pfm", folder / "x.json"
    done = subprocess.run([
        str(a) for a in (vv, world, "-o", picture, "--size", f"{SIZE[0]}x{SIZE[1]}", "--seed", seed,
                         "--transport", transport, "--stats", stats, "--quiet", *more)
    ],
                          capture_output=True,
                          text=True)
    if done.returncode != 0:
        raise SystemExit(f"bench_render.py: vv failed: {done.stderr.strip()}")
    told = json.loads(stats.read_text())
    if told["transport"]["chosen"] != transport:
        return None
    return read_pfm(picture)[2], told["time"]["render"]


def worker(request):
    """Runs in Mitsuba's Python: renders on request, writes raw floats and returns the seconds of
    each picture."""
    import time

    import mitsuba as mi
    import numpy as np
    mi.set_variant(request["variant"])
    scene = mi.load_file(request["scene"])
    height, width = SIZE[1], SIZE[0]

    def render(spp, seed):
        start = time.time()
        image = np.array(mi.render(scene, spp=spp, seed=seed))[:, :, :3]
        return image, time.time() - start

    render(1, 12345)  # so that compilation is not measured
    answers = []
    for job in request["jobs"]:
        total, seconds, passes = np.zeros((height, width, 3)), 0.0, 0
        while passes == 0 or seconds < job.get("seconds", 0):
            image, took = render(job["spp"], job["seed"] + 7919 * passes)
            total, seconds, passes = total + image, seconds + took, passes + 1
        (total / passes)[::-1].astype("<f4").tofile(job["out"])
        answers.append(seconds)
        print(json.dumps(seconds), flush=True)
        if seconds > request["limit"] and not job.get("seconds"):
            break


class Mitsuba:

    def __init__(self, python, variant):
        self.python, self.variant = python, variant

    def works(self, folder):
        """Also renders a small picture: the just-in-time compiler may lack its library, or end the
        process."""
        test = (
            "import mitsuba as mi; mi.set_variant(%r); mi.render(mi.load_dict(mi.cornell_box()), spp=1).numpy()"
            % self.variant)
        try:
            return subprocess.run([self.python, "-c", test],
                                  capture_output=True,
                                  timeout=300,
                                  cwd=folder).returncode == 0
        except (OSError, subprocess.TimeoutExpired):
            return False

    def render(self, scene, jobs, limit):
        request = json.dumps({
            "variant": self.variant,
            "scene": str(scene),
            "jobs": jobs,
            "limit": limit
        })
        done = subprocess.run([self.python, __file__, "--worker"],
                              input=request,
                              capture_output=True,
                              text=True)
        seconds = [float(line) for line in done.stdout.split()]
        pictures = []
        for job in jobs[:len(seconds)]:
            values = array.array("f")
            values.frombytes(pathlib.Path(job["out"]).read_bytes())
            pictures.append(values)
        return list(zip(pictures, seconds))


# Errors -----------------------------------------------------------------------------------------


class Reference:
    """The mean of two halves, and its uncertainty."""

    def __init__(self, a, b):
        self.values = [(x + y) / 2 for x, y in zip(a, b)]
        n = len(self.values)
        self.weights = [1 / (r * r + 0.01) for r in self.values]
        squares = [(x - y)**2 / 4 for x, y in zip(a, b)]
        self.mse = sum(squares) / n
        self.relative = sum(s * w for s, w in zip(squares, self.weights)) / n
        self.mean = sum(self.values) / n
        pixels = [sum(a[i:i + 3]) - sum(b[i:i + 3]) for i in range(0, n, 3)]
        self.mean_error = math.sqrt(sum(d * d for d in pixels)) / 2 / n

    def compare(self, picture):
        n = len(self.values)
        mse = relative = 0.0
        for x, r, w in zip(picture, self.values, self.weights):
            d = (x - r)**2
            mse += d
            relative += d * w
        return mse / n - self.mse, relative / n - self.relative, sum(picture) / n


def summary(scene, renderer, spp, reference, pictures):
    """Returns a row: means over the pictures of several seeds."""
    # errors below the reference's own error are meaningless
    rows = [reference.compare(values) for values, _ in pictures]
    n = len(rows)
    seconds = sum(s for _, s in pictures) / n
    mse, relative = (sum(r[k] for r in rows) / n for k in (0, 1))
    mse, relative = (mse if mse > reference.mse else math.nan), (relative if relative
                                                                 > reference.relative else math.nan)
    means = [r[2] for r in rows]
    mean = sum(means) / n
    spread = math.sqrt(sum((m - mean)**2 for m in means) /
                       (n - 1) / n) * T95.get(n - 1, 2.0) if n > 1 else float("nan")
    half = math.hypot(spread, 1.96 * reference.mean_error)
    return {
        "scene": scene,
        "renderer": renderer,
        "spp": spp,
        "seeds": n,
        "seconds": seconds,
        "rmse": math.sqrt(mse),
        "relmse": relative,
        "bias": mean / reference.mean - 1,
        "bias_interval": half / reference.mean,
        "efficiency": relative * seconds
    }


def measure_ours(vv, scene, folder, transport, reference, budget):
    rows = []
    for spp in SAMPLES:
        pictures = []
        for seed in range(1, budget.seeds + 1):
            made = ours(vv, scene, folder, transport, seed, "--spp", spp)
            if made is None:
                return rows
            pictures.append(made)
        rows.append(summary(scene, transport, spp, reference, pictures))
        if max(s for _, s in pictures) > budget.picture:
            break
    return rows


def measure_mitsuba(mitsuba, scene, folder, reference, budget):
    exported = folder / "scene.xml"
    if reference is None:  # the transport's own reference
        halves = mitsuba.render(exported, [{
            "spp": 64,
            "seed": s,
            "seconds": budget.reference / 2,
            "out": str(folder / f"ref{s}")
        } for s in (501, 502)], math.inf)
        if len(halves) < 2:
            return []
        reference = Reference(halves[0][0], halves[1][0])
    rows = []
    for spp in SAMPLES:
        jobs = [{
            "spp": spp,
            "seed": s,
            "out": str(folder / f"m{s}")
        } for s in range(1, budget.seeds + 1)]
        pictures = mitsuba.render(exported, jobs, math.inf)
        if len(pictures) < len(jobs):
            break
        rows.append(
            summary(scene, f"Mitsuba {mitsuba.variant.split('_')[0]}", spp, reference, pictures))
        if max(s for _, s in pictures) > budget.picture:
            break
    return rows


def measure(scene, options, budget, mitsubas):
    title, transports, exact = SCENES[scene]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        halves = None
        for transport in transports:  # the first transport that this build has
            probe = ours(options.vv, scene, folder, transport, 1000, "--spp", 16)
            if probe is None:
                continue
            # A power of two: low-discrepancy point sets are far better than several rounds.
            spp = 16 * 2**max(0, int(math.log2(budget.reference / 2 / max(probe[1], 1e-3))))
            halves = [
                ours(options.vv, scene, folder, transport, seed, "--spp", min(spp, 65536))[0]
                for seed in (1001, 1002)
            ]
            break
        reference = Reference(*halves)
        print(
            f"{title}: reference by {transport}, twice {spp} samples, noise {math.sqrt(reference.mse):.3g} (RMSE)",
            flush=True)
        rows = []
        for transport in transports:
            rows += measure_ours(options.vv, scene, folder, transport, reference, budget)
        if mitsubas:
            remarks = export_mitsuba.export(ROOT / f"examples/scenes/{scene}.wrl", folder, SIZE,
                                            options.vv, options.replay)
            for remark in remarks:
                print(f"  for Mitsuba: {remark}")
            for mitsuba in mitsubas:
                rows += measure_mitsuba(mitsuba, scene, folder, reference if exact else None,
                                        budget)
        for row in rows:
            print(
                "  {renderer:<14} {spp:>5} spp {seconds:8.3f} s  RMSE {rmse:.4f}  relMSE {relmse:.4f}  bias {bias:+.4f} +- "
                "{bias_interval:.4f}".format(**row),
                flush=True)
        return rows


# Reports ----------------------------------------------------------------------------------------


def table(rows):
    """Returns the table by world and renderer, from the pictures with the most samples that the
    reference can resolve."""
    text = (
        "| world | renderer | samples | seconds | RMSE | relMSE | relMSE x seconds | bias, 95 % |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n")
    for key in dict.fromkeys((r["scene"], r["renderer"]) for r in rows):
        own = [r for r in rows if (r["scene"], r["renderer"]) == key]
        own = [r for r in own if not math.isnan(r["rmse"] + r["relmse"])] or own
        last = own[-1]
        efficiency = sorted(r["efficiency"] for r in own[len(own) // 2:])
        text += (
            "| {title} | {renderer} | {spp} | {seconds:.2f} | {rmse:.4f} | {relmse:.4f} | {e:.3g} | {b:+.2f} ± {i:.2f} % |\n"
            .format(title=SCENES[key[0]][0],
                    e=efficiency[len(efficiency) // 2],
                    b=100 * last["bias"],
                    i=100 * last["bias_interval"],
                    **last))
    return text


def plotted(row, what):
    if what != "bias":
        return row["seconds"], row[what]
    least, size = 1e-5, abs(row["bias"])
    return row["seconds"], max(size, least), max(size - row["bias_interval"],
                                                 least), max(size + row["bias_interval"], least)


def report(rows, options, mitsubas):
    out = pathlib.Path(options.out)
    with open(out / "render.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    plots = []
    for scene in dict.fromkeys(r["scene"] for r in rows):
        for what, title in (("rmse", "RMSE"), ("relmse", "relMSE"),
                            ("bias", "bias of the mean, and its 95 % interval")):
            lines = {}
            for row in rows:
                if row["scene"] == scene and not math.isnan(row[what] + row["bias_interval"]):
                    lines.setdefault(row["renderer"], []).append(plotted(row, what))
            name = f"bench_render_{scene}_{what}.svg"
            (out / name).write_text(log_plot(SCENES[scene][0], "seconds", title, lines))
            plots.append(name)
    text = table(rows)
    if not mitsubas:
        text += "\nMitsuba 3 was not there.\n"
    (out / "render.md").write_text(text)
    if options.docs:
        page = ROOT / "docs/benchmarks.md"
        begin, end = "<!-- bench-render -->\n", "<!-- /bench-render -->\n"
        before, rest = page.read_text().split(begin)
        # the table contains the same data
        plots = [p for p in plots if not p.endswith("relmse.svg")]
        images = "".join(
            f"![{p[13:-4].replace('_', ': ')} over seconds](images/{p})\n" for p in plots)
        page.write_text(before + begin + text + "\n" + images + end + rest.split(end)[1])
        for plot in plots:
            (ROOT / "docs/images" / plot).write_text((out / plot).read_text())
    print(f"{out}: render.csv, render.md, {', '.join(plots)}")


def main():
    if sys.argv[1:] == ["--worker"]:
        return worker(json.load(sys.stdin))
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", required=True)
    parser.add_argument("--full",
                        action="store_true",
                        help="long references and pictures, more seeds")
    parser.add_argument("--docs", action="store_true", help="also into docs/benchmarks.md")
    parser.add_argument("--again",
                        action="store_true",
                        help="measure nothing: plots and page from FOLDER/render.csv")
    parser.add_argument("--vv", default=export_mitsuba.BIN / "vv")
    parser.add_argument("--replay", default=export_mitsuba.BIN / "openrt-replay")
    parser.add_argument("--mitsuba",
                        default=os.environ.get("MITSUBA_PYTHON", sys.executable),
                        help="a Python that has Mitsuba 3")
    parser.add_argument("--scenes", default=",".join(SCENES))
    options = parser.parse_args()
    pathlib.Path(options.out).mkdir(parents=True, exist_ok=True)
    if options.again:
        with open(pathlib.Path(options.out) / "render.csv", newline="") as file:
            rows = [{
                k: v if k in ("scene", "renderer") else float(v) for k, v in row.items()
            } for row in csv.DictReader(file)]
        rows = [{**row, "spp": int(row["spp"])} for row in rows if row["spp"] > 1]
        return report(rows, options, any(r["renderer"].startswith("Mitsuba") for r in rows))
    mitsubas = [
        m for m in (Mitsuba(options.mitsuba, v) for v in ("llvm_ad_rgb", "scalar_rgb"))
        if m.works(options.out)
    ]
    if not mitsubas:
        print(
            "Mitsuba 3 is not installed here (MITSUBA_PYTHON names a Python that has it): ours alone"
        )
    rows = []
    for scene in options.scenes.split(","):
        rows += measure(scene, options, Budget(options.full), mitsubas)
    report(rows, options, mitsubas)


if __name__ == "__main__":
    main()
