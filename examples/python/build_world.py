"""Builds a world in a program, with a spiral of spheres and a curved surface from numpy; writes and
renders it. Usage: build_world.py FOLDER."""
import pathlib
import sys

import numpy as np

import xvrml


def surface(edge: int = 40) -> xvrml.Shape:
    x, z = np.meshgrid(np.linspace(-2, 2, edge), np.linspace(-2, 2, edge))
    height = 0.3 * np.sin(3 * x) * np.cos(2 * z)
    grid = xvrml.ElevationGrid(xDimension=edge,
                               zDimension=edge,
                               xSpacing=4 / (edge - 1),
                               zSpacing=4 / (edge - 1),
                               height=height.ravel(),
                               creaseAngle=3.0,
                               solid=False)
    return xvrml.Shape(geometry=grid, appearance=paint(0.3, 0.5, 0.8))


def paint(red: float, green: float, blue: float) -> xvrml.Appearance:
    return xvrml.Appearance(
        material=xvrml.Material(diffuseColor=(red, green, blue), specularColor=(0.3, 0.3, 0.3)))


def main(folder: str) -> None:
    world = xvrml.World()
    world.add(xvrml.Viewpoint(position=(0, 3, 6), orientation=(1, 0, 0, -0.45),
                              description="above"),
              name="Above")
    world.add(xvrml.Transform(translation=(-2, 0, -2), children=[surface()]), name="Sea")
    ball, look = xvrml.Sphere(radius=0.15), paint(0.9, 0.4, 0.1)
    for step in range(24):
        angle = step / 3
        world.add(
            xvrml.Transform(translation=(np.cos(angle), 0.5 + step / 20, np.sin(angle)),
                            children=[xvrml.Shape(geometry=ball, appearance=look)]))
    world.save(pathlib.Path(folder) / "spiral.wrl")
    world.render(size=(320, 240), spp=16,
                 viewpoint="Above").save(pathlib.Path(folder) / "spiral.png")


if __name__ == "__main__":
    main(sys.argv[1])
