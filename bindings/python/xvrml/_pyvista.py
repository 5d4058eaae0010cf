"""Converts what PyVista shows to nodes (interop.from_pyvista): the surfaces, lines and points of data
sets with the colours of their scalars, and the actors, the camera and the lights of a Plotter."""
import warnings

import numpy as np

import xvrml

from . import _placing, _shaping
from .figures import map_colors


def convert(thing, scalars, cmap, clim, color):
    if hasattr(thing, "renderer") and hasattr(thing, "camera"):
        return _plotter(thing)
    if not hasattr(thing, "active_scalars") and not hasattr(thing, "n_blocks"):  # VTK itself
        import pyvista
        thing = pyvista.wrap(thing)
    if hasattr(thing, "n_blocks"):
        if clim is None and scalars is not None and color is None:  # one range for all blocks
            low, high = thing.get_data_range(scalars, allow_missing=True)
            clim = (low, high) if np.isfinite([low, high]).all() else None
        return xvrml.Group(children=[
            convert(block, scalars, cmap, clim, color) for block in thing if block is not None
        ])
    values = thing.active_scalars if scalars is None else None
    if scalars is not None and scalars in thing.array_names:
        values = thing[scalars]
    colors = None
    if color is None and values is not None:
        colors = np.asarray(values)
        is_color = colors.ndim == 2 and colors.shape[1] in (3, 4)
        if is_color and colors.dtype == np.uint8:
            colors = colors[:, :3] / np.float32(255)
        elif is_color and scalars is None:
            colors = None  # vectors are no colours
        else:
            magnitude = np.linalg.norm(colors, axis=1) if colors.ndim == 2 else colors
            colors = map_colors(magnitude, cmap, clim)
    material = xvrml.Material() if color is None else xvrml.Material(diffuseColor=tuple(color)[:3])
    return _shapes(thing, colors, material)


def _shapes(data, colors, material, crease=0, textured=None):
    """Returns a Shape, or a Group of them, of the surface, the lines and the points of a data set.
    colors: one for each of its points, or of its cells, or None. crease: a creaseAngle. textured: an
    Appearance for the faces, if they have places in a texture; None: they are of the material."""
    places = None if textured is None else data.active_texture_coordinates
    per_point = colors is not None and len(colors) == data.n_points
    if colors is not None and not per_point and len(colors) != data.n_cells:
        colors = None
    copy = data.copy(deep=False)
    copy.clear_data()
    if colors is not None:
        (copy.point_data if per_point else copy.cell_data)["xvrml"] = colors
    if places is not None:
        copy.point_data["xvrml texture"] = np.asarray(places)[:, :2]
    surface = copy if hasattr(copy, "lines") else _surface(copy)
    if surface.n_strips:
        surface = surface.triangulate()
    shapes = []
    first = 0  # the cells of a PolyData are its vertices, lines and faces, in this order
    for kind, cells in (("points", surface.verts), ("lines", surface.lines), ("faces",
                                                                           surface.faces)):
        index, starts = _index(np.asarray(cells))
        count = len(starts) - 1
        if count:
            of_points = np.asarray(surface.point_data["xvrml"]) if per_point else None
            of_cells = None
            if colors is not None and not per_point:
                of_cells = np.asarray(surface.cell_data["xvrml"])[first:first + count]
            shape = _shape(kind, surface.points, (index, starts), of_points, of_cells, material,
                           crease)
            if kind == "faces" and places is not None:
                shape.appearance = textured
                shape.geometry.texCoord = xvrml.TextureCoordinate(
                    point=np.asarray(surface.point_data["xvrml texture"], np.float32))
            shapes.append(shape)
        first += count
    if len(shapes) == 1:
        return shapes[0]
    return xvrml.Group(children=shapes)


def _texture(actor):
    """Returns the texture of an actor as a PixelTexture, or None."""
    prop = actor.prop
    texture = actor.GetTexture() or (prop.GetTexture("albedoTex") if hasattr(prop, "GetTexture") else
                                     None)
    if texture is None:
        return None
    texture.Update()
    image = texture.GetInput()
    scalars = None if image is None else image.GetPointData().GetScalars()
    if scalars is None:
        return None
    from vtkmodules.util.numpy_support import vtk_to_numpy
    width, height, _ = image.GetDimensions()
    pixels = vtk_to_numpy(scalars).reshape(height, width, -1)[::-1]  # VTK begins at the bottom
    if pixels.dtype != np.uint8 or pixels.shape[2] > 4:
        return None  # numbers that a table of colours would map
    repeat = bool(texture.GetRepeat())
    return xvrml.PixelTexture(image=np.ascontiguousarray(pixels), repeatS=repeat, repeatT=repeat)


def _surface(data):
    """Returns the surface of a data set as a PolyData."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # newer versions want an argument that older ones do not know
        return data.extract_surface()


def _shape(kind, points, cells, of_points, of_cells, material, crease):
    coord = xvrml.Coordinate(point=np.asarray(points, np.float32))
    index, starts = cells
    if kind == "points":
        used = index[index >= 0]
        geometry = xvrml.PointSet(coord=xvrml.Coordinate(point=np.asarray(points, np.float32)[used]))
        if of_points is not None:
            geometry.color = xvrml.Color(color=of_points[used])
        elif of_cells is not None:
            geometry.color = xvrml.Color(color=np.repeat(of_cells, np.diff(starts), axis=0))
    elif kind == "lines":
        geometry = xvrml.IndexedLineSet(coord=coord, coordIndex=index)
    else:
        geometry = xvrml.IndexedFaceSet(coord=coord, coordIndex=index, solid=False, creaseAngle=crease)
    if kind != "points" and (of_points is not None or of_cells is not None):
        geometry.color = xvrml.Color(color=of_points if of_points is not None else of_cells)
        geometry.colorPerVertex = of_points is not None
    if kind != "faces":  # lines and points show emissiveColor (clauses 6.24, 6.36)
        shown = "baseColor" if hasattr(material, "baseColor") else "diffuseColor"
        return _shaping.thin(geometry, getattr(material, shown))
    return xvrml.Shape(geometry=geometry, appearance=xvrml.Appearance(material=material))


def _index(cells):
    """Returns the cells of VTK (n, i1, ... in, m, ...) as indices with -1 after each cell, and the
    numbers of indices before each cell and after the last."""
    index = np.empty(len(cells), np.int32)
    starts, at = [0], 0
    while at < len(cells):
        count = int(cells[at])
        index[at:at + count] = cells[at + 1:at + 1 + count]
        index[at + count] = -1
        starts.append(starts[-1] + count)
        at += count + 1
    return index, np.array(starts)


def _plotter(plotter):
    """Returns a Group of what a Plotter shows: its camera as a Viewpoint or an OrthoViewpoint, its
    background, the lights that stand in its scene, and its visible actors that have a data set."""
    sky = tuple(plotter.renderer.GetBackground())
    children = [_viewpoint(plotter.camera), xvrml.Background(skyColor=[sky])]
    for light in plotter.renderer.lights:
        if light.on and light.is_scene_light:
            children.append(_light(light))
    for actor in plotter.renderer.actors.values():
        mapper = getattr(actor, "mapper", None)
        data = getattr(mapper, "dataset", None)
        is_surface = hasattr(getattr(actor, "prop", None), "GetInterpolation")
        if data is None or not actor.GetVisibility() or not is_surface:
            continue
        material = _material(actor.prop)
        crease = 0 if actor.prop.GetInterpolation() == 0 else np.pi  # VTK_FLAT
        texture = _texture(actor)
        look = None if texture is None else _shaping.textured(_material(actor.prop), texture)
        if hasattr(data, "n_blocks"):
            shape = xvrml.Group(children=[
                _shapes(block, None, material, crease, look)
                for block in data.recursive_iterator(skip_none=True)
            ])
        else:
            shape = _shapes(data, _shown_colors(mapper), material, crease, look)
        children.append(_placing.placed(shape, _matrix(actor)))
    return xvrml.Group(children=children)


def _matrix(actor):
    matrix = actor.GetMatrix()
    return np.array([[matrix.GetElement(row, column) for column in range(4)] for row in range(4)])


def _shown_colors(mapper):
    """Returns the colours that the mapper gives to points or cells, or None."""
    if not mapper.GetScalarVisibility():
        return None
    interpolates = mapper.GetInterpolateScalarsBeforeMapping()
    mapper.InterpolateScalarsBeforeMappingOff()  # with it, VTK makes a texture of the colours
    colors = mapper.MapScalars(1.0)
    mapper.SetInterpolateScalarsBeforeMapping(interpolates)
    if colors is None:
        return None
    from vtkmodules.util.numpy_support import vtk_to_numpy
    return vtk_to_numpy(colors)[:, :3] / np.float32(255)


def _material(prop):
    color, clear = tuple(prop.GetColor()), 1 - float(prop.GetOpacity())
    if prop.GetInterpolation() == 3:  # VTK_PBR
        return xvrml.PhysicalMaterial(baseColor=color,
                                      metallic=float(prop.GetMetallic()),
                                      roughness=float(prop.GetRoughness()),
                                      transparency=clear)
    specular = float(prop.GetSpecular())
    return xvrml.Material(diffuseColor=color,
                          specularColor=tuple(specular * c for c in prop.GetSpecularColor()),
                          shininess=min(1, float(prop.GetSpecularPower()) / 128),
                          ambientIntensity=min(1, float(prop.GetAmbient())),
                          transparency=clear)


def _viewpoint(camera):
    place, up = np.array(camera.position, float), np.array(camera.up, float)
    back = place - np.array(camera.focal_point, float)
    back /= np.linalg.norm(back)
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    rotation = np.stack([right, np.cross(back, right), back], axis=1)
    given = dict(position=place, orientation=_placing.axis_angle(rotation))
    if camera.parallel_projection:
        half = float(camera.parallel_scale)
        return xvrml.OrthoViewpoint(fieldOfView=(-half, -half, half, half), **given)
    return xvrml.Viewpoint(fieldOfView=np.radians(camera.view_angle), **given)


def _light(light):
    place = np.array(light.position, float)
    along = np.array(light.focal_point, float) - place
    color = dict(color=tuple(light.diffuse_color)[:3], intensity=min(1, float(light.intensity)))
    if not light.positional:
        return xvrml.DirectionalLight(direction=along, **color)
    if light.cone_angle < 90:
        angle = np.radians(light.cone_angle)
        return xvrml.SpotLight(location=place, direction=along, cutOffAngle=angle, beamWidth=angle,
                               radius=1e6, **color)
    return xvrml.PointLight(location=place, radius=1e6, **color)
