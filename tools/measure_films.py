#!/usr/bin/env python3
"""Measures films of few samples: how far their pictures are from the true ones (FLIP), and whether
they flicker.

measure_films.py --out FOLDER [--vv PROGRAM] [--worlds a,b,FILE.wrl] [--spp N] [--size WxH]
                 [--reference-spp N] [--denoise] [--threads N] [--table FILE]

Each world is filmed for 18 frames while the mouse turns it, once with the samples as they are (raw)
and once with --preview. Six frames are then rendered with many samples. FLIP is that of `vv compare`.

* flicker: how much neighbouring pictures differ, over how much the true ones do. A film that is still
  where the true one is has 1, or less if it is smoother than it should be.
* seams: how much pictures differ where a history of the preview ends (every eighth frame), over how
  much they differ elsewhere.

References are kept in FOLDER until the world or the settings change. The pictures of each
film are left there: WORLD-raw-0020.png, WORLD-film-0020.png.
"""
import argparse
import hashlib
import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[1]
FIRST, LAST, PERIOD = 8, 25, 8
PAIRS = ((15, 16), (19, 20), (23, 24))  # compared with the true ones
FPS, STEP = 30, 0.003  # the mouse goes on by STEP of half the width in each frame


def drag(folder):
    """Writes the script of a mouse that turns the world slowly; returns its file."""
    lines = ["0 move 0 0", "0 press left 0 0"]
    lines += [f"{(n - 0.5) / FPS:.6f} move {STEP * n:.5f} 0" for n in range(1, LAST + 2)]
    file = folder / "turn.txt"
    file.write_text("\n".join(lines) + "\n")
    return file


class World:
    """One world and its pictures."""

    def __init__(self, options, name):
        places = (pathlib.Path(name), ROOT / f"examples/scenes/{name}.wrl")
        self.file = next((place for place in places if place.is_file()), None)
        if not self.file:
            raise SystemExit(f"measure_films.py: there is no world {name}")
        self.options, self.name = options, self.file.stem

    def path(self, kind, frame):
        return self.options.out / f"{self.name}-{kind}-{frame:04}.png"

    def render(self, kind, frames, *how):
        subprocess.run([
            self.options.vv, self.file, "--input",
            drag(self.options.out), "--frames", frames, "--size", self.options.size, "--threads",
            str(self.options.threads), "-q", *how, "-o", self.options.out / f"{self.name}-{kind}.png"
        ],
                       check=True)

    def references(self):
        """Returns the kind of the true pictures, after rendering those that are not there."""
        o = self.options
        key = (self.file.read_bytes(), o.size, o.reference_spp, STEP)
        kind = "true" + hashlib.sha256(repr(key).encode()).hexdigest()[:8]
        for a, b in PAIRS:
            if not (self.path(kind, a).exists() and self.path(kind, b).exists()):
                self.render(kind, f"{a}-{b}", "--spp", str(o.reference_spp), "--seed", "7777")
        return kind

    def flip(self, one, other):
        """Returns the mean FLIP of two pictures, each a kind and a frame."""
        done = subprocess.run(
            [self.options.vv, "compare", "--json",
             self.path(*one),
             self.path(*other)],
            capture_output=True,
            text=True,
            check=False)
        return json.loads(done.stdout)["flip"]

    def measure(self):
        """Returns the row of the table."""
        spp = ("--spp", str(self.options.spp))
        frames = f"{FIRST}-{LAST}"
        self.render("raw", frames, *spp)
        self.render("film", frames, *spp, "--preview",
                    *(["--denoise"] if self.options.denoise else []))
        true = self.references()
        truly = sum(self.flip((true, a), (true, b)) for a, b in PAIRS)
        row = {"world": self.name}
        for kind in ("raw", "film"):
            errors = [self.flip((true, n), (kind, n)) for pair in PAIRS for n in pair]
            row[kind] = {
                "flip": sum(errors) / len(errors),
                "worst": max(errors),
                "flicker": sum(self.flip((kind, a), (kind, b)) for a, b in PAIRS) / truly,
                "seams": self.seams(kind)
            }
        return row

    def seams(self, kind):
        steps = {n: self.flip((kind, n - 1), (kind, n)) for n in range(FIRST + 1, LAST + 1)}
        at = [step for n, step in steps.items() if n % PERIOD == 0]
        others = [step for n, step in steps.items() if n % PERIOD]
        return (sum(at) / len(at)) / (sum(others) / len(others))


def table(rows):
    lines = [
        "| world | FLIP, raw | film | worst frame | flicker, raw | film | seams, raw | film |",
        "|" + " --- |" * 8
    ]
    for row in rows:
        raw, film = row["raw"], row["film"]
        lines.append(f"| {row['world']} | {raw['flip']:.3f} | {film['flip']:.3f} | "
                     f"{film['worst']:.3f} | {raw['flicker']:.2f} | {film['flicker']:.2f} | "
                     f"{raw['seams']:.2f} | {film['seams']:.2f} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--vv", default=ROOT / "build/release/bin/vv", type=pathlib.Path)
    parser.add_argument("--worlds", default="globe,chess,still_life,board")
    parser.add_argument("--spp", type=int, default=8)
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--reference-spp", type=int, default=1024)
    parser.add_argument("--denoise", action="store_true")
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--table", type=pathlib.Path)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    rows = []
    for name in options.worlds.split(","):
        rows.append(World(options, name).measure())
        print(table(rows[-1:]).splitlines()[-1], flush=True)
    if options.table:
        options.table.write_text(table(rows))
    print("\n" + table(rows), end="")


if __name__ == "__main__":
    main()
