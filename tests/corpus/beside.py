"""Draws worlds in the way of other browsers and measures how far pictures are from theirs. Used by
corpus_x3d.py.

The difference of two pictures is the mean of the absolute differences of all colours, 0 to 255.
A file's difference is that to the nearer picture. Files that no other browser has drawn do not
count."""
import re
import statistics
import subprocess

import numpy

import sheets

SIZE = (160, 120)
VIEWPOINT = re.compile(rb"(<|\b)(Ortho|Geo|ORT)?Viewpoint(\s*\{|[\s/>])")


def options(vv, world):
    """Returns the options with which vv draws a world as other browsers do: without shadows, with
    the standard's viewpoint, headlight and background where the world has none. PhysicalMaterial
    has linear colours everywhere, all else the numbers of the file."""
    text = world.read_bytes()
    chosen = ["--shadows", "off", "--size", "%dx%d" % SIZE]
    if b"PhysicalMaterial" not in text:
        chosen += ["--colour", "vrml97"]
    try:
        info = subprocess.run([vv, world, "--info"], capture_output=True, timeout=30).stdout
    except subprocess.TimeoutExpired:
        info = b""  # drawing it takes too long, too, and says so
    if VIEWPOINT.search(text) and not re.search(rb"(?m)^viewpoints +0$", info):
        return chosen
    chosen += ["--camera", "0,0,10:0,0,0:0,1,0"]
    for name, option in ((rb"\w*Background", ["--background", "0,0,0"]),
                         (rb"NavigationInfo", ["--headlight", "on"])):
        if not re.search(rb"(?m)^ +\d+ +" + name + rb"$", info):
            chosen += option
    return chosen


def difference(a, b):
    return float(numpy.abs(numpy.asarray(a, dtype=float) - numpy.asarray(b, dtype=float)).mean())


def measure(rows, folders):
    """Gives each row its differences to the pictures of `folders`, and the smallest of them."""
    for row in rows:
        ours = sheets.load(row["picture"], SIZE)
        theirs = [sheets.load(folder / row["picture"].name, SIZE) for folder in folders]
        row["differences"] = [
            difference(ours, sheets.on_black(one)) if ours and one else None for one in theirs
        ]
        known = [one for one in row["differences"] if one is not None]
        row["difference"] = min(known) if known else None


def write(rows, folders, path):
    """Writes the table of differences, the largest first. Returns a sentence with the medians."""
    known = sorted((row for row in rows if row["difference"] is not None),
                   key=lambda row: -row["difference"])
    lines = ["difference\t" + "\t".join(folder.name for folder in folders) + "\tfile"]
    for row in known:
        cells = ["" if one is None else f"{one:.2f}" for one in row["differences"]]
        lines.append(f"{row['difference']:.2f}\t" + "\t".join(cells) +
                     f"\t{row['origin']}/{row['path']}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    if not known:
        return "no file was drawn by another browser"
    medians = []
    for i, folder in enumerate(folders):
        some = [row["differences"][i] for row in known if row["differences"][i] is not None]
        medians.append(f"{statistics.median(some):.2f} to {folder.name}" if some else "")
    return (f"{len(known)} files: median difference {statistics.median(r['difference'] for r in known):.2f} "
            f"of 255 to the nearer; " + ", ".join(filter(None, medians)))
