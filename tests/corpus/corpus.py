#!/usr/bin/env python3
"""Runs vv on real VRML files and compares the pictures with those of two other browsers.

corpus.py --vv build/release/bin/vv --corpus FOLDER --out build/corpus
    table, contact sheets, report  (`make corpus`)
corpus.py --vv build/release/bin/vv --quick
    only the promises of each class (the ctest `corpus`)

The folder of files (default $OPENRT_CORPUS or ../shared/corpus) holds FEATURES.tsv, which gives the
class of each file, and pictures/{view3dscene,x_ite}. Exit code 0: every file keeps its class's
promise; 77: there is no such folder."""
import argparse
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

import promises

ROOT = pathlib.Path(__file__).resolve().parents[2]
TIMEOUT = 30  # seconds per run


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--vv", type=pathlib.Path, required=True)
    parser.add_argument("--corpus",
                        type=pathlib.Path,
                        default=os.environ.get("OPENRT_CORPUS") or ROOT.parent / "shared/corpus")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/corpus")
    parser.add_argument("--quick",
                        action="store_true",
                        help="load and render a few pixels of each, keep no pictures")
    parser.add_argument("--only", default="", help="files whose path holds this text")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--spp",
                        type=int,
                        default=4,
                        help="samples a pixel of the pictures that are compared")
    return parser.parse_args()


def files(corpus, only):
    """Returns the rows of FEATURES.tsv as dictionaries."""
    lines = (corpus / "FEATURES.tsv").read_text(encoding="utf-8").rstrip("\n").split("\n")
    names = lines[0].split("\t")
    rows = [dict(zip(names, line.split("\t"))) for line in lines[1:]]
    for row in rows:
        row["file"] = f"{row['folder']}/{row['path']}"
    return [row for row in rows if only in row["file"]]


def vv(program, world, picture, *options):
    """Runs vv on a world. Returns its exit code (negative: signal; None: timed out), seconds, MiB, messages."""
    command = [program, world, "-o", picture, "--threads", "1", *options]
    with tempfile.TemporaryFile() as log:
        start = time.monotonic()
        process = subprocess.Popen([str(c) for c in command],
                                   stdin=subprocess.DEVNULL,
                                   stdout=log,
                                   stderr=log)
        code = None
        while time.monotonic() - start < TIMEOUT:
            done, status, usage = os.wait4(process.pid, os.WNOHANG)
            if done:
                code = os.waitstatus_to_exitcode(status)
                break
            time.sleep(0.004)
        else:
            process.kill()
            _, _, usage = os.wait4(process.pid, 0)
        process.returncode = code
        log.seek(0)
        text = log.read(1 << 20).decode("utf-8", "replace")
    return {
        "code": code,
        "seconds": time.monotonic() - start,
        "mib": usage.ru_maxrss / 1024,
        "log": text
    }


def without_viewpoint(corpus, row):
    """Returns True if neither the file nor its Inlines can hold a Viewpoint, and X_ITE has drawn
    it."""
    nodes = row["standard_nodes"].split(",")
    return not ({"Viewpoint", "Inline"} & set(nodes) or "EXTERNPROTO" in row["features"] or
                not (corpus / "pictures/x_ite" / (row["file"] + ".png")).exists())


def draw(args, row, out):
    """Runs one file and returns the results with respect to its promise."""
    world = args.corpus / row["file"]
    picture = out / (row["file"] + ".png")
    picture.parent.mkdir(parents=True, exist_ok=True)
    if args.quick:
        runs = [vv(args.vv, world, picture, "--size", "32x24", "--spp", "1")]
    else:
        # For a file without a Viewpoint vv fits a camera of its own. X_ITE uses the standard's
        # default position (clause 6.53), so the test sets the same.
        place = ["--camera", "0,0,10:0,0,0:0,1,0"] if without_viewpoint(args.corpus, row) else []
        plain = picture.with_suffix(".default.png")
        runs = [
            vv(args.vv, world, plain, "--size", "160x120", "--spp", "1"),
            vv(args.vv, world, picture, "--size", "240x180", "--spp", str(args.spp), "--colour",
               "vrml97", "--shadows", "off", *place)
        ]
        plain.unlink(missing_ok=True)
    log = runs[-1]["log"]
    row.update(
        code=runs[-1]["code"],
        seconds=max(r["seconds"] for r in runs),
        mib=max(r["mib"] for r in runs),
        log=log,
        warnings=len(re.findall(r":\d+: warning: |^vv: warning: ", log, re.M)),
        errors=len(re.findall(r":\d+: error: |^vv: error: ", log, re.M)),
        broken=[
            b for r in runs for b in promises.broken(row["class"], r["code"], r["log"], TIMEOUT)
        ],
        picture=picture if picture.exists() else None)
    if row["code"] == 0 and not picture.exists():
        row["broken"].append("exit code 0 without a picture")
    row["broken"] = list(dict.fromkeys(row["broken"]))
    return row


def main():
    args = arguments()
    args.corpus = pathlib.Path(args.corpus).resolve()
    if not (args.corpus / "FEATURES.tsv").exists():
        print(f"no corpus at {args.corpus}: skipped")
        return 77
    rows = files(args.corpus, args.only)
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(
            args.jobs) as pool:
        out = pathlib.Path(scratch) if args.quick else args.out / "pictures"
        rows = list(pool.map(lambda row: draw(args, row, out), rows))
        wall = time.monotonic() - start
        if not args.quick:
            import sheets
            sheets.write(args, rows, wall)
    for row in rows:
        for what in row["broken"]:
            first = next((line for line in row["log"].splitlines() if "error" in line), "")
            print(f"{row['class']:7} {row['file']}: {what}  {first[:200]}")
    bad = sum(1 for row in rows if row["broken"])
    print(
        f"{len(rows)} files in {wall:.0f} s, {bad} break their class's promise; slowest {max(r['seconds'] for r in rows):.1f} s, "
        f"largest {max(r['mib'] for r in rows):.0f} MiB")
    return 1 if bad or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
