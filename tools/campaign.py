#!/usr/bin/env python3
"""Runs the long tests one after the other and keeps their results in docs/campaigns.md (`make
campaign`). A stage that has passed on these sources is left out, so a campaign that was
interrupted goes on where it stopped. Sources are the same where a commit changes nothing but the
table. A stage that fails does not end the campaign, but its exit code.

usage: campaign.py [--list] [--only NAME ...] [--hours H] [--jobs N]
    --list    prints the stages, and which of them are due
    --only    runs these stages, also where they have passed
    --hours   starts no stage after so many hours
"""
import argparse
import dataclasses
import datetime
import os
import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/campaigns.md"
LOGS = ROOT / "build/campaign"
FUZZ_RUNS = 10_000_000  # executions of each fuzz target on one state of the sources
FUZZ_ROUND = 600  # seconds of one target before the next has its turn
HEAD = ["stage", "runs", "date", "commit", "result", "figure"]

# These patterns find what a tool's output says about itself, for the column "figure".
SUMS = (
    r"(\d+% tests passed, \d+ tests failed out of \d+)",  # ctest
    r"^((?:\d+ (?:passed|failed|skipped|errors?|deselected)(?:, )?)+) in ",  # pytest
    r"\[  PASSED  \] (\d+ tests?)",  # GoogleTest
    r"^((?:ok|BAD) .*)$",  # cluster campaign, soak
    r"^FIGURE: (.*)$",
)


@dataclasses.dataclass
class Stage:
    name: str
    what: str
    command: str

    def run(self, jobs):
        """Runs the stage; returns whether it passed, and its figure."""
        LOGS.mkdir(parents=True, exist_ok=True)
        log = LOGS / f"{self.name}.log"
        begin = time.monotonic()
        with open(log, "w", encoding="utf-8") as file:
            code = subprocess.run(["bash", "-c", f"set -o pipefail; {self.command}"],
                                  cwd=ROOT,
                                  stdin=subprocess.DEVNULL,
                                  stdout=file,
                                  stderr=subprocess.STDOUT,
                                  env={
                                      **os.environ, "MAKEFLAGS": f"JOBS={jobs}"
                                  }).returncode
        minutes = (time.monotonic() - begin) / 60
        text = log.read_text(encoding="utf-8", errors="replace")
        found = [m.group(1) for sum_ in SUMS for m in re.finditer(sum_, text, re.MULTILINE)]
        figure = "; ".join(dict.fromkeys(found[-6:])) or "exit code 0"
        if code != 0:
            figure = f"exit code {code}; {figure}" if found else f"exit code {code}"
        return code == 0, f"{figure} ({minutes:.0f} min)"


STAGES = [
    Stage("debian-12", "`make test-debian-12`: `make test` on a machine that has nothing but "
          "Debian 12 and `make`, without a compiler cache", "make test-debian-12"),
    Stage("often", "`make test-often`: what has threads, windows, processes or sockets, 20 times",
          "make test-often"),
    Stage("asan", "`make asan`", "make asan"),
    Stage("tsan", "`make tsan`", "make tsan"),
    Stage("script-worlds", "100,000 random worlds of Scripts with ASan and UBSan (after `asan`)",
          "XVRML_RANDOM_WORLDS=1:100000 build/asan-ubsan/bin/conformance "
          "--gtest_filter='ScriptEnds.Worlds*'"),
    Stage("decoder", "10,000 mutants of each of 18 pictures and sounds, and of two STEP models, for "
          "the processes that decode them (after `asan`)", "XVRML_DECODER_MUTANTS=10000 build/asan-ubsan/bin/unit_xvrml "
          "--gtest_filter='Decoder.Damaged*:StepModels.Damaged*'"),
    Stage("fuzz", f"every target of `make fuzz` {FUZZ_RUNS:,} times; executions on the same "
          "sources add up", ""),
    Stage("embree-4", "`make test-embree4`: all tests against Embree 4 in a Debian 13",
          "make test-embree4"),
    Stage("allocations", "`make test-alloc-failures`: every allocation fails once",
          "make test-alloc-failures"),
    Stage("writes", "`make test-write-failures`: every write fails once",
          "make test-write-failures"),
    Stage("sequences", "`make python-sequences`: 100,000 random sequences of calls",
          "make python-sequences"),
    Stage("rays", "`make test-rays`: rays at edges and vertices of closed meshes",
          "make test-rays"),
    Stage("cluster", "`make cluster-campaign`: workers killed at random, partitions, 10,000 frames",
          "make cluster-campaign"),
    Stage("soak", "`make soak`: a window and a cluster for an hour", "make soak"),
    Stage("wheel", "`make wheel test-wheel`: the wheel in a bare Debian 12",
          "make wheel test-wheel"),
    Stage("deb", "`make deb`", "make deb"),
    Stage("container", "`make container`", "make container"),
]


def git(*arguments):
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True)


def is_same_source(commit):
    """Returns whether the sources are those of the commit, but for the table of campaigns."""
    return bool(commit) and git("diff", "--quiet", commit, "--", ".",
                                f":!{PAGE.relative_to(ROOT)}").returncode == 0


def read_rows():
    """Returns the rows of the table by the names of their stages."""
    rows = {}
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("| `") and len(cells) == len(HEAD):
            rows[cells[0].strip("`")] = cells[2:]
    return rows


def write_rows(rows):
    """Replaces the table of the page."""
    before, _, rest = PAGE.read_text(encoding="utf-8").partition("<!-- table -->\n")
    after = rest.partition("<!-- end of table -->")[2]
    lines = ["| " + " | ".join(HEAD) + " |", "| --- " * len(HEAD) + "|"]
    for stage in STAGES:
        row = rows.get(stage.name, ["", "", "not run", ""])
        lines.append("| " + " | ".join([f"`{stage.name}`", stage.what, *row]) + " |")
    PAGE.write_text(before + "<!-- table -->\n" + "\n".join(lines) + "\n<!-- end of table -->" + after,
                    encoding="utf-8")


def count_executions():
    """Returns the executions of each fuzz target on these sources."""
    path = ROOT / "build/fuzz-corpus/executions.tsv"
    counts = {}
    same = {}
    for line in path.read_text(encoding="ascii").splitlines() if path.exists() else []:
        name, number, commit = (line.split("\t") + [""])[:3]
        if commit not in same:
            same[commit] = is_same_source(commit)
        if same[commit]:
            counts[name] = counts.get(name, 0) + int(number)
    return counts


def fuzz(end):
    """Runs the targets in turns until each has had its executions, or until the time `end`."""
    LOGS.mkdir(parents=True, exist_ok=True)
    begin = time.monotonic()
    build = "make fuzz-targets"
    with open(LOGS / "fuzz.log", "w", encoding="utf-8") as log:

        def call(command):
            return subprocess.run(["bash", "-c", command],
                                  cwd=ROOT,
                                  stdin=subprocess.DEVNULL,
                                  stdout=log,
                                  stderr=subprocess.STDOUT).returncode == 0

        if not call(build):
            return False, "the fuzz targets do not build"
        targets = sorted(path.name for path in (ROOT / "build/fuzz/bin").glob("fuzz_*"))
        failed = set()
        while True:
            counts = count_executions()
            due = [t for t in targets if counts.get(t, 0) < FUZZ_RUNS and t not in failed]
            if not due or time.monotonic() > end:
                break
            for target in due:
                if time.monotonic() > end:
                    break
                left = FUZZ_RUNS - counts.get(target, 0)
                if not call(f"TARGETS={target} RUNS={left} tools/run-fuzz.sh build/fuzz/bin {FUZZ_ROUND}"):
                    failed.add(target)
    reached = sum(counts.get(t, 0) >= FUZZ_RUNS for t in targets)
    rest = sorted((counts.get(t, 0), t) for t in targets if counts.get(t, 0) < FUZZ_RUNS)
    figure = f"{sum(counts.values()):,} executions; {reached} of {len(targets)} targets have {FUZZ_RUNS:,}"
    if rest:
        figure += f", fewest {rest[0][1]} with {rest[0][0]:,}"
    if failed:
        figure += "; findings: " + ", ".join(sorted(failed))
    minutes = (time.monotonic() - begin) / 60
    return not failed and reached == len(targets), f"{figure} ({minutes:.0f} min)"


def main():
    parser = argparse.ArgumentParser(description="Runs the long tests.")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--only", nargs="+", choices=[stage.name for stage in STAGES], default=[])
    parser.add_argument("--hours", type=float, default=1e9)
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    end = time.monotonic() + options.hours * 3600

    rows = read_rows()
    passed = {
        name
        for name, row in rows.items() if row[2] == "passed" and is_same_source(row[1])
    }
    if options.list:
        for stage in STAGES:
            print(f"{stage.name:12} {'passed' if stage.name in passed else 'due':7} {stage.what}")
        return 0
    if git("status", "--porcelain", "--untracked-files=no", "--", ".",
           f":!{PAGE.relative_to(ROOT)}").stdout:
        print("campaign: commit the changes first: a row of the table names the commit it speaks of",
              file=sys.stderr)
        return 2

    worst = 0
    for stage in STAGES:
        if options.only and stage.name not in options.only:
            continue
        if not options.only and stage.name in passed:
            continue
        if time.monotonic() > end:
            print(f"{stage.name}: not begun, the time is over")
            worst = 1
            continue
        commit = git("rev-parse", "--short=10", "HEAD").stdout.strip()
        good, figure = fuzz(end) if stage.name == "fuzz" else stage.run(options.jobs)
        date = datetime.date.today().isoformat()
        rows[stage.name] = [date, commit, "passed" if good else "failed", figure]
        write_rows(rows)
        print(f"{stage.name}: {'passed' if good else 'FAILED'}: {figure}", flush=True)
        if not good:
            worst = 1
            print(f"    its output is in {LOGS.relative_to(ROOT) / (stage.name + '.log')}")
    return worst


if __name__ == "__main__":
    sys.exit(main())
