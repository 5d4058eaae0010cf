"""Renders without VRML: a mesh from numpy and an exact sphere. Usage: bare_renderer.py PICTURE."""
import sys

import numpy as np

from xvrml import rt


def torus(
    around: int = 64,
    across: int = 32
) -> "tuple[np.ndarray[tuple[int, ...], np.dtype[np.float64]], list[list[int]]]":
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, around, endpoint=False),
                       np.linspace(0, 2 * np.pi, across, endpoint=False),
                       indexing="ij")
    ring = 1 + 0.35 * np.cos(v)
    points = np.stack([ring * np.cos(u), 0.35 * np.sin(v), ring * np.sin(u)], -1).reshape(-1, 3)
    faces = []
    for i in range(around):
        for j in range(across):
            a, b = i * across + j, (i + 1) % around * across + j
            c, d = (i + 1) % around * across + (j + 1) % across, i * across + (j + 1) % across
            faces += [[a, c, b], [a, d, c]]
    return points, faces


def main(path: str) -> None:
    with rt.Context() as context:
        gold = context.shader("VRML97",
                              diffuseColor=(0.8, 0.55, 0.2),
                              specularColor=(0.5, 0.5, 0.5),
                              shininess=0.4)
        blue = context.shader("VRML97", diffuseColor=(0.1, 0.3, 0.8))
        context.instance(context.mesh(*torus(), shader=gold))
        context.instance(context.sphere(0.5, shader=blue))
        context.light(context.shader("VRML97DirectionalLight", direction=(-0.5, -1, -0.7)))
        context.camera(eye=(0, 2.5, 3.5), at=(0, 0, 0), fov=45)
        context.render(size=(320, 240), spp=16).save(path)


if __name__ == "__main__":
    main(sys.argv[1])
