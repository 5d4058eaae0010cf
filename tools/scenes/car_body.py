"""The car's skin: a tensor product of cubic B-splines over a net of a few sections, with holes for
wheels and windows, and the greenhouse on top of it. x points forwards, y up, z to the right; unit:
metre. It is one half of the car; the other half is its mirror image."""
import math

from scenes.parts import number

AXLES, HUB, ARCH = (1.37, -1.30), .325, .375  # wheels: x of both axles, height, radius of the hole

# Sections from nose to tail: x, half width, height of the shoulder, height in the middle, height of the sill.
SECTIONS = [
    (2.31, .56, .625, .645, .42),
    (2.285, .715, .675, .705, .33),
    (2.20, .785, .710, .755, .265),
    (2.00, .822, .742, .805, .225),
    (1.68, .845, .772, .850, .205),
    (1.32, .858, .800, .890, .195),
    (.92, .864, .818, .920, .185),
    (.48, .866, .832, .945, .18),
    (0.0, .866, .838, .950, .18),
    (-.48, .868, .846, .955, .18),
    (-.92, .874, .858, .960, .185),
    (-1.32, .874, .866, .955, .195),
    (-1.68, .858, .864, .935, .215),
    (-2.00, .822, .852, .905, .255),
    (-2.20, .765, .825, .870, .32),
    (-2.285, .68, .775, .815, .41),
    (-2.31, .52, .70, .74, .50),
]


def section(half, shoulder, middle, sill):
    """Returns control points (z, y) from below the sill to the ridge; the last but one is mirrored
    beyond it."""
    side = shoulder - sill
    rise = middle - shoulder
    return [(.70 * half, sill - .005), (.90 * half, sill - .01), (.975 * half, sill + .06 * side),
            (.995 * half, sill + .28 * side), (1.012 * half, sill + .55 * side),
            (.998 * half, sill + .80 * side), (.975 * half, shoulder - .02),
            (.93 * half, shoulder + .028), (.80 * half, shoulder + .42 * rise + .012),
            (.52 * half, shoulder + .88 * rise), (.22 * half, middle + .012), (0, middle + .014)]


def basis(t):
    return ((1 - t)**3 / 6, (3 * t**3 - 6 * t * t + 4) / 6, (-3 * t**3 + 3 * t * t + 3 * t + 1) / 6,
            t**3 / 6)


def slopes(t):
    return (-(1 - t)**2 / 2, (3 * t * t - 4 * t) / 2, (-3 * t * t + 2 * t + 1) / 2, t * t / 2)


def unit(v):
    length = math.sqrt(sum(c * c for c in v)) or 1
    return tuple(c / length for c in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def spline(points, u):
    """Evaluates a cubic B-spline that starts and ends at its first and last control point; u from 0
    to 1."""
    n = len(points)
    position = min(max(u, 0.0), 1.0) * (n - 1)
    i = min(int(position), n - 2)
    t = position - i
    ends = [tuple(2 * a - b for a, b in zip(points[0], points[1]))
           ] + list(points) + [tuple(2 * a - b for a, b in zip(points[-1], points[-2]))]
    return tuple(
        sum(w * p[a] for w, p in zip(basis(t), ends[i:i + 4])) for a in range(len(points[0])))


class Skin:

    def __init__(self):
        self.net = []
        for x, half, shoulder, middle, sill in SECTIONS:
            row = section(half, shoulder, middle, sill)
            self.net.append([(x, y, z) for z, y in row])
        self.rows, self.columns = len(self.net), len(self.net[0])

    def control(self, i, j):
        """Extrapolates linearly beyond the ends, and by the mirror image beyond the ridge."""
        if j >= self.columns:
            x, y, z = self.control(i, 2 * (self.columns - 1) - j)
            return (x, y, -z)
        if j < 0:
            return tuple(2 * a - b for a, b in zip(self.control(i, 0), self.control(i, 1)))
        if i < 0:
            return tuple(2 * a - b for a, b in zip(self.control(0, j), self.control(1, j)))
        if i >= self.rows:
            return tuple(2 * a - b
                         for a, b in zip(self.control(self.rows -
                                                      1, j), self.control(self.rows - 2, j)))
        return self.net[i][j]

    def at(self, u, v):
        """Returns point and normal; u from nose to tail, v from sill to ridge, both from 0 to 1."""
        pu, pv = u * (self.rows - 1), v * (self.columns - 1)
        i, j = min(int(pu), self.rows - 2), min(int(pv), self.columns - 2)
        bu, bv, su, sv = basis(pu - i), basis(pv - j), slopes(pu - i), slopes(pv - j)
        p, du, dv = [0.0] * 3, [0.0] * 3, [0.0] * 3
        for a in range(4):
            for b in range(4):
                c = self.control(i - 1 + a, j - 1 + b)
                for k in range(3):
                    p[k] += bu[a] * bv[b] * c[k]
                    du[k] += su[a] * bv[b] * c[k]
                    dv[k] += bu[a] * sv[b] * c[k]
        return tuple(p), unit(cross(dv, du))

    def u_of(self, x):
        low, high = 0.0, 1.0
        for _ in range(40):
            middle = (low + high) / 2
            if self.at(middle, .5)[0][0] > x:
                low = middle
            else:
                high = middle
        return (low + high) / 2

    def v_of(self, u, axis, value, start, end):
        """Returns where along a section the height (axis 1) or the width (2) has a value; the
        coordinate must be monotonic from start to end."""
        rising = self.at(u, end)[0][axis] > self.at(u, start)[0][axis]
        low, high = start, end
        for _ in range(40):
            middle = (low + high) / 2
            if (self.at(u, middle)[0][axis] < value) == rising:
                low = middle
            else:
                high = middle
        return (low + high) / 2

    def deck(self, x, z):
        """Returns the height of the upper side."""
        u = self.u_of(x)
        return self.at(u, self.v_of(u, 2, z, .62, 1.0))[0][1]

    def side(self, x, y):
        """Returns point and normal on the flank."""
        u = self.u_of(x)
        return self.at(u, self.v_of(u, 1, y, .1, .68))


class Greenhouse:
    """Roof, pillars and windows: columns from the middle of the windscreen around to the middle of
    the rear window, each a spline from the deck to the middle of the roof."""
    # outlines: centre, half length, half width, power
    BASE, TOP = (-.40, 1.20, .715, 3.0), (-.30, .53, .535, 2.7)
    ROOF, CROWN = 1.325, 1.375
    # The ends of the windows at the deck and at the roof: z on the windscreen, x on the sides, z on
    # the rear window.
    BREAKS = [("z", 0, 0), ("z", .60, .435), ("x", .50, .03), ("x", -.36, -.37), ("x", -.43, -.43),
              ("x", -1.02, -.63), ("r", .50, .36), ("r", 0, 0)]
    STEPS = [9, 3, 10, 2, 8, 7, 9]
    GLASS = {0, 2, 4, 6}
    ROWS = [0, .015, .06] + [.06 + .50 * i / 7 for i in range(1, 8)
                            ] + [.575, .61, .65, .70, .76, .82, .88, .94, 1]
    FIRST, LAST = 2, 9  # first and last row with glass

    def __init__(self, skin):
        self.skin = skin
        self.marks, self.bands = [], []
        angles = [
            (self.angle(self.BASE, k, b), self.angle(self.TOP, k, t)) for k, b, t in self.BREAKS
        ]
        for band, (one, other) in enumerate(zip(angles, angles[1:])):
            for s in range(self.STEPS[band]):
                f = s / self.STEPS[band]
                self.marks.append(tuple(a + (b - a) * f for a, b in zip(one, other)))
                self.bands.append(band)
        self.marks.append(angles[-1])
        self.columns = [self.controls(*m) for m in self.marks]

    @staticmethod
    def angle(outline, kind, value):
        middle, length, width, power = outline
        if kind == "x":
            share = (value - middle) / length
            return math.acos(math.copysign(abs(share)**(power / 2), share))
        a = math.asin((value / width)**(power / 2))
        return a if kind == "z" else math.pi - a

    @staticmethod
    def outline(outline, a):
        middle, length, width, power = outline
        c, s = math.cos(a), math.sin(a)
        return middle + length * math.copysign(abs(c)**(2 / power), c), width * abs(s)**(2 / power)

    def controls(self, base, top):
        bx, bz = self.outline(self.BASE, base)
        tx, tz = self.outline(self.TOP, top)
        b, t = (bx, self.skin.deck(bx, bz) - .012, bz), (tx, self.ROOF, tz)

        def between(f, out):
            x, y, z = (p + (q - p) * f for p, q in zip(b, t))
            flank = abs(math.sin((base + top) / 2))
            return (x + out * (.35 if math.cos(base) > 0 else -.35) * (1 - flank), y + out * .25,
                    z + out * flank)

        middle = self.TOP[0]
        inner = [(middle + (tx - middle) * f, self.ROOF + (self.CROWN - self.ROOF) * r, tz * f)
                 for f, r in ((.80, .62), (.4, .95), (0, 1.0))]
        return [b, between(.3, .03), between(.62, .032), (t[0], t[1] - .012, t[2]), *inner]

    def at(self, column, t):
        return spline(self.columns[column], t)

    def normal(self, column, t):

        def place(c, s):
            last = len(self.columns) - 1
            if c < 0 or c > last:
                x, y, z = self.at(-c if c < 0 else 2 * last - c, s)
                return (x, y, -z)
            return self.at(c, s)

        if t > .999:
            return (0.0, 1.0, 0.0)
        h = .004
        du = tuple(a - b for a, b in zip(place(column + 1, t), place(column - 1, t)))
        low, high = max(0.0, t - h), min(1.0, t + h)
        dv = tuple(a - b for a, b in zip(place(column, high), place(column, low)))
        n = unit(cross(du, dv))
        return n if n[1] > -.2 else tuple(-c for c in n)

    def patch(self, columns, rows, offset=0.0):
        """Returns points and normals of a part; its rows are indices into ROWS."""
        points, normals = [], []
        for r in rows:
            for c in columns:
                n = self.normal(c, self.ROWS[r])
                points.append(tuple(p + offset * m for p, m in zip(self.at(c, self.ROWS[r]), n)))
                normals.append(n)
        return points, normals

    def column_range(self, band):
        first = sum(self.STEPS[:band])
        return list(range(first, first + self.STEPS[band] + 1))


def faces_of(rows, columns, keep=lambda r, c: True):
    return [(r * columns + c, r * columns + c + 1, (r + 1) * columns + c + 1, (r + 1) * columns + c)
            for r in range(rows - 1)
            for c in range(columns - 1)
            if keep(r, c)]


def surface(points, normals, faces, solid=False, side=1):
    """Returns an IndexedFaceSet with given normals. It contains only points in use, and its faces
    are oriented by the normals. Side -1: the mirror image."""
    points, normals = ([(x, y, z * side) for x, y, z in v] for v in (points, normals))
    number_of, used = {}, []
    turned = []
    for face in faces:
        a, b, c = (points[i] for i in (face[0], face[1], face[2]))
        if face[0] == face[1]:
            b, c = points[face[2]], points[face[3]]
        n = cross(tuple(q - p for p, q in zip(a, b)), tuple(q - p for p, q in zip(a, c)))
        if sum(p * q for p, q in zip(n, normals[face[0]])) < 0:
            face = face[::-1]
        for i in face:
            if i not in number_of:
                number_of[i] = len(used)
                used.append(i)
        turned.append(tuple(number_of[i] for i in face))
    listed = ", ".join(" ".join(number(round(c, 4)) for c in points[i]) for i in used)
    vectors = ", ".join(" ".join(number(round(c, 3)) for c in normals[i]) for i in used)
    indices = " ".join(" ".join(str(i) for i in face) + " -1" for face in turned)
    return (
        f"IndexedFaceSet {{ solid {'TRUE' if solid else 'FALSE'}\n    coord Coordinate {{ point [ {listed} ] }}\n"
        f"    normal Normal {{ vector [ {vectors} ] }}\n    coordIndex [ {indices} ] }}")


def hull(skin, house, side, along=90, across=28):
    """Returns the lower body, with openings for the wheels and the cabin."""
    points, normals = [], []
    for r in range(along + 1):
        for c in range(across + 1):
            u = r / along
            # denser where the shape is round
            u = u + .035 * math.sin(4 * math.pi * u) / (2 * math.pi)
            p, n = skin.at(u, c / across)
            points.append(p)
            normals.append(n)
    columns = across + 1
    middle, length, width, power = house.BASE

    def in_cabin(p):
        return p[1] > .75 and abs(
            (p[0] - middle) / (length - .1))**power + abs(p[2] / (width - .09))**power < 1

    def in_arch(p):
        return p[1] < .80 and p[2] > .3 and any(
            math.hypot(p[0] - x, p[1] - HUB) < ARCH for x in AXLES)

    gone = [in_cabin(p) or in_arch(p) for p in points]
    faces = faces_of(
        along + 1, columns,
        lambda r, c: not any(gone[i] for i in (r * columns + c, r * columns + c + 1,
                                               (r + 1) * columns + c + 1, (r + 1) * columns + c)))
    # Points beside the hole of a wheel are moved to its edge.
    count = {}
    for face in faces:
        for i in face:
            count[i] = count.get(i, 0) + 1
    for i, p in enumerate(points):
        inner = 0 < i % columns < columns - 1 and 0 < i // columns < along
        if not gone[i] and inner and 0 < count.get(i, 0) < 4:
            for x in AXLES:
                d = math.hypot(p[0] - x, p[1] - HUB)
                if ARCH <= d < ARCH + .09 and p[1] < .80:
                    nx, ny = x + (p[0] - x) * ARCH / d, HUB + (p[1] - HUB) * ARCH / d
                    if ny > .23:
                        points[i], normals[i] = skin.side(nx, ny)
    return surface(points, normals, faces, side=side)
