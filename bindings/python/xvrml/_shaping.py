"""Makes Shapes in one colour, and indices of cells, for what comes from other packages."""
import numpy as np

import xvrml


def faces(geometry, color=None):
    """Returns a Shape of faces. color: where they have none of their own; None: that of a
    Material."""
    material = xvrml.Material() if color is None else xvrml.Material(diffuseColor=tuple(color)[:3])
    return xvrml.Shape(geometry=geometry, appearance=xvrml.Appearance(material=material))


def thin(geometry, color):
    """Returns a Shape of lines or points, which show emissiveColor (clauses 6.24, 6.36)."""
    material = xvrml.Material(emissiveColor=tuple(color)[:3])
    return xvrml.Shape(geometry=geometry, appearance=xvrml.Appearance(material=material))


def index(cells):
    """Returns rows of indices with -1 behind each."""
    cells = np.asarray(cells)
    made = np.full((len(cells), cells.shape[1] + 1), -1, np.int32)
    made[:, :-1] = cells
    return made.ravel()
