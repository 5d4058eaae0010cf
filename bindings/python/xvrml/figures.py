"""Draws data: meshes of other packages, point clouds and height fields.

>>> xvrml.picture(trimesh.load("part.stl")).save("part.png")
>>> xvrml.picture(points, values=density, cmap="viridis", point_size=0.02).save("cloud.png")
>>> xvrml.show(plotter)  # of PyVista, with its camera, colours and lights

picture() and show() are also members of the package itself. to_world() returns the world that they
draw; points() and height_field() return Shapes for other worlds.
"""
import os
import pathlib
import subprocess
import sys

import numpy as np

import xvrml

from . import _shaping

__all__ = ["picture", "show", "to_world", "points", "height_field"]

_UNKNOWN = (0.5, 0.5, 0.5)  # the colour of values that are not numbers


def map_colors(values, cmap="viridis", clim=None):
    """Returns the colours of values as float32 of shape (n, 3), as matplotlib shows them. cmap: the
    name of a colour map of matplotlib, a Colormap, or a function from numbers between 0 and 1 to
    colours. clim: the values at its ends; None: the least and the largest value. Values that are
    not finite are grey."""
    values = np.asarray(values, float).ravel()
    if isinstance(cmap, str):
        import matplotlib
        cmap = matplotlib.colormaps[cmap]
    known = np.isfinite(values)
    if clim is None:
        clim = (values[known].min(), values[known].max()) if known.any() else (0, 1)
    low, high = map(float, clim)
    places = np.zeros(len(values))
    if high > low:
        places[known] = np.clip((values[known] - low) / (high - low), 0, 1)
    colors = np.asarray(cmap(places), float)[:, :3].astype(np.float32)
    colors[~known] = _UNKNOWN
    return colors


def _colors(count, what, values, colors, cmap, clim):
    """Returns one colour for each of `count` places, or None."""
    if values is not None and colors is not None:
        raise ValueError("values, colors: one of them expected, not both")
    if values is not None:
        colors = map_colors(values, cmap, clim)
    if colors is None:
        return None
    colors = np.asarray(colors)
    if colors.ndim != 2 or colors.shape[0] != count or colors.shape[1] not in (3, 4):
        raise ValueError(f"{'colors' if values is None else 'values'}: one for each of the {count} "
                         f"{what} expected, not an array of shape {np.shape(values if values is not None else colors)}")
    if colors.dtype == np.uint8:
        colors = colors / 255
    return np.ascontiguousarray(colors[:, :3], np.float32)


def points(xyz, values=None, *, colors=None, color=(0.8, 0.8, 0.8), cmap="viridis", clim=None):
    """Returns a Shape of points. World.render(point_size=...) draws them as balls; without it they
    are one pixel wide.

    xyz     numbers of shape (n, 3)
    values  n numbers, which the colour map `cmap` of matplotlib makes to colours; clim: the values
            at its ends (default: the least and the largest)
    colors  instead: (n, 3), floats from 0 to 1 or bytes
    color   of all points, if neither is given
    """
    xyz = np.asarray(xyz, np.float32)
    if xyz.ndim != 2 or xyz.shape[1] != 3:
        raise ValueError(f"xyz: numbers of shape (n, 3) expected, not {xyz.shape}")
    each = _colors(len(xyz), "points", values, colors, cmap, clim)
    geometry = xvrml.PointSet(coord=xvrml.Coordinate(point=xyz))
    if each is not None:
        geometry.color = xvrml.Color(color=each)
    return _shaping.thin(geometry, color)


def height_field(z, *, spacing=(1.0, 1.0), values=None, colors=None, color=None, cmap="viridis",
                 clim=None):
    """Returns a Shape of the surface y = z[row, column]. Columns run along x, rows towards the
    viewer along z, both from 0.

    z        heights of shape (rows, columns), at least 2 x 2
    spacing  distances of columns and of rows
    values   numbers of the same shape, which the colour map `cmap` makes to colours (clim as in
             points()); z itself is one of them
    colors   instead: (rows, columns, 3)
    """
    z = np.asarray(z, np.float32)
    if z.ndim != 2 or min(z.shape) < 2:
        raise ValueError(f"z: heights of shape (rows, columns), at least 2 x 2, expected, not {z.shape}")
    if not np.isfinite(z).all():
        raise ValueError("z: finite heights expected; replace those that are missing")
    if colors is not None:
        colors = np.asarray(colors)
        colors = colors.reshape(-1, colors.shape[-1])
    each = _colors(z.size, "heights", values, colors, cmap, clim)
    geometry = xvrml.ElevationGrid(xDimension=z.shape[1],
                                   zDimension=z.shape[0],
                                   xSpacing=float(spacing[0]),
                                   zSpacing=float(spacing[1]),
                                   height=z.ravel(),
                                   solid=False,
                                   creaseAngle=np.pi)
    if each is not None:
        geometry.color = xvrml.Color(color=each)
    return _shaping.faces(geometry, color)


def _cloud(xyz, options):
    """Returns a Transform to the middle of points, with the points around it: coordinates have
    single precision, which is too coarse for a scan in coordinates of the earth."""
    finite = np.isfinite(xyz).all(axis=1)
    middle = xyz[finite].mean(axis=0).astype(np.float32) if finite.any() else np.zeros(3, np.float32)
    return xvrml.Transform(translation=middle, children=[points(xyz - middle.astype(float), **options)])


def _array(array, options):
    """Returns the node of an array: a point cloud if it has three columns, else a height field."""
    if array.ndim == 2 and array.shape[1] == 3:
        return _cloud(array, options)
    if array.ndim == 2:
        return height_field(array, **options)
    raise TypeError("an array of shape (n, 3), for points, or (rows, columns), for heights, expected, "
                    f"not {array.shape}")


def _node(thing, options):
    package = type(thing).__module__.partition(".")[0]
    if package in ("pyvista", "pyvistaqt") or hasattr(thing, "GetClassName"):  # classes of VTK
        return xvrml.interop.from_pyvista(thing, **options)
    if package == "open3d":
        return xvrml.interop.from_open3d(thing, **options)
    if hasattr(thing, "faces") or hasattr(thing, "graph") or hasattr(thing, "entities"):
        return xvrml.interop.from_trimesh(thing, **options)
    if type(thing).__name__ == "PointCloud" and package == "trimesh":
        colors = getattr(thing, "colors", None)
        given = {} if colors is None or not len(colors) else {"colors": np.asarray(colors)}
        return _cloud(np.asarray(thing.vertices, float), {**given, **options})
    try:
        array = np.asarray(thing, float)
    except (TypeError, ValueError):
        array = None
    if array is None or array.ndim == 0:
        raise TypeError("a file, a World, a Node, a mesh of trimesh, Open3D or PyVista, or an array "
                        f"expected, not the {type(thing).__name__} {thing!r:.60}")
    return _array(array, options)


def to_world(thing, **options):
    """Returns the World that shows something: a file (str or path), a World (itself), a Node, a mesh
    or a point cloud of trimesh, Open3D or PyVista, a Plotter of PyVista, an array of shape (n, 3)
    for points, or another array with two dimensions for heights. options: those of points(),
    height_field(), or of interop.from_trimesh(), from_open3d() and from_pyvista()."""
    if isinstance(thing, (str, os.PathLike, xvrml.World)):
        if options:
            raise TypeError(f"{next(iter(options))}: not for files and worlds, which have colours")
        return thing if isinstance(thing, xvrml.World) else xvrml.load(thing)
    world = xvrml.World()
    if isinstance(thing, xvrml.Node):
        if options:
            raise TypeError(f"{next(iter(options))}: not for nodes, which have colours")
        world.add(thing)
        return world
    world.add(_node(thing, options))
    return world


_LOOKS = ("values", "colors", "color", "scalars", "cmap", "clim", "spacing")


def _prepare(thing, options):
    """Returns the world that shows something, and the options of World.render(). Points and lines
    of data get a size, so that they are more than single pixels."""
    looks = {name: options[name] for name in _LOOKS if name in options}
    rendering = {name: value for name, value in options.items() if name not in looks}
    world = to_world(thing, **looks)
    if isinstance(thing, (str, os.PathLike, xvrml.Node, xvrml.World)):
        return world, rendering
    kinds = {mesh.kind for mesh in world.meshes(spheres=0)}
    if not kinds & {"points", "lines"}:
        return world, rendering
    extent = float(np.linalg.norm(np.diff(world.bounds, axis=0)))
    for kind, name, part in (("points", "point_size", 100), ("lines", "line_width", 400)):
        if extent > 0 and kind in kinds:
            rendering.setdefault(name, extent / part)
    return world, rendering


def picture(thing, **options):
    """Returns a Picture of something; to_world() says of what. options: those of to_world(), and of
    World.render() (size, spp, ...). A Plotter gives its camera; else the picture is fitted to what
    there is. Points of data are balls of a hundredth of the extent, and lines a quarter as thick,
    unless point_size or line_width say otherwise."""
    world, rendering = _prepare(thing, options)
    return world.render(**rendering)


def show(thing, **options):
    """Shows something in a notebook as a live view (World.view(), which needs jupyter_rfb), else in
    a window of vv; returns the view, or the process (subprocess.Popen). options: those of
    picture(); a window takes only those of to_world(), and size, point_size and line_width."""
    world, rendering = _prepare(thing, options)
    if "ipykernel" in sys.modules:
        return world.view(**rendering)
    named = {"size": "--size", "point_size": "--point-size", "line_width": "--line-width"}
    path = os.fspath(thing) if isinstance(thing, (str, os.PathLike)) else None
    command = [_program(), path or "-"]
    for name, value in rendering.items():
        if name not in named:
            raise TypeError(f"show(): {name}: a window takes size, point_size and line_width")
        command += [named[name], "x".join(map(str, value)) if name == "size" else str(float(value))]
    if path:  # relative URLs of the file go on working
        return subprocess.Popen(command)
    process = subprocess.Popen(command, stdin=subprocess.PIPE)
    with process.stdin as pipe:
        pipe.write(world.to_vrml().encode())
    return process


def _program():
    """Returns the path of vv: that of the package, else the one that the shell finds."""
    own = pathlib.Path(__file__).resolve().parent / "bin" / "vv"
    return os.environ.get("OPENRT_VV") or (str(own) if own.exists() else "vv")
