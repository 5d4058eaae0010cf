#!/usr/bin/env python3
"""Writes the tables of docs/accuracy.md: runs the numeric tests and the audit of the error bars,
and inserts their output between the markers of that page (`make accuracy`).

usage: accuracy.py BIN [--seeds N] [--edge N] [--page docs/accuracy.md] [--only audit|numeric]
"""
import argparse
import pathlib
import re
import subprocess
import sys
import textwrap


def number(text):
    return "" if text == "nan" else "%.6g" % float(text)


def paragraph(text):
    """Returns the lines of a paragraph, wrapped as the pages of docs/ are."""
    return textwrap.wrap(text, 100, break_long_words=False, break_on_hyphens=False)


def order(row):
    match = re.match(r"([A-Z]+)(\d+)", row[0])
    return (match.group(1), int(match.group(2)), row[1]) if match else ("~", 0, row[0] + row[1])


def numeric(folder):
    run = subprocess.run([folder / "numeric"], stdout=subprocess.PIPE, text=True)
    rows = [
        line.split("\t")[1:] for line in run.stdout.splitlines() if line.startswith("accuracy\t")
    ]
    total = re.search(r"\[==========\] (\d+) tests? .* ran\. \((\d+) ms", run.stdout)
    out = [
        *paragraph(
            "Of each test the comparison that came nearest to its tolerance; without numbers: a "
            "test that compares pictures, counts or conditions. Rays: of the last frame."),
        "",
        "| id | test | expected | got | tolerance | comparisons | | s | rays |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for row in sorted(rows, key=order):
        name, test, expected, got, tolerance, comparisons, passed, seconds, rays = row
        out.append(
            "| %s | %s | %s | %s | %s | %s | %s | %.2f | %s |" %
            (name, test.split("/")[-2] + "/" + test.split("/")[-1] if test.count("/") > 1 else test,
             number(expected), number(got), number(tolerance), comparisons
             if comparisons != "0" else "", passed, float(seconds), rays if rays != "0" else ""))
    failed = sum(row[6] != "pass" for row in rows)
    out += [
        "",
        "%d tests with an id, %d failed; of the whole program %s." %
        (len(rows), failed, "%s tests, %.0f s" %
         (total.group(1), int(total.group(2)) / 1000) if total else "nothing is known")
    ]
    return out, run.returncode


def audit(folder, seeds, edge):
    run = subprocess.run([folder / "audit", str(seeds), str(edge)],
                         stdout=subprocess.PIPE,
                         text=True)
    out = [
        *paragraph(
            "%d pictures of %dx%d pixels each, seeds 1 to %d, against a long render (8192 to 65536 "
            "samples) and the other pictures, or a closed form. Coverage: of trusted intervals that "
            "are not exact. Tiles: 5th percentile over those of 8x8 pixels. In it: share of the "
            "pictures that were off by what was said. Cost: mean square error over that of as many "
            "independent samples. The last column has what does not hold." %
            (seeds, edge, edge, seeds)),
        "",
        "| scene | use | samples | untrusted | exact | wrong | coverage | tiles | of all | off by | said | in it | bias | cost | |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    pattern = re.compile(
        r"^(.{10}) (\S+) +(\d+) +(\S+) +(\S+) +(\d+)  (\S+ \+- \S+)  (\S+)  (\S+)  (\S+)  (\S+ \+- \S+)  (\S+)"
        r"  (\S+ \+- \S+)  (\S+) ?(.*)$")
    lines = run.stdout.splitlines()[1:]
    for line in (line for line in lines if not line.startswith("#")):
        match = pattern.match(line)
        if not match:
            sys.exit("accuracy.py: a line of the audit that is not understood: " + line)
        out.append("| " + " | ".join(part.strip() for part in match.groups()) + " |")
    out += [""] + ["*" + line[1:] for line in lines if line.startswith("#")]
    return out, run.returncode


def put(page, name, lines):
    begin, end = "<!-- %s: tools/accuracy.py -->" % name, "<!-- end of %s -->" % name
    text = page.read_text()
    head, rest = text.split(begin, 1)
    page.write_text(head + begin + "\n" + "\n".join(lines) + "\n" + end + rest.split(end, 1)[1])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--edge", type=int, default=16)
    parser.add_argument("--page", type=pathlib.Path, default=pathlib.Path("docs/accuracy.md"))
    parser.add_argument("--only", choices=["audit", "numeric"])
    options = parser.parse_args()
    code = 0
    if options.only != "numeric":
        lines, failed = audit(options.bin, options.seeds, options.edge)
        put(options.page, "audit", lines)
        code |= failed
    if options.only != "audit":
        lines, failed = numeric(options.bin)
        put(options.page, "numeric", lines)
        code |= failed
    return code


if __name__ == "__main__":
    sys.exit(main())
