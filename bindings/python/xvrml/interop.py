"""Converts worlds and pictures to and from other packages: trimesh, Open3D, PyVista, Pillow, matplotlib.
Each package is imported on first use.

Pictures often need no conversion: numpy.asarray(image) works, and Jupyter shows an image that ends
a cell.
"""
import numpy as np

from . import _placing, _shaping

__all__ = [
    "from_trimesh", "to_trimesh", "from_open3d", "from_pyvista", "to_pyvista", "to_pil", "from_pil",
    "imshow"
]


def from_trimesh(mesh, color=None):
    """Converts a trimesh.Trimesh, Path3D, Path2D or PointCloud to a Shape, or a trimesh.Scene to a
    Group with a Transform for each of its nodes. The texture of a mesh is that of its base colour.
    color: of what has none; of a mesh, instead of its own."""
    import xvrml
    if hasattr(mesh, "graph") and hasattr(mesh, "geometry"):
        shapes = {name: from_trimesh(one, color) for name, one in mesh.geometry.items()}
        group = xvrml.Group()
        children = []
        for name in mesh.graph.nodes_geometry:
            matrix, geometry = mesh.graph[name]
            matrix = np.asarray(matrix, float)
            if np.linalg.det(matrix[:3, :3]) > 0:
                children.append(_placing.placed(shapes[geometry], matrix))
            else:  # a Transform cannot mirror
                children.append(
                    from_trimesh(mesh.geometry[geometry].copy().apply_transform(matrix), color))
        group.children = children
        return group
    if hasattr(mesh, "entities"):
        return _from_path(mesh, color)
    if not hasattr(mesh, "faces"):
        return _from_cloud(mesh, color)
    geometry = xvrml.IndexedFaceSet(
        coord=xvrml.Coordinate(point=np.asarray(mesh.vertices, np.float32)),
        coordIndex=_shaping.index(mesh.faces),
        solid=bool(mesh.is_watertight))
    visual = getattr(mesh, "visual", None)
    if color is None and getattr(visual, "kind", None) == "vertex":
        geometry.color = xvrml.Color(color=np.asarray(visual.vertex_colors)[:, :3] / 255)
    elif color is None and getattr(visual, "kind", None) == "face":
        geometry.color = xvrml.Color(color=np.asarray(visual.face_colors)[:, :3] / 255)
        geometry.colorPerVertex = False
    shape = _shaping.faces(geometry, color)
    image, factor = _texture(visual) if color is None else (None, None)
    if image is None:
        return shape
    geometry.texCoord = xvrml.TextureCoordinate(point=np.asarray(visual.uv, np.float32))
    shape.appearance = _shaping.textured(xvrml.Material(diffuseColor=factor), from_pil(image))
    return shape


def _texture(visual):
    """Returns the picture of a trimesh visual and the colour that multiplies it, or None twice."""
    material = getattr(visual, "material", None)
    image = getattr(material, "baseColorTexture", None)  # PBRMaterial
    factor = getattr(material, "baseColorFactor", None)
    if image is None:
        image, factor = getattr(material, "image", None), None  # SimpleMaterial
    if image is None or getattr(visual, "uv", None) is None:
        return None, None
    if factor is None:
        return image, (1, 1, 1)
    factor = np.asarray(factor)
    return image, tuple(factor[:3] / (255 if factor.dtype == np.uint8 else 1))


def _from_path(path, color):
    scale = path.scale if len(path.entities) else 1  # decides how finely arcs are divided
    runs, colors = [], []
    for entity in path.entities:
        run = np.asarray(entity.discrete(path.vertices, scale=scale), float)
        if len(run) < 2:  # a text
            continue
        runs.append(np.pad(run, ((0, 0), (0, 3 - run.shape[1]))))
        colors.append((0.8, 0.8, 0.8) if entity.color is None else np.asarray(entity.color)[:3] / 255)
    return _shaping.lines(runs, None if color is not None else colors, color)


def _from_cloud(cloud, color):
    import xvrml
    geometry = xvrml.PointSet(
        coord=xvrml.Coordinate(point=np.asarray(cloud.vertices, np.float32)))
    colors = getattr(cloud, "colors", None)
    if color is None and colors is not None and len(colors) == len(cloud.vertices):
        geometry.color = xvrml.Color(color=np.asarray(colors)[:, :3] / 255)
    return _shaping.thin(geometry, (0.8, 0.8, 0.8) if color is None else color)


def from_open3d(geometry, color=None):
    """Converts a TriangleMesh, a PointCloud or a LineSet of Open3D to a Shape, with its colours.
    color: of what has none."""
    import xvrml

    def array(name):
        values = np.asarray(getattr(geometry, name, ()))
        return values if len(values) else None

    own = array("vertex_colors") if hasattr(geometry, "triangles") else array("colors")
    vertices = array("vertices" if hasattr(geometry, "triangles") else "points")
    if vertices is None:
        raise ValueError(f"geometry: points expected; the {type(geometry).__name__} has none")
    if hasattr(geometry, "lines"):
        made = xvrml.IndexedLineSet(coordIndex=_shaping.index(geometry.lines), colorPerVertex=False)
    elif hasattr(geometry, "triangles"):
        made = xvrml.IndexedFaceSet(coordIndex=_shaping.index(geometry.triangles), solid=False)
        normals = array("vertex_normals")
        if normals is not None:
            made.normal = xvrml.Normal(vector=normals)
    else:
        made = xvrml.PointSet()
    made.coord = xvrml.Coordinate(point=vertices)
    if color is None and own is not None:
        made.color = xvrml.Color(color=np.clip(own, 0, 1))
    shown = (0.8, 0.8, 0.8) if color is None else color
    return (_shaping.faces if hasattr(geometry, "triangles") else _shaping.thin)(made, shown)


def from_pyvista(thing, scalars=None, *, cmap="viridis", clim=None, color=None):
    """Converts a data set of PyVista or VTK to a Shape or a Group of them, a MultiBlock to a Group,
    and a Plotter to a Group of its actors, its camera (a Viewpoint) and the lights that it has in its
    scene; lights that follow the camera are left to the renderer.

    scalars  name of the array that gives the colours; None: the active one
    cmap     name of a colour map of matplotlib, a Colormap, or a function
    clim     the values at its ends; None: the least and the largest
    color    instead of scalars

    A Plotter has its own colours: the last four are ignored for it. Volumes and texts are left out."""
    from . import _pyvista
    return _pyvista.convert(thing, scalars, cmap, clim, color)


def _meshes(world, spheres):
    return [mesh for mesh in world.meshes(spheres=spheres) if mesh.kind == "triangles"]


def _outward(mesh):
    """Returns the faces in counter-clockwise order as seen from the front, wherever the mesh is
    placed."""
    faces = mesh.faces
    return faces if mesh.ccw == (np.linalg.det(mesh.matrix[:3, :3]) > 0) else faces[:, ::-1]


def to_trimesh(world, spheres=32):
    """Returns a trimesh.Scene of everything that is drawn. Its names are those of the Shapes."""
    import trimesh
    scene = trimesh.Scene()
    for mesh in _meshes(world, spheres):
        made = trimesh.Trimesh(mesh.vertices,
                               mesh.faces if mesh.ccw else mesh.faces[:, ::-1],
                               process=False)
        color = _color(mesh)
        made.visual.vertex_colors = (np.clip(
            mesh.colors if mesh.colors is not None else np.tile(color,
                                                                (len(mesh.vertices), 1)), 0, 1) *
                                     255).astype(np.uint8)
        scene.add_geometry(made, node_name=mesh.node.def_name or None, transform=mesh.matrix)
    return scene


def _color(mesh):
    appearance = mesh.node.appearance
    material = appearance.material if appearance is not None and hasattr(appearance,
                                                                         "material") else None
    return material.diffuseColor if material is not None and hasattr(
        material, "diffuseColor") else (0.8, 0.8, 0.8)


def to_pyvista(world, spheres=32):
    """Returns a pyvista.MultiBlock of everything that is drawn, in world coordinates."""
    import pyvista
    blocks = pyvista.MultiBlock()
    for number, mesh in enumerate(_meshes(world, spheres)):
        faces = _outward(mesh)
        cells = np.empty((len(faces), 4), np.int64)
        cells[:, 0], cells[:, 1:] = 3, faces
        made = pyvista.PolyData(mesh.world_vertices, cells.ravel())
        if mesh.colors is not None:
            made.point_data["colors"] = mesh.colors
        blocks.append(made, mesh.node.def_name or f"shape{number}")
    return blocks


def to_pil(image):
    """Returns a PIL.Image that shows a picture as a screen does."""
    from PIL import Image
    return Image.fromarray(image.display, "RGB")


def from_pil(image):
    """Returns a PixelTexture made from a PIL.Image."""
    import xvrml
    pixels = np.asarray(image if image.mode in ("L", "LA", "RGB",
                                                "RGBA") else image.convert("RGBA"))
    return xvrml.PixelTexture(image=pixels)


def imshow(image, channel=None, ax=None, **options):
    """Shows a picture, or one of its channels, in matplotlib's axes."""
    import matplotlib.pyplot as plt
    ax = ax or plt.gca()
    return ax.imshow(image.display if channel is None else image[channel], **options)
