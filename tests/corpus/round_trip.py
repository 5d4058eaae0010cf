#!/usr/bin/env python3
"""Writes each file of a folder in every encoding, and compares the pictures of what was written with that
of the file.

round_trip.py --corpus FOLDER --out build/round-trip   (`make round-trip`)

Needs the package xvrml on PYTHONPATH. The folder is that of corpus_x3d.py. A file that can be drawn is
written as .x3dv, .x3d, .json and .wrl. Each one has the same picture at time 0, or World.save says what
changes. Each file has a process of its own, so that one that ends badly is a row like others. Prints a
table of counts, and writes files.tsv with a row for each picture that differs. `--resume` goes on where an
earlier run with the same folders was interrupted. Exit code 0: none differs without a message; 77: there
is no such folder."""
import argparse
import collections
import concurrent.futures
import json
import multiprocessing
import pathlib
import sys

import numpy as np
import xvrml

from corpus_x3d import ROOT, encoding_of, folder_of

SUFFIXES = (".x3dv", ".x3d", ".json", ".wrl")
# Mean difference of all pixels, of 255. Numbers are written so that they read back equal, so that most
# pictures are equal byte for byte; edges of parts that touch may choose the other part.
SAME = 0.5
STATES = ("same", "told", "silent", "not read")
TIMEOUT = 300  # seconds for all encodings of one file
FAULTS = (OSError, ValueError, RuntimeError)  # those of xvrml: unreadable files, worlds without a picture


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--corpus", type=pathlib.Path, default=folder_of())
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/round-trip")
    parser.add_argument("--only", default="", help="files whose path holds this text")
    parser.add_argument("--every", type=int, default=1, help="only each N-th file")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--resume", action="store_true", help="keep the rows that --out has already")
    return parser.parse_args()


def drawn(path):
    """Returns the picture of a world that begins to run."""
    world = xvrml.load(path)
    world.time = 0
    return world.render(size=(80, 60), spp=1, threads=1).display[..., :3].astype(np.int32)


def written(source, path):
    """Writes a world to a path. Returns what is said of it, one line each."""
    world = xvrml.load(source)
    before = len(world.warnings)
    world.save(path)
    return [warning.message for warning in world.warnings[before:]]


def travel(corpus, name, folder):
    """Writes one file in all encodings. Returns a row for each of them; none if it cannot be drawn."""
    source = corpus / name
    try:
        first = drawn(source)
    except FAULTS:
        return []
    rows = []
    for suffix in SUFFIXES:
        copy = folder / (name.replace("/", "__") + suffix)
        state, amount, told = "not read", 255.0, []
        try:
            told = written(source, copy)
            amount = float(np.abs(first - drawn(copy)).mean())
            state = "same" if amount <= SAME else "told" if told else "silent"
        except FAULTS as error:
            told = [str(error)]
        rows.append({"file": name, "from": encoding_of(source), "to": suffix, "state": state, "amount": amount,
                     "told": "; ".join(told)})
    return rows


def keep(corpus, name, folder, store):
    """Writes the rows of one file to a file, whole or not at all."""
    part = store.with_suffix(".part")
    part.write_text(json.dumps(travel(corpus, name, folder)))
    part.rename(store)


def kept(args, name):
    """Returns the rows of one file: those of an interrupted run with --resume, else new ones."""
    store = args.out / "rows" / (name.replace("/", "__") + ".json")
    if not args.resume or not store.exists():
        store.unlink(missing_ok=True)
        process = multiprocessing.get_context("fork").Process(
            target=keep, args=(args.corpus, name, args.out / "worlds", store))
        process.start()
        process.join(TIMEOUT)
        process.kill()
        process.join()
    if store.exists():
        return json.loads(store.read_text())
    return [{"file": name, "from": encoding_of(args.corpus / name), "to": "any", "state": "not read", "amount": 255.0,
             "told": f"the process ended with {process.exitcode}"}]


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
    names = ["/".join(line.split("\t")[:2]) for line in manifest.read_text().splitlines()[1:]]
    names = [name for name in names if args.only in name][::args.every]
    for folder in ("worlds", "rows"):
        (args.out / folder).mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        rows = [row for found in pool.map(lambda name: kept(args, name), names) for row in found]
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
