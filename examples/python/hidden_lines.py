"""Draws the visible edges of a world as an SVG file: hidden_lines.py WORLD SVG

A renderer gathers the edges: where a surface ends, has a crease, or turns away from the eye. Rays
find out which pieces of them are hidden."""
import pathlib
import sys
from typing import Any, List

import numpy as np
import numpy.typing as npt

import xvrml
from xvrml import rt

SIZE = (800, 600)
PIECES = 32  # into which an edge is cut
CREASE = np.cos(np.radians(25))
Array = npt.NDArray[Any]


class Edges(xvrml.Renderer):

    def __init__(self, eye: Array) -> None:
        self.eye = eye
        self.edges: List[Array] = [np.empty((0, 2, 3))]
        self.caster = rt.Raycaster()

    def draw(self, shape: xvrml.DrawnShape) -> None:
        mesh = shape.mesh
        if mesh.kind == "lines":
            self.edges.append(mesh.world_vertices[mesh.faces])
        elif mesh.kind == "triangles":
            self.caster.add_mesh(mesh)
            self.edges.append(self.edges_of(mesh.world_vertices, mesh.faces))

    def edges_of(self, points: Array, faces: Array) -> Array:
        """Returns the edges (n, 2, 3) that are drawn of a mesh."""
        points, same = np.unique(points.round(6), axis=0, return_inverse=True)
        faces = same.reshape(-1)[faces]
        corners = points[faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        lengths = np.linalg.norm(normals, axis=1)
        faces, corners = faces[lengths > 0], corners[lengths > 0]
        normals = normals[lengths > 0] / lengths[lengths > 0, None]
        front = ((self.eye - corners[:, 0]) * normals).sum(1) > 0
        sides = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, at, count = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
        owners = np.argsort(at.reshape(-1), kind="stable") // 3  # faces, edge by edge
        last = np.cumsum(count) - 1
        a, b = owners[last], owners[last - count + 1]
        turns = (front[a] != front[b]) | ((normals[a] * normals[b]).sum(1) < CREASE)
        drawn: Array = points[edges[(count != 2) | turns]]
        return drawn


def main(path: str, svg: str) -> None:
    world = xvrml.load(path)
    camera = world.render(size=SIZE, spp=1).camera
    if camera is None:
        sys.exit(f"{path}: the world is not seen through a pinhole")
    eye = camera.pose[:3, 3]
    found = Edges(eye)
    world.render_with(found, view=camera.pose @ np.diag([1.0, -1, -1, 1]))
    edges = np.concatenate(found.edges)
    steps = np.linspace(0, 1, PIECES + 1)[:, None]
    places = edges[:, :1] * (1 - steps) + edges[:, 1:] * steps  # (edges, PIECES + 1, 3)
    ways = (places[:, 1:] + places[:, :-1]) / 2 - eye
    rays = np.concatenate([np.broadcast_to(eye, ways.shape), ways], axis=2)
    hidden = found.caster.test_occlusions(rays.astype(np.float32), tfar=1 - 1e-3)
    seen = camera.project(places)
    shown = ~hidden & (seen[:, 1:, 2] > 0) & (seen[:, :-1, 2] > 0)
    lines = [
        f'<path d="M{x:.2f} {y:.2f}L{u:.2f} {v:.2f}"/>'
        for (x, y, _), (u, v, _) in zip(seen[:, :-1][shown], seen[:, 1:][shown])
    ]
    pathlib.Path(svg).write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE[0]} {SIZE[1]}" fill="none" '
        'stroke="black" stroke-linecap="round">\n' + "\n".join(lines) + "\n</svg>\n")
    print(f"{len(edges)} edges, {shown.mean():.0%} of them visible")


if __name__ == "__main__":
    main(*sys.argv[1:])
