# Types of xvrml.interop. Classes of other packages are Any, so that the packages need not be
# installed.
from typing import Any, Optional, Sequence

from . import Node, Picture, World


def from_trimesh(mesh: Any, color: Optional[Sequence[float]] = ...) -> Node:
    ...


def to_trimesh(world: World, spheres: int = ...) -> Any:
    ...


def from_open3d(geometry: Any, color: Optional[Sequence[float]] = ...) -> Node:
    ...


def from_pyvista(thing: Any,
                 scalars: Optional[str] = ...,
                 *,
                 cmap: Any = ...,
                 clim: Optional[Sequence[float]] = ...,
                 color: Optional[Sequence[float]] = ...) -> Node:
    ...


def to_pyvista(world: World, spheres: int = ...) -> Any:
    ...


def to_pil(image: Picture) -> Any:
    ...


def from_pil(image: Any) -> Node:
    ...


def imshow(image: Picture, channel: Optional[str] = ..., ax: Any = ..., **options: Any) -> Any:
    ...
