"""The results of bench_render.py --transports: how the transport that vv chooses compares with the
best of the others at equal CPU time."""
from .errors import at_time, geometric_mean
from .report import cell, curve, plots, write_csv

TIMES = tuple(2.0**k for k in range(-8, 8))  # CPU seconds at which the curves are compared


def compare(rows, world):
    """Returns what the line of a world says: the latest time at which every curve has an error, the
    errors there by transport, and the geometric mean and the largest of the ratios of auto to the
    best of the others over all such times. None if there is no such time."""
    names = list(dict.fromkeys(r["renderer"] for r in rows if r["world"] == world))
    curves = {name: curve(rows, world, name, "relmse") for name in names}
    ratios, latest = [], None
    for time in TIMES:
        errors = {name: at_time(points, time) for name, points in curves.items()}
        if "auto" not in errors or len(errors) < 2 or None in errors.values():
            continue
        ratios.append(errors["auto"] / min(e for name, e in errors.items() if name != "auto"))
        latest = time, errors
    return (*latest, geometric_mean(ratios), max(ratios)) if ratios else None


def table(rows):
    """Returns one line for each world."""
    others = [n for n in dict.fromkeys(r["renderer"] for r in rows) if n != "auto"]
    heads = ["world", "CPU s", *(f"relMSE {name}" for name in others), "relMSE auto"]
    lines = [[*heads, "auto / best, mean", "auto / best, largest"], ["---"] * (len(heads) + 2)]
    for world in dict.fromkeys(r["world"] for r in rows):
        title = next(r["title"] for r in rows if r["world"] == world)
        found = compare(rows, world)
        if not found:
            lines.append([title] + ["-"] * (len(heads) + 1))
            continue
        time, errors, mean, largest = found
        lines.append([
            title, f"{time:g}", *(cell(errors.get(name)) for name in (*others, "auto")),
            cell(mean),
            cell(largest)
        ])
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def write(rows, out):
    """Writes transports.csv, transports.md and the curves; returns the table and the curves'
    names."""
    write_csv(out / "transports.csv", rows)
    names = []
    for name, text in plots(rows, "bench_transports", {"relmse": "relMSE"}):
        (out / name).write_text(text)
        names.append(name)
    text = table(rows)
    (out / "transports.md").write_text(text)
    return text, names
