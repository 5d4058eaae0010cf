#!/usr/bin/env python3
"""Runs vv on a folder of X3D, VRML 1.0 and glTF files and says what it reads of them.

corpus_x3d.py --vv build/release/bin/vv --corpus FOLDER --out build/corpus-x3d   (`make corpus-x3d`)

The folder (default $OPENRT_CORPUS_X3D or ../shared/corpus-x3d) holds MANIFEST.tsv with the columns
folder (the origin), path and bytes. Writes table.md (counts by encoding and origin, and what is
missing most often), files.tsv (a row for each file; what was understood of single files is in
notes_x3d.tsv beside this program) and, with --sheets, contact sheets of the
pictures. --beside FOLDER ... compares with pictures of other browsers, ORIGIN__PATH.png (slashes
are __): vv draws as they do (beside.py), beside.tsv has the differences, and the sheets show the
most different first, theirs on the right. Exit code 0: no file crashes vv or takes longer than 30 s; 77: there is no such folder."""
import argparse
import collections
import concurrent.futures
import os
import pathlib
import re
import sys

from corpus import vv

ROOT = pathlib.Path(__file__).resolve().parents[2]
CELL, CAPTION, COLUMNS, ROWS = (200, 150), 14, 3, 6
UNKNOWN = re.compile(r"nodes of type '([^']*)' are not supported|'([^']*)' is not a known node type"
                     r"|field '([^']*)' of (\w+) is not supported|(IMPORT|mappings) (?:is|are) not supported")


def folder_of():
    """Returns the folder of files that is used if no other one is given."""
    return pathlib.Path(os.environ.get("OPENRT_CORPUS_X3D") or ROOT.parent / "shared/corpus-x3d")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--vv", type=pathlib.Path, required=True)
    parser.add_argument("--corpus",
                        type=pathlib.Path,
                        default=folder_of())
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/corpus-x3d")
    parser.add_argument("--only", default="", help="files whose path holds this text")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--sheets", action="store_true", help="also contact sheets")
    parser.add_argument("--beside",
                        type=pathlib.Path,
                        nargs="+",
                        default=[],
                        help="folders of pictures by other browsers")
    return parser.parse_args()


def encoding_of(path):
    """Returns the name of a file's encoding in the table."""
    suffix = path.suffix.lower()
    return {
        ".wrl": "VRML 1.0",
        ".iv": "VRML 1.0",
        ".gltf": "glTF",
        ".glb": "glTF",
        ".x3dz": ".x3d",
        ".x3dvz": ".x3dv"
    }.get(suffix, suffix)


def is_uniform(picture):
    """Returns whether all pixels of a picture are equal."""
    from PIL import Image
    return all(low == high for low, high in Image.open(picture).convert("RGB").getextrema())


def draw(args, origin, path):
    """Runs one file. Returns its row."""
    world = args.corpus / origin / path
    picture = args.out / "pictures" / (f"{origin}/{path}".replace("/", "__") + ".png")
    picture.unlink(missing_ok=True)
    spp = "8" if args.beside else "4" if args.sheets else "1"
    how = ["--size", "200x150"]
    if args.beside:
        import beside
        how = beside.options(args.vv, world)
    run = vv(args.vv, world, picture, "--spp", spp, *how)
    errors = len(re.findall(r":\d+: error: |^vv: error: ", run["log"], re.M))
    lacks = {next(g for g in m.groups() if g) for m in UNKNOWN.finditer(run["log"])}
    if run["code"] is None:
        state = "hangs"
    elif run["code"] < 0 or run["code"] > 128:
        state = "crashes"
    elif not picture.exists():
        state = "refused"
    elif errors:
        state = "errors"
    elif lacks:
        state = "lacks nodes"
    elif "warning" not in run["log"] and is_uniform(picture):
        state = "silently empty"
    else:
        state = "reads"
    first = next((line for line in run["log"].splitlines() if "error" in line), "")
    return {
        "origin": origin,
        "path": path,
        "encoding": encoding_of(world),
        "state": state,
        "lacks": sorted(lacks),
        "seconds": run["seconds"],
        "mib": run["mib"],
        "message": first.replace(str(world), "")[:160],
        "picture": picture
    }


STATES = ["reads", "silently empty", "lacks nodes", "errors", "refused", "crashes", "hangs"]


def table(rows):
    """Returns the counts by encoding and by origin, and what is missing, as Markdown."""
    lines = [
        "| files | all | " + " | ".join(STATES) + " | without error or lack |",
        "| --- " * (len(STATES) + 3) + "|"
    ]
    groups = collections.defaultdict(list)
    for row in rows:
        groups[row["encoding"]].append(row)
        groups[f"{row['encoding']}, {row['origin']}"].append(row)
    for name in sorted(groups):
        count = collections.Counter(row["state"] for row in groups[name])
        good = count["reads"] / len(groups[name])
        lines.append(f"| {name} | {len(groups[name])} | " +
                     " | ".join(str(count[state]) for state in STATES) + f" | {good:.0%} |")
    missing = collections.Counter(name for row in rows for name in row["lacks"])
    lines += ["", "| missing | files |", "| --- | --- |"]
    lines += [f"| {name} | {count} |" for name, count in missing.most_common(60)]
    return "\n".join(lines) + "\n"


def write_sheets(args, rows):
    """Writes contact sheets: our picture and, on its right, those of the other browsers."""
    from PIL import Image, ImageDraw
    width = CELL[0] * (1 + len(args.beside))
    shown = [row for row in rows if row["picture"].exists()]
    if args.beside:
        shown = sorted((r for r in shown if r["difference"] is not None),
                       key=lambda r: -r["difference"])
    per_sheet = COLUMNS * ROWS
    for number in range(0, len(shown), per_sheet):
        sheet = Image.new("RGB", (COLUMNS * (width + 6), ROWS * (CELL[1] + CAPTION)), "white")
        text = ImageDraw.Draw(sheet)
        for i, row in enumerate(shown[number:number + per_sheet]):
            x, y = i % COLUMNS * (width + 6), i // COLUMNS * (CELL[1] + CAPTION)
            text.text((x, y), f"{row['origin']}/{row['path']}"[-width // 6:], fill="black")
            pictures = [row["picture"], *(f / row["picture"].name for f in args.beside)]
            for k, path in enumerate(pictures):
                if path.exists():
                    picture = Image.open(path).convert("RGB").resize(CELL)
                    sheet.paste(picture, (x + k * CELL[0], y + CAPTION))
        sheet.save(args.out / f"sheet{number // per_sheet:02d}.png")


def main():
    args = arguments()
    args.corpus = pathlib.Path(args.corpus).resolve()
    manifest = args.corpus / "MANIFEST.tsv"
    if not manifest.exists():
        print(f"no corpus at {args.corpus}: skipped")
        return 77
    listed = [line.split("\t")[:2] for line in manifest.read_text().splitlines()[1:]]
    listed = [(origin, path) for origin, path in listed if args.only in f"{origin}/{path}"]
    (args.out / "pictures").mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        rows = list(pool.map(lambda one: draw(args, *one), listed))
    text = table(rows)
    (args.out / "table.md").write_text(text)
    with open(args.out / "files.tsv", "w", encoding="utf-8") as file:
        for row in sorted(rows, key=lambda r: (STATES.index(r["state"]), r["origin"], r["path"])):
            file.write(f"{row['state']}\t{row['origin']}/{row['path']}\t{row['seconds']:.1f} s\t"
                       f"{row['mib']:.0f} MiB\t{' '.join(row['lacks'])}\t{row['message']}\n")
    if args.beside:
        import beside
        beside.measure(rows, args.beside)
        text += "\n" + beside.write(rows, args.beside, args.out / "beside.tsv") + "\n"
    if args.sheets:
        write_sheets(args, rows)
    print(text)
    return 1 if any(row["state"] in ("crashes", "hangs") for row in rows) or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
