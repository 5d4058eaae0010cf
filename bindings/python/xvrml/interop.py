"""Converts worlds and pictures to and from other packages: trimesh, PyVista, Pillow, matplotlib.
Each package is imported on first use.

Pictures often need no conversion: numpy.asarray(image) works, and Jupyter shows an image that ends
a cell.
"""
import numpy as np

__all__ = ["from_trimesh", "to_trimesh", "to_pyvista", "to_pil", "from_pil", "imshow"]


def from_trimesh(mesh, color=None):
    """Converts a trimesh.Trimesh to a Shape, or a trimesh.Scene to a Group with a Transform for
    each of its nodes."""
    import xvrml
    if hasattr(mesh, "graph") and hasattr(mesh, "geometry"):
        shapes = {
            name: from_trimesh(one, color)
            for name, one in mesh.geometry.items()
            if hasattr(one, "faces")
        }
        group = xvrml.Group()
        children = []
        for name in mesh.graph.nodes_geometry:
            matrix, geometry = mesh.graph[name]
            if geometry not in shapes:
                continue
            matrix = np.asarray(matrix, float)
            if np.linalg.det(matrix[:3, :3]) > 0:
                children.append(_placed(shapes[geometry], matrix))
            else:  # a Transform cannot mirror
                children.append(
                    from_trimesh(mesh.geometry[geometry].copy().apply_transform(matrix), color))
        group.children = children
        return group
    faces = np.asarray(mesh.faces)
    index = np.full((len(faces), 4), -1, np.int32)
    index[:, :3] = faces
    geometry = xvrml.IndexedFaceSet(
        coord=xvrml.Coordinate(point=np.asarray(mesh.vertices, np.float32)),
        coordIndex=index.ravel(),
        solid=bool(mesh.is_watertight))
    visual = getattr(mesh, "visual", None)
    if color is None and getattr(visual, "kind", None) == "vertex":
        geometry.color = xvrml.Color(color=np.asarray(visual.vertex_colors)[:, :3] / 255)
    elif color is None and getattr(visual, "kind", None) == "face":
        geometry.color = xvrml.Color(color=np.asarray(visual.face_colors)[:, :3] / 255)
        geometry.colorPerVertex = False
    material = xvrml.Material(diffuseColor=color) if color is not None else xvrml.Material()
    return xvrml.Shape(geometry=geometry, appearance=xvrml.Appearance(material=material))


def _placed(shape, matrix):
    """Returns a Transform that is equivalent to the matrix. Translation, rotation and scale come
    from its singular value decomposition."""
    import xvrml
    if np.allclose(matrix, np.eye(4)):
        return shape
    u, s, vt = np.linalg.svd(matrix[:3, :3])
    if np.linalg.det(vt) < 0:
        vt, u = -vt, -u
    rotation = u @ vt
    return xvrml.Transform(translation=matrix[:3, 3],
                           rotation=_axis_angle(rotation),
                           scale=s,
                           scaleOrientation=_axis_angle(vt.T),
                           children=[shape])


def _axis_angle(r):
    angle = np.arccos(np.clip((np.trace(r) - 1) / 2, -1, 1))
    if angle < 1e-12:
        return (0, 0, 1, 0)
    if np.pi - angle < 1e-6:
        column = np.argmax(np.diag(r))
        axis = (r + np.eye(3))[:, column]
    else:
        axis = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    return (*(axis / np.linalg.norm(axis)), angle)


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
