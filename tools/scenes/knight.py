"""The knight of the chess set: a horse's head that looks along -z, on a neck that rises from y =
.25. It is a tube of ovals along a curve, with ears and a mane, and the only piece that is not a
surface of revolution."""
import math

from scenes.parts import curve, mesh, tube

# Outline of head and neck from the side, row by row from the foot to the muzzle: front (throat) and
# back (crest) as (forward, up), and half of the width; measured in a drawing.
SIDE = [
    # forward, up      back,  up    half width
    (.20, .245, -.205, .245, .165),
    (.20, .30, -.215, .31, .160),
    (.165, .39, -.225, .41, .148),
    (.12, .48, -.215, .53, .132),
    (.085, .56, -.185, .655, .118),
    (.07, .63, -.14, .77, .107),
    (.07, .685, -.08, .865, .100),
    (.085, .715, -.01, .935, .100),
    (.11, .715, .065, .955, .108),
    (.15, .69, .13, .925, .112),
    (.185, .65, .195, .875, .104),
    (.22, .605, .255, .815, .092),
    (.255, .565, .31, .755, .082),
    (.295, .535, .36, .70, .078),
    (.33, .525, .385, .65, .072),
]
COLUMNS = 24


def knight_head():
    stations = curve(SIDE, 2)
    rows = []
    for k, (fx, fy, bx, by, half) in enumerate(stations):
        t = k / (len(stations) - 1)
        mx, my = (fx + bx) / 2, (fy + by) / 2
        ux, uy = (bx - fx) / 2, (by - fy) / 2  # half of the depth, from the centre to the crest
        ring = []
        for i in range(COLUMNS):
            a = 2 * math.pi * i / COLUMNS
            c, s = math.cos(a), math.sin(a)  # c = 1: crest, s: sideways
            power = .8
            cc, ss = math.copysign(abs(c)**power, c), math.copysign(abs(s)**power, s)
            wide = half
            if t < .62 and c > 0:  # the neck narrows towards the mane
                wide *= 1 - .45 * c * c * min(1.0, t * 4)
            elif c < 0:
                wide *= 1 - .25 * c * c
            if .62 < t and c < 0:  # the jaw
                wide *= 1 - .1 * c
            depth = 1.0
            if .04 < t < .56 and c > .9:  # the mane: teeth along the crest
                depth = 1 + (.22 if k % 2 else .05)
            if t > .82 and -.75 < c < -.35:  # the mouth
                wide *= .9
            if .5 < t < .72 and -.5 < c < .6:  # the cheek
                wide *= 1.08
            ring.append((ss * wide, my + uy * cc * depth, -(mx + ux * cc * depth)))
        rows.append(ring)
    points, faces = tube(rows)
    for side in (-1, 1):
        add(points, faces, ear(side))
        add(points, faces, ball((side * .101, .838, -.165), .026))
        add(points, faces, ball((side * .058, .655, -.352), .016))
    return mesh(points, faces, 1.1)


def add(points, faces, more):
    start = len(points)
    points += more[0]
    faces += [tuple(i + start for i in face) for face in more[1]]


def ear(side):
    """Returns a leaf shape on the poll."""
    rows = []
    for up, wide, deep in ((-.03, .03, .026), (.02, .036, .028), (.06, .03, .022), (.1, .014, .012),
                           (.118, .004, .004)):
        x, y, z = side * (.052 + up * .25), .925 + up, .0 - up * .35 - .02
        rows.append([(x + wide * math.cos(a), y, z - deep * math.sin(a))
                     for a in (2 * math.pi * i / 10 for i in range(10))])
    return tube(rows)


def ball(centre, radius, n=10):
    rows = []
    for k in range(1, 6):
        a = -math.pi / 2 + math.pi * k / 6
        rows.append([
            (centre[0] + radius * math.cos(a) * math.cos(b), centre[1] + radius * math.sin(a),
             centre[2] - radius * math.cos(a) * math.sin(b))
            for b in (2 * math.pi * i / n for i in range(n))
        ])
    return tube(rows)
