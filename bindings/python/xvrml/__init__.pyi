# Types of the package for checkers and editors. Those of the nodes are in nodes.pyi, which nodegen
# writes.
import os
from typing import (
    Any,
    BinaryIO,
    Callable,
    ContextManager,
    Dict,
    Iterable,
    Iterator,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    TextIO,
    Tuple,
    TypeVar,
    Union,
    overload,
)

import numpy as np
import numpy.typing as npt

from . import nodes as nodes
from .nodes import *
from .figures import picture as picture, show as show, to_world as to_world
from .notebook import View as _View
from .rt import Raycaster

_Path = Union[str, "os.PathLike[str]"]
_Source = Union[str, "os.PathLike[str]", bytes, BinaryIO, TextIO]
_Callback = Callable[[Any, float], Any]
_Function = TypeVar("_Function", bound=Callable[[Any, float], Any])
_Node = TypeVar("_Node", bound="Node")

__version__: str


class ParseError(ValueError):
    file: str
    line: int
    column: int


class EditError(ValueError):
    ...


class RenderError(RuntimeError):
    ...


class ClusterError(RenderError):
    ...


class Worker:

    @property
    def name(self) -> str:
        ...

    @property
    def here(self) -> bool:
        ...

    @property
    def alive(self) -> bool:
        ...

    @property
    def threads(self) -> int:
        ...

    @property
    def tiles(self) -> int:
        ...

    @property
    def late(self) -> int:
        ...

    @property
    def lost(self) -> int:
        ...

    @property
    def rays(self) -> int:
        ...

    @property
    def bytes_sent(self) -> int:
        ...

    @property
    def bytes_received(self) -> int:
        ...

    @property
    def busy_seconds(self) -> float:
        ...

    @property
    def latency(self) -> float:
        ...


class Cluster:

    def __init__(
        self,
        workers: Union[None, str, Sequence[str]] = ...,
        *,
        key: Union[None, str, os.PathLike[str]] = ...,
        listen: Optional[str] = ...,
        allow_keys: Union[None, str, os.PathLike[str]] = ...,
        local_threads: Optional[int] = ...,
        split: str = ...,
        require: int = ...,
        tolerant: bool = ...,
        shader_path: Union[None, str, os.PathLike[str]] = ...,
        isa: str = ...,
    ) -> None:
        ...

    def __enter__(self) -> Cluster:
        ...

    def __exit__(self, *exception: Any) -> None:
        ...

    def close(self) -> None:
        ...

    @property
    def workers(self) -> List[Worker]:
        ...

    def wait(self, count: int = ..., timeout: float = ...) -> None:
        ...


class Diagnostic:

    @property
    def severity(self) -> str:
        ...

    @property
    def file(self) -> str:
        ...

    @property
    def line(self) -> int:
        ...

    @property
    def column(self) -> int:
        ...

    @property
    def message(self) -> str:
        ...


class ViewpointInfo:

    @property
    def name(self) -> str:
        ...

    @property
    def description(self) -> str:
        ...

    @property
    def matrix(self) -> npt.NDArray[np.float64]:
        ...


class Node:

    @property
    def node_type(self) -> str:
        ...

    @property
    def type(self) -> Any:
        ...

    @property
    def fields(self) -> Any:
        ...

    @property
    def def_name(self) -> Any:
        ...

    def edit(self, field: str) -> ContextManager[npt.NDArray[Any]]:
        ...

    def __getattr__(self, field: str) -> Any:
        ...

    def __setattr__(self, field: str, value: Any) -> None:
        ...


class Mesh:

    @property
    def node(self) -> Node:
        ...

    @property
    def kind(self) -> str:
        ...

    @property
    def matrix(self) -> npt.NDArray[np.float64]:
        ...

    @property
    def vertices(self) -> npt.NDArray[np.float32]:
        ...

    @property
    def world_vertices(self) -> npt.NDArray[np.float64]:
        ...

    @property
    def faces(self) -> npt.NDArray[np.uint32]:
        ...

    @property
    def normals(self) -> Optional[npt.NDArray[np.float32]]:
        ...

    @property
    def texcoords(self) -> Optional[npt.NDArray[np.float32]]:
        ...

    @property
    def colors(self) -> Optional[npt.NDArray[np.float32]]:
        ...

    @property
    def alphas(self) -> Optional[npt.NDArray[np.float32]]:
        ...

    @property
    def radius(self) -> float:
        ...

    @property
    def solid(self) -> bool:
        ...

    @property
    def ccw(self) -> bool:
        ...


_Rgb = Tuple[float, float, float]


class MaterialValues(NamedTuple):
    model: str
    color: _Rgb
    emissive_color: _Rgb
    line_color: _Rgb
    specular_color: _Rgb
    ambient_intensity: float
    shininess: float
    metallic: float
    roughness: float
    transparency: float
    normal_scale: float
    color_texture: Optional[Node]
    emissive_texture: Optional[Node]
    specular_texture: Optional[Node]
    ambient_texture: Optional[Node]
    shininess_texture: Optional[Node]
    normal_texture: Optional[Node]
    metallic_roughness_texture: Optional[Node]
    occlusion_texture: Optional[Node]


class TextureLayer(NamedTuple):
    texture: Node
    transform: npt.NDArray[np.float64]
    mode: str
    source: str
    function: str


class TexturePicture(NamedTuple):
    array: Optional[npt.NDArray[Any]]
    file: bytes
    path: str
    type: str
    error: str


class AppearanceParts(NamedTuple):
    appearance: Optional[Node]
    material: Optional[Node]
    back_material: Optional[Node]
    texture: Optional[Node]
    texture_transform: Optional[Node]
    shader: Optional[Node]
    textures_multiply: bool
    front: MaterialValues
    back: Optional[MaterialValues]
    layers: List[TextureLayer]


class Reach(NamedTuple):
    node: Node
    reason: str


class RenderState:

    @property
    def path(self) -> List[Node]:
        ...

    @property
    def parent(self) -> Optional[Node]:
        ...

    @property
    def name(self) -> str:
        ...

    @property
    def matrix(self) -> npt.NDArray[np.float64]:
        ...

    @property
    def local(self) -> npt.NDArray[np.float64]:
        ...

    @property
    def inner(self) -> Optional[npt.NDArray[np.float64]]:
        ...

    @property
    def planes(self) -> npt.NDArray[np.float64]:
        ...


class DrawnShape:

    @property
    def node(self) -> Shape:
        ...

    @property
    def geometry(self) -> Node:
        ...

    @property
    def path(self) -> List[Node]:
        ...

    @property
    def name(self) -> str:
        ...

    @property
    def matrix(self) -> npt.NDArray[np.float64]:
        ...

    @property
    def mesh(self) -> Mesh:
        ...

    @property
    def appearance(self) -> AppearanceParts:
        ...

    @property
    def planes(self) -> npt.NDArray[np.float64]:
        ...

    @property
    def uses(self) -> int:
        ...

    @property
    def reaches(self) -> Dict[str, Reach]:
        ...


class Renderer:

    def render(self, node: Node, state: RenderState) -> Optional[str]:
        ...

    def leave(self, node: Node, state: RenderState) -> None:
        ...

    def draw(self, shape: DrawnShape) -> None:
        ...


class Pinhole:

    def __init__(self,
                 K: npt.ArrayLike,
                 T: Optional[npt.ArrayLike] = ...,
                 *,
                 center: float = ...) -> None:
        ...

    @classmethod
    def from_pose(cls, K: npt.ArrayLike, pose: npt.ArrayLike, *, center: float = ...) -> "Pinhole":
        ...

    @property
    def K(self) -> npt.NDArray[np.float64]:
        ...

    @property
    def T(self) -> npt.NDArray[np.float64]:
        ...

    @property
    def pose(self) -> npt.NDArray[np.float64]:
        ...

    @property
    def center(self) -> float:
        ...

    def cropped(self, x: int, y: int) -> Pinhole:
        ...

    def project(self, points: npt.ArrayLike) -> npt.NDArray[np.float64]:
        ...

    def rays(self, width: int, height: int) -> npt.NDArray[np.float32]:
        ...


class Measurement:

    @property
    def name(self) -> str:
        ...

    @property
    def quantity(self) -> str:
        ...

    @property
    def unit(self) -> str:
        ...

    @property
    def direction(self) -> Tuple[float, float, float]:
        ...

    @property
    def positions(self) -> npt.NDArray[np.float64]:
        ...

    @property
    def values(self) -> npt.NDArray[np.float32]:
        ...

    @property
    def half_widths(self) -> npt.NDArray[np.float32]:
        ...

    @property
    def trusted(self) -> npt.NDArray[np.bool_]:
        ...

    @property
    def samples(self) -> npt.NDArray[np.uint32]:
        ...

    @property
    def stats(self) -> Dict[str, Any]:
        ...

    @property
    def outdoors(self) -> float:
        ...


class Picture:

    @property
    def array(self) -> npt.NDArray[np.float32]:
        ...

    @property
    def error(self) -> npt.NDArray[np.float32]:
        ...

    @property
    def time(self) -> float:
        ...

    @property
    def display(self) -> npt.NDArray[np.uint8]:
        ...

    @property
    def shape(self) -> Tuple[int, int, int]:
        ...

    @property
    def channels(self) -> Tuple[str, ...]:
        ...

    @property
    def names(self) -> Tuple[str, ...]:
        ...

    @property
    def nodes(self) -> Tuple[Optional[Node], ...]:
        ...

    @property
    def camera(self) -> Optional[Pinhole]:
        ...

    @property
    def stats(self) -> Dict[str, Any]:
        ...

    @property
    def note(self) -> str:
        ...

    def denoised(self, *, threads: int = ..., audit: bool = ...) -> Picture:
        ...

    def doubt(self, colours: npt.ArrayLike) -> npt.NDArray[np.float32]:
        ...

    @property
    def colour(self) -> str:
        ...

    @property
    def exposure(self) -> float:
        ...

    @exposure.setter
    def exposure(self, stops: Union[float, str]) -> None:
        ...

    @property
    def view(self) -> str:
        ...

    @view.setter
    def view(self, curve: str) -> None:
        ...

    def __getitem__(self, key: Any) -> npt.NDArray[Any]:
        ...

    def __array__(self, dtype: Any = ..., copy: Optional[bool] = ...) -> npt.NDArray[Any]:
        ...

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        ...

    def coco(
        self,
        image_id: int = ...,
        file_name: str = ...,
        categories: Union[None, Mapping[str, str], Callable[[str], Optional[str]]] = ...,
        compressed: bool = ...,
        first_id: int = ...,
    ) -> Dict[str, Any]:
        ...

    def matte(self, *names: Union[str, int]) -> npt.NDArray[np.float32]:
        ...

    def _repr_png_(self) -> bytes:
        ...


class Film:

    def __init__(self, path: _Path, fps: float = ...) -> None:
        ...

    def add(self, picture: Union[Picture, npt.NDArray[np.uint8]]) -> None:
        ...

    def close(self) -> None:
        ...

    def __enter__(self) -> Film:
        ...

    def __exit__(self, *exception: Any) -> None:
        ...


class EditStep:

    def __enter__(self) -> None:
        ...

    def __exit__(self, arg0: object, arg1: object, arg2: object) -> None:
        ...


class Editor:

    def __call__(self, name: str) -> EditStep:
        ...

    def set(self, node: Node, field: str, value: object) -> None:
        ...

    def insert(
        self,
        text: str,
        parent: Optional[Node] = ...,
        field: str = ...,
        index: Optional[int] = ...,
    ) -> Node:
        ...

    def use(
        self,
        node: Node,
        parent: Optional[Node] = ...,
        field: str = ...,
        index: Optional[int] = ...,
    ) -> None:
        ...

    def remove(self, node: Node, parent: Optional[Node] = ..., field: str = ...) -> None:
        ...

    def move(
        self,
        node: Node,
        parent: Optional[Node] = ...,
        field: str = ...,
        index: Optional[int] = ...,
    ) -> None:
        ...

    def duplicate(self, node: Node, parent: Optional[Node] = ..., field: str = ...) -> Node:
        ...

    def wrap(self, node: Node, type: str = ...) -> Node:
        ...

    def rename(self, node: Node, name: str) -> None:
        ...

    def add_route(self, from_node: Node, out: str, to_node: Node, in_: str) -> None:
        ...

    def delete_route(self, from_node: Node, out: str, to_node: Node, in_: str) -> None:
        ...

    def undo(self) -> Optional[str]:
        ...

    def redo(self) -> Optional[str]:
        ...

    @property
    def changed(self) -> bool:
        ...

    @property
    def read_only(self) -> Optional[str]:
        ...

    def text(self) -> str:
        ...

    def save(self, path: Optional[_Path] = ..., *, overwrite: bool = ...) -> None:
        ...


class World:

    def __init__(self) -> None:
        ...

    @property
    def path(self) -> str:
        ...

    @property
    def warnings(self) -> List[Diagnostic]:
        ...

    @property
    def names(self) -> Tuple[str, ...]:
        ...

    @property
    def roots(self) -> Tuple[Node, ...]:
        ...

    @property
    def bounds(self) -> Optional[npt.NDArray[np.float64]]:
        ...

    @property
    def viewpoints(self) -> List[ViewpointInfo]:
        ...

    @property
    def time(self) -> float:
        ...

    @time.setter
    def time(self, seconds: float) -> None:
        ...

    @property
    def epoch(self) -> float:
        ...

    @property
    def edit(self) -> Editor:
        ...

    def __getitem__(self, name: str) -> Node:
        ...

    def __contains__(self, name: object) -> bool:
        ...

    def __iter__(self) -> Iterator[str]:
        ...

    def __len__(self) -> int:
        ...

    def add(self, node: _Node, name: Optional[str] = ...) -> _Node:
        ...

    def remove(self, node: Node) -> None:
        ...

    def set_shader(self, selector: str, shader: str) -> int:
        ...

    def route(self, source: _End, target: _End) -> None:
        ...

    def unroute(self, source: _End, target: _End) -> bool:
        ...

    def add_route(self, from_node: Node, out: str, to_node: Node, in_: str) -> bool:
        ...

    def delete_route(self, from_node: Node, out: str, to_node: Node, in_: str) -> bool:
        ...

    @overload
    def on(self, event: _End) -> Callable[[_Function], _Function]:
        ...

    @overload
    def on(self, event: _End, callback: _Function) -> _Function:
        ...

    def listen(self, node: Node, event: str, callback: _Callback) -> int:
        ...

    def unlisten(self, node: Node, number: int) -> None:
        ...

    def to_vrml(self) -> str:
        ...

    def to_x3d(self, encoding: str = ...) -> str:
        ...

    def save(self, path: _Path) -> None:
        ...

    def meshes(self, *, spheres: int = ..., view: Optional[npt.ArrayLike] = ...) -> List[Mesh]:
        ...

    def render_with(self,
                    renderer: Renderer,
                    *,
                    view: Optional[npt.ArrayLike] = ...,
                    spheres: int = ...,
                    all_choices: bool = ...,
                    max_visits: int = ...) -> None:
        ...

    def texture_picture(self, node: Node, decode: bool = ...) -> TexturePicture:
        ...

    def raycaster(self, spheres: int = ...) -> Raycaster:
        ...

    def render(
        self,
        size: Tuple[int, int] = ...,
        spp: Optional[int] = ...,
        viewpoint: Union[None, str, int] = ...,
        camera: Union[None, Pinhole, Sequence[Sequence[float]], npt.NDArray[Any]] = ...,
        fit: bool = ...,
        fov: Optional[float] = ...,
        seed: int = ...,
        threads: int = ...,
        shadows: bool = ...,
        colour: str = ...,
        headlight: Union[str, bool] = ...,
        depth: int = ...,
        channels: Union[None, str, Sequence[str]] = ...,
        transport: str = ...,
        error: float = ...,
        time_limit: float = ...,
        clamp: float = ...,
        cluster: Optional[Cluster] = ...,
        progress: Union[None, bool, Callable[[float], Any]] = ...,
        multiply_textures: bool = ...,
        up: Optional[str] = ...,
        background: Union[None, str, "os.PathLike[str]", Sequence[float]] = ...,
        isa: str = ...,
        follow_images: bool = ...,
        jitter: bool = ...,
        light_stride: int = ...,
        exact_shapes: bool = ...,
        *,
        exposure: Union[float, str] = ...,
        view: str = ...,
        crop: Union[None, Tuple[int, int, int, int], Sequence[int]] = ...,
        depth_along: str = ...,
        preset: Optional[str] = ...,
        studio: Union[None, bool, str, Sequence[float]] = ...,
        from_: Optional[str] = ...,
        ortho: Optional[float] = ...,
        raster: bool = ...,
        point_size: float = ...,
        line_width: float = ...,
        sky: Optional[str] = ...,
    ) -> Picture:
        ...

    def measure(
        self,
        *,
        spp: Optional[int] = ...,
        seed: int = ...,
        threads: int = ...,
        depth: int = ...,
        transport: str = ...,
        error: float = ...,
        time_limit: float = ...,
        cluster: Optional[Cluster] = ...,
        progress: Union[None, bool, Callable[[float], Any]] = ...,
        exact_shapes: bool = ...,
        point_size: float = ...,
        line_width: float = ...,
        sky: Optional[str] = ...,
    ) -> List[Measurement]:
        ...

    def view(self, size: Tuple[int, int] = ..., **options: Any) -> _View:
        ...

    def _repr_png_(self) -> Optional[bytes]:
        ...

    def film(self,
             path: _Path,
             start: float,
             stop: float,
             fps: float = ...,
             **options: Any) -> None:
        ...

    def animate(self,
                start: float,
                stop: float,
                fps: float = ...,
                **options: Any) -> Iterator[Picture]:
        ...


_End = Union[str, Tuple[Node, str]]
_Triple = Union[Tuple[float, float, float], Sequence[float]]


class Browser(World):

    def __init__(
        self,
        source: _Source,
        *,
        start: float = ...,
        limits: Optional[Mapping[str, int]] = ...,
        allow_absolute: bool = ...,
        script_path: Union[None, str, "os.PathLike[str]"] = ...,
        trust: bool = ...,
        epoch: float = ...,
        direct_output_always: bool = ...,
    ) -> None:
        ...

    @property
    def now(self) -> float:
        ...

    @property
    def generation(self) -> int:
        ...

    def tick(self, time: float) -> None:
        ...

    def node(self, name: str) -> Optional[Node]:
        ...

    def create_node(self, type: str, **fields: Any) -> Node:
        ...

    def add_root(self, node: Node) -> None:
        ...

    def remove_root(self, node: Node) -> None:
        ...

    def create_vrml_from_string(self, text: str) -> Tuple[Node, ...]:
        ...

    def load_url(self, urls: Sequence[str]) -> None:
        ...

    def replace_world(self, nodes: Sequence[Node]) -> None:
        ...

    @property
    def bound(self) -> Dict[str, Optional[Node]]:
        ...

    def bind_viewpoint(self, name: str) -> bool:
        ...

    def camera(self, aspect: float = ...) -> npt.NDArray[np.float64]:
        ...

    def set_transition(self, seconds: float) -> None:
        ...

    def pointer(self, x: float, y: float, button: bool = ..., aspect: float = ...) -> None:
        ...

    def pointer_ray(self, origin: _Triple, direction: _Triple, button: bool = ...) -> None:
        ...

    def pointer_leave(self) -> None:
        ...

    @property
    def sensors_at_pointer(self) -> Tuple[Node, ...]:
        ...

    def pick(self,
             origin: _Triple,
             direction: _Triple,
             both_sides: bool = ...) -> Optional[Dict[str, Any]]:
        ...

    def navigate(
        self,
        dt: float,
        *,
        ahead: float = ...,
        right: float = ...,
        up: float = ...,
        turn: float = ...,
        tilt: float = ...,
        roll: float = ...,
    ) -> None:
        ...

    def key(self, name: str, pressed: bool) -> None:
        ...

    def press_key(self, name: str, pressed: bool = ...) -> bool:
        ...

    def type_text(self, text: str) -> bool:
        ...

    @property
    def senses_keys(self) -> bool:
        ...

    @property
    def navigation(self) -> str:
        ...

    @navigation.setter
    def navigation(self, name: str) -> None:
        ...

    def load_inlines(self) -> int:
        ...


class LiveView:

    raw: bool
    on_wake: Optional[Callable[[], Any]]

    def __init__(
        self,
        world: World,
        size: Tuple[int, int] = ...,
        *,
        spp: Optional[int] = ...,
        viewpoint: Union[None, str, int] = ...,
        camera: Union[None, Sequence[Sequence[float]], npt.NDArray[Any]] = ...,
        fit: bool = ...,
        fov: Optional[float] = ...,
        seed: int = ...,
        threads: int = ...,
        shadows: bool = ...,
        colour: str = ...,
        headlight: Union[str, bool] = ...,
        depth: int = ...,
        transport: str = ...,
        clamp: float = ...,
        multiply_textures: bool = ...,
        up: Optional[str] = ...,
        background: Union[None, str, "os.PathLike[str]", Sequence[float]] = ...,
        isa: str = ...,
        exact_shapes: bool = ...,
        studio: Union[None, bool, str, Sequence[float]] = ...,
        point_size: float = ...,
        line_width: float = ...,
    ) -> None:
        ...

    def step(self, now: Optional[float] = ...) -> Optional[float]:
        ...

    def look(self) -> Optional[npt.NDArray[np.uint8]]:
        ...

    def wait(self, timeout: float = ...) -> npt.NDArray[np.uint8]:
        ...

    def event(self, event: Dict[str, Any]) -> None:
        ...

    def resize(self, width: int, height: int) -> None:
        ...

    def close(self) -> None:
        ...

    def __enter__(self) -> LiveView:
        ...

    def __exit__(self, *exception: Any) -> None:
        ...

    @property
    def world(self) -> World:
        ...

    @property
    def is_open(self) -> bool:
        ...

    @property
    def picture(self) -> Optional[npt.NDArray[np.uint8]]:
        ...

    @property
    def is_finished(self) -> bool:
        ...

    @property
    def facts(self) -> Dict[str, Any]:
        ...

    @property
    def camera(self) -> Optional[npt.NDArray[np.float64]]:
        ...

    @property
    def paused(self) -> bool:
        ...

    @paused.setter
    def paused(self, paused: bool) -> None:
        ...

    @property
    def visible(self) -> bool:
        ...

    @visible.setter
    def visible(self, visible: bool) -> None:
        ...


def load_node_plugins(path: Union[None, str, "os.PathLike[str]"] = ...) -> List[str]:
    ...


class Feature(NamedTuple):
    name: str
    text: str
    available: bool
    detail: str
    file: str
    how: str


def features() -> Dict[str, Feature]:
    ...


def denoise(
    colour: npt.ArrayLike,
    albedo: Optional[npt.ArrayLike] = ...,
    normal: Optional[npt.ArrayLike] = ...,
    *,
    threads: int = ...,
) -> npt.NDArray[np.float32]:
    ...


def compare(
    a: Union[_Path, Picture, npt.ArrayLike],
    b: Union[_Path, Picture, npt.ArrayLike],
    *,
    samples: Optional[Tuple[int, int]] = ...,
    variance: bool = ...,
) -> Dict[str, Any]:
    ...


def merge(
    files: Iterable[_Path],
    output: Optional[_Path] = ...,
    *,
    sums: bool = ...,
) -> Picture:
    ...


def load(
    source: _Source,
    *,
    limits: Optional[Mapping[str, int]] = ...,
    allow_absolute: bool = ...,
    step_error: float = ...,
) -> World:
    ...


def loads(
    text: Union[str, bytes],
    path: _Path = ...,
    *,
    limits: Optional[Mapping[str, int]] = ...,
    allow_absolute: bool = ...,
) -> World:
    ...
