"""VRML97 worlds and ray-traced pictures of them.

>>> import xvrml
>>> world = xvrml.load("world.wrl")
>>> world["Door"].translation = (0, 0, 2)
>>> picture = world.render(size=(640, 480), spp=16)
>>> picture.save("door.png")
"""
from ._xvrml import Diagnostic, Node, ParseError, Picture, RenderError, Viewpoint, World, load, __version__

__all__ = ["Diagnostic", "Node", "ParseError", "Picture", "RenderError", "Viewpoint", "World", "load", "__version__"]
