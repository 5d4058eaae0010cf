#!/usr/bin/env python3
"""Makes the pictures of docs/figures.md: the same scene by pyrender and by VTK, and by xvrml.

tools/figure_pictures.py [FOLDER]

writes figures-pyrender.jpg and figures-pyvista.jpg into docs/images, or into FOLDER, in about a minute. The
package has to be on PYTHONPATH, and pyrender (which needs EGL), pyvista (which needs a display, so use
xvfb-run), trimesh and Pillow as well."""
import os
import pathlib
import sys

os.environ.setdefault("PYOPENGL_PLATFORM", "egl")  # before pyrender is imported

import numpy as np  # noqa: E402
import pyrender  # noqa: E402
import pyvista  # noqa: E402
import trimesh  # noqa: E402
from PIL import Image  # noqa: E402

import xvrml  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[1]
SIZE = (400, 300)
INK = (0.75, 0.2, 0.12), (0.15, 0.4, 0.65), (0.85, 0.65, 0.2)


def parts():
    """Returns the meshes of the scene, each with its place and its colour; z points up."""
    ring = trimesh.creation.annulus(r_min=0.45, r_max=0.9, height=0.5)
    ball = trimesh.creation.icosphere(subdivisions=4, radius=0.42)
    block = trimesh.creation.box((0.7, 0.7, 1.1))
    floor = trimesh.creation.box((7, 7, 0.1))
    return [(ring, (-0.2, 0.1, 0.25), INK[0]), (ball, (-0.2, 0.1, 0.86), INK[1]),
            (block, (1.2, 0.6, 0.55), INK[2]), (floor, (0, 0, -0.05), (0.8, 0.8, 0.8))]


def look_at(eye, at):
    """Returns the pose of a camera (OpenGL's axes) that stands at eye and looks at a point."""
    back = np.subtract(eye, at) / np.linalg.norm(np.subtract(eye, at))
    right = np.cross((0, 0, 1), back)
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, :] = np.stack([right, np.cross(back, right), back, eye], axis=1)
    return pose


EYE, LAMP = (2.6, -3.6, 2.6), (-2, -2, 4)
FOV, SKY = 0.7, (0.62, 0.68, 0.74)


def by_pyrender():
    scene = pyrender.Scene(bg_color=(*SKY, 1.0), ambient_light=(0.25, 0.25, 0.25))
    for mesh, place, color in parts():
        material = pyrender.MetallicRoughnessMaterial(baseColorFactor=(*color, 1), metallicFactor=0,
                                                      roughnessFactor=0.6)
        pose = trimesh.transformations.translation_matrix(place)
        scene.add(pyrender.Mesh.from_trimesh(mesh, material=material, smooth=False), pose=pose)
    scene.add(pyrender.PerspectiveCamera(yfov=FOV), pose=look_at(EYE, (0.2, 0.2, 0.4)))
    scene.add(pyrender.DirectionalLight(intensity=3), pose=look_at(LAMP, (0, 0, 0)))
    color, _ = pyrender.OffscreenRenderer(*SIZE).render(scene)
    return color


def pyrender_scene_here():
    world = xvrml.World()
    for mesh, place, color in parts():
        shape = xvrml.interop.from_trimesh(mesh, color=color)
        world.add(xvrml.Transform(translation=place, children=[shape]))
    world.add(xvrml.Background(skyColor=[SKY]))
    world.add(xvrml.NavigationInfo(headlight=False))
    world.add(xvrml.DirectionalLight(direction=np.negative(LAMP), intensity=0.7))
    pose = look_at(EYE, (0.2, 0.2, 0.4))
    return world.render(size=SIZE, camera=pose, fov=np.degrees(FOV), spp=128,
                        transport="path").display


def plotter():
    """Returns the Plotter of a drop's waves, with the way of a float as a tube."""
    x, y = np.meshgrid(np.linspace(-4, 4, 161), np.linspace(-4, 4, 161))
    radius = np.hypot(x, y)
    z = 0.7 * np.cos(3 * radius) / (1 + 0.6 * radius**2)
    waves = pyvista.StructuredGrid(x, y, z)
    waves["height"] = z.ravel(order="F")
    turn = np.linspace(0, 6 * np.pi, 300)
    way = np.stack([np.cos(turn), np.sin(turn), np.zeros(300)], axis=1) * (turn / 6 / np.pi * 3)[:, None]
    way[:, 2] = 0.9
    shown = pyvista.Plotter(off_screen=True, window_size=SIZE)
    shown.set_background("white")
    shown.add_mesh(waves, scalars="height", cmap="viridis", smooth_shading=True, show_scalar_bar=False)
    shown.add_mesh(pyvista.lines_from_points(way).tube(radius=0.06), color="tomato", smooth_shading=True)
    shown.camera_position = [(5, -8, 6.5), (0, 0, 0), (0, 0, 1)]
    return shown


def plotter_here():
    world = xvrml.to_world(plotter())
    world.add(xvrml.NavigationInfo(headlight=False))
    world.add(xvrml.DirectionalLight(direction=(1.5, 1, -2), intensity=0.9))
    return world.render(size=SIZE, spp=128, transport="path").display


def save(name, folder, *pictures):
    both = np.concatenate([np.asarray(one)[..., :3] for one in pictures], axis=1)
    Image.fromarray(np.ascontiguousarray(both, np.uint8)).save(folder / name, quality=88)


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "docs/images")
    save("figures-pyrender.jpg", folder, by_pyrender(), pyrender_scene_here())
    save("figures-pyvista.jpg", folder, plotter().screenshot(return_img=True), plotter_here())


if __name__ == "__main__":
    main()
