#!/usr/bin/env python3
"""Writes the worlds of examples/scenes that show shaders and transports. They are checked in; run
it again after a change.

make_scenes.py FOLDER     a .wrl for each function below and of scenes/, packed (.wrz) if it is long
"""
import gzip
import math
import pathlib
import struct
import sys
import zlib

from scenes.car import car
from scenes.chess import chess
from scenes.earth import earth
from scenes.globe import globe
from scenes.headlight import headlight_studio
from scenes.parts import at, box, lathe, numbers, quad, shader, shape, viewpoint, world


def glass_ball():
    floor = shader("Checker", "checker", "3f size 1 0 1", "3f even .75 .72 .66",
                   "3f odd .09 .16 .2")
    return world(
        "Glass ball", viewpoint((0.4, 1.9, 6.2), (0, 0.9, 0), 0.62),
        "Background { skyColor [ .25 .45 .85, .75 .85 .95 ] skyAngle 1.5707963 }",
        "PointLight { location 4 7 3 attenuation 0 0 .02 radius 60 }",
        "DirectionalLight { direction -.4 -1 -.6 intensity .35 ambientIntensity .3 }",
        at((0, 1, 0), "DEF Ball " + shape(shader("Glass", "glass", "1f index 1.5"), "Sphere { }")),
        at((-2.1, 0.6, -1.6),
           shape(
               "Appearance { material Material { diffuseColor .85 .2 .1 specularColor .4 .4 .4 shininess .4 } }",
               "Sphere { radius .6 }")),
        at((2.3, 0.45, -0.6), shape(shader("Mirror", "mirror"),
                                    "Sphere { radius .45 }")), "DEF Floor " +
        shape(floor, quad((-25, 0, 25), (25, 0, 25), (25, 0, -25), (-25, 0, -25), True)))


def mirror_corridor():
    mirror = shader("Mirror", "mirror", "3f reflectance .86 .9 .88")
    wood = shader("Wood", "wood", "3f axis 1 0 .1", "1f rings 5")
    parts = [
        "PointLight { location 0 2.6 1 attenuation 0 0 .12 radius 200 }",
        "DEF Left " + shape(mirror, quad((-1.5, 0, 4), (-1.5, 0, -4), (-1.5, 3, -4), (-1.5, 3, 4))),
        "DEF Right " + shape(mirror, quad((1.5, 0, -4), (1.5, 0, 4), (1.5, 3, 4), (1.5, 3, -4))),
        shape(wood, quad((-1.5, 0, 4), (1.5, 0, 4), (1.5, 0, -4), (-1.5, 0, -4))),
        shape("DEF White Appearance { material Material { diffuseColor .8 .8 .78 } }",
              quad((-1.5, 3, -4), (1.5, 3, -4), (1.5, 3, 4), (-1.5, 3, 4))),
        shape("USE White", quad((-1.5, 0, -4), (1.5, 0, -4), (1.5, 3, -4), (-1.5, 3, -4))),
        shape("USE White", quad((1.5, 0, 4), (-1.5, 0, 4), (-1.5, 3, 4), (1.5, 3, 4))),
        at((0.5, 0.8, -1.4),
           shape(
               "Appearance { material Material { diffuseColor .1 .3 .75 specularColor .5 .5 .5 shininess .5 } }",
               "Cylinder { radius .28 height 1.6 }")),
        at((0.5, 1.85, -1.4),
           shape("Appearance { material Material { diffuseColor .9 .55 .1 } }",
                 "Sphere { radius .3 }")),
    ]
    return world("Between two mirrors", viewpoint((-0.9, 1.65, 1.6), (1.5, 1.25, -1.2), 1.05),
                 *parts)


def cornell():
    """Returns the Cornell box with its usually quoted dimensions, scaled to a width of one metre,
    and the colours of its paints and lamp."""
    white = shader("Diffuse", "diffuse", "color reflectance .73 .73 .73")
    parts = [
        "DEF Lamp " + shape(
            shader("Diffuse", "diffuse", "color reflectance .78 .78 .78", "color emission 17 12 4"),
            quad((.38, .998, -.6), (.62, .998, -.6), (.62, .998, -.41), (.38, .998, -.41), True)),
        "DEF Floor " + shape("DEF White " + white, quad((0, 0, 0), (1, 0, 0), (1, 0, -1),
                                                        (0, 0, -1))),
        "DEF Ceiling " + shape("USE White", quad((0, 1, -1), (1, 1, -1), (1, 1, 0), (0, 1, 0))),
        "DEF Back " + shape("USE White", quad((0, 0, -1), (1, 0, -1), (1, 1, -1), (0, 1, -1))),
        "DEF Red " + shape(shader("Diffuse", "diffuse", "color reflectance .63 .065 .05"),
                           quad((0, 0, 0), (0, 0, -1), (0, 1, -1), (0, 1, 0))),
        "DEF Green " + shape(shader("Diffuse", "diffuse", "color reflectance .14 .45 .091"),
                             quad((1, 0, -1), (1, 0, 0), (1, 1, 0), (1, 1, -1))),
        at((.665, .15, -.31),
           "DEF Short " + shape("USE White", box(.297, .3, .297)),
           turn=(0, 1, 0, -.29)),
        at((.335, .3, -.63),
           "DEF Tall " + shape("USE White", box(.297, .6, .297)),
           turn=(0, 1, 0, .34)),
    ]
    return world("Cornell box", viewpoint((.5, .5, 1.44), (.5, .5, 0), .69), *parts)


def furnace():
    """Returns a furnace: emission and reflectance add up to 1, so the radiance is 1 everywhere and
    the objects are invisible."""
    walls = shader("Diffuse", "diffuse", "color emission .5 .4 .2", "color reflectance .5 .6 .8")
    faces = (
        "IndexedFaceSet { solid FALSE coord Coordinate { point [ -4 -4 4, 4 -4 4, 4 4 4, -4 4 4, -4 -4 -4, 4 -4 -4, 4 4 -4, "
        "-4 4 -4 ] } coordIndex [ 0 1 2 3 -1 5 4 7 6 -1 1 5 6 2 -1 4 0 3 7 -1 3 2 6 7 -1 4 5 1 0 -1 ] }"
    )
    return world(
        "Furnace", viewpoint((0, 0, 3), (0, 0, 0), .8), shape("DEF Walls " + walls, faces),
        at((-.8, 0, 0), shape("USE Walls", "Sphere { radius .7 }")),
        at((.9, -.2, -.5), shape(shader("Glass", "glass"), "Sphere { radius .6 }")),
        at((.3, .9, -.8),
           shape(shader("Mirror", "mirror", "color reflectance 1 1 1"), "Sphere { radius .4 }")))


def caustic():
    """Returns a caustic: sunlight from a small lamp through a ball of glass and off a ring of gold,
    onto a wall and a table."""
    matt = "DEF Wall " + shader("Diffuse", "diffuse", "color reflectance .75 .73 .7")
    ring = lathe([(1.0, -.25), (1.0, .25), (1.04, .25), (1.04, -.25), (1.0, -.25)], 64, .5)
    gold = shader("Metal", "metal", "color n .16 .42 1.35", "color k 3.5 2.4 1.8")
    return world(
        "Caustics", viewpoint((.4, 2.6, 6.8), (.4, .9, -.6), .62),
        at((-3.2, 5.4, 2.6), "DEF Lamp " + shape(
            shader("Diffuse", "diffuse", "color reflectance 0 0 0",
                   "color emission 1500 1430 1290"), "Sphere { radius .12 }")),
        shape(matt, quad((-8, 0, 8), (8, 0, 8), (8, 0, -2.4), (-8, 0, -2.4))),
        shape("USE Wall", quad((-8, 0, -2.4), (8, 0, -2.4), (8, 6, -2.4), (-8, 6, -2.4))),
        at((-.7, .8, -.6), "DEF Ball " +
           shape(shader("Glass", "glass", "1f index 1.5", "1f abbe 35"), "Sphere { radius .8 }")),
        at((1.7, .26, .4), "DEF Ring " + shape(gold, ring), turn=(1, 0, 0, -1.5708)))


def car_paint():
    """Returns the body of a model car, lofted from a few sections along its length."""
    sections = [(-2.2, .22, .48, .34), (-2.05, .42, .52, .52), (-1.2, .5, .56, .62),
                (-.7, .54, .58, .7), (0, .56, .76, .74), (.55, .56, .77, .74), (1.2, .54, .6, .72),
                (1.9, .48, .5, .64), (2.15, .34, .44, .46), (2.25, .2, .38, .3)]
    ring = 24
    points, faces = [], []
    for x, low, high, wide in sections:  # superellipses: flat sides, round edges
        for i in range(ring):
            c, s = math.cos(2 * math.pi * i / ring), math.sin(2 * math.pi * i / ring)
            y, z = (math.copysign(abs(v)**.55, v) for v in (s, c))
            points.append((x, .62 + (high * y if y > 0 else low * .62 * y), wide * z))
    for k in range(len(sections) - 1):
        for i in range(ring):
            j = (i + 1) % ring
            faces.append(
                f"{k * ring + i} {k * ring + ring + i} {k * ring + ring + j} {k * ring + j} -1")
    last = (len(sections) - 1) * ring
    faces.append(" ".join(str(i) for i in range(ring)) + " -1")
    faces.append(" ".join(str(last + i) for i in reversed(range(ring))) + " -1")
    body = ("IndexedFaceSet { creaseAngle 1.2\n  coord Coordinate { point [ " +
            ", ".join(numbers(p) for p in points) + " ] }\n  coordIndex [ " + " ".join(faces) +
            " ] }")
    tyre = lathe([(.2, -.11), (.2, .11), (.33, .12), (.36, .06), (.36, -.06), (.33, -.12),
                  (.2, -.11)], 32, .8)
    hub = lathe([(0.001, .08), (.12, .1), (.2, .06)], 32, .8)
    wheels = []
    for n, (x, side) in enumerate([(-1.3, .6), (1.35, .6), (-1.3, -.6), (1.35, -.6)]):
        parts = ["USE Tyre", "USE Hub"] if n else [
            "DEF Tyre " + shape(
                "Appearance { material Material { diffuseColor .05 .05 .05 specularColor .1 .1 .1 } }",
                tyre), "DEF Hub " + shape(shader("Metal", "metal", "1f roughness .15"), hub)
        ]
        wheels.append(at((x, .36, side), *parts, turn=(0, 1, 0, 0 if side > 0 else math.pi)))
    return world(
        "Car paint", viewpoint((-4.2, 2.1, 5.6), (0, .55, 0), .6),
        "Background { skyColor [ .35 .5 .8, .75 .82 .9, 1 .95 .88 ] skyAngle [ 1.1, 1.5707 ] groundColor [ .2 .2 .2, .3 .28 .26 ] "
        "groundAngle 1.5707 }",
        "DirectionalLight { direction .5 -1 -.6 color 1 .96 .9 intensity .8 }", "DEF Body " +
        shape(shader("CarPaint", "carpaint", "1f flakeSize .0025", "1f flakes .25"), body), *wheels,
        shape(shader("Diffuse", "diffuse", "color reflectance .35 .35 .36"),
              quad((-40, 0, 40), (40, 0, 40), (40, 0, -40), (-40, 0, -40))))


def carved():
    """Returns wood, marble and a chequered table, and a label with a picture."""
    label = ("PixelTexture { repeatS FALSE repeatT FALSE image 8 8 1 " +
             " ".join("0xE0" if (x in (0, 7) or y in (0, 7) or (x + y) % 3) else "0x30"
                      for y in range(8)
                      for x in range(8)) + " }")
    return world(
        "Carved", viewpoint((.6, 2.3, 6), (0, .75, 0), .6), "Background { skyColor .5 .55 .6 }",
        "SpotLight { location -3 6 4 direction 3 -5.4 -4 beamWidth .4 cutOffAngle .6 radius 40 ambientIntensity .3 }",
        "DirectionalLight { direction -.6 -.5 -1 intensity .3 }",
        at((-1.5, .6, 0),
           "DEF Block " + shape(
               shader("Wood", "wood", "3f axis .15 1 .1", "3f pith .5 0 .4", "1f rings 9",
                      "1f varnish 1.45"), box(1.2, 1.2, 1.2)),
           turn=(0, 1, 0, .5)),
        at((.25, .7, -.4), "DEF Globe " + shape(
            shader("Marble", "marble", "1f veins 3", "1f polish 1.5"), "Sphere { radius .7 }")),
        at((1.75, .5, .3), "DEF Tin " + shape(
            f'ORTAppearance {{ texture {label} textureTransform TextureTransform {{ scale 3 1 }} '
            'shader ORTShader { name "Plastic" file "plastic" options [ "color color .9 .75 .4" "1f roughness .15" ] } }',
            "Cylinder { radius .45 height 1 }")),
        shape(
            shader("Checker", "checker", "3f size .6 0 .6", "3f even .6 .5 .4",
                   "3f odd .25 .18 .14", "1f coating 1.4"),
            quad((-8, 0, 8), (8, 0, 8), (8, 0, -8), (-8, 0, -8))))


def interior():
    """Returns a room that receives all its light through a pane of glass."""
    plaster = "DEF Plaster " + shader("Diffuse", "diffuse", "color reflectance .75 .73 .68")
    w = "USE Plaster"
    return world(
        "Through a window",
        viewpoint((1.55, 1.5, 1.9), (-.5, 1.05, -1), 1.05),
        at((-3.4, 1.9, -.4), "DEF Sky " +
           shape(shader("Diffuse", "diffuse", "color reflectance 0 0 0", "color emission 9 11 14"),
                 quad((0, -1.4, 1.6), (0, -1.4, -1.6), (0, 1.4, -1.6), (0, 1.4, 1.6)))),
        at((-1.96, 1.45, -.4),
           "DEF Pane " + shape(shader("Glass", "glass", "1f index 1.5"), box(.02, 1.3, 1.4))),
        shape(plaster, quad((-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2))),
        shape(w, quad((-2, 2.6, -2), (2, 2.6, -2), (2, 2.6, 2), (-2, 2.6, 2))),
        shape(w, quad((-2, 0, -2), (2, 0, -2), (2, 2.6, -2), (-2, 2.6, -2))),
        shape(w, quad((2, 0, 2), (-2, 0, 2), (-2, 2.6, 2), (2, 2.6, 2))),
        shape(shader("Diffuse", "diffuse", "color reflectance .6 .2 .12"),
              quad((2, 0, -2), (2, 0, 2), (2, 2.6, 2), (2, 2.6, -2))),
        # the wall with the window, in four pieces
        shape(w, quad((-2, 0, 2), (-2, 0, -2), (-2, .8, -2), (-2, .8, 2))),
        shape(w, quad((-2, 2.1, 2), (-2, 2.1, -2), (-2, 2.6, -2), (-2, 2.6, 2))),
        shape(w, quad((-2, .8, 2), (-2, .8, .3), (-2, 2.1, .3), (-2, 2.1, 2))),
        shape(w, quad((-2, .8, -1.1), (-2, .8, -2), (-2, 2.1, -2), (-2, 2.1, -1.1))),
        at((-.3, .38, -1),
           shape("DEF Oak " + shader("Diffuse", "diffuse", "color reflectance .45 .27 .13"),
                 box(1.5, .06, .8))),
        *(at((-.3 + x, .175, -1 + z), shape("USE Oak", box(.06, .35, .06)))
          for x in (-.68, .68)
          for z in (-.33, .33)),
        at((-.2, .61, -1),
           "DEF Vase " + shape(shader("Glass", "glass", "1f index 1.5"), "Sphere { radius .2 }")))


def headlight():
    """Returns a lamp in the focus of a paraboloid, behind a glass lens, and their light on a wall.
    Unit: centimetre."""
    focus, radius, hole = 3.0, 8.0, 1.0
    reflector = lathe([(r, r * r / (4 * focus) - focus)
                       for r in [hole + (radius - hole) * i / 14 for i in range(15)]], 64, 1)
    rim = radius * radius / (4 * focus) - focus
    # Plano-convex: flat towards the lamp, a paraboloid on the outside; its faces point outwards.
    convex = [(radius * i / 10, rim + 3.2 - 2.2 * (i / 10)**2) for i in range(11)]
    lens = lathe(convex + [(radius, rim + .5), (0, rim + .5)], 64, .7)
    lacquer = shader("Reflector", "reflector", "1f lacquer 1")
    return world(
        "Headlight", viewpoint(
            (52, 20, 27), (0, 1, 23),
            .82), "Background { skyColor .1 .12 .17 }", "DEF Filament " + shape(
                shader("Diffuse", "diffuse", "color reflectance 0 0 0",
                       "color emission 1800 1650 1400"), "Sphere { radius .25 }"),
        "DEF Reflector " + shape(lacquer, reflector),
        "DEF Lens " + shape(shader("Glass", "glass", "1f index 1.52"), lens),
        "DEF Housing " + shape(
            shader("Plastic", "plastic", "color color .3 .32 .35", "1f roughness .2"),
            lathe([(radius + .1, rim + .5), (radius + .1, rim - 1), (4.2, -4.2),
                   (.001, -4.2)], 48, .5)),
        "DEF Wall " + shape(shader("Diffuse", "diffuse", "color reflectance .7 .7 .7"),
                            quad((60, -11, 50), (-40, -11, 50), (-40, 40, 50), (60, 40, 50))),
        shape(shader("Diffuse", "diffuse", "color reflectance .4 .38 .36"),
              quad((-40, -11, 50), (60, -11, 50), (60, -11, -40), (-40, -11, -40))))


def board():
    """Returns a circuit board as exported by layout programs: many small shapes, few materials; lit
    by a sky."""
    parts = []
    plastic = "DEF Black " + shader("Plastic", "plastic", "color color .03 .03 .035",
                                    "1f roughness .25")
    tin = "DEF Tin " + shader("Metal", "metal", "1f roughness .12")
    gold = "DEF Gold " + shader("Metal", "metal", "color n .16 .42 1.35", "color k 3.5 2.4 1.8",
                                "1f roughness .1")
    mask = shader("Plastic", "plastic", "color color .02 .16 .07", "1f roughness .08")
    parts.append("DEF Board " + at((0, -.08, 0), shape(mask, box(10, .16, 7))))

    def package(name, length, width, height, pins, pitch):
        body = [
            at((0, height / 2 + .05, 0),
               shape(plastic if name == "DIP" else "USE Black", box(length, height, width)))
        ]
        for side in (-1, 1):
            for i in range(pins):
                x = (i - (pins - 1) / 2) * pitch
                first = name == "DIP" and side == -1 and i == 0
                pin = shape(tin, box(pitch * .4, .05, .25)) if first else "USE Pin"
                body.append(
                    at((x, .06, side * (width / 2 + .1)), ("DEF Pin " if first else "") + pin))
        return f"DEF {name} Group {{ children [\n  " + "\n  ".join(body) + " ] }"

    parts.append(at((-2.6, 0, -1.2), package("DIP", 2.6, 1.0, .5, 8, .3)))
    parts.append(at((1.2, 0, -1.4), "USE DIP"))
    parts.append(at((-2.6, 0, 1.4), "USE DIP"))
    chip = "DEF Chip Group { children [ " + at((0, .1, 0), shape("USE Black", box(.22, .16, .24))) + " " + \
        at((-.16, .1, 0), "DEF Cap " + shape("USE Tin", box(.1, .17, .25))) + " " + at((.16, .1, 0), "USE Cap") + " ] }"
    for n in range(18):
        x, z = 1.0 + .55 * (n % 6), .5 + .55 * (n // 6)
        parts.append(
            at((x, 0, z), chip if n == 0 else "USE Chip", turn=(0, 1, 0, 1.5708 * (n * 7 % 2))))
    can = lathe([(.001, 0), (.3, 0), (.32, .06), (.3, .12), (.32, .18), (.32, .95), (.28, 1),
                 (.001, 1)], 24, .7)
    parts.append(
        at((3.9, 0, -2.2), "DEF Can Transform { rotation 1 0 0 -1.5708 children " +
           shape(shader("Metal", "metal", "1f roughness .3"), can) + " }"))
    parts.append(at((3.1, 0, -2.2), "USE Can"))
    for n in range(10):
        parts.append(
            at((-4.6, .01, -2.25 + .5 * n),
               ("DEF Pad " +
                shape(gold, "Cylinder { radius .14 height .03 }")) if n == 0 else "USE Pad"))
    led = shader("Diffuse", "diffuse", "color reflectance .3 .05 .05", "color emission 6 .4 .3")
    parts.append(at((4.5, .14, 2.9), "DEF Led " + shape(led, "Sphere { radius .12 }")))
    sky = ('ORTBackground { shader ORTShader { name "EnvironmentMap" file "environmentmap" '
           'options [ "texture texture studio.png", "1f intensity 4", "1f rotation .6" ] } }')
    table = shape(shader("Diffuse", "diffuse", "color reflectance .55 .5 .45"),
                  quad((-40, -.5, 40), (40, -.5, 40), (40, -.5, -40), (-40, -.5, -40)))
    return world("Circuit board", viewpoint((1.6, 6.6, 9.4), (.1, 0, .2), .62), sky, *parts, table)


def studio():
    """Returns a picture (PNG) of the surroundings in a photographer's studio: dim walls, three
    bright panels and a window."""
    width, height = 128, 64
    panels = [(.05, .2, .12, .3, (255, 250, 240)), (.38, .53, .06, .2, (255, 255, 255)),
              (.62, .7, .3, .42, (255, 225, 180)), (.8, .95, .16, .36, (190, 215, 255))]
    rows = b""
    for y in range(height):
        rows += b"\0"
        for x in range(width):
            u, v = (x + .5) / width, (y + .5) / height
            grey = int(70 - 30 * v) if v < .5 else int(48 - 24 * v)
            colour = (grey, grey, grey + 4)
            for left, right, top, bottom, bright in panels:
                if left <= u < right and top <= v < bottom:
                    colour = bright
            rows += bytes(colour)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(
            ">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n" +
            chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


SCENES = [
    glass_ball, mirror_corridor, cornell, furnace, caustic, car_paint, carved, interior, headlight,
    board, chess, headlight_studio, car, globe
]
LONG = 250000  # bytes of a file that is packed


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__.strip())
    folder = pathlib.Path(sys.argv[1])
    for make in SCENES:
        text = make().encode()
        if len(text) < LONG:
            (folder / f"{make.__name__}.wrl").write_bytes(text)
        else:
            (folder / f"{make.__name__}.wrz").write_bytes(gzip.compress(text, 9, mtime=0))
    (folder / "studio.png").write_bytes(studio())
    (folder / "globe.png").write_bytes(earth())


if __name__ == "__main__":
    main()
