#!/usr/bin/env python3
"""Measures live pictures: how far they are from the true ones while something moves (FLIP), how
often they come, how late, and whether they flicker.

live_flip.py --bench PROGRAM --out FOLDER [--worlds a,b,FILE.wrl] [--seconds N] [--pairs N]
             [--steps N] [--frame WxH[xS[xK]]] [--size WxH] [--compare WxH] [--threads N]
             [--denoiser own|oidn|auto]
             [--reference-spp N] [--reference-error E] [--strip FOLDER] [--docs] [--fresh]

`make bench-live` runs it. PROGRAM is bench_live, which shows each world on a slow and on a fast turn,
once with the samples as they are and once rebuilt, and keeps what the window would show. Some
instants are then rendered with many samples, in the size of the comparison (--compare). The
picture that is shown is scaled to the window (--size) and then to that size, and compared by FLIP
(the package flip-evaluator).

By default the pictures are those for which the clock leaves time, so the machine must have no other
work. --steps N shows N pictures of one size (--frame) at fixed instants instead; then FLIP can be
measured on a busy machine, and the columns of times are empty.

FOLDER gets live.json, live.md (the table) and a strip of pictures for each world: raw, rebuilt and
converged, above on the slow and below on the fast turn. --strip puts the strips elsewhere; --docs
puts table and strips into docs/. Converged pictures are kept in FOLDER/references until the world or
the settings change, or until --fresh.
"""
import argparse
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys

try:
    import flip_evaluator
    import numpy
    from PIL import Image
except ImportError as missing:
    raise SystemExit(f"live_flip.py: {missing}. It needs numpy, Pillow and flip-evaluator: "
                     "pip install --target FOLDER flip-evaluator, then PYTHONPATH=FOLDER")

ROOT = pathlib.Path(__file__).resolve().parents[2]
TURNS = {"slow": 0.15, "fast": 0.8}  # radians a second
# FLIP that a rebuilt picture should not exceed, on the slow and on the fast turn
AIMS = {
    "globe": (0.08, 0.11),
    "board": (0.06, 0.08),
    "headlight_studio": (0.15, 0.18),
    "chess": (0.08, 0.10),
    "still_life": (0.03, 0.04),
    "car": (0.10, 0.13),
}
KINDS = ("raw", "rebuilt")
LEAD = 1.0  # seconds until frame rate and accumulation have settled
TILE = (320, 240)  # size of a picture in a strip


def find(name):
    """Returns the file of a world, or None if it is not here."""
    places = [
        pathlib.Path(name), ROOT / f"examples/scenes/{name}.wrl",
        ROOT / f"examples/scenes/{name}.wrz",
        ROOT.parent / f"shared/bench/{name}.wrl"
    ]
    return next((p for p in places if p.is_file()), None)


# Arithmetic -------------------------------------------------------------------------------------


def settled(frames, fps):
    """Returns the frames after the first second, or after the first quarter of a shorter run."""
    last = frames[-1]["instant"]
    return [f for f in frames if f["instant"] >= min(LEAD * fps, last / 4)]


def choose_pairs(frames, count):
    """Returns neighbouring frames near `count` places that are spread over the run; the last pair
    ends it."""
    if len(frames) < 2:
        return []
    first, last = frames[0]["instant"], frames[-1]["instant"]
    chosen = {}
    for place in range(count):
        wanted = first + (last - first) * (place + 1) / count
        i = min(range(len(frames) - 1), key=lambda i: abs(frames[i + 1]["instant"] - wanted))
        chosen[i] = frames[i], frames[i + 1]
    return list(chosen.values())


def times(frames):
    """Returns frames a second, the mean and the longest time from input to picture, and the longest
    time without a new picture. Input comes at any moment and is seen in the first frame that is
    started afterwards."""
    intervals = [(b["asked"] - a["asked"], b["shown"] - (a["asked"] + b["asked"]) / 2)
                 for a, b in zip(frames, frames[1:])]
    waited = sum(w for w, _ in intervals)
    if waited <= 0:
        return {}
    return {
        "rate": (len(frames) - 1) / (frames[-1]["shown"] - frames[0]["shown"]),
        "latency": sum(w * late for w, late in intervals) / waited,
        "longest_latency": max(b["shown"] - a["asked"] for a, b in zip(frames, frames[1:])),
        "stall": max(b["shown"] - a["shown"] for a, b in zip(frames, frames[1:])),
    }


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else None


# Pictures ---------------------------------------------------------------------------------------


def as_shown(path, window, size):
    """Returns a picture as the window scales it, scaled to the size of the comparison."""
    with Image.open(path) as opened:
        picture = opened.convert("RGB")
    if picture.size != window:
        picture = picture.resize(window, Image.BILINEAR)
    return picture.resize(size, Image.BOX)


def flip(reference, test):
    """Returns the mean FLIP error of two pictures of one size."""
    arrays = [
        numpy.ascontiguousarray(p, dtype=numpy.float32) / numpy.float32(255)
        for p in (reference, test)
    ]
    return float(flip_evaluator.evaluate(*arrays, "LDR", applyMagma=False)[1])


def write_strip(path, rows):
    """Writes rows of pictures beside each other, with a palette so that the file is small."""
    width = max(len(row) for row in rows)
    sheet = Image.new("RGB", (width * TILE[0], len(rows) * TILE[1]))
    for y, row in enumerate(rows):
        for x, picture in enumerate(row):
            sheet.paste(picture.resize(TILE, Image.BOX), (x * TILE[0], y * TILE[1]))
    sheet.quantize(256, dither=Image.Dither.NONE).save(path, optimize=True)


# Measurement ------------------------------------------------------------------------------------


class Run:
    """Holds what bench_live has shown on one turn."""

    def __init__(self, folder, pairs):
        facts = json.loads((folder / "frames.json").read_text())
        self.folder, self.still = folder, facts["still"]
        self.frames = settled(facts["frames"], facts["fps"])
        self.pairs = choose_pairs(self.frames, pairs)
        if not self.pairs:
            raise SystemExit(
                f"live_flip.py: {folder.parent.name}: too few pictures; more --seconds "
                "or --steps")
        self.rebuilt = all(f["preview"] for f in facts["frames"])

    def instants(self):
        return [f["instant"] for pair in self.pairs for f in pair]

    def nearest(self, instant):
        """Returns the compared instant that is nearest to another."""
        return min(self.instants(), key=lambda k: abs(k - instant))

    def file(self, instant):
        return self.folder / f"{instant:04}.ppm"

    def size(self):
        middle = sorted(self.frames, key=lambda f: f["width"])[len(self.frames) // 2]
        return f"{middle['width']}x{middle['height']}"

    def remove_rest(self):
        """Removes the pictures that are not compared."""
        kept = {self.file(k) for k in self.instants()} | {self.folder / "still.ppm"}
        for file in set(self.folder.glob("*.ppm")) - kept:
            file.unlink()


class World:
    """One world and what all its measurements share."""

    def __init__(self, options, file):
        self.options, self.file, self.name = options, file, file.name.split(".")[0]

    def bench(self, size, *arguments):
        """Runs bench_live with the options that all modes share, for a window of some size."""
        o = self.options
        done = subprocess.run([
            o.bench, *arguments, f"--size={size[0]}x{size[1]}", f"--fps={o.fps}",
            f"--threads={o.threads}", self.file
        ],
                              capture_output=True,
                              text=True)
        if done.returncode:
            raise SystemExit(f"live_flip.py: {o.bench}: {done.stderr.strip() or done.returncode}")

    def picture(self, path):
        return as_shown(path, self.options.size, self.options.compare)

    def show(self, turn, kind):
        folder = self.options.out / self.name / f"{turn}-{kind}"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        how = [
            f"--show={folder}", f"--speed={TURNS[turn]}", f"--seconds={self.options.seconds}",
            f"--denoiser={self.options.denoiser}"
        ]
        if kind == "raw":
            how.append("--raw")
        if self.options.steps:
            how += [f"--steps={self.options.steps}", f"--frame={self.options.frame}"]
        self.bench(self.options.size, *how)
        run = Run(folder, self.options.pairs)
        run.remove_rest()
        return run

    def converged(self, turn, instants, seed=0):
        """Returns the converged pictures of some instants; renders those that are not kept."""
        o = self.options
        key = [
            self.file.read_bytes().hex(), o.compare, o.fps, TURNS[turn], o.reference_spp,
            o.reference_error, seed
        ]
        digest = hashlib.sha256(json.dumps(key).encode()).hexdigest()[:12]
        folder = o.out / "references" / f"{self.name}-{turn}-{digest}"
        folder.mkdir(parents=True, exist_ok=True)
        files = {k: folder / f"{k:04}.ppm" for k in sorted(set(instants))}
        missing = [k for k, file in files.items() if not file.exists()]
        if missing:
            print(f"  {turn}: {len(missing)} converged pictures", flush=True)
            self.bench(o.compare, f"--converge={folder}", f"--speed={TURNS[turn]}",
                       f"--at={','.join(map(str, missing))}", f"--spp={o.reference_spp}",
                       f"--error={o.reference_error}", f"--seed={seed}")
        return {k: Image.open(file).convert("RGB") for k, file in files.items()}

    def measure(self, turn):
        """Returns the row of a turn, and pictures of it: raw, rebuilt, converged."""
        runs = {kind: self.show(turn, kind) for kind in KINDS}
        rebuilt = runs["rebuilt"]
        stop = rebuilt.still["instant"]
        true = self.converged(turn, [k for run in runs.values() for k in run.instants()] + [stop])
        again = self.converged(turn, [stop], seed=1)
        row = {"world": self.name, "turn": turn, "previews": rebuilt.rebuilt}
        for kind, run in runs.items():
            row[kind] = {"size": run.size(), **self.compare(run, true)}
            if not self.options.steps:
                row[kind].update(times(run.frames))
        row["still"] = flip(true[stop], self.picture(rebuilt.folder / "still.ppm"))
        row["still_samples"], row["whole"] = rebuilt.still["samples"], rebuilt.still["whole"]
        row["noise"] = flip(true[stop], again[stop])
        middle = rebuilt.pairs[len(rebuilt.pairs) // 2][0]["instant"]
        strip = [self.picture(run.file(run.nearest(middle))) for run in runs.values()]
        return row, strip + [true[middle]]

    def compare(self, run, true):
        """Returns the mean FLIP of the frames, and that of neighbours over the converged ones'."""
        shown = {k: self.picture(run.file(k)) for k in run.instants()}
        steps = [(a["instant"], b["instant"]) for a, b in run.pairs]
        change = mean(flip(shown[a], shown[b]) for a, b in steps)
        truly = mean(flip(true[a], true[b]) for a, b in steps)
        return {
            "flip": mean(flip(true[k], picture) for k, picture in shown.items()),
            "flicker": change / truly if truly > 0 else None
        }


# Report -----------------------------------------------------------------------------------------


def number(value, form=".3f", unit="", factor=1):
    return "-" if value is None else format(value * factor, form) + unit


def table(rows, options):
    """Returns the table as Markdown."""
    heads = [
        "world", "turn", "FLIP, raw", "FLIP, rebuilt", "aim", "after the stop", "pixels",
        "frames a second", "input to picture, mean (longest)", "longest stall", "unbiased after",
        "flicker, raw", "flicker, rebuilt", "noise"
    ]
    lines = [heads, ["---"] * len(heads)]
    for row in rows:
        own = row["rebuilt"]
        aim = AIMS.get(row["world"], (None, None))[list(TURNS).index(row["turn"])]
        late = "-"
        if "latency" in own:
            late = f"{1000 * own['latency']:.0f} ms ({1000 * own['longest_latency']:.0f})"
        lines.append([
            row["world"], row["turn"],
            number(row["raw"]["flip"]),
            number(own["flip"]),
            number(aim, ".2f"),
            number(row["still"]), own["size"],
            number(own.get("rate"), ".1f"), late,
            number(own.get("stall"), ".0f", " ms", 1000),
            number(row["whole"], ".1f", " s"),
            number(row["raw"]["flicker"], ".2f"),
            number(own["flicker"], ".2f"),
            number(row["noise"])
        ])
    text = "".join(f"| {' | '.join(line)} |\n" for line in lines)
    return text + "\n" + note(rows, options)


def note(rows, options):
    """Returns the sentences below the table: how it was measured."""
    o = options
    how = (f"{o.steps} pictures of fixed size at fixed instants, without the clock"
           if o.steps else f"{o.seconds:g} s on the clock, load average {o.load:.1f} before it")
    text = (f"Window {o.size[0]}x{o.size[1]}, compared at {o.compare[0]}x{o.compare[1]}; {how}; "
            f"converged pictures of at most {o.reference_spp} samples or an error of "
            f"{100 * o.reference_error:g} %; neighbours compared a turn: {o.pairs}.\n")
    if not all(row["previews"] for row in rows):
        text += ("\nThis build of bench_live did not rebuild all of the pictures that should have "
                 "been: the column \"rebuilt\" is not what it says.\n")
    return text


def put_between_marks(page, text):
    """Replaces what stands between the marks of a page of docs/."""
    begin, end = "<!-- bench-live -->\n", "<!-- /bench-live -->\n"
    before, rest = page.read_text().split(begin)
    page.write_text(before + begin + text + end + rest.split(end)[1])


def gallery(rows):
    """Returns the strips with captions, for docs/window.md."""
    text = ""
    for name in dict.fromkeys(row["world"] for row in rows):
        own = {row["turn"]: row for row in rows if row["world"] == name}
        parts = (f"{turn} {number(row['raw']['flip'])} and {number(row['rebuilt']['flip'])}"
                 for turn, row in own.items())
        text += f"![{name}: raw, rebuilt and converged](images/live-{name}.png)\n\n"
        text += f"`{name}`: FLIP of the raw and of the rebuilt pictures: {', '.join(parts)}.\n\n"
    return text


def write_docs(rows, options):
    put_between_marks(ROOT / "docs/benchmarks.md", table(rows, options))
    put_between_marks(ROOT / "docs/window.md", gallery(rows))


def size(text):
    width, height = map(int, text.split("x"))
    if width < 1 or height < 1:
        raise ValueError(text)
    return width, height


def read_options():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--bench", default=ROOT / "build/release/bin/bench_live")
    add("--out", default=ROOT / "build/bench/live", type=pathlib.Path)
    add("--worlds", default=",".join(AIMS))
    add("--seconds", type=float, default=6)
    add("--steps", type=int, default=0)
    add("--frame", default="400x300")
    add("--pairs", type=int, default=1)
    add("--size", type=size, default=(800, 600))
    add("--compare", type=size, default=(400, 300))
    add("--fps", type=float, default=30)
    add("--threads", type=int, default=0)
    add("--denoiser", choices=["own", "oidn", "auto"], default="own")
    add("--reference-spp", type=int, default=128)
    add("--reference-error", type=float, default=0.03)
    add("--strip", type=pathlib.Path)
    add("--docs", action="store_true")
    add("--fresh", action="store_true")
    options = parser.parse_args()
    if not pathlib.Path(options.bench).exists():
        raise SystemExit(f"live_flip.py: {options.bench} is not built: make bench-live builds it")
    options.load = os.getloadavg()[0]
    if options.docs and not options.strip:
        options.strip = ROOT / "docs/images"
    return options


def main():
    options = read_options()
    if options.fresh:
        shutil.rmtree(options.out / "references", ignore_errors=True)
    strips = options.strip or options.out
    strips.mkdir(parents=True, exist_ok=True)
    options.out.mkdir(parents=True, exist_ok=True)
    rows = []
    for name in options.worlds.split(","):
        file = find(name)
        if not file:
            print(f"{name}: not here, left out", flush=True)
            continue
        print(f"{name}:", flush=True)
        world, pictures = World(options, file), []
        for turn in TURNS:
            row, strip = world.measure(turn)
            rows.append(row)
            pictures.append(strip)
        write_strip(strips / f"live-{world.name}.png", pictures)
    if not rows:
        raise SystemExit("live_flip.py: none of these worlds is here")
    (options.out / "live.json").write_text(json.dumps(rows, indent=1) + "\n")
    (options.out / "live.md").write_text(table(rows, options))
    print("\n" + table(rows, options), end="")
    if options.docs:
        write_docs(rows, options)


if __name__ == "__main__":
    sys.exit(main())
