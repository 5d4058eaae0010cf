"""Provides a class for every node type. xvrml.Box(size=(1, 2, 3)) creates a node that is in no
world yet; keywords are fields.

The classes come from the tables that nodegen writes from the .node files, including those of node
plug-ins.
"""
from . import _xvrml

__all__ = sorted(_xvrml._node_classes())
globals().update(_xvrml._node_classes())


def __getattr__(name):
    try:
        return _xvrml._node_classes()[name]
    except KeyError:
        raise AttributeError(f"there is no node type {name}") from None
