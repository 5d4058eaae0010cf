"""examples/scenes/globe.wrl: a globe that turns under a moving lamp. Both, and a camera, follow
paths of many keys, as design programs export them. One loop takes 8 seconds, at 30 pictures per
second."""
import math

from scenes.parts import HEADER, arc, at, box, curve, lathe, mesh, number, numbers, shader, shape, viewpoint

ROUND, KEYS = 8, 96
CENTRE = (0, 2.65, 0)
# Positions of the lamp at equal time steps; the path is closed.
LAMP = [(-3.0, 4.7, 1.2), (-2.0, 4.9, 2.2), (.1, 5.1, 2.7), (2.1, 4.8, 2.2), (3.1, 4.3, 1.1),
        (2.3, 4.5, 2.0), (.3, 4.95, 2.6), (-1.9, 4.8, 2.1)]
CAMERA = [(0, 3.5, 11.4), (2.6, 3.9, 10.8), (4.2, 4.6, 9.4), (3.0, 4.0, 10.6), (0, 3.5, 11.4),
          (-2.8, 3.1, 10.8), (-4.0, 2.8, 9.8), (-2.6, 3.1, 10.9)]


def closed(points, count):
    """Returns this many points, and the first one again, along a smooth closed curve through the
    given points."""
    n, line = len(points), []
    for k in range(count + 1):
        position = (k % count) / count * n
        i, t = int(position), position - int(position)
        p, q, r, s = (points[(i + d) % n] for d in (-1, 0, 1, 2))
        line.append(
            tuple(b + t / 2 * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))
                  for a, b, c, d in zip(p, q, r, s)))
    return line


def turn_of(position, target):
    """Returns the rotation of a Viewpoint as four numbers."""
    text = viewpoint(position, target, .5)
    words = text.split("orientation ")[1].split(" fieldOfView")[0].split()
    return tuple(float(w) for w in words)


def keys(values, kind, name):
    n = len(values) - 1
    return (f"DEF {name} {kind} {{\n  key [ {' '.join(number(i / n) for i in range(n + 1))} ]\n"
            f"  keyValue [ {', '.join(numbers(v) for v in values)} ]\n}}")


def lit(diffuse, specular=None, shininess=.3, extra=""):
    """Returns an appearance whose default shader is the one for global illumination."""
    spec = f" specularColor {numbers(specular)} shininess {number(shininess)}" if specular else ""
    return f"ORTAppearance {{ material Material {{ diffuseColor {numbers(diffuse)}{spec} }} {extra}shader USE Light_From_All_Sides }}"


def book(length, height, depth, colour, page=(.86, .8, .68)):
    cover = lit(colour, (.1, .1, .1), .3)
    t = .035
    return "Group { children [\n  " + "\n  ".join([
        at((0, height - t / 2, 0), shape(cover, box(length, t, depth))),
        at((0, t / 2, 0), shape(cover, box(length, t, depth))),
        at((-length / 2 + t / 2, height / 2, 0), shape(cover, box(t, height - 2.02 * t, depth))),
        at((.01, height / 2, 0), shape(lit(page), box(length - .1, height - 2.02 * t, depth - .1)))
    ]) + " ] }"


def globe():
    foot = [(0, 0)] + [(1.1, 0)] + arc(1.1, .07, .05, .07, -90, 90, 8)[1:] + [(1.02, .15)] + \
        curve([(.98, .19), (.6, .27), (.3, .40), (.17, .62), (.14, .78)], 5) + arc(.11, .82, .07, .05, -60, 90, 6) + [(0, .88)]
    ring = [(1.70 + .05 * math.cos(a), .085 * math.sin(a))
            for a in (2 * math.pi * i / 12 for i in range(13))]
    brass = "DEF Brass " + shader("Metal", "metal", "color n .45 .62 1.15", "color k 3.6 2.6 2.0",
                                  "1f roughness .18")
    walnut = shader("Wood", "wood", "3f axis 0 1 .1", "3f pith .5 0 .3", "1f rings 9",
                    "color light .26 .12 .06", "color dark .10 .04 .018", "1f varnish 1.5")
    table = shader("Wood", "wood", "3f axis 1 .02 .07", "3f pith 0 -3.4 1.2", "1f rings 2.4",
                   "color light .56 .33 .16", "color dark .30 .15 .06", "1f wobble .9",
                   "1f grain .45", "1f varnish 1.45")
    shade_out = [(.16, .30), (.20, .28), (.30, .12), (.62, -.28), (.64, -.30)]
    shade_in = [(.61, -.29), (.29, .10), (.16, .22), (0, .24)]
    bulb = 'DEF Bulb ' + shape(
        shader("Diffuse", "diffuse", "color reflectance 0 0 0", "color emission 400 335 245"),
        "Sphere { radius .28 }")
    path, ride = closed(LAMP, KEYS), closed(CAMERA, KEYS)
    goal = (CENTRE[0], CENTRE[1] - .5, CENTRE[2] + .3)
    aims = []
    for p in path:  # the lamp's -y points at the globe
        x, y, z = (b - a for a, b in zip(p, goal))
        length = math.sqrt(x * x + y * y + z * z)
        flat = math.hypot(x, z)
        aims.append((-z / flat, 0, x / flat, math.acos(-y / length)))
    spin = [(0, 1, 0, 2 * math.pi * i / 32) for i in range(33)]
    rides = [turn_of(p, (0, 2.55, 0)) for p in ride]
    rotated = lambda rotation, *children: f"Transform {{ rotation {numbers(rotation)} children [\n  " + "\n  ".join(
        children) + " ] }"
    return HEADER + "\n".join([
        "# A globe that turns, lit by a lamp that travels on a path. 8 seconds are one round: vv globe.wrl --frames 0-239 -o globe.mp4",
        "# Written by tools/make_scenes.py; globe.png is a map drawn for this file.",
        'WorldInfo { title "Globe" info [ "part of OpenRT\'s examples" ] }',
        'NavigationInfo { headlight FALSE type "EXAMINE" }',
        "Background { skyColor .05 .06 .08 }",
        viewpoint((0, 3.5, 11.4), (0, 2.55, 0), .52, "DEF Front Viewpoint", 'description "Front" '),
        viewpoint((5.4, 5.6, 7.6),
                  (0, 2.2, 0), .5, "DEF Above Viewpoint", 'description "From above" '),
        viewpoint(CAMERA[0], (0, 2.55, 0), .52, "DEF Ride Viewpoint", 'description "Ride" '),
        "# The shader that surfaces have unless another is said.",
        'Switch { choice Shape { appearance ORTAppearance { shader DEF Light_From_All_Sides ORTShader { name "GlobalIllumination" } } } }',
        at((0, -.15, 0), "DEF Table " + shape(table, box(24, .3, 12))),
        at((0, 5, -4.2), "DEF Wall " + shape(lit((.74, .69, .58)), box(30, 16, .2))),
        at((-13, 4, 2), "DEF Window " +
           shape(shader("Diffuse", "diffuse", "color reflectance 0 0 0", "color emission 6 8 11"),
                 mesh([(0, -3, 3), (0, -3, -3), (0, 3, -3), (0, 3, 3)], [(0, 1, 2, 3)]))),
        "DEF Stand Group { children [",
        shape(walnut, lathe(foot[::-1], 64, .5, True, True)),
        at((0, .93, 0), shape(brass, "Cylinder { radius .09 height .22 }")),
        at(CENTRE, shape("USE Brass", lathe(ring, 96, 1.5))),
        "] }",
        at(CENTRE,
           shape("USE Brass", "Cylinder { radius .035 height 3.46 }"),
           *(at((0, y, 0), shape("USE Brass", "Sphere { radius .085 }")) for y in (1.80, -1.80)),
           "DEF Earth Transform { children " +
           shape(lit((1, 1, 1), (.16, .16, .17), .5, 'texture ImageTexture { url "globe.png" } '),
                 "DEF Ball Sphere { radius 1.52 }") + " }",
           turn=(0, 0, 1, -.4084)),
        "# Books.",
        at((3.5, 0, -1.5), rotated((0, 1, 0, .35), book(2.5, .36, 1.8, (.45, .07, .06)))),
        at((3.45, .362, -1.5), rotated((0, 1, 0, .12), book(2.2, .28, 1.6, (.08, .20, .16)))),
        at((3.4, .644, -1.45), rotated((0, 1, 0, .5), book(1.9, .22, 1.35, (.68, .50, .16)))),
        "# The lamp, on its cord.",
        f"DEF Lamp Transform {{ translation {numbers(path[0])} children [",
        at((0, 4.35, 0), shape(lit((.05, .05, .05)), "Cylinder { radius .018 height 8 }")),
        f"  DEF Shade Transform {{ rotation {numbers(aims[0])} children [",
        "  " + shape(lit((.03, .16, .12), (.3, .3, .3), .6), lathe(shade_out, 48, .5, False, True)),
        "  " + shape(lit((.05, .048, .045)), lathe(shade_in, 48, .5, False, True)),
        at((0, .30, 0), shape("USE Brass", "Sphere { radius .16 }")),
        at((0, -.22, 0), bulb),
        "] } ] }",
        f"DEF Day TimeSensor {{ cycleInterval {ROUND} loop TRUE }}",
        keys(spin, "OrientationInterpolator", "Spin"),
        keys(path, "PositionInterpolator", "Lamp_Path"),
        keys(aims, "OrientationInterpolator", "Lamp_Aim"),
        keys(ride, "PositionInterpolator", "Ride_Path"),
        keys(rides, "OrientationInterpolator", "Ride_Aim"),
        *(f"ROUTE Day.fraction_changed TO {name}.set_fraction"
          for name in ("Spin", "Lamp_Path", "Lamp_Aim", "Ride_Path", "Ride_Aim")),
        "ROUTE Spin.value_changed TO Earth.set_rotation",
        "ROUTE Lamp_Path.value_changed TO Lamp.set_translation",
        "ROUTE Lamp_Aim.value_changed TO Shade.set_rotation",
        "ROUTE Ride_Path.value_changed TO Ride.set_position",
        "ROUTE Ride_Aim.value_changed TO Ride.set_orientation",
    ]) + "\n"
