"""Loads and edits VRML97 worlds and renders ray-traced pictures of them.

>>> import xvrml
>>> world = xvrml.load("world.wrl")
>>> world["Door"].translation = (0, 0, 2)
>>> world.add(xvrml.Shape(geometry=xvrml.Box(size=(1, 2, 3))), name="Crate")
>>> image = world.render(size=(640, 480), error=0.02)
>>> image.save("door.png")

A world has its own clock. The clock moves only when the program sets it:

>>> @world.on("Door.translation_changed")
... def moved(value, time): print(value)
>>> world.time = 0.5
>>> for frame in world.animate(0, 10, fps=25): ...

picture() and show() draw data: meshes of other packages, point clouds, height fields.

xvrml.rt is the renderer without VRML. xvrml.interop converts meshes and pictures to and from other
packages. xvrml.control controls a world that vv runs in another process.
"""
import difflib as _difflib
import importlib as _importlib
import warnings as _warnings

from . import _arguments, _features, _world
from . import _xvrml
from ._camera import Pinhole
from ._features import Feature, features
from ._live import LiveView
from ._renderer import (AppearanceParts, MaterialValues, Reach, Renderer, TextureLayer,
                        TexturePicture)
from ._world import loads
from ._xvrml import (Browser, Cluster, ClusterError, Diagnostic, DrawnShape, EditError, Editor,
                     EditStep, Film, Measurement, Mesh, Node, ParseError, Picture, RenderError,
                     RenderState, ViewpointInfo, Worker, World, load_node_plugins, __version__)

load = _arguments.explained(_xvrml.load)
denoise = _arguments.explained(_xvrml.denoise)
merge = _arguments.explained(_xvrml.merge)
compare = _arguments.explained(_xvrml.compare)
for _class in (World, Browser, Cluster, Editor, Film, Node, Picture, _xvrml.Viewer):
    _arguments.explain_class(_class)
_world.complete(World, Node)

_features.look_for_pyoidn()

for _line in load_node_plugins():
    _warnings.warn(_line, RuntimeWarning)

from . import nodes as nodes  # noqa: E402  after the plug-ins, whose nodes have classes too
from .nodes import *  # noqa: E402,F401,F403

__all__ = [
    "AppearanceParts", "Browser", "Cluster", "ClusterError", "Diagnostic", "DrawnShape",
    "EditError", "Editor", "EditStep", "Feature", "Film", "LiveView", "MaterialValues",
    "Measurement", "Mesh", "Node", "ParseError", "Picture", "Pinhole", "Reach", "RenderError",
    "RenderState", "Renderer", "TextureLayer", "TexturePicture", "ViewpointInfo", "Worker",
    "World", "compare", "denoise", "features", "load", "load_node_plugins", "loads", "merge",
    "__version__", *nodes.__all__
]

_SUBMODULES = ("control", "dask", "figures", "interop", "notebook", "ray", "rt")
_FIGURES = ("picture", "show", "to_world")  # functions of xvrml.figures, which needs numpy


def __getattr__(name):
    """Imports submodules on first use, and finds nodes of plug-ins that were loaded later."""
    if name.startswith("__"):
        raise AttributeError(f"module xvrml has no attribute {name}")
    if name in _SUBMODULES:
        try:
            return _importlib.import_module(f".{name}", __name__)
        except ModuleNotFoundError as error:
            raise AttributeError(
                f"xvrml.{name} needs the package {error.name}, which is not installed") from error
    if name in _FIGURES:
        return getattr(_importlib.import_module(".figures", __name__), name)
    try:
        return getattr(nodes, name)
    except AttributeError:
        known = [*__all__, *_SUBMODULES, *_FIGURES, "nodes"]
        near = _difflib.get_close_matches(name, known,
                                          1) or [k for k in known if k.lower() == name.lower()]
        hint = f"; did you mean {near[0]}?" if near else ""
        raise AttributeError(f"module xvrml has no attribute {name}{hint}") from None
