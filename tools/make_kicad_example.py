#!/usr/bin/env python3
"""Writes examples/kicad: a small board in the form of KiCad's VRML export, and the models that it
names.

make_kicad_example.py FOLDER     blinker.wrl and shapes3D/*.wrl; checked in, run it again after a change

As in such exports, the board is a list of layers without names, z is up, and the unit is the
millimetre. Parts are Inlines of models whose unit is a tenth of an inch (hence their scale of
2.54), and their Materials have DEF names. The board and the models were made for this project.
"""
import math
import pathlib
import sys

WIDTH, HEIGHT, THICK = 40.0, 26.0, 1.6  # size of the board in mm
MATERIALS = {  # materials of the models, named as in KiCad's libraries
    "IC-BODY-EPOXY-04": "ambientIntensity 0.29 diffuseColor 0.148 0.145 0.145 specularColor 0.18 0.168 0.16 shininess 0.35",
    "PIN-01": "ambientIntensity 0.271 diffuseColor 0.824 0.82 0.781 specularColor 0.328 0.258 0.172 shininess 0.7",
    "PIN-02": "ambientIntensity 0.379 diffuseColor 0.859 0.738 0.496 specularColor 0.137 0.145 0.184 shininess 0.4",
    "PLASTIC-BLACK": "ambientIntensity 0.25 diffuseColor 0.09 0.09 0.1 specularColor 0.2 0.2 0.2 shininess 0.3",
    "CAP-CERAMIC-05": "ambientIntensity 0.179 diffuseColor 0.273 0.273 0.273 specularColor 0.203 0.188 0.176 shininess 0.07",
    "RES-SMD-01": "ambientIntensity 0.25 diffuseColor 0.082 0.086 0.094 specularColor 0.066 0.063 0.063 shininess 0.3",
    "LED-RED": "ambientIntensity 0.789 diffuseColor 0.7 0.1 0.05 specularColor 0.33 0.24 0.2 shininess 0.5 transparency 0.1",
    "MET-ALUMINUM": "ambientIntensity 0.256 diffuseColor 0.372 0.372 0.373 specularColor 0.556 0.554 0.556 shininess 0.127",
}
# The layers of the board have colours and no names. These are the numbers of KiCad 6 to 9.
LAYERS = {
    "body": "diffuseColor 0.43 0.45 0.3 specularColor 0.487 0.505 0.37 shininess 0.01",
    "copper": "diffuseColor 0.75 0.61 0.23 specularColor 0.9 0.844 0.692 shininess 0.9",
    "mask": "diffuseColor 0.0784 0.2 0.141 specularColor 0.355 0.44 0.399 transparency 0.17 shininess 0.3",
    "paste": "diffuseColor 0.5 0.5 0.5 specularColor 0.8 0.8 0.8 shininess 0.7",
    "silk": "diffuseColor 0.961 0.961 0.961 specularColor 0.965 0.965 0.965 shininess 0.02",
}


class Faces:
    """Collects the faces of an IndexedFaceSet."""

    def __init__(self):
        self.points, self.faces = [], []

    def prism(self, outline, low, high, top=True, bottom=True):
        """outline: convex or concave, counter-clockwise seen from +z."""
        base, n = len(self.points), len(outline)
        self.points += [(x, y, low) for x, y in outline] + [(x, y, high) for x, y in outline]
        if top:
            self.faces.append([base + n + i for i in range(n)])
        if bottom:
            self.faces.append([base + n - 1 - i for i in range(n)])
        self.faces += [
            [base + i, base + (i + 1) % n, base + n + (i + 1) % n, base + n + i] for i in range(n)
        ]

    def box(self, x, y, z, sx, sy, sz):
        self.prism([(x - sx / 2, y - sy / 2), (x + sx / 2, y - sy / 2), (x + sx / 2, y + sy / 2),
                    (x - sx / 2, y + sy / 2)], z - sz / 2, z + sz / 2)

    def track(self, way, width, low, high):
        """Adds a strip of copper along a path of points, with round ends."""
        for (x0, y0), (x1, y1) in zip(way, way[1:]):
            a = math.atan2(y1 - y0, x1 - x0)
            outline = [(x1 + width / 2 * math.cos(a + t), y1 + width / 2 * math.sin(a + t))
                       for t in half_turn(-math.pi / 2)]
            outline += [(x0 + width / 2 * math.cos(a + t), y0 + width / 2 * math.sin(a + t))
                        for t in half_turn(math.pi / 2)]
            self.prism(outline, low, high, bottom=False)

    def disc(self, x, y, radius, low, high):
        turns = [2 * math.pi * i / 24 for i in range(24)]
        self.prism([(x + radius * math.cos(t), y + radius * math.sin(t)) for t in turns],
                   low,
                   high,
                   bottom=False)

    def lathe(self, profile, steps=32):
        """Adds a surface of revolution about the z axis. profile: (radius, z) from the bottom
        up."""
        base = len(self.points)
        for r, z in profile:
            self.points += [(r * math.cos(2 * math.pi * i / steps),
                             r * math.sin(2 * math.pi * i / steps), z) for i in range(steps)]
        for row in range(len(profile) - 1):
            for i in range(steps):
                a, b = base + row * steps + i, base + row * steps + (i + 1) % steps
                self.faces.append([a, b, b + steps, a + steps])
        self.faces.append([base + (len(profile) - 1) * steps + i for i in range(steps)])
        self.faces.append([base + steps - 1 - i for i in range(steps)])

    def text(self, crease=0.5, convex=True):
        points = ", ".join(" ".join(f"{c:.4g}" for c in p) for p in self.points)
        faces = " ".join(" ".join(map(str, f)) + " -1" for f in self.faces)
        flag = "" if convex else " convex FALSE"
        return f"IndexedFaceSet {{ creaseAngle {crease}{flag}\n  coord Coordinate {{ point [ {points} ] }}\n  coordIndex [ {faces} ] }}"


def half_turn(start, steps=8):
    return [start + math.pi * i / steps for i in range(steps + 1)]


def rounded(width, height, radius):
    out = []
    for cx, cy, start in ((1, 1, 0), (-1, 1, .5), (-1, -1, 1), (1, -1, 1.5)):
        for i in range(7):
            a = math.pi * (start + i / 12)
            out.append((cx * (width / 2 - radius) + radius * math.cos(a),
                        cy * (height / 2 - radius) + radius * math.sin(a)))
    return out


def layer(name, faces, convex=True):
    return (
        f"Transform {{ children [ Group {{ children [ Shape {{\n appearance Appearance {{ material Material {{ {LAYERS[name]} }} }}\n"
        f" geometry {faces.text(convex=convex)} }} ] }} ] }}\n")


def shape(material, faces, crease=0.5):
    return (
        f"Shape {{ appearance Appearance {{ material DEF {material} Material {{ {MATERIALS[material]} }} }}\n"
        f" geometry {faces.text(crease)} }}\n")


def soic():
    body, pins = Faces(), Faces()
    body.prism(rounded(3.9, 4.9, .15), .15, .95)
    body.prism(rounded(3.7, 4.7, .15), .95, 1.55)
    for i in range(4):
        for side in (-1, 1):
            y = 1.905 - 1.27 * i
            pins.box(side * 2.15, y, .85, .5, .41, .2)
            pins.box(side * 2.4, y, .5, .2, .41, .9)
            pins.box(side * 2.7, y, .1, .8, .41, .2)
    return shape("IC-BODY-EPOXY-04", body) + shape("PIN-01", pins)


def chip(body_material, height):
    body, pins = Faces(), Faces()
    body.box(0, 0, height / 2, 1.3, 1.2, height * .96)
    for side in (-1, 1):
        pins.prism([(x + side * .825, y) for x, y in rounded(.4, 1.25, .08)], 0, height)
    return shape(body_material, body) + shape("PIN-01", pins)


def led():
    body, pins = Faces(), Faces()
    dome = [(2.5 * math.cos(a), 6.1 + 2.5 * math.sin(a))
            for a in (math.pi / 2 * i / 10 for i in range(10))]
    body.lathe([(2.9, 1.0), (2.9, 2.0), (2.5, 2.0), *dome, (.2, 8.6)])
    for x in (-1.27, 1.27):
        pins.box(x, 0, -.6, .5, .5, 3.4)
    return shape("LED-RED", body, 1) + shape("PIN-01", pins)


def header():
    body, pins = Faces(), Faces()
    for i in range(4):
        octagon = [(x, y - 2.54 * i)
                   for x, y in ((1.27, -.9), (1.27, .9), (.9, 1.27), (-.9, 1.27), (-1.27, .9),
                                (-1.27, -.9), (-.9, -1.27), (.9, -1.27))]
        body.prism(octagon, 0, 2.54)
        pins.box(0, -2.54 * i, 2.8, .64, .64, 11.5)
    return shape("PLASTIC-BLACK", body, 0) + shape("PIN-02", pins, 0)


def electrolytic():
    body, foot = Faces(), Faces()
    body.lathe([(3.1, .3), (3.15, .6), (3.15, 1.3), (2.9, 1.6), (3.15, 1.9), (3.15, 5.6),
                (2.95, 5.8)])
    foot.prism(rounded(6.6, 6.6, .8), 0, .5)
    return shape("MET-ALUMINUM", body, .6) + shape("PLASTIC-BLACK", foot, 0)


MODELS = {
    "SOIC-8_3.9x4.9mm": soic,
    "R_0805_2012Metric": lambda: chip("RES-SMD-01", .5),
    "C_0805_2012Metric": lambda: chip("CAP-CERAMIC-05", 1.1),
    "LED_D5.0mm": led,
    "PinHeader_1x04_P2.54mm_Vertical": header,
    "CP_Elec_6.3x5.8": electrolytic
}
PARTS = [("SOIC-8_3.9x4.9mm", -3, 1, 0), ("CP_Elec_6.3x5.8", 6.5, -5.5, 0),
         ("LED_D5.0mm", 13, 5, 90), ("PinHeader_1x04_P2.54mm_Vertical", -16, 3.81, 0),
         ("R_0805_2012Metric", 4, 3, 90), ("R_0805_2012Metric", 7, 3, 90),
         ("R_0805_2012Metric", -3, 6.5, 0), ("C_0805_2012Metric", -9, -2, 90),
         ("C_0805_2012Metric", -3, -6, 0)]
TRACKS = [[(-16, 3.81), (-11, 3.81), (-9.6, 2.9), (-5.7, 2.9)],
          [(-16, 1.27), (-12, 1.27), (-9.5, -1.1), (-9, -1.1)],
          [(-16, -1.27), (-13, -1.27), (-11, -2.9), (-9, -2.9), (-6.5, -6), (-3.9, -6)],
          [(-16, -3.81), (-12, -8.5), (3.8, -8.5), (3.8, -6)],
          [(-5.7, 1.6), (-8, 1.6), (-8, 6.5), (-3.9, 6.5)], [(-.3, 2.9), (2.6, 2.9), (4, 4)],
          [(-2.1, 6.5), (6, 6.5), (7, 5.4), (7, 4)], [(7, 2.1), (9, 2.1), (11.5, 3.73), (13, 3.73)],
          [(4, 2.1), (4, .6), (8.8, -2), (9.2, -5.5)],
          [(-.3, -.9), (1, -.9), (3.8, -3.5), (3.8, -5.5)],
          [(13, 6.27), (13, 10.5), (-10, 10.5), (-12, 8.5), (-16, 4.5)]]


def board():
    outline = rounded(WIDTH, HEIGHT, 2.5)
    body, mask, copper, paste, silk = (Faces() for _ in range(5))
    body.prism(outline, -THICK / 2, THICK / 2)
    top = THICK / 2 + .02
    mask.prism(outline, THICK / 2, top, bottom=False)  # seen from outside alone
    mask.prism(outline, -top, -THICK / 2, top=False)
    for way in TRACKS:  # below the mask
        copper.track(way, .5, THICK / 2, THICK / 2 + .01)
    for i in range(4):  # the rings of the header and the LED, the holes in the corners
        copper.disc(-16, 3.81 - 2.54 * i, .85, top, top + .04)
    for y in (3.73, 6.27):
        copper.disc(13, y, .9, top, top + .04)
    for x in (-17.3, 17.3):
        for y in (-10.3, 10.3):
            copper.disc(x, y, 1.6, top, top + .04)
    for name, x, y, turn in PARTS:
        if name.startswith(("R_", "C_")):
            for side in (-1, 1):
                dx, dy = (0, side * .95) if turn else (side * .95, 0)
                paste.box(x + dx, y + dy, top + .03, 1.3 if turn else 1.0, 1.0 if turn else 1.3,
                          .05)
        if name.startswith("SOIC"):
            for i in range(8):
                paste.box(x + (2.7 if i % 2 else -2.7), y + 1.905 - 1.27 * (i // 2), top + .03, 1.5,
                          .55, .05)
    for outline_of in ([(-5.3, 4),
                        (-.7, 4)], [(-5.3, -2),
                                    (-.7, -2)], [(10, 1.6),
                                                 (16, 1.6)], [(-17.7, 5.5), (-14.3, 5.5),
                                                              (-14.3, -5.5), (-17.7, -5.5),
                                                              (-17.7, 5.5)], [(2.6, -9.4),
                                                                              (10.4, -9.4),
                                                                              (10.4, -1.6),
                                                                              (2.6, -1.6),
                                                                              (2.6, -9.4)]):
        silk.track(outline_of, .2, top, top + .025)
    layers = layer("body", body, False) + layer("mask", mask, False) + layer("copper", copper)
    return layers + layer("paste", paste) + layer("silk", silk)


def placed(name, x, y, turn):
    spin = f" rotation 0 0 1 {math.radians(turn):.6g}" if turn else ""
    return (
        f"Transform {{ translation {x:g} {y:g} {THICK / 2 + .05:g}{spin} scale 2.54 2.54 2.54 children [\n"
        f" Inline {{ url \"shapes3D/{name}.wrl\" }} ] }}\n")


def in_tenths(text):
    """Converts a model from millimetres to tenths of an inch."""
    return f"Transform {{ scale 0.3937008 0.3937008 0.3937008 children [\n{text}] }}\n"


def main():
    folder = pathlib.Path(sys.argv[1])
    (folder / "shapes3D").mkdir(parents=True, exist_ok=True)
    for name, make in MODELS.items():
        (folder / f"shapes3D/{name}.wrl").write_text("#VRML V2.0 utf8\n" + in_tenths(make()))
    text = "#VRML V2.0 utf8\nWorldInfo { title \"blinker\" }\nTransform { scale 1 1 1 children [\n" + board(
    )
    (folder / "blinker.wrl").write_text(text + "".join(placed(*part) for part in PARTS) + "] }\n")


if __name__ == "__main__":
    main()
