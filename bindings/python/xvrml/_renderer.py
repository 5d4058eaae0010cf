"""Implements Renderer, the base class of renderers for worlds, and World.render_with()."""
import difflib
import re
from typing import Any, NamedTuple, Optional

from . import _arguments, _xvrml


class Renderer:
    """The base of classes that draw worlds in a way of their own, or gather what is in them.

    A method render_TYPE(node, state) is called for each node of that type: render_transform,
    render_indexed_face_set, render_ort_shader, and render_instance for instances of prototypes.
    render(node, state) is called for each node without such a method. They return None or
    "children" to go on into the node's children, or "skip" to leave out the node and everything
    below it. For a Shape, "draw" draws it without visiting its appearance and geometry.

    World.render_with() walks over the world and calls the methods. Lengths are in metres."""

    def render(self, node, state):
        """Called for each node whose type has no method of its own. state: a RenderState."""

    def leave(self, node, state):
        """Called after the children of each node that were visited."""

    def draw(self, shape):
        """Called for each Shape with a geometry. shape: a DrawnShape."""


class MaterialValues(NamedTuple):
    """The values of a material of any type under one name each."""
    model: str  # "none" (no material), "phong", "physical" or "unlit"
    color: tuple  # diffuseColor, baseColor, or the emissiveColor of an UnlitMaterial
    emissive_color: tuple
    line_color: tuple  # that lines and points have
    specular_color: tuple
    ambient_intensity: float
    shininess: float
    metallic: float
    roughness: float
    transparency: float
    normal_scale: float
    color_texture: Optional[Any]  # nodes; None: no texture
    emissive_texture: Optional[Any]
    specular_texture: Optional[Any]
    ambient_texture: Optional[Any]
    shininess_texture: Optional[Any]
    normal_texture: Optional[Any]
    metallic_roughness_texture: Optional[Any]
    occlusion_texture: Optional[Any]


class TextureLayer(NamedTuple):
    """One picture that gives a surface its colour."""
    texture: Any  # the node
    transform: Any  # 4x4 matrix from texture coordinates of the mesh to those of the picture
    mode: str  # mode, source and function of a MultiTexture; "": its defaults
    source: str
    function: str


class TexturePicture(NamedTuple):
    """The picture of a texture node."""
    array: Optional[Any]  # uint8 (height, width, components), or float32 of radiances; None: no picture
    file: bytes  # the bytes of the file; b"": it comes from no file
    path: str
    type: str  # "image/png" and the like; "": it comes from no file
    error: str  # why there is no picture; "": there is one, or the node names none


class AppearanceParts(NamedTuple):
    """The appearance of a Shape with its references resolved: nodes, or None."""
    appearance: Optional[Any]  # Appearance or ORTAppearance
    material: Optional[Any]
    back_material: Optional[Any]
    texture: Optional[Any]
    texture_transform: Optional[Any]
    shader: Optional[Any]  # the ORTShader of an ORTAppearance
    textures_multiply: bool  # a colour texture multiplies the material's colour, as in X3D
    front: MaterialValues
    back: Optional[MaterialValues]  # None: as front
    layers: list  # each a TextureLayer


class Reach(NamedTuple):
    """The node that an event can reach, and the cause."""
    node: Any
    reason: str  # "ROUTE from Clock.fraction_changed"


def callback_name(node_type):
    """Returns the name of the method for a node type: IndexedFaceSet is render_indexed_face_set."""
    return "render_" + re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_",
                              node_type).lower()


def _callbacks(renderer):
    """Returns the methods of a renderer by node type, and that for instances of prototypes."""
    own = type(renderer)
    types = {callback_name(name): name for name in _xvrml._node_classes()}
    for name in dir(own):
        if name.startswith("render_") and name not in types and name != "render_instance":
            near = difflib.get_close_matches(name, [*types, "render_instance"], 1, 0.85)
            if near:
                raise TypeError(
                    f"{own.__name__}.{name}: no node type has such a method; did you mean {near[0]}?"
                )
    general = renderer.render if own.render is not Renderer.render else None
    by_type = {
        node_type: getattr(renderer, name, general)
        for name, node_type in types.items()
    }
    return by_type, getattr(renderer, "render_instance", general)


def render_with(self, renderer, *, view=None, spheres=32, all_choices=False, max_visits=4_000_000):
    """Walks over the world as it is now, and calls the methods of a Renderer for its nodes and
    Shapes. Exceptions of the methods end the walk and pass through. The methods cannot change the
    world.

    view: camera-to-world matrix, for levels of detail and billboards. spheres: as for meshes().
    all_choices: go into all children of a Switch and all levels of an LOD. max_visits: more visits
    to nodes raise ValueError."""
    if not isinstance(renderer, Renderer):
        raise TypeError("render_with(): renderer: an object of a class derived from xvrml.Renderer "
                        f"expected, not {_arguments._short(renderer)}")
    own = type(renderer)
    by_type, instance = _callbacks(renderer)
    self._render_with(by_type, instance,
                      renderer.leave if own.leave is not Renderer.leave else None,
                      renderer.draw if own.draw is not Renderer.draw else None, view,
                      _arguments.whole("render_with(): spheres", spheres, 0, 1000),
                      bool(all_choices),
                      _arguments.whole("render_with(): max_visits", max_visits, 1, 2**64 - 1))
