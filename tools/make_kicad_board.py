#!/usr/bin/env python3
"""Makes a board in the manner of an export of KiCad 10: Materials without names, parts translated
from STEP.

make_kicad_board.py FOLDER [--parts FOLDER] [--count N] [--form own|linear|encoded] [--named]

writes board.wrl and shapes3D/*.wrl. Parts are the .wrl models below --parts, for example those of
Debian's kicad-packages3d; without it those of make_kicad_example.py. `--form` says how the colours
of the parts arrive: as KiCad's numbers, as their linear form, or as if they were linear and had
been encoded as sRGB. `--named` keeps the names, as KiCad up to 9 does: the truth to compare with.
Parts, places and turns follow from the number of the part alone.
"""
import argparse
import importlib.util
import math
import pathlib
import re

HERE = pathlib.Path(__file__).parent
MATERIAL = re.compile(r"DEF\s+(\S+)\s+Material\s*\{([^}]*)\}")
NUMBERS = r"\s+([-+0-9.e]+)"
GAP = 1.5  # mm between parts
TENTH = 2.54  # mm in a unit of a model


def decoded(value):
    return value / 12.92 if value <= .04045 else ((value + .055) / 1.055)**2.4


def encoded(value):
    return value * 12.92 if value <= .0031308 else 1.055 * value**(1 / 2.4) - .055


FORMS = {"own": lambda value: value, "linear": decoded, "encoded": encoded}


def translated(text, form):
    """Returns a model as KiCad 10 writes it: no names of Materials, specular colour and shininess of
    its translator, colours in one of the forms."""
    bodies = {}

    def without_name(match):
        name, fields = match.groups()
        diffuse = re.search("diffuseColor" + 3 * NUMBERS, fields)
        clear = re.search("transparency" + NUMBERS, fields)
        colour = [FORMS[form](float(v)) for v in (diffuse.groups() if diffuse else (.8, .8, .8))]
        bodies[name] = (
            f"Material {{ ambientIntensity 0.1 diffuseColor {' '.join(f'{c:.6g}' for c in colour)}"
            f" specularColor 0.12 0.12 0.12 shininess 0.1"
            f" transparency {float(clear.group(1)) if clear else 0:g} }}")
        return bodies[name]

    text = MATERIAL.sub(without_name, text)
    return re.sub(r"material\s+USE\s+(\S+)",
                  lambda use: "material " + bodies.get(use.group(1), use.group(0)), text)


def extent(text):
    """Returns the size of a model in mm, seen from above, and its middle."""
    scale = float((re.search(r"scale\s+([0-9.]+)", text) or [0, 1])[1])
    xs, ys = [], []
    for points in re.findall(r"point\s*\[([^\]]*)\]", text):
        numbers = [float(v) for v in re.findall(r"[-+0-9.e]+", points)]
        xs += numbers[0::3]
        ys += numbers[1::3]
    if not xs:
        return None
    unit = scale * TENTH
    return ((max(xs) - min(xs)) * unit, (max(ys) - min(ys)) * unit,
            (max(xs) + min(xs)) / 2 * unit, (max(ys) + min(ys)) / 2 * unit)


def example():
    spec = importlib.util.spec_from_file_location("make_kicad_example", HERE / "make_kicad_example.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def models(folder, made):
    """Returns texts of models by name, in the order of their names."""
    if not folder:
        return {name: "#VRML V2.0 utf8\n" + made.in_tenths(make()) for name, make in made.MODELS.items()}
    return {path.stem: path for path in sorted(folder.rglob("*.wrl"))}


def chosen(available, count):
    """Returns `count` names, evenly over all of them."""
    names = list(available)
    return [names[i * len(names) // count % len(names)] if len(names) >= count else names[i % len(names)]
            for i in range(count)]


def placed(sizes):
    """Returns places in rows about the middle of a board, and the size of the board. sizes: mm."""
    width = math.sqrt(sum((w + GAP) * (h + GAP) for w, h in sizes)) * 1.15
    places, x, y, row = [], 0.0, 0.0, 0.0
    for i in sorted(range(len(sizes)), key=lambda i: (-sizes[i][1], i)):
        w, h = sizes[i]
        if x + w > width and x > 0:
            x, y, row = 0.0, y + row + GAP, 0.0
        places.append((i, x + w / 2, y + h / 2))
        x, row = x + w + GAP, max(row, h)
    height = y + row
    return [(i, px - width / 2, height / 2 - py) for i, px, py in places], width + 6, height + 6


def layers(made, places, sizes, width, height):
    """Returns the layers of the board: its body, mask, tracks, a pad ring beside and a frame around
    each part."""
    body, mask, copper, paste, silk = (made.Faces() for _ in range(5))
    outline, thick = made.rounded(width, height, 2), made.THICK / 2
    body.prism(outline, -thick, thick)
    mask.prism(outline, thick, thick + .02, bottom=False)
    mask.prism(outline, -thick - .02, -thick, top=False)
    before = None
    for i, x, y in places:
        if before:
            copper.track([before, (before[0], y), (x, y)], .3, thick, thick + .01)
        before = x, y
        w, h = sizes[i]
        paste.box(x, y, thick + .05, w * .9, h * .9, .05)
        silk.track([(x - w / 2, y - h / 2 - GAP / 3), (x + w / 2, y - h / 2 - GAP / 3)], .15,
                   thick + .02, thick + .045)
    for x in (-1, 1):
        for y in (-1, 1):
            copper.disc(x * (width / 2 - 2), y * (height / 2 - 2), 1.2, thick + .02, thick + .06)
    return (made.layer("body", body, False) + made.layer("mask", mask, False) +
            made.layer("copper", copper) + made.layer("paste", paste) + made.layer("silk", silk))


def write_board(folder, parts=None, count=200, form="own", named=False):
    made = example()
    available = models(parts, made)
    (folder / "shapes3D").mkdir(parents=True, exist_ok=True)
    texts, used, sizes = {}, [], []
    for name in chosen(available, count):
        if name not in texts:
            source = available[name]
            texts[name] = source if isinstance(source, str) else source.read_text(errors="replace")
        size = extent(texts[name])
        if size:
            used.append((name, size))
            sizes.append(size[:2])
    places, width, height = placed(sizes)
    lines = []
    for i, x, y in places:
        name, (_, _, mx, my) = used[i]
        lines.append(f"Transform {{ translation {x - mx:g} {y - my:g} {made.THICK / 2 + .05:g}"
                     f" scale {TENTH} {TENTH} {TENTH} children [\n"
                     f" Inline {{ url \"shapes3D/{name}.wrl\" }} ] }}\n")
    for name in sorted({name for name, _ in used}):
        text = texts[name] if named else translated(texts[name], form)
        (folder / f"shapes3D/{name}.wrl").write_text(text)
    board = layers(made, places, sizes, width, height)
    (folder / "board.wrl").write_text("#VRML V2.0 utf8\nWorldInfo { title \"board.wrl - Generated by "
                                      "Pcbnew\" }\n" + board + "".join(lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--parts", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--form", choices=FORMS, default="own")
    parser.add_argument("--named", action="store_true")
    given = parser.parse_args()
    write_board(given.folder, given.parts, given.count, given.form, given.named)


if __name__ == "__main__":
    main()
