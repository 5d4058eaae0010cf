"""Meshes full of special cases. Shared by the tests of ray queries in single and in double precision."""
import numpy as np


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
