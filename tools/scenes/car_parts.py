"""The car's parts: wheels, lamps, mirrors, chrome, the cabin, and the studio around it."""
import math

from scenes.car_body import ARCH, AXLES, HUB, cross, surface, unit
from scenes.parts import aim, arc, at, box, curve, lathe, mesh, numbers, shader, shape, tube


def panel(place, target, wide, high, *light):
    w, h = wide / 2, high / 2
    lamp = shader("Diffuse", "diffuse", "color reflectance 0 0 0",
                  "color emission " + numbers(light))
    return at(place,
              shape(lamp, mesh([(-w, -h, 0), (w, -h, 0), (w, h, 0), (-w, h, 0)], [(0, 1, 2, 3)])),
              turn=aim(place, target))


def studio():
    floor = shader("Plastic", "plastic", "color color .42 .43 .45", "1f roughness .2")
    return [
        "Background { skyColor [ .30 .32 .35, .42 .44 .47, .62 .64 .67 ] skyAngle [ 1.1, 1.57 ] groundColor [ .1 .1 .1, .3 .31 .33 ] "
        "groundAngle 1.57 }",
        "DEF Floor " + shape(
            floor,
            lathe([(0, 0),
                   (9, 0)] + arc(9, 4, 4, 4, -90, 0, 12)[1:] + [(13, 9)], 64, .5, False, True)),
        panel((-.2, 4.6, -1.0), (-.19, 0, -.6), 7, 3, 8, 8, 8.2),
        panel((1.5, 2.2, 8), (0, .6, 0), 7, 1.2, 5, 5, 5.1),
        panel((8, 2.4, -3), (0, .5, 0), 1.4, 4, 5, 5.1, 5.4),
    ]


def oval(a, b, c, power=2.6, columns=18, rows=9):
    """Returns a cushion: an ellipsoid that is almost a box."""

    def soft(v):
        return math.copysign(abs(v)**(2 / power), v)

    rings = []
    for k in range(1, rows):
        t = -math.pi / 2 + math.pi * k / rows
        rings.append([(a * soft(math.cos(t)) * soft(math.cos(p)), b * soft(math.sin(t)),
                       -c * soft(math.cos(t)) * soft(math.sin(p)))
                      for p in (2 * math.pi * i / columns for i in range(columns))])
    return mesh(*tube(rings), 1.3)


def bead(path, wide, high, closed=False, sides=8):
    """Returns a bar with an oval section along a path; the wide side is horizontal."""
    rows = []
    for i, p in enumerate(path):
        before, after = path[i - 1 if i or closed else i], path[(i + 1) % len(path) if i +
                                                                1 < len(path) or closed else i]
        along = unit(tuple(a - b for a, b in zip(after, before)))
        out = unit(cross(along, (0, 1, 0)) if abs(along[1]) < .99 else (0, 0, 1))
        up = cross(out, along)
        rows.append([
            tuple(c + wide * math.cos(a) * o + high * math.sin(a) * u
                  for c, o, u in zip(p, out, up))
            for a in (2 * math.pi * k / sides for k in range(sides))
        ])
    if closed:
        rows.append(rows[0])
    points, faces = tube(rows, caps=not closed)
    return mesh(points, [f[::-1] for f in faces], 1.2, False)


def ribbon(samples, half):
    """Returns a line on the skin; its points have normals."""
    points, normals = [], []
    for i, (p, n) in enumerate(samples):
        q, o = samples[min(i + 1, len(samples) - 1)][0], samples[max(i - 1, 0)][0]
        across = unit(cross(n, tuple(a - b for a, b in zip(q, o))))
        for s in (-half, half):
            points.append(tuple(c + .0012 * m + s * w for c, m, w in zip(p, n, across)))
            normals.append(n)
    return surface(points, normals,
                   [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(samples) - 1)])


def wheel():
    tread = []
    for z in (-.062, -.03, .002, .034):
        tread += [(.325, z), (.325, z + .023), (.317, z + .025), (.317, z + .03)]
    tyre = ([(.204, -.088)] + curve([(.212, -.098), (.25, -.104), (.29, -.1), (.316, -.083),
                                     (.325, -.066)], 3) + tread + curve([(.325, .066), (.316, .083),
                                                                         (.29, .1), (.25, .104),
                                                                         (.212, .098)], 3) +
            [(.204, .088), (.204, -.088)])
    rim = [(.204, -.09), (.186, -.085), (.182, .06), (.19, .078), (.2, .084), (.206, .096),
           (.212, .096), (.206, .088), (.204, .08)]
    disc = [(.0, .0), (.148, .0), (.148, -.012), (.0, -.012)]
    hub = [(0, .084)] + arc(0, .066, .042, .018, 90, 0, 8)[1:] + [(.055, .06), (.06, .045),
                                                                  (.06, .0)]
    rows = []
    for f in range(7):
        r = .045 + (.192 - .045) * f / 6
        wide, deep, z = .021 - .006 * math.sin(math.pi * f / 6), .012, .05 + .022 * (f / 6)**2
        rows.append([(r, wide * math.copysign(abs(math.cos(a))**.6, math.cos(a)),
                      z + deep * math.copysign(abs(math.sin(a))**.6, math.sin(a)))
                     for a in (2 * math.pi * k / 12 for k in range(12))])
    points, faces = tube(rows)
    spoke = "DEF Spoke " + shape("USE Alloy", mesh(points, faces, .8, False))
    rubber = shader("Plastic", "plastic", "color color .022 .022 .023", "1f roughness .35")
    alloy = "DEF Alloy " + shader("Metal", "metal", "1f roughness .16")
    steel = shader("Metal", "metal", "color n 2.9 2.9 2.6", "color k 3.1 3.1 3.0",
                   "1f roughness .3")
    parts = [
        shape(rubber, lathe(tyre, 72, .5)),
        shape(alloy, lathe(rim, 72, .5)),
        shape(steel, lathe(disc, 48, .5)),
        shape("USE Alloy", lathe(hub, 32, .5))
    ]
    for i in range(10):
        parts.append(
            at((0, 0, 0), spoke if i == 0 else "USE Spoke", turn=(0, 0, 1, 2 * math.pi * i / 10)))
    return "Group { children [\n  " + "\n  ".join(parts) + " ] }"


def wheels():
    result = []
    for i, (x, side) in enumerate([(AXLES[0], 1), (AXLES[1], 1), (AXLES[0], -1), (AXLES[1], -1)]):
        result.append(
            at((x, HUB, .742 * side),
               "USE Wheel" if i else "DEF Wheel " + wheel(),
               turn=(0, 1, 0, 0 if side > 0 else math.pi)))
        angles = [math.radians(-20 + 220 * k / 30) for k in range(31)]
        points = [(x + (ARCH + .004) * math.cos(a), HUB + (ARCH + .004) * math.sin(a), z * side)
                  for a in angles
                  for z in (.45, .83)]
        result.append(
            shape(
                "USE Black",
                mesh(points, [(2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2) for k in range(30)], 1,
                     False)))
    result.append(at((0, .27, 0), shape("USE Black", box(3.6, .14, 1.25))))
    result.append(at((0, .235, 0), shape("USE Black", box(1.9, .1, 1.5))))
    return result


def lamp():
    """Returns a round headlamp that faces +z."""
    ring = [(.076, .012), (.082, .03), (.092, .03), (.099, .018), (.099, -.12), (.08, -.12),
            (.076, .012)]
    bowl = [(r, -.030 + r * r / .19) for r in (.014 + .062 * i / 16 for i in range(17))]
    lens = [(0, .034)] + [(.078 * i / 12, .034 - .026 * (i / 12) ** 2) for i in range(1, 13)] + [(.078, .002)] + \
        [(.078 * i / 12, .028 - .026 * (i / 12) ** 2) for i in range(12, -1, -1)]
    return "DEF Headlamp Group { children [\n  " + "\n  ".join([
        shape("USE Chrome", lathe(ring, 48, .4)),
        shape(shader("Reflector", "reflector"), lathe(bowl, 48, 1)),
        at((0, 0, -.012), shape("USE Chrome", "Sphere { radius .011 }")),
        shape("USE Pane", lathe(lens, 48, .5, True))
    ]) + " ] }"


def mirrors(skin):
    """Returns two mirrors outside, on stalks, and one inside; all are aimed so that the driver
    looks back."""
    eye, result = (-.42, 1.13, -.34), []
    glass = shader("Mirror", "mirror", "3f reflectance .88 .9 .9")
    shell = []
    for k in range(7):
        a = math.pi / 2 * k / 7
        shell.append([
            (.085 * math.cos(a) * c, .056 * math.cos(a) * s, .06 * math.sin(a)) for c, s in ((
                math.cos(p), math.sin(p)) for p in (2 * math.pi * i / 20 for i in range(20)))
        ])
    points, faces = tube(shell)
    plate = [(.079 * math.cos(p), .050 * math.sin(p), -.002)
             for p in (2 * math.pi * i / 32 for i in range(32))]
    case = shape("USE Chrome", mesh(points, faces, 1.2, False))
    face = "DEF Outside_Mirror " + shape(glass, mesh(plate, [tuple(range(31, -1, -1))], 0, False))
    for side in (1, -1):
        place = (.36, .985, .935 * side)
        to_eye, back = unit(tuple(e - p for e, p in zip(eye, place))), unit((-1, .0, .12 * side))
        normal = unit(tuple(a + b for a, b in zip(to_eye, back)))
        turn = aim((0, 0, 0), tuple(-c for c in normal))
        result.append(
            at(place, ("DEF Mirror_Case " + case) if side > 0 else "USE Mirror_Case",
               face if side > 0 else "USE Outside_Mirror",
               turn=turn))
        foot = skin.side(.44, .845)[0]
        result.append(
            shape(
                "USE Chrome",
                bead(
                    curve([(foot[0], foot[1] - .01, foot[2] * side), (.41, .9, .895 * side),
                           (.365, .955, .93 * side)], 4), .014, .012)))
    place = (.40, 1.15, 0)
    to_eye = unit(tuple(e - p for e, p in zip(eye, place)))
    normal = unit(tuple(a + b for a, b in zip(to_eye, (-1, -.02, 0))))
    inner = [(.115 * math.copysign(abs(math.cos(p))**.5, math.cos(p)),
              .033 * math.copysign(abs(math.sin(p))**.5, math.sin(p)), -.0125)
             for p in (2 * math.pi * i / 32 for i in range(32))]
    result.append(
        at(place,
           shape("USE Black", oval(.125, .041, .012, 5)),
           "DEF Inner_Mirror " + shape(glass, mesh(inner, [tuple(range(31, -1, -1))], 0, False)),
           turn=aim((0, 0, 0), tuple(-c for c in normal))))
    result.append(
        shape("USE Black", bead([(.412, 1.15, 0), (.43, 1.18, 0), (.40, 1.225, 0)], .008, .008)))
    return result


def cabin(skin, house):
    dark = "DEF Trim " + shader("Plastic", "plastic", "color color .03 .028 .027",
                                "1f roughness .4")
    leather = "DEF Leather " + shader("Plastic", "plastic", "color color .30 .15 .075",
                                      "1f roughness .3")
    rows = []
    middle, length, width, power = house.BASE
    for inset, depth in ((.03, None), (.10, None), (.12, .6), (.14, .3)):
        ring = []
        for i in range(64):
            x, z = house.outline((middle, length - inset, width - inset, power),
                                 2 * math.pi * i / 64 if i <= 32 else 2 * math.pi * (64 - i) / 64)
            y = depth if depth is not None else skin.deck(x, z) + .004
            ring.append((x, y, z if i <= 32 else -z))
        rows.append(ring)
    points, faces = tube(rows, caps=False)
    faces.append(tuple(192 + i for i in range(64)))
    parts = [
        shape(dark, mesh(points, faces, .5, False)),
        at((.52, .86, 0), shape("USE Trim", oval(.24, .085, .60, 4))),
        at((.36, .90, -.34), shape("USE Trim", oval(.10, .055, .19, 3)))
    ]
    for i, z in enumerate((.34, -.34)):
        seat = [
            at((-.18, .50, 0), shape("USE Leather" if i else leather, oval(.29, .10, .25, 3.5))),
            at((-.52, .76, 0),
               shape("USE Leather", oval(.085, .32, .235, 3.2)),
               turn=(0, 0, 1, .26)),
            at((-.635, 1.10, 0),
               shape("USE Leather", oval(.045, .075, .12, 3.2)),
               turn=(0, 0, 1, .2))
        ]
        parts.append(
            at((0, 0, z),
               *([f"DEF Seat Group {{ children [ {' '.join(seat)} ] }}"]
                 if i == 0 else ["USE Seat"])))
    parts.append(at((-1.0, .52, 0), shape("USE Leather", oval(.2, .1, .55, 4))))
    parts.append(
        at((-1.18, .76, 0), shape("USE Leather", oval(.09, .22, .55, 4)), turn=(0, 0, 1, .4)))
    rim = [(.185 * math.cos(a), .185 * math.sin(a), 0)
           for a in (2 * math.pi * i / 40 for i in range(40))]
    spokes = [
        shape("USE Alloy", box(.36, .022, .006)),
        at((0, -.09, 0), shape("USE Alloy", box(.022, .18, .006)))
    ]
    parts.append(
        at((.16, .90, -.34),
           shape(
               "USE Trim",
               lathe([(.185 + .013 * math.cos(a), .013 * math.sin(a))
                      for a in (2 * math.pi * k / 10 for k in range(11))], 48, 2)),
           *spokes,
           "Shape { appearance USE Trim geometry Sphere { radius .035 } }",
           turn=(*unit((-.25, -1, 0)), math.pi / 2)) if rim else "")
    return parts


def lines(skin):
    """Returns the gaps of doors, bonnet and boot, drawn on the skin."""

    def flank(points):
        return [skin.side(*p) for p in points]

    def across(x, bend, half):
        samples = []
        for i in range(17):
            z = half * i / 16
            u = skin.u_of(x - bend * (z / half)**2)
            samples.append(skin.at(u, skin.v_of(u, 2, z, .62, 1.0)))
        return samples

    def along(start, end, z0, z1):
        samples = []
        for i in range(25):
            f = i / 24
            u = skin.u_of(start + (end - start) * f)
            samples.append(skin.at(u, skin.v_of(u, 2, z0 + (z1 - z0) * f, .62, 1.0)))
        return samples

    gaps = [
        flank([(.60 - .06 * math.sin(math.pi * i / 20), .235 + (.855 - .235) * i / 20)
               for i in range(21)]),
        flank([(-.62 - .05 * (i / 20)**3, .235 + (.872 - .235) * i / 20) for i in range(21)]),
        flank([(.60 - 1.22 * i / 24, .235) for i in range(25)]),
        across(.86, .10, .70),
        along(.76, 2.18, .70, .57),
        across(2.18, .04, .57),
        across(-1.64, -.05, .66),
        along(-1.59, -2.16, .66, .58)
    ]
    return gaps


def all_parts(skin, house):
    chrome = "DEF Chrome " + shader("Metal", "metal", "color n 3.1 3.05 2.6", "color k 3.3 3.4 3.2",
                                    "1f roughness .02")
    black = "DEF Black " + shader("Diffuse", "diffuse", "color reflectance .018 .018 .02")
    parts = [
        "DEF Wheels Group { children [", "Switch { choice [ " + shape(black, "Sphere { }") + " " +
        shape(chrome, "Sphere { }") + " ] }", *wheels(), "] }"
    ]
    gaps = lines(skin)
    for side in (1, -1):
        for samples in gaps:
            mirrored = [((p[0], p[1], p[2] * side), (n[0], n[1], n[2] * side)) for p, n in samples]
            parts.append(shape("USE Black", ribbon(mirrored, .0028)))
        for x in AXLES:  # lips of the arches
            path = []
            for k in range(37):
                a = math.radians(-11 + 202 * k / 36)
                p, n = skin.side(x + ARCH * math.cos(a), HUB + ARCH * math.sin(a))
                path.append((p[0], p[1], (p[2] - .002) * side))
            parts.append(shape("USE Paint", bead(path, .011, .011, False, 6)))
        belt = [
            tuple(c * s
                  for c, s in zip(house.at(i, .02), (1, 1, side)))
            for i in range(0, len(house.columns), 2)
        ]
        parts.append(shape("USE Chrome", bead(belt, .006, .008)))
        p, n = skin.side(-.48, .73)
        parts.append(
            at((p[0], p[1], (p[2] + .016) * side), shape("USE Chrome", oval(.085, .011, .010, 4))))
        parts.append(
            at((2.342, .575, .615 * side),
               lamp() if side > 0 else "USE Headlamp",
               turn=(0, 1, 0, math.pi / 2 - .10 * side)))
        parts.append(
            at((2.23, .415, .56 * side),
               shape(shader("Plastic", "plastic", "color color .75 .28 .03", "1f roughness .1"),
                     oval(.03, .022, .07, 4)),
               turn=(0, 1, 0, .5 * side)))
        parts.append(
            at((-2.255, .66, .54 * side),
               shape(shader("Plastic", "plastic", "color color .5 .012 .012", "1f roughness .05"),
                     oval(.035, .05, .13, 5)),
               turn=(0, 1, 0, -.35 * side)))
    for u, x in ((0.0, 2.322), (1.0, -2.322)):  # nose and tail
        rim = [skin.at(u, k / 28)[0] for k in range(29)]
        rim = rim + [(a, b, -c) for a, b, c in rim[-2::-1]]
        low, high = rim[0][1], rim[28][1]
        middle = (x, (low + high) / 2, 0)
        rows = []
        for f in (0, .04, .15, .5, .9):
            rows.append([
                tuple(p + (m - p) * (f if a != 0 else min(1, 4 * f)) * (1 if a != 2 else .96)
                      for a, (p, m) in enumerate(zip(q, middle)))
                for q in rim
            ])
        points, faces = tube(rows, closed_rings=True, caps=True)
        parts.append(shape("USE Paint", mesh(points, faces, .9, False)))
    loop = [(2.332, .545 + .062 * math.copysign(abs(math.sin(a))**.4, math.sin(a)),
             .36 * math.copysign(abs(math.cos(a))**.4, math.cos(a)))
            for a in (2 * math.pi * i / 64 for i in range(64))]
    parts.append(
        shape("USE Black",
              mesh([(2.328, y, z) for _, y, z in loop], [tuple(range(63, -1, -1))], 0, False)))
    parts.append(shape("USE Chrome", bead(loop, .007, .007, True)))
    parts += [
        at((2.332, .545 + .023 * k, 0), shape("USE Chrome", box(.006, .005, .70)))
        for k in (-2, -1, 0, 1, 2)
    ]
    parts.append(at((2.336, .545, 0), shape("USE Chrome", box(.01, .112, .02))))
    for y, plan in ((.385, [(1.80, .852), (2.08, .818), (2.25, .73), (2.35, .55), (2.392, .3),
                            (2.402, 0)]), (.455, [(-1.80, .868), (-2.08, .83), (-2.26, .735),
                                                  (-2.355, .55), (-2.392, .3), (-2.402, 0)])):
        half = curve(plan, 4)
        path = [(x, y, z) for x, z in half] + [(x, y, -z) for x, z in half[-2::-1]]
        parts.append(shape("USE Chrome", bead(path, .022, .044, False, 14)))
    return parts + mirrors(skin) + cabin(skin, house)
