"""Prints what a depth camera sees of a world, as characters, without rendering a picture. Usage:
depth_camera.py WORLD."""
import sys

import numpy as np

import xvrml
from xvrml import rt


def main(path: str) -> None:
    world = xvrml.load(path)
    caster = world.raycaster()
    low = np.min([mesh.world_vertices.min(0) for mesh in world.meshes()], 0)
    high = np.max([mesh.world_vertices.max(0) for mesh in world.meshes()], 0)
    centre, size = (low + high) / 2, float(np.linalg.norm(high - low))
    rays = rt.create_rays_pinhole(50,
                                  center=centre,
                                  eye=centre + np.array([0.3, 0.4, 1.0]) * size,
                                  up=(0, 1, 0),
                                  width_px=60,
                                  height_px=24)[::-1, ::-1]  # upright: Open3D begins below
    rays[..., 3:] /= np.linalg.norm(rays[..., 3:], axis=-1, keepdims=True)
    hits = caster.cast_rays(rays)
    met = np.isfinite(hits["t_hit"])
    near, far = hits["t_hit"][met].min(), hits["t_hit"][met].max()
    shade = np.full(met.shape, " ")
    shade[met] = np.array(list("@%#*+=-:."))[np.clip(
        (hits["t_hit"][met] - near) / (far - near + 1e-9) * 9, 0, 8).astype(int)]
    print("\n".join("".join(row) for row in shade))
    names = {caster.meshes[i].node.def_name or "-" for i in np.unique(hits["geometry_ids"][met])}
    print(
        f"{met.mean():.0%} of the rays meet {', '.join(sorted(names))}, {near:.2f} to {far:.2f} away"
    )


if __name__ == "__main__":
    main(sys.argv[1])
