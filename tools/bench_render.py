#!/usr/bin/env python3
"""Measures the error of pictures over CPU time: vv's transports, and Mitsuba 3 if it is installed.

bench_render.py --out FOLDER [--worlds a,b,FILE.wrl] [--full] [--docs] [--again] [--fresh]
                [--reference SECONDS] [--picture SECONDS] [--seeds N]
                [--size WxH] [--threads N] [--vv PROGRAM] [--mitsuba PYTHON]
bench_render.py --out FOLDER --transports path,light,auto [--docs] ...
bench_render.py --out FOLDER --binaries OLD NEW [--rounds N] [--spp N] [--worlds ...]

`make bench-render` runs it. Worlds are names from tools/rendering/worlds.py or files. FOLDER gets
render.csv (a row for each world, renderer and number of samples), curves (SVG) and render.md;
--docs also writes the last two to docs/. --again makes them from render.csv without measuring.

The reference of a world is a long render with other seeds, in two halves; their difference measures
its noise, which is subtracted from the errors. It is kept in FOLDER/references until the world or
the settings change, or until --fresh. Seconds are CPU seconds of all threads, without the start-up,
which has a column of its own.

--transports renders every world with the same transports, without Mitsuba. FOLDER gets
transports.csv, a curve of each world, and transports.md, which says how the error of auto compares
with the best of the others at equal CPU time. `make bench-transports` runs it for eight worlds.

--binaries decides about a change: two builds of vv take turns with the same seeds. OLD and NEW may
have options: --binaries "old/vv" "new/vv --depth 8". FOLDER gets binaries.csv and binaries.md.
"""
import argparse
import hashlib
import json
import math
import os
import pathlib
import statistics
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import export_mitsuba  # noqa: E402
from export_mitsuba import ROOT, read_pfm, write_pfm  # noqa: E402
from rendering import automatic, renderers, report  # noqa: E402
from rendering.errors import Measured, Reference, mean, ratio_of_means  # noqa: E402
from rendering.worlds import WORLDS, find  # noqa: E402

SAMPLES = tuple(2**k for k in range(1, 17))  # a single sample would lie at the pixel's centre
HALVES = (1001, 1002)  # seeds of the reference; pictures have small ones


class Bench:
    """Holds what all measurements share."""

    def __init__(self, options):
        self.options = options
        self.out = pathlib.Path(options.out)
        self.size = tuple(map(int, options.size.split("x")))

    def transports(self, program, entry, file, folder):
        """Returns a renderer for each transport of a world that the build has."""
        wanted = self.options.transports
        made = [
            renderers.Vv(program, file, transport, self.size, self.options.threads, folder)
            for transport in (wanted.split(",") if wanted else entry.transports)
        ]
        made = [vv for vv in made if vv.supported()]
        if not made:
            raise SystemExit(f"bench_render.py: {program} lacks {' and '.join(entry.transports)}")
        return made

    def reference(self, world, file, by, make):
        """Returns the reference of a world; make() renders the two halves if they are not kept."""
        key = [file.read_text(errors="replace"), self.size, by, self.options.reference]
        digest = hashlib.sha256(json.dumps(key).encode()).hexdigest()[:12]
        folder = self.out / "references"
        folder.mkdir(parents=True, exist_ok=True)
        kept = [folder / f"{world}-{digest}-{half}.pfm" for half in (1, 2)]
        if self.options.fresh or not all(k.exists() for k in kept):
            for path, picture in zip(kept, make()):
                write_pfm(path, *self.size, picture)
        made = Reference(*(read_pfm(k)[2] for k in kept))
        print(f"  reference by {by}: noise {math.sqrt(made.noise[0]):.2g} (RMSE), "
              f"{made.noise[1]:.2g} (relMSE)", flush=True)  # yapf: disable
        return made

    def vv_reference(self, world, file, vv):
        """Renders the halves with all cores, because their time is not measured."""

        def halves():
            seconds = vv.render(16, HALVES[0])[1]
            spp = affordable(16, seconds, self.options.reference / 2)
            return [vv.render(spp, seed, threads=0)[0] for seed in HALVES]

        by = " ".join(["vv", *vv.options, "--transport", vv.name])
        return self.reference(world, file, by, halves)


def affordable(spp, seconds, limit):
    """Returns the number of samples that fits into a time, from the time of fewer samples. It is a
    power of two times these, which suits low-discrepancy points."""
    return min(SAMPLES[-1], spp * 2**max(0, int(math.log2(limit / max(seconds, 1e-3)))))


def row(world, entry, renderer, spp, startup, seconds, measured):
    return {
        "world": world,
        "title": entry.title,
        "renderer": renderer,
        "spp": spp,
        "startup": startup,
        "seconds": seconds,
        "rmse": measured.rmse,
        "relmse": measured.relmse,
        "relmse_interval": measured.relmse_interval,
        "product": measured.relmse * seconds,
        "bias": measured.bias,
        "bias_interval": measured.bias_interval,
    }


# Error over time --------------------------------------------------------------------------------


def sweep_vv(bench, world, entry, vv, reference):
    """Yields a row for each number of samples, until a picture is slow or too good to be judged.
    Pictures that cost less than a quarter of the start-up are left out: what remains after the
    subtraction is mostly the noise of the clock."""
    startup = vv.startup()
    for spp in SAMPLES:
        pictures = [vv.render(spp, seed) for seed in range(1, bench.options.seeds + 1)]
        seconds = mean([s for _, s in pictures]) - startup
        if seconds < startup / 4:
            continue
        measured = Measured(reference, [p for p, _ in pictures])
        yield row(world, entry, vv.name, spp, startup, seconds, measured)
        if 2 * seconds > bench.options.picture or math.isnan(measured.relmse):
            break


def sweep_mitsuba(bench, world, entry, mitsuba, folder, reference):
    """Yields the rows of one variant: all seeds of one number of samples in one process."""
    for spp in SAMPLES:
        jobs = [{"spp": spp, "seed": seed} for seed in range(1, bench.options.seeds + 1)]
        startup, pictures = mitsuba.render(folder, jobs)
        if len(pictures) < len(jobs):
            break
        seconds = mean([s for _, s in pictures])
        measured = Measured(reference, [p for p, _ in pictures])
        yield row(world, entry, mitsuba.name, spp, startup, seconds, measured)
        if 2 * seconds > bench.options.picture or math.isnan(measured.relmse):
            break


def mitsuba_reference(bench, world, file, mitsuba, folder):

    def halves():
        jobs = [{"spp": 64, "seed": s, "seconds": bench.options.reference / 2} for s in HALVES]
        pictures = mitsuba.render(folder, jobs)[1]
        if len(pictures) < len(jobs):
            raise SystemExit(f"bench_render.py: {mitsuba.name} made no reference of {world}")
        return [p for p, _ in pictures]

    return bench.reference(world, file, mitsuba.name, halves)


def measure(bench, name, mitsubas):
    """Yields the rows of one world."""
    world, entry, file = find(name, bench.out / "worlds")
    print(entry.title, flush=True)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        ours = bench.transports(bench.options.vv, entry, file, folder)
        reference = bench.vv_reference(world, file, ours[0])
        for vv in ours:
            yield from sweep_vv(bench, world, entry, vv, reference)
        if not entry.mitsuba or not mitsubas:
            return
        renderers.export(file, folder, bench.size, bench.options.vv, bench.options.replay)
        if entry.mitsuba == "own":
            reference = mitsuba_reference(bench, world, file, mitsubas[0], folder)
        for mitsuba in mitsubas:
            yield from sweep_mitsuba(bench, world, entry, mitsuba, folder, reference)


def measure_all(bench):
    options = bench.options
    mitsubas = []
    if not options.transports:
        mitsubas = renderers.mitsubas(options.mitsuba, options.threads or os.cpu_count(), bench.out)
    if not mitsubas and not options.transports:
        print("Mitsuba 3 is not installed here (MITSUBA_PYTHON names a Python that has it): "
              "vv alone")  # yapf: disable
    rows = []
    for name in options.worlds.split(","):
        for line in measure(bench, name, mitsubas):
            print("  {renderer:<14} {spp:>5} spp {seconds:8.3f} s  RMSE {rmse:.4f}  relMSE "
                  "{relmse:.5f} +- {relmse_interval:.5f}  product {product:.3g}  bias {bias:+.4f} "
                  "+- {bias_interval:.4f}".format(**line), flush=True)  # yapf: disable
            rows.append(line)
    return rows


# Two binaries -----------------------------------------------------------------------------------


class Side:
    """One of the two programs: its CPU seconds, and the relMSE and the mean of its pictures."""

    def __init__(self, vv):
        self.vv, self.startup = vv, vv.startup()
        self.seconds, self.errors, self.means = [], [], []

    def render(self, spp, seed, reference):
        picture, seconds = self.vv.render(spp, seed)
        self.seconds.append(max(seconds - self.startup, 1e-6))
        self.errors.append(reference.errors(picture)[1])
        self.means.append(mean(picture))
        return picture


def compare_transport(bench, world, entry, programs, reference):
    """Renders with both programs in turns, each round with another seed and the other one first.
    Returns the row of the comparison."""
    old, new = (Side(vv) for vv in programs)
    spp = bench.options.spp
    if not spp:  # about one second a picture
        spp = affordable(4, old.vv.render(4, 0)[1] - old.startup, 1)
    same = True
    for seed in range(1, bench.options.rounds + 1):
        order = (old, new) if seed % 2 else (new, old)
        first, second = (side.render(spp, seed, reference) for side in order)
        same = same and first == second
    seconds_ratio = statistics.median(n / o for o, n in zip(old.seconds, new.seconds))
    relmse_ratio, relmse_factor = ratio_of_means(new.errors, old.errors)
    if mean(old.errors) < reference.noise[1] and not same:
        relmse_ratio = math.nan  # the reference cannot judge these pictures
    brightness, brightness_factor = ratio_of_means(new.means, old.means)
    return {
        "world": world,
        "title": entry.title,
        "renderer": old.vv.name,
        "spp": spp,
        "seconds_old": statistics.median(old.seconds),
        "seconds_ratio": seconds_ratio,
        "relmse_old": mean(old.errors),
        "relmse_ratio": relmse_ratio,
        "relmse_factor": relmse_factor,
        "product_ratio": relmse_ratio * seconds_ratio,
        "brightness": brightness,
        "brightness_factor": brightness_factor,
        "same_bytes": same,
    }


def compare(bench, name):
    """Yields a row for each transport of a world."""
    world, entry, file = find(name, bench.out / "worlds")
    print(entry.title, flush=True)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        programs = [
            bench.transports(program, entry, file, folder) for program in bench.options.binaries
        ]
        reference = bench.vv_reference(world, file, programs[0][0])
        for old in programs[0]:
            for new in programs[1]:
                if new.name == old.name:
                    yield compare_transport(bench, world, entry, (old, new), reference)


def compare_all(bench):
    rows = []
    for name in bench.options.worlds.split(","):
        for line in compare(bench, name):
            print("  {renderer:<8} {spp:>5} spp {seconds_old:8.3f} s  new/old: CPU "
                  "{seconds_ratio:.3f}  relMSE {relmse_ratio:.3f}  product {product_ratio:.3f}  "
                  "brightness {brightness:.4f}".format(**line), flush=True)  # yapf: disable
            rows.append(line)
    text = report.comparison(rows)
    report.write_csv(bench.out / "binaries.csv", rows)
    (bench.out / "binaries.md").write_text(text)
    print(text)


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", required=True)
    parser.add_argument("--worlds", default=",".join(WORLDS), help="names and files, by commas")
    parser.add_argument("--reference", type=float, help="CPU seconds of a reference (30; full 300)")
    parser.add_argument("--picture", type=float, help="most CPU seconds of a picture (2; full 20)")
    parser.add_argument("--seeds", type=int, help="pictures a measurement (3; full 5)")
    parser.add_argument("--full", action="store_true", help="long references, pictures, more seeds")
    parser.add_argument("--docs", action="store_true", help="also into docs/benchmarks.md")
    parser.add_argument("--again", action="store_true", help="measure nothing: from render.csv")
    parser.add_argument("--fresh", action="store_true", help="render the references again")
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--threads", type=int, default=1, help="of each renderer (default 1)")
    parser.add_argument("--vv", default=export_mitsuba.BIN / "vv")
    parser.add_argument("--replay", default=export_mitsuba.BIN / "openrt-replay")
    parser.add_argument("--mitsuba",
                        default=os.environ.get("MITSUBA_PYTHON", sys.executable),
                        help="a Python that has Mitsuba 3")
    parser.add_argument("--binaries", nargs=2, metavar=("OLD", "NEW"), help="compare two builds")
    parser.add_argument("--transports",
                        help="of all worlds, by commas; the first of a world that "
                        "vv has makes the reference")
    parser.add_argument("--rounds", type=int, default=9, help="turns of --binaries (default 9)")
    parser.add_argument("--spp", type=int, help="samples of --binaries (default: about 1 s)")
    options = parser.parse_args()
    options.reference = options.reference or (300 if options.full else 30)
    options.picture = options.picture or (20 if options.full else 2)
    options.seeds = options.seeds or (5 if options.full else 3)
    return options


def write_transports(bench, rows):
    text, names = automatic.write(rows, bench.out)
    print(text)
    if bench.options.docs:
        report.into_page(ROOT / "docs/benchmarks.md", text, names, bench.out, "bench-transports")


def main():
    bench = Bench(parse())
    bench.out.mkdir(parents=True, exist_ok=True)
    if bench.options.binaries:
        return compare_all(bench)
    again = bench.options.again
    table = "transports.csv" if bench.options.transports else "render.csv"
    rows = report.read_csv(bench.out / table) if again else measure_all(bench)
    if bench.options.transports:
        return write_transports(bench, rows)
    with_mitsuba = any(r["renderer"].startswith("Mitsuba") for r in rows)
    text, names = report.write(rows, bench.out, with_mitsuba)
    if bench.options.docs:
        report.into_page(ROOT / "docs/benchmarks.md", text, names, bench.out)
    print(f"{bench.out}: render.csv, render.md and {len(names)} curves")


if __name__ == "__main__":
    main()
