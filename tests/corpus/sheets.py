"""Makes the table and contact sheets of a corpus run: our pictures beside those of two other
browsers, largest distance first. Used by corpus.py.

The distance is the root mean square difference of the three colours, in units of full scale. It is
computed after a small blur, so that shifting an edge by half a pixel does not count. view3dscene's
empty background (a dark grey) counts as black, like the standard's. The corner where X_ITE may
write the viewpoint's name does not count. The smaller of the two distances is used."""
import html
import pathlib

import numpy
from PIL import Image, ImageDraw, ImageFilter

BROWSERS = ("view3dscene", "x_ite")
SIZE = (240, 180)
CELL = (160, 120)
CAPTION = 24
COLUMNS, ROWS = 3, 8
EMPTY = (26, 26, 26)
LABEL = (slice(0, 30), slice(100, 240))


def load(path, size=SIZE):
    """Returns RGB on black, or None."""
    if not path or not path.exists():
        return None
    picture = Image.open(path).convert("RGBA")
    flat = Image.new("RGBA", picture.size, (0, 0, 0, 255))
    flat.alpha_composite(picture)
    flat = flat.convert("RGB")
    return flat if flat.size == size else flat.resize(size)


def on_black(picture):
    """Returns a picture by view3dscene with the standard's empty background."""
    pixels = numpy.array(picture)
    pixels[(pixels == EMPTY).all(axis=2)] = 0
    return Image.fromarray(pixels)


def reference(corpus, browser, file):
    picture = load(corpus / "pictures" / browser / (file + ".png"))
    return on_black(picture) if picture is not None and browser == "view3dscene" else picture


def distance(a, b, without_label):
    if a is None or b is None:
        return None
    difference = [
        numpy.asarray(p.filter(ImageFilter.GaussianBlur(1.5)), dtype=numpy.float32) / 255
        for p in (a, b)
    ]
    square = (difference[0] - difference[1])**2
    if without_label:
        square[LABEL] = 0
    return float(numpy.sqrt(square.mean()))


def notes():
    """Reads hand-written remarks: path, tab, text."""
    path = pathlib.Path(__file__).with_name("notes.tsv")
    if not path.exists():
        return {}
    return dict(
        line.split("\t", 1)
        for line in path.read_text(encoding="utf-8").splitlines()
        if "\t" in line)


def waits(row):
    """Returns which parts of the file are not drawn because they need time, events or scripts."""
    features = row["features"].split(",")
    what = [name for name in ("animated", "sensor") if name in features
           ] + [f for f in features if f.startswith("script:")]
    return "moves: " + ", ".join(what) if what else ""


def compare(args, rows):
    remarks = notes()
    for row in rows:
        ours = load(row["picture"])
        theirs = {b: reference(args.corpus, b, row["file"]) for b in BROWSERS}
        row["distances"] = {b: distance(ours, p, b == "x_ite") for b, p in theirs.items()}
        row["between"] = distance(theirs["view3dscene"], theirs["x_ite"], True)
        known = [d for d in row["distances"].values() if d is not None]
        row["distance"] = min(known) if known else None
        row["black"] = ours is not None and not numpy.asarray(ours).any()
        row["note"] = remarks.get(row["file"], "")
        row["waits"] = waits(row)
        row["pictures"] = [ours, *theirs.values()]


def number(value):
    return "" if value is None else f"{value:.3f}"


def sheet(rows, path):
    width, height = COLUMNS * (3 * CELL[0] + 6), ROWS * (CELL[1] + CAPTION)
    canvas = Image.new("RGB", (width, height), (60, 60, 60))
    pen = ImageDraw.Draw(canvas)
    for i, row in enumerate(rows):
        x, y = (i % COLUMNS) * (3 * CELL[0] + 6), (i // COLUMNS) * (CELL[1] + CAPTION)
        for k, picture in enumerate(row["pictures"]):
            if picture is not None:
                canvas.paste(picture.resize(CELL, Image.BOX), (x + k * CELL[0] + k, y + CAPTION))
        name = row["file"] if len(row["file"]) < 66 else "..." + row["file"][-63:]
        pen.text((x + 2, y), f"{number(row['distance'])} {name}", fill=(255, 255, 255))
        second = f"{row['class']} v3d {number(row['distances']['view3dscene'])} xite {number(row['distances']['x_ite'])} " \
                 f"them {number(row['between'])} {row['waits']}"
        pen.text((x + 2, y + 11),
                 second[:78],
                 fill=(255, 160, 160) if row["broken"] else (180, 180, 180))
    canvas.save(path)


def write(args, rows, wall):
    compare(args, rows)
    out = args.out
    folder = out / "sheets"
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.png"):
        old.unlink()
    ranked = sorted(rows, key=lambda r: (r["distance"] is None, -(r["distance"] or 0)))
    per = COLUMNS * ROWS
    for i in range(0, len(ranked), per):
        sheet(ranked[i:i + per], folder / f"{i // per + 1:02}.png")

    columns = [
        "distance", "view3dscene", "x_ite", "between them", "class", "exit", "seconds", "MiB",
        "warnings", "errors", "file", "broken", "waits", "note"
    ]
    table = [[
        number(r["distance"]), *(number(r["distances"][b]) for b in BROWSERS),
        number(r["between"]), r["class"],
        str(r["code"]), f"{r['seconds']:.2f}", f"{r['mib']:.0f}",
        str(r["warnings"]),
        str(r["errors"]), r["file"], "; ".join(r["broken"]), r["waits"], r["note"]
    ] for r in ranked]
    (out / "table.tsv").write_text("\n".join("\t".join(line) for line in [columns, *table]) + "\n",
                                   encoding="utf-8")
    with open(out / "logs.txt", "w", encoding="utf-8") as logs:
        for r in ranked:
            logs.write(f"=== {r['file']} ({r['class']}, exit {r['code']})\n{r['log'].rstrip()}\n")
    page(out / "table.html", columns, table, ranked, args.corpus)
    summary(out / "summary.md", rows, wall)


def page(path, columns, table, rows, corpus):

    def cell(text):
        return f"<td>{html.escape(text)}</td>"

    lines = [
        "<!doctype html><meta charset=utf-8><title>Corpus</title><style>td{font:12px sans-serif;vertical-align:top}"
        "img{width:240px}</style><table><tr><th>ours, view3dscene, X_ITE",
        *(f"<th>{c}" for c in columns), "</tr>"
    ]
    for row, line in zip(rows, table):
        sources = [
            row["picture"], *(corpus / "pictures" / b / (row["file"] + ".png") for b in BROWSERS)
        ]
        images = "".join(
            f'<img src="{html.escape(pathlib.Path(s).resolve().as_uri())}">' for s in sources
            if s and pathlib.Path(s).exists())
        lines.append(f"<tr><td style='white-space:nowrap'>{images}</td>" +
                     "".join(cell(c) for c in line) + "</tr>")
    path.write_text("\n".join([*lines, "</table>"]), encoding="utf-8")


def summary(path, rows, wall):
    lines = [
        "| class | files | promises kept | median distance | beyond 0.1 | all black |",
        "| --- | --- | --- | --- | --- | --- |"
    ]
    for kind in ("strict", "ext", "header", "bad", "v1"):
        some = [r for r in rows if r["class"] == kind]
        known = sorted(r["distance"] for r in some if r["distance"] is not None)
        median = f"{known[len(known) // 2]:.3f}" if known else ""
        lines.append(
            f"| {kind} | {len(some)} | {sum(not r['broken'] for r in some)} | {median} | {sum(d > 0.1 for d in known)} | "
            f"{sum(r['black'] for r in some)} |")
    lines.append(
        f"\n{len(rows)} files twice each in {wall:.0f} s; slowest {max(r['seconds'] for r in rows):.1f} s; "
        f"largest {max(r['mib'] for r in rows):.0f} MiB.")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))
