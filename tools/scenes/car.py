"""examples/scenes/car.wrz: a coupe in a studio. car_body.py contains the skin, car_parts.py wheels,
lamps and the rest; this file assembles them."""
import math

from scenes.car_body import Greenhouse, Skin, faces_of, hull, surface
from scenes.parts import HEADER, shader, shape, viewpoint


def both(name, look, make):
    """Returns a part of the right side and its mirror image; the first one contains the shader."""
    return f"DEF {name}_Right {shape(look, make(1))}\nDEF {name}_Left {shape('USE ' + look.split()[1], make(-1))}"


def pillars(house, side):
    """Returns the painted parts of the greenhouse."""
    rows = list(range(len(house.ROWS)))
    columns = list(range(len(house.columns)))
    points, normals = house.patch(columns, rows)

    def painted(r, c):
        return not (house.bands[c] in house.GLASS and house.FIRST <= r < house.LAST)

    return surface(points, normals, faces_of(len(rows), len(columns), painted), side=side)


def pane(house, band, side=1):
    """Returns a window: a closed plate of 5 mm. The mirror images close those in the middle of the
    car."""
    columns = house.column_range(band)
    rows = list(range(house.FIRST, house.LAST + 1))
    outer, out_normals = house.patch(columns, rows, -.0005)
    inner, in_normals = house.patch(columns, rows, -.0055)
    if band in (0, 6):  # both halves

        def full(points):
            n, result = len(columns), []
            for r in range(len(rows)):
                line = points[r * n:(r + 1) * n]
                other = [(x, y, -z) for x, y, z in (line[:0:-1] if band == 0 else line[-2::-1])]
                result += other + line if band == 0 else line + other
            return result

        outer, out_normals, inner, in_normals = (
            full(p) for p in (outer, out_normals, inner, in_normals))
        columns = list(range(2 * len(columns) - 1))
    n, m = len(columns), len(rows)
    total = n * m
    faces = faces_of(m, n)
    points = outer + inner
    normals = out_normals + [tuple(-c for c in v) for v in in_normals]
    faces += [tuple(i + total for i in f) for f in faces_of(m, n)]
    # The edge has points of its own, because its normals differ.
    loop = [(0, c) for c in range(n)] + [(r, n - 1) for r in range(1, m)] + [
        (m - 1, c) for c in range(n - 2, -1, -1)
    ] + [(r, 0) for r in range(m - 2, 0, -1)]
    centre = tuple(sum(p[a] for p in outer) / total for a in range(3))
    start = len(points)
    for r, c in loop:
        p = outer[r * n + c]
        away = tuple(q - o for q, o in zip(p, centre))
        nrm = out_normals[r * n + c]
        dot = sum(x * y for x, y in zip(away, nrm))
        away = tuple(x - dot * y for x, y in zip(away, nrm))
        length = math.sqrt(sum(x * x for x in away)) or 1
        for face in (outer, inner):
            points.append(face[r * n + c])
            normals.append(tuple(x / length for x in away))
    k = len(loop)
    faces += [(start + 2 * i, start + 2 * i + 1, start + 2 * ((i + 1) % k) + 1,
               start + 2 * ((i + 1) % k)) for i in range(k)]
    return surface(points, normals, faces, True, side)


def car():
    from scenes import car_parts as parts
    skin = Skin()
    house = Greenhouse(skin)
    paint = "DEF Paint " + shader(
        "CarPaint", "carpaint", "color color .42 .012 .018", "color flakeColor .6 .13 .1",
        "1f flakes .25", "1f flakeRoughness .45", "1f flakeSize .0012", "1f flakeSpread .06")
    glass = "DEF Pane " + shader("Glass", "glass", "1f index 1.52", "color absorption 9 4 6")
    text = [
        "# A coupe in a studio. Written by tools/make_scenes.py.",
        'WorldInfo { title "Car" info [ "part of OpenRT\'s examples" ] }',
        'NavigationInfo { type "EXAMINE" headlight FALSE }',
        viewpoint((5.6, 1.4, 4.5), (.42, .50, -.06), .475, "DEF Front Viewpoint",
                  'description "Front" '),
        viewpoint((-5.2, 1.75, 4.6), (0, .55, 0), .5, "DEF Rear Viewpoint", 'description "Rear" '),
        viewpoint((.05, .62, 7.2), (.05, .60, 0), .5, "DEF Side Viewpoint", 'description "Side" '),
        viewpoint((.20, 1.225, .44), (.40, 1.15, 0), .5, "DEF Mirrors Viewpoint",
                  'description "Mirrors in each other" '),
        viewpoint((-.42, 1.12, -.34), (.6, 1.04, -.36), .8, "DEF Driver Viewpoint",
                  'description "Driver" '),
        *parts.studio(),
        both("Hull", paint, lambda side: hull(skin, house, side)),
        both("Pillars", "USE Paint", lambda side: pillars(house, side)),
        "DEF Windscreen " + shape(glass, pane(house, 0)),
        "DEF Rear_Window " + shape("USE Pane", pane(house, 6)),
        both("Door_Window", "USE Pane", lambda side: pane(house, 2, side)),
        both("Quarter_Window", "USE Pane", lambda side: pane(house, 4, side)),
        *parts.all_parts(skin, house),
    ]
    return HEADER + "\n".join(text) + "\n"
