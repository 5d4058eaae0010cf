"""The results of bench_render.py as text: a CSV file, Markdown tables, curves as SVG."""
import csv
import math

from plot_svg import log_plot

from .errors import at_time, geometric_mean

TIMES = (0.1, 1, 10)  # CPU seconds of the table
PEER = "Mitsuba llvm"
MEASURES = {"relmse": "relMSE", "rmse": "RMSE"}


def write_csv(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


def read_csv(path):
    """Returns the rows with their numbers as floats."""
    with open(path, newline="") as file:
        return [{
            k: v if k in ("world", "title", "renderer") else float(v) for k, v in row.items()
        } for row in csv.DictReader(file)]


def curve(rows, world, renderer, measure):
    """Returns the points (CPU seconds, error) of a renderer that the reference can judge."""
    return [
        (r["seconds"], r[measure])
        for r in rows
        if (r["world"], r["renderer"]) == (world, renderer) and r["seconds"] > 0 and r[measure] > 0
    ]


def cell(value, form=".2g"):
    return "-" if value is None or math.isnan(value) else format(value, form)


def table(rows):
    """Returns one line for each world and renderer: errors at equal CPU time."""
    heads = ["world", "renderer", "start-up"]
    heads += [f"relMSE at {t} s" for t in TIMES] + ["RMSE at 1 s", "relMSE x s", f"{PEER} / this"]
    lines = [heads + ["bias, 95 %"], ["---"] * (len(heads) + 1)]
    for world, renderer in dict.fromkeys((r["world"], r["renderer"]) for r in rows):
        own = [r for r in rows if (r["world"], r["renderer"]) == (world, renderer)]
        points = curve(rows, world, renderer, "relmse")
        theirs = at_time(curve(rows, world, PEER, "relmse"), 1)
        ours = at_time(points, 1)
        last = own[-1]
        lines.append([
            last["title"],
            renderer,
            cell(last["startup"]),
            *(cell(at_time(points, t)) for t in TIMES),
            cell(at_time(curve(rows, world, renderer, "rmse"), 1)),
            cell(points[-1][0] * points[-1][1] if points else None),
            cell(theirs / ours if theirs and ours and renderer != PEER else None),
            f"{100 * last['bias']:+.2f} ± {100 * last['bias_interval']:.2f} %",
        ])
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def plots(rows, prefix="bench_render", measures=None):
    """Yields name and text of the curves of each world: relMSE and RMSE over CPU seconds."""
    for world in dict.fromkeys(r["world"] for r in rows):
        own = [r for r in rows if r["world"] == world]
        for measure, label in (measures or MEASURES).items():
            lines = {
                renderer: curve(own, world, renderer, measure)
                for renderer in dict.fromkeys(r["renderer"] for r in own)
            }
            lines = {renderer: points for renderer, points in lines.items() if points}
            if lines:
                yield (f"{prefix}_{world}_{measure}.svg",
                       log_plot(own[0]["title"], "CPU seconds", label, lines))


def write(rows, out, with_mitsuba):
    """Writes render.csv, render.md and the curves; returns the table and the curves' names."""
    write_csv(out / "render.csv", rows)
    names = []
    for name, text in plots(rows):
        (out / name).write_text(text)
        names.append(name)
    text = table(rows) + ("" if with_mitsuba else "\nMitsuba 3 was not there.\n")
    (out / "render.md").write_text(text)
    return text, names


def into_page(page, text, names, out, mark="bench-render"):
    """Puts the table and the curves between the marks of a page of docs/."""
    begin, end = f"<!-- {mark} -->\n", f"<!-- /{mark} -->\n"
    before, rest = page.read_text().split(begin)
    images = "".join(
        f"![{n.split('_', 2)[2][:-4].replace('_', ' ')} over CPU seconds](images/{n})\n"
        for n in names)
    page.write_text(before + begin + text + "\n" + images + end + rest.split(end)[1])
    for name in names:
        (page.parent / "images" / name).write_text((out / name).read_text())


def interval(ratio, factor):
    """Returns a ratio with its interval, as in 0.912 (0.880 to 0.945)."""
    if math.isnan(ratio):
        return "-"
    return f"{ratio:.3f}" + ("" if math.isnan(factor) else
                             f" ({ratio / factor:.3f} to {ratio * factor:.3f})")


def comparison(rows):
    """Returns the table of two binaries: each line one world and transport, the last one the
    geometric mean. All columns but "CPU s, old" are new over old."""
    heads = ["world", "transport", "samples", "CPU s, old", "CPU s", "relMSE", "relMSE x CPU s"]
    lines = [heads + ["brightness"], ["---"] * 8]
    for r in rows:
        factor = r["relmse_factor"]
        lines.append([
            r["title"], r["renderer"], f"{r['spp']:.0f}",
            cell(r["seconds_old"]), f"{r['seconds_ratio']:.3f}",
            "same bytes" if r["same_bytes"] else interval(r["relmse_ratio"], factor),
            interval(r["product_ratio"], factor),
            interval(r["brightness"], r["brightness_factor"])
        ])
    ratios = ("seconds_ratio", "relmse_ratio", "product_ratio")
    means = [cell(geometric_mean([r[ratio] for r in rows]), ".3f") for ratio in ratios]
    lines.append(["geometric mean", "", "", "", *means, ""])
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)
