"""examples/scenes/headlight_studio.wrl: a headlamp on a photographer's table, about 800,000
triangles. Unit: centimetre. The light goes along +z, and the origin is the middle of the reflector.
All large surfaces are Extrusions, so that the file is short: the reflector is a scalloped oval that
grows along the axis, the lens a fluted section that is swept up along an arc."""
import math

from scenes.parts import HEADER, aim, arc, at, lathe, mesh, number, numbers, shader, shape, tube, viewpoint

WIDE, HIGH, DEEP = 8.6, 5.9, 5.2  # half axes of the reflector's rim, and its depth
SECTORS, RINGS = 20, 7  # number of facets around and along
HOLE = .17  # radius of the hole for the bulb, in units of the rim's size
# focal length in the vertical plane; horizontally the light spreads
FOCUS = HIGH * HIGH / (4 * DEEP)


def extrusion(section, spine, scale=(), crease=.3, caps=(False, False), solid=True, convex=True):
    fields = [
        f"beginCap {'TRUE' if caps[0] else 'FALSE'} endCap {'TRUE' if caps[1] else 'FALSE'} solid {'TRUE' if solid else 'FALSE'} "
        f"convex {'TRUE' if convex else 'FALSE'} creaseAngle {number(crease)}",
        "crossSection [ " + ", ".join(numbers(p) for p in section) + " ]",
        "spine [ " + ", ".join(numbers(p) for p in spine) + " ]"
    ]
    if scale:
        fields.append("scale [ " + ", ".join(numbers(s) for s in scale) + " ]")
    return "Extrusion { " + "\n    ".join(fields) + " }"


def superellipse(a, b, power, angle):
    c, s = math.cos(angle), math.sin(angle)
    return a * math.copysign(abs(c)**(2 / power), c), b * math.copysign(abs(s)**(2 / power), s)


def reflector(around=24, along=28):
    """Each facet bulges towards the light in proportion to its size; the ridges between facets stay
    sharp."""
    section = []
    for i in range(SECTORS * around + 1):
        a, t = 2 * math.pi * (i % (SECTORS * around)) / (SECTORS * around), i / around % 1
        bulge = 1 - .016 * (1 - (2 * t - 1)**2)
        x, y = superellipse(WIDE, HIGH, 2.35, a)
        section.append((x * bulge, -y * bulge))
    spine, scale = [], []
    for i in range(RINGS * along + 1):
        t, inside = i / (RINGS * along), i / along % 1
        g = HOLE + (1 - HOLE) * t
        z = DEEP * g * g
        g *= 1 - .022 * (1 - (2 * inside - 1)**2)
        spine.append((0, z, 0))
        scale.append((g, g))
    # Seen from inside, the section runs in the opposite direction.
    return extrusion(section[::-1], spine, scale, .09)


def lens(flute_points=32, rows=290):
    """Returns a domed plate of 4 mm with flutes on the inside, broad ones in the middle."""
    half_wide, half_high, thick = 9.0, 6.3, .42
    dome = 1.25
    front = []
    for i in range(121):
        x = -half_wide + 2 * half_wide * i / 120
        front.append((dome * (1 - (x / half_wide)**2), x))
    edges = [-8.7, -8.3]
    while edges[-1] < 8.65:
        x = edges[-1]
        edges.append(x + (.9 if -3.7 < x + .1 < 3.6 else .55))
    back = []
    for a, b in zip(edges, edges[1:]):
        depth = .085 * (b - a)
        for k in range(flute_points):
            x = a + (b - a) * k / flute_points
            bulge = depth * (1 - (2 * k / flute_points - 1)**2)
            back.append((dome * (1 - (x / half_wide)**2) - thick - bulge + .12, x))
    x = edges[-1]
    back.append((dome * (1 - (x / half_wide)**2) - thick + .12, x))
    loop = front + back[::-1]
    section = [(u, -x) for u, x in loop]
    section.append(section[0])
    spine, scale = [], []
    for i in range(rows + 1):
        y = -half_high + 2 * half_high * i / rows
        spine.append((0, y, -.75 * (y / half_high)**2))
        scale.append((1, (1 - .9995 * abs(y / half_high)**7 * .75)**.5))
    return extrusion(section, spine, scale, .35, (True, True), True, False)


def ring(profile, wide, high, power, steps=160, crease=.5):
    """Returns a profile (outwards, forwards) swept along a rounded rectangle."""
    spine = [(*superellipse(wide, high, power, 2 * math.pi * i / steps), 0) for i in range(steps)]
    return extrusion(profile, spine + spine[:1], (), crease, solid=False)


def plate(z, steps=144):
    """Returns the plate between the rim of the reflector and the bezel."""
    inner = [
        superellipse(WIDE - .02, HIGH - .02, 2.35, 2 * math.pi * i / steps) for i in range(steps)
    ]
    outer = [superellipse(9.35, 6.65, 7, 2 * math.pi * i / steps) for i in range(steps)]
    points = [(x, y, z) for x, y in inner + outer]
    return mesh(points,
                [(i, steps + i, steps + (i + 1) % steps, (i + 1) % steps) for i in range(steps)], 0,
                False)


def bulb():
    """Returns an H4 bulb: a glass tube that is open below, in a metal base. Its axis is z."""
    outer, inner = .82, .74
    glass = ([(outer, -.9)] + [(outer, 2.9)] + arc(0, 2.9, outer, .75, 0, 90, 24)[1:] +
             arc(0, 2.9, inner, .66, 90, 0, 24) + [(inner, -.9), (outer, -.9)])
    cap = [(.86, 2.7), (.86, 2.9)] + arc(0, 2.92, .86, .79, 0, 90, 16)[1:]
    base = [(0, -2.6), (.75, -2.6), (.75, -2.2), (1.05, -2.2), (1.05, -.75), (.62, -.7), (.62, -.2),
            (.5, -.15), (0, -.15)]
    return lathe(glass[::-1], 96, .5, True), lathe(base[::-1], 64, .5,
                                                   True), lathe(cap[::-1], 48, .5)


def filament():
    """Returns a coil of tungsten wire along the axis, around the focus."""
    turns, steps, radius, wire, length = 11, 14, .085, .02, .62
    spine = []
    for i in range(turns * steps + 1):
        a = 2 * math.pi * i / steps
        spine.append(
            (radius * math.cos(a), radius * math.sin(a), length * (i / (turns * steps) - .5)))
    section = [(wire * math.cos(2 * math.pi * i / 6), -wire * math.sin(2 * math.pi * i / 6))
               for i in range(6)]
    return extrusion(section + section[:1], spine, (), 1.2, (True, True))


def post(x):
    points, faces = tube([[(x + .03 * math.cos(a), .03 * math.sin(a), z)
                           for a in (2 * math.pi * i / 8
                                     for i in range(8))]
                          for z in (-.2, FOCUS - .3 if x < 0 else FOCUS + .3)])
    return mesh(points, faces, .9)


def panel(place, target, wide, high, *light):
    w, h = wide / 2, high / 2
    lamp = shader("Diffuse", "diffuse", "color reflectance 0 0 0",
                  "color emission " + numbers(light))
    return at(place,
              shape(lamp, mesh([(-w, -h, 0), (w, -h, 0), (w, h, 0), (-w, h, 0)], [(0, 1, 2, 3)])),
              turn=aim(place, target))


def headlight_studio():
    chrome = "DEF Chrome " + shader("Metal", "metal", "color n 3.1 3.05 2.6", "color k 3.3 3.4 3.2",
                                    "1f roughness .03")
    black = "DEF Black " + shader("Plastic", "plastic", "color color .02 .02 .022",
                                  "1f roughness .22")
    steel = "DEF Steel " + shader("Metal", "metal", "color n 2.9 2.9 2.6", "color k 3.1 3.1 3.0",
                                  "1f roughness .2")
    rim = DEEP + .05
    glass, base, cap = bulb()
    bezel = ([(-.28, 1.05)] + arc(.12, .95, .4, .55, 180, 0, 18)[0:] + [(.52, .2), (.52, -1.1),
                                                                        (.38, -1.1), (.38, .05),
                                                                        (-.05, .3), (-.28, .75),
                                                                        (-.28, 1.05)])
    bucket = [(1, 0), (.97, -1.2), (.86, -3), (.68, -5), (.42, -6.6), (.2, -7.1), (.0, -7.1)]
    outline = [superellipse(9.72, 7.02, 6, 2 * math.pi * i / 120) for i in range(120)]
    housing = extrusion([(x, -y) for x, y in outline + outline[:1]],
                        [(0, z + 5.2, 0) for _, z in bucket[::-1]],
                        [(max(s, .002), max(s, .002)) for s, _ in bucket[::-1]], .6)
    parts = [
        "DEF Reflector " + at(
            (0, 0, 0),
            shape(shader("Reflector", "reflector", "1f lacquer 1.5"), reflector()),
            turn=(1, 0, 0, math.pi / 2)),
        "DEF Lens " + at(
            (0, 0, rim + 1.3),
            shape(shader("Glass", "glass", "1f index 1.52", "color absorption .012 .004 .008"),
                  lens())),
        "DEF Bulb " + shape(shader("Glass", "glass", "1f index 1.47"), glass),
        "DEF Base " + shape(steel, base),
        "DEF Cap " + shape(chrome, cap),
        "DEF Filament " + at((0, 0, FOCUS),
                             shape(
                                 shader("Diffuse", "diffuse", "color reflectance .3 .3 .3",
                                        "color emission 9000 6900 4200"), filament())),
        shape("USE Steel", post(-.14)),
        shape("USE Steel", post(.14)),
        "DEF Mask " + shape(black, plate(rim)),
        "DEF Bezel " + at((0, 0, rim + .4), shape("USE Chrome", ring(bezel, 9.2, 6.5, 6.5))),
        "DEF Housing " + at((0, 0, 0), shape("USE Black", housing), turn=(1, 0, 0, math.pi / 2)),
    ]
    foot = 7.6
    table = shader("Plastic", "plastic", "color color .11 .115 .125", "1f roughness .25")
    wall = shader("Diffuse", "diffuse", "color reflectance .34 .34 .36")
    return HEADER + "\n".join([
        "# A headlamp on a photographer's table, alight. Written by tools/make_scenes.py.",
        'WorldInfo { title "Headlight in the studio" info [ "part of OpenRT\'s examples" ] }',
        'NavigationInfo { type "EXAMINE" headlight FALSE }',
        viewpoint((24, 9, 42),
                  (2.2, -1.2, 4.5), .52, "DEF Front Viewpoint", 'description "Front" '),
        viewpoint((9, 3.5, 24), (.2, 0, 3), .5, "DEF Close Viewpoint", 'description "The lens" '),
        viewpoint((60, 40, 30), (10, 0, 20), .9, "DEF Beam Viewpoint", 'description "The beam" '),
        "Background { skyColor [ .8 .84 .9, .62 .64 .68, .45 .46 .48 ] skyAngle [ .7, 1.57 ] groundColor [ .1 .1 .11, .4 .41 .42 ] groundAngle 1.57 }",
        "DEF Headlight " + at((0, 0, 0), *parts), "DEF Table " + shape(
            table,
            mesh([(-80, -foot, 120), (80, -foot, 120), (80, -foot, -40),
                  (-80, -foot, -40)], [(0, 1, 2, 3)])), "DEF Backdrop " + shape(
                      wall,
                      mesh([(-120, -foot, -40), (120, -foot, -40), (120, 90, -40),
                            (-120, 90, -40)], [(0, 1, 2, 3)])),
        panel((-26, 34, 24), (0, 0, 2), 34, 22, 4, 4.2, 4.5),
        panel((46, 12, 6), (0, 0, 4), 8, 40, 5, 4.9, 4.8)
    ]) + "\n"
