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


def lines(runs, colors, color=None):
    """Returns a Shape of lines. runs: an array of points (n, 3) for each of them. colors: a colour
    for each; None: all have `color`."""
    counts = [len(run) for run in runs]
    cells = np.full(sum(counts) + len(runs), -1, np.int32)
    first = 0
    for number, count in enumerate(counts):
        cells[first + number:first + number + count] = np.arange(first, first + count)
        first += count
    points = np.concatenate(runs) if runs else np.zeros((0, 3))
    geometry = xvrml.IndexedLineSet(coord=xvrml.Coordinate(point=np.asarray(points, np.float32)),
                                    coordIndex=cells)
    if colors:
        geometry.color = xvrml.Color(color=np.asarray(colors, np.float32))
        geometry.colorPerVertex = False
    return thin(geometry, (0.8, 0.8, 0.8) if color is None else color)


def textured(material, texture):
    """Returns an Appearance of a material and a PixelTexture that its colour multiplies. In VRML97
    the texture replaces the colour, so the pixels are multiplied, and the colour becomes white."""
    shown = "baseColor" if hasattr(material, "baseColor") else "diffuseColor"
    color = np.asarray(getattr(material, shown), float)
    pixels = np.asarray(texture.image)
    if pixels.shape[2] >= 3 and (color != 1).any():
        tinted = pixels.astype(float)
        tinted[..., :3] *= color
        texture.image = np.round(tinted).astype(np.uint8)
    if pixels.shape[2] >= 3:  # grey ones are multiplied
        setattr(material, shown, (1, 1, 1))
    return xvrml.Appearance(material=material, texture=texture)


def index(cells):
    """Returns rows of indices with -1 behind each."""
    cells = np.asarray(cells)
    made = np.full((len(cells), cells.shape[1] + 1), -1, np.int32)
    made[:, :-1] = cells
    return made.ravel()
