"""The worlds of bench_render.py: some of examples/scenes, and small ones that are written here
because no example asks the same of a renderer. Any other world can be named by its file."""
import dataclasses
import math
import pathlib
import random
import struct

from scenes.parts import (at, box, lathe, mesh, number, numbers, quad, shader, shape, viewpoint,
                          world)

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples/scenes"


@dataclasses.dataclass
class World:
    """One line of the benchmark. The first transport makes the reference, so all transports of a
    world must follow the same light. `mitsuba` says what Mitsuba is measured against: "same" (our
    reference, where every surface has an exact counterpart), "own" (a long render of its own, where
    they differ in small things) or "" (Mitsuba is left out, because it would show other light)."""
    title: str
    transports: tuple
    mitsuba: str = ""
    write: object = None  # function(folder) -> text of a world that is not in examples/scenes


def grey(*reflectance):
    return shader("Diffuse", "diffuse", f"color reflectance {numbers(reflectance)}")


def lamp(*emission):
    return shader("Diffuse", "diffuse", "color reflectance 0 0 0",
                  f"color emission {numbers(emission)}")


def forest(folder):
    """400 instances of one tree of 1,200 leaves in front of a sky."""
    rng = random.Random(17)
    points, faces = [], []
    for leaf in range(1200):
        height = rng.uniform(0.7, 4)
        angle, reach = rng.uniform(0, 2 * math.pi), math.sqrt(rng.random()) * (4.1 - height) / 3
        middle = (reach * math.cos(angle), height, reach * math.sin(angle))
        for corner in range(3):
            points.append(tuple(m + rng.uniform(-0.14, 0.14) for m in middle))
        faces.append((3 * leaf, 3 * leaf + 1, 3 * leaf + 2))
    tree = shape(grey(.2, .45, .1), mesh(points, faces, solid=False))
    trees = []
    for k in range(400):
        place = (2.4 * (k % 20) - 24 + rng.uniform(-.8, .8), 0,
                 2.4 * (k // 20) - 40 + rng.uniform(-.8, .8))
        node = "USE Tree" if trees else f"DEF Tree ORTInstance {{ children {tree} }}"
        trees.append(at(place, node, turn=(0, 1, 0, rng.uniform(0, 6.28))))
    ground = quad((-60, 0, 60), (60, 0, 60), (60, 0, -60), (-60, 0, -60))
    return world(
        "Forest", viewpoint((2, 7, 22), (0, 1, -8), 0.7),
        "Background { skyColor [ .3 .5 .9, .8 .85 .9 ] skyAngle 1.5707963 "
        "groundColor [ .2 .2 .15 ] }", shape(grey(.35, .3, .2), ground), *trees)


def glossy(folder):
    """Metal plates from nearly polished to rough under lamps from small to large (after Veach and
    Guibas 1995): neither light samples nor BSDF samples alone are enough."""
    parts = [shape(grey(.4, .4, .4), quad((-9, -.4, 6), (9, -.4, 6), (9, -.4, -6), (-9, -.4, -6)))]
    for k, roughness in enumerate((.02, .06, .15, .3)):
        plate = shape(shader("Metal", "metal", f"1f roughness {roughness}"), box(7, .06, 1.1))
        parts.append(at((0, .25 * (3 - k)**1.3, 2.2 - 1.5 * (3 - k)), plate,
                        turn=(1, 0, 0, .5 - .1 * k)))  # yapf: disable
    for k, radius in enumerate((.04, .14, .4, .9)):
        light = lamp(*(3 / radius**2 for _ in range(3)))
        parts.append(at((2.1 * k - 3.2, 3.6, -3.4), shape(light, f"Sphere {{ radius {radius} }}")))
    return world("Glossy plates", viewpoint((0, 2.6, 10), (0, .9, -1), .6), *parts)


def screen(folder):
    """A room that is lit only by a screen with a picture: emission that varies."""
    rng = random.Random(5)
    colours = (f"0x{rng.randbytes(3).hex()}" for _ in range(64))
    picture = ('ORTAppearance { shader ORTShader { name "GlobalIllumination" file "vrml97" '
               'options "1i lit 0" } '
               f"texture PixelTexture {{ image 8 8 3 {' '.join(colours)} }} }}")
    wall = "DEF Wall " + grey(.8, .78, .75)
    return world(
        "Lit by a screen", viewpoint((0, 1.6, 4.2), (0, 1.1, -1), .9),
        at((0, 1.6, -1.9), shape(picture, quad((-2.4, -1.2, 0), (2.4, -1.2, 0), (2.4, 1.2, 0),
                                               (-2.4, 1.2, 0), True))),
        shape(wall, quad((-3, 0, -2), (3, 0, -2), (3, 3, -2), (-3, 3, -2))),
        *(shape("USE Wall", quad(*corners)) for corners in (
            ((-3, 0, 5), (3, 0, 5), (3, 0, -2), (-3, 0, -2)),
            ((-3, 3, -2), (3, 3, -2), (3, 3, 5), (-3, 3, 5)),
            ((-3, 0, 5), (-3, 0, -2), (-3, 3, -2), (-3, 3, 5)),
            ((3, 0, -2), (3, 0, 5), (3, 3, 5), (3, 3, -2)))),
        at((-.9, .5, .2), shape(grey(.7, .2, .15), "Sphere { radius .5 }")),
        at((.9, .4, .4), shape(shader("Metal", "metal", "1f roughness .2"), box(.8, .8, .8)),
           turn=(0, 1, 0, .5)))  # yapf: disable


def sky(path, width=128, height=64):
    """Writes a sky with a low sun of 2 x 2 pixels over a dark ground."""
    values = []
    for row in range(height):  # from the bottom up
        up = math.sin(math.pi * ((row + .5) / height - .5))
        colour = (.25, .38, .7) if up > 0 else (.05, .05, .04)
        values += [c * (1.6 - up) if up > 0 else c for c in colour] * width
    for row, column in ((42, 88), (42, 89), (43, 88), (43, 89)):
        start = 3 * (row * width + column)
        values[start:start + 3] = (900, 700, 450)
    path.write_bytes(f"PF\n{width} {height}\n-1.0\n".encode() +
                     struct.pack(f"<{len(values)}f", *values))


def dusk(folder):
    """Hills, posts and a shed under a sky with a sun, and two lamps: light samples are shared
    between sky and emitters."""
    sky(folder / "dusk_sky.pfm")
    heights = (number(.5 * math.sin(.9 * (i % 32)) * math.cos(.7 * (i // 32)) + .04 * (i % 5))
               for i in range(32 * 32))
    hills = ("ElevationGrid { xDimension 32 zDimension 32 xSpacing .7 zSpacing .7 solid FALSE "
             f"creaseAngle 1 height [ {' '.join(heights)} ] }}")
    posts = [
        at((1.7 * k - 6, 1, -1.5 - k % 3), shape(grey(.5, .3, .2), box(.15, 2.4, .15)))
        for k in range(8)
    ]
    dome = lathe([(1.2, 0), (1.1, .6), (.7, 1), (.05, 1.2)], steps=24, up=True)
    return world(
        "Dusk", viewpoint((0, 2.6, 9), (0, .6, 0), .7),
        'ORTBackground { shader ORTShader { name "EnvironmentMap" file "environmentmap" '
        'options "texture texture dusk_sky.pfm" } }',
        at((-11, 0, -14), shape(grey(.3, .35, .2), hills)),
        at((1.6, .3, 2), shape(grey(.6, .6, .6), dome)),
        at((1.6, .7, 2), shape(lamp(40, 28, 12), "Sphere { radius .12 }")),
        at((-1.5, .8, 3.6), shape(lamp(20, 14, 6), "Sphere { radius .08 }")), *posts)


def caustic_even(folder):
    """The example caustic without dispersion, which Mitsuba's glass does not have."""
    return (EXAMPLES / "caustic.wrl").read_text().replace(' "1f abbe 35"', "")


WORLDS = {
    "cornell": World("Cornell box", ("path", "light"), "same"),
    "headlight": World("Headlight: mirror and lens", ("light", "path"), "same"),
    "interior": World("Interior lit through glass", ("light", "path"), "same"),
    "board": World("Circuit board under an environment", ("path",), "own"),
    "caustic": World("Caustics, with dispersion", ("light", "path")),
    "caustic_even": World("Caustics, without dispersion", ("light", "path"), "same", caustic_even),
    "still_life": World("Still life: direct light of lamps", ("direct",)),
    "car_paint": World("Car paint: flakes, coat, sky, sun", ("path",)),
    "globe": World("Globe: wood, brass, a window", ("path",)),
    "forest": World("Forest: 400 instances under a sky", ("path",), "same", forest),
    "glossy": World("Glossy plates, lamps of four sizes", ("path",), "own", glossy),
    "screen": World("Room lit by a picture", ("path",), "", screen),
    "dusk": World("Dusk: sun, sky and lamps", ("path",), "own", dusk),
}


def find(name, folder):
    """Returns the short name, the World and the file of a name in WORLDS or of a file. A written
    world goes to the folder."""
    if name in WORLDS:
        entry = WORLDS[name]
        if entry.write is None:
            return name, entry, EXAMPLES / f"{name}.wrl"
        folder.mkdir(parents=True, exist_ok=True)
        file = folder / f"{name}.wrl"
        file.write_text(entry.write(folder))
        return name, entry, file
    file = pathlib.Path(name).resolve()
    if not file.is_file():
        raise SystemExit(f"bench_render.py: {name} is neither a file nor one of {' '.join(WORLDS)}")
    return file.stem, World(file.stem, ("auto",)), file
