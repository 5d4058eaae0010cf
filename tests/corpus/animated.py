#!/usr/bin/env python3
"""Runs animated VRML files for ten seconds of their own time and lists the script engines they
need.

animated.py --vv build/release/bin/vv [--corpus FOLDER] [--out build/corpus]

FOLDER holds real VRML files. Each file with the feature `animated` runs at 10 Hz and is mapped once
a second (vv --check: no pictures). A crash, a time-out, an error of the program or a runaway
cascade fails the test; problems of the file itself do not. vv --info must count the Scripts of each
file by protocol, unless the Script itself is wrong and lost (0 in the table).

Each file with ECMAScript also runs for ten seconds. An error of a Script fails the test, unless
script_errors.tsv lists the file with the reason why its program is wrong. A file that is listed
without need fails, too. Writes OUT/scripts.tsv. Exit code 77: there is no such folder."""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
TIMEOUT = 40  # seconds per run
DONE, PROBLEMS = 0, 4  # exit codes of vv --check
ECMASCRIPT = {"script:javascript", "script:vrmlscript", "script:ecmascript", "script:js-file"}


def run(*command):
    """Returns the exit code (None: timed out), the output and the messages."""
    try:
        done = subprocess.run([str(c) for c in command],
                              stdin=subprocess.DEVNULL,
                              capture_output=True,
                              timeout=TIMEOUT)
    except subprocess.TimeoutExpired:
        return None, "", ""
    return done.returncode, done.stdout.decode("utf-8",
                                               "replace"), done.stderr.decode("utf-8", "replace")


def complaint(code, talk):
    if code is None:
        return f"not done in {TIMEOUT} s"
    if code < 0:
        return f"ended by signal {-code}"
    if code not in (DONE, PROBLEMS):
        return f"exit code {code}"
    wrong = re.search(r"^vv: error: .*|.*more than \d+ events.*", talk, re.M)
    return wrong.group(0) if wrong else ""


def play(args, row):
    start = time.monotonic()
    code, _, talk = run(args.vv, args.corpus / row["file"], "--check", "--frames", "0-100/10",
                        "--fps", "10", "-q")
    return row["file"], complaint(code, talk), time.monotonic() - start


def scripts_of(args, row):
    """Returns the number of Scripts by protocol, as counted by vv."""
    code, out, talk = run(args.vv, args.corpus / row["file"], "--info", "--json", "-q")
    if code != DONE:
        return row, None, complaint(code, talk)
    told = json.loads(out)
    if not told["scripts"] and told["errors"]:  # the Script itself was lost to an error of the file
        lost = sorted(f.removeprefix("script:") for f in row["features"] if f.startswith("script:"))
        return row, [{"protocol": p, "count": 0, "declared": 0, "engine": False} for p in lost], ""
    return row, told["scripts"], ""


def expected_errors():
    """Returns a dictionary from file to the reason why a Script in it fails."""
    lines = (pathlib.Path(__file__).parent /
             "script_errors.tsv").read_text(encoding="utf-8").rstrip("\n").split("\n")
    return dict(line.split("\t") for line in lines)


def run_scripts(args, row):
    """Returns what is wrong with the run of a file's ECMAScript."""
    code, _, talk = run(args.vv, args.corpus / row["file"], "--check", "--frames", "0-100/10",
                        "--fps", "10")
    wrong = complaint(code, talk)
    failed = re.findall(r"^.*: error: Script(?: \S+)?: .*", talk, re.M)
    expected = row["file"] in args.expected
    if not wrong and failed and not expected:
        wrong = failed[0]
    if not wrong and expected and not failed:
        wrong = "no Script fails any more: remove it from script_errors.tsv"
    return row["file"], wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--vv", type=pathlib.Path, required=True)
    parser.add_argument("--corpus",
                        type=pathlib.Path,
                        default=os.environ.get("OPENRT_CORPUS") or ROOT.parent / "shared/corpus")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/corpus")
    parser.add_argument("--jobs", type=int, default=2)
    args = parser.parse_args()
    args.corpus = pathlib.Path(args.corpus).resolve()
    args.expected = expected_errors()
    if not (args.corpus / "FEATURES.tsv").exists():
        print(f"no corpus at {args.corpus}: skipped")
        return 77
    lines = (args.corpus / "FEATURES.tsv").read_text(encoding="utf-8").rstrip("\n").split("\n")
    rows = [dict(zip(lines[0].split("\t"), line.split("\t"))) for line in lines[1:]]
    for row in rows:
        row["file"] = f"{row['folder']}/{row['path']}"
        row["features"] = row["features"].split(",")
    animated = [row for row in rows if "animated" in row["features"]]
    scripted = [
        row for row in rows if any(f.startswith("script:")
                                   for f in row["features"]) and row["class"] not in ("v1", "bad")
    ]
    start = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        played = list(pool.map(lambda row: play(args, row), animated))
        counted = list(pool.map(lambda row: scripts_of(args, row), scripted))
        there = any(one["engine"]
                    for _, found, _ in counted
                    for one in found or []
                    if one["protocol"] in ("javascript", "vrmlscript"))
        programs = [row for row in scripted if there and ECMASCRIPT & set(row["features"])]
        ran = list(pool.map(lambda row: run_scripts(args, row), programs))
    wall = time.monotonic() - start
    failed = 0
    for file, wrong, _ in played:
        if wrong:
            failed += 1
            print(f"{file}: {wrong}")
    for file, wrong in ran:
        if wrong:
            failed += 1
            print(f"{file}: {wrong}")
    if not there:
        print("no script engine for ECMAScript is there: its Scripts were not run")
    args.out.mkdir(parents=True, exist_ok=True)
    needed = {}
    with open(args.out / "scripts.tsv", "w", encoding="utf-8") as table:
        table.write("file\tprotocol\tscripts\tin prototypes\tengine\n")
        for row, found, wrong in counted:
            if found is None or not found:
                failed += 1
                print(f"{row['file']}: {wrong or 'no Script is announced'}")
                continue
            for one in found:
                table.write(
                    f"{row['file']}\t{one['protocol']}\t{one['count']}\t{one['declared']}\t{'there' if one['engine'] else 'missing'}\n"
                )
                needed.setdefault(one["protocol"], set()).add(row["file"])
    slowest = max(played, key=lambda p: p[2], default=("", "", 0))
    print(
        f"{len(played)} animated files and {len(counted)} with scripts ({len(ran)} in ECMAScript were run) in {wall:.0f} s, {failed} failed; slowest {slowest[0]} {slowest[2]:.1f} s"
    )
    print("engines:",
          ", ".join(f"{protocol} {len(files)}" for protocol, files in sorted(needed.items())))
    return 1 if failed or not played else 0


if __name__ == "__main__":
    sys.exit(main())
