#!/usr/bin/env python3
"""Writes each file of a folder in every encoding with vv, and compares the pictures of what was written with
that of the file.

round_trip.py --vv build/release/bin/vv --corpus FOLDER --out build/round-trip   (`make round-trip`)

The folder is that of corpus_x3d.py. A file that vv can draw is written as .x3dv, .x3d, .json and .wrl. Each
one has the same picture, or `vv --write` says what changes. Prints a table of counts, and writes files.tsv
with a row for each picture that differs. `--resume` goes on where an earlier run with the same folders was
interrupted. Exit code 0: none differs without a message; 77: there is no such folder."""
import argparse
import collections
import concurrent.futures
import json
import pathlib
import subprocess
import sys

from corpus import vv
from corpus_x3d import ROOT, encoding_of, folder_of

SUFFIXES = (".x3dv", ".x3d", ".json", ".wrl")
SIZE = ("--size", "80x60", "--spp", "1", "--epoch", "0")
# Mean difference of all pixels, of 255. Numbers are written so that they read back equal, so that most
# pictures are equal byte for byte; edges of parts that touch may choose the other part.
SAME = 0.5
STATES = ("same", "told", "silent", "not read")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--vv", type=pathlib.Path, required=True)
    parser.add_argument("--corpus", type=pathlib.Path, default=folder_of())
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/round-trip")
    parser.add_argument("--only", default="", help="files whose path holds this text")
    parser.add_argument("--every", type=int, default=1, help="only each N-th file")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--resume", action="store_true", help="keep the rows that --out has already")
    return parser.parse_args()


def difference(one, other):
    """Returns the mean difference of two pictures, of 255."""
    from PIL import Image, ImageChops, ImageStat
    both = ImageChops.difference(Image.open(one).convert("RGB"), Image.open(other).convert("RGB"))
    return sum(ImageStat.Stat(both).mean) / 3


def written(args, world, path):
    """Writes a world to a path. Returns what vv says of it, one line each; None: it was not written."""
    path.unlink(missing_ok=True)
    try:
        done = subprocess.run([args.vv, world, "--write", path], capture_output=True, timeout=60)
    except subprocess.TimeoutExpired:
        return None
    told = done.stderr.decode("utf-8", "replace")
    return [line for line in told.splitlines() if "--write: " in line] if path.exists() else None


def travel(args, origin, path):
    """Writes one file in all encodings. Returns a row for each of them; none if it cannot be drawn."""
    world = args.corpus / origin / path
    name = f"{origin}/{path}".replace("/", "__")
    first = args.out / "pictures" / (name + ".png")
    first.unlink(missing_ok=True)
    if vv(args.vv, world, first, *SIZE)["code"] != 0 or not first.exists():
        return []
    rows = []
    for suffix in SUFFIXES:
        copy, again = args.out / "worlds" / (name + suffix), args.out / "pictures" / (name + suffix + ".png")
        again.unlink(missing_ok=True)
        told = written(args, world, copy)
        state, amount = "not read", 255.0
        if told is not None:
            vv(args.vv, copy, again, *SIZE)
        if again.exists():
            amount = difference(first, again)
            state = "same" if amount <= SAME else "told" if told else "silent"
        rows.append({"file": f"{origin}/{path}", "from": encoding_of(world), "to": suffix, "state": state,
                     "amount": amount, "told": "; ".join(told or [])})
    return rows


def kept(args, origin, path):
    """Returns the rows of one file: those of an interrupted run with --resume, else new ones, which it keeps."""
    store = args.out / "rows" / (f"{origin}/{path}".replace("/", "__") + ".json")
    if args.resume and store.exists():
        return json.loads(store.read_text())
    rows = travel(args, origin, path)
    part = store.with_suffix(".part")
    part.write_text(json.dumps(rows))
    part.rename(store)
    return rows


def table(rows):
    """Returns the counts by encoding, as Markdown."""
    lines = ["| from | to | files | " + " | ".join(STATES) + " |", "| --- " * (len(STATES) + 3) + "|"]
    groups = collections.defaultdict(list)
    for row in rows:
        groups[row["from"], row["to"]].append(row["state"])
        groups["all", row["to"]].append(row["state"])
    for (before, after), states in sorted(groups.items()):
        lines.append(f"| {before} | {after} | {len(states)} | " +
                     " | ".join(str(states.count(state)) for state in STATES) + " |")
    return "\n".join(lines) + "\n"


def main():
    args = arguments()
    args.corpus = args.corpus.resolve()
    manifest = args.corpus / "MANIFEST.tsv"
    if not manifest.exists():
        print(f"no corpus at {args.corpus}: skipped")
        return 77
    listed = [line.split("\t")[:2] for line in manifest.read_text().splitlines()[1:]]
    listed = [(origin, path) for origin, path in listed if args.only in f"{origin}/{path}"][::args.every]
    for folder in ("pictures", "worlds", "rows"):
        (args.out / folder).mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        rows = [row for found in pool.map(lambda one: kept(args, *one), listed) for row in found]
    with open(args.out / "files.tsv", "w", encoding="utf-8") as file:
        for row in sorted(rows, key=lambda r: (STATES.index(r["state"]), -r["amount"]), reverse=True):
            if row["state"] != "same":
                file.write(f"{row['state']}\t{row['file']}\t{row['to']}\t{row['amount']:.2f}\t{row['told']}\n")
    text = table(rows)
    (args.out / "table.md").write_text(text)
    print(text)
    return 1 if not rows or any(row["state"] in ("silent", "not read") for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
