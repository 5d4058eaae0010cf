"""VRML97 worlds and ray-traced pictures of them.

>>> import xvrml
>>> world = xvrml.load("world.wrl")
>>> world["Door"].translation = (0, 0, 2)
>>> picture = world.render(size=(640, 480), spp=16)
>>> picture.save("door.png")

A Browser is a world that runs; time is an argument:

>>> browser = xvrml.Browser("world.wrl")
>>> browser.listen(browser["Door"], "translation_changed", print)
>>> browser.tick(0.5)
>>> browser.render().save("later.png")
"""
import warnings as _warnings

from ._xvrml import (Browser, Cluster, ClusterError, Diagnostic, Node, ParseError, Picture, RenderError, Viewpoint, Worker, World, load,
                     load_node_plugins, __version__)

__all__ = ["Browser", "Cluster", "ClusterError", "Diagnostic", "Node", "ParseError", "Picture", "RenderError", "Viewpoint", "Worker", "World", "load",
           "load_node_plugins", "__version__"]

for _line in load_node_plugins():
    _warnings.warn(_line, RuntimeWarning)
