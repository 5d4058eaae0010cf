"""The truth about rays and triangles in rational arithmetic, and meshes full of special cases. Shared
by the tests of ray queries in single and in double precision."""
import math
from fractions import Fraction

import numpy as np

# The origin of a ray through an edge or a vertex is moved by (E, E^2, E^3). That is so small that it
# decides nothing else: all numbers are whole multiples of 2^-1074.
E = Fraction(1, 2**5000)


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def rational(numbers):
    return [Fraction(float(x)) for x in numbers]


class Crossing:
    """The true crossing of a ray and the plane of a triangle."""

    def __init__(self, ray, corners):
        origin, direction = ray[:3], ray[3:]
        a, b, c = corners
        self.normal = cross(minus(b, a), minus(c, a))
        along = dot(self.normal, direction)
        self.hit = along != 0
        if not self.hit:
            return
        self.t = dot(self.normal, minus(a, origin)) / along
        self.point = [o + self.t * d for o, d in zip(origin, direction)]
        square = dot(self.normal, self.normal)
        at = minus(self.point, a)
        u = dot(cross(at, minus(c, a)), self.normal)
        v = dot(cross(minus(b, a), at), self.normal)
        least = min(u, v, square - u - v)
        self.hit, self.tie = least > 0, least == 0
        if least >= 0:
            self.u, self.v = u / square, v / square
        if self.tie:
            shift = (E, E * E, E * E * E)
            start = [x + e for x, e in zip(origin, shift)]
            t = dot(self.normal, minus(a, start)) / along
            at = [x + t * d for x, d in zip(start, direction)]
            self.hit = min(
                dot(cross(minus(q, p), minus(at, p)), self.normal)
                for p, q in ((a, b), (b, c), (c, a))) > 0


def crossings(ray, corners, triangles, near=0, far=math.inf):
    """Returns the true crossings of a ray by triangle."""
    ray, found = rational(ray), {}
    for n, triangle in enumerate(triangles):
        at = Crossing(ray, [corners[i] for i in triangle])
        if at.hit and at.t > Fraction(near) and (math.isinf(far) or at.t <= Fraction(far)):
            found[n] = at
    return found


def soup(random, kind):
    """Returns a mesh full of special cases: shared vertices, vertices at the same places, coplanar
    faces, slivers, triangles without area."""
    if kind == "lattice":
        points = random.integers(-2, 3, (24, 3))
    elif kind == "flat":
        points = np.concatenate([random.integers(-3, 4, (24, 2)), np.zeros((24, 1))], 1)
    elif kind == "far":
        points = random.integers(-2, 3, (24, 3)) + 1e6
    elif kind == "slivers":
        points = random.normal(size=(24, 3)) * (1, 1e-7, 1)
    else:
        points = random.normal(size=(24, 3))
    triangles = random.integers(0, 24, (40, 3))
    triangles[::7, 2] = triangles[::7, 1]
    points = np.concatenate([points, points]).astype(np.float32)
    triangles[1::2] += 24
    return points, triangles
