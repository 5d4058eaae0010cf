# Types of xvrml.rt.
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union, overload

import numpy as np
import numpy.typing as npt

from . import Mesh, Picture


class Error(RuntimeError):
    ...


class _Thing:

    @property
    def id(self) -> int:
        ...


class Object(_Thing):

    def delete(self) -> None:
        ...


class Instance(_Thing):
    matrix: npt.ArrayLike
    visible: bool
    shader: Optional[Shader]
    fog: Optional[Shader]
    user_data: int

    def delete(self) -> None:
        ...


class Texture(_Thing):

    def delete(self) -> None:
        ...


class Light(_Thing):
    matrix: npt.ArrayLike

    def delete(self) -> None:
        ...


class Shader(_Thing):

    @property
    def name(self) -> str:
        ...

    @property
    def parameters(self) -> Dict[str, Tuple[str, str]]:
        ...

    def __setitem__(self, name: str, value: Any) -> None:
        ...

    def delete(self) -> None:
        ...


_Hits = Dict[str, npt.NDArray[Any]]


class Context:

    def __init__(self, threads: int = ..., *, config: str = ...) -> None:
        ...

    def close(self) -> None:
        ...

    @property
    def closed(self) -> bool:
        ...

    def __enter__(self) -> Context:
        ...

    def __exit__(self, *args: Any) -> None:
        ...

    def mesh(
        self,
        vertices: npt.ArrayLike,
        faces: Optional[npt.ArrayLike] = ...,
        *,
        normals: Optional[npt.ArrayLike] = ...,
        texcoords: Optional[npt.ArrayLike] = ...,
        colors: Optional[npt.ArrayLike] = ...,
        shader: Optional[Shader] = ...,
        name: int = ...,
        cull: bool = ...,
        replaces: Optional[Object] = ...,
    ) -> Object:
        ...

    def sphere(self, radius: float, *, shader: Optional[Shader] = ..., name: int = ...) -> Object:
        ...

    def quadric(
        self,
        coefficients: Sequence[float],
        low: Sequence[float],
        high: Sequence[float],
        *,
        ccw: bool = ...,
        shader: Optional[Shader] = ...,
        name: int = ...,
    ) -> Object:
        ...

    def cylinder(
        self,
        radius: float,
        low: float,
        high: float,
        *,
        ccw: bool = ...,
        shader: Optional[Shader] = ...,
        name: int = ...,
    ) -> Object:
        ...

    def cone(
        self,
        low_radius: float,
        high_radius: float,
        low: float,
        high: float,
        *,
        ccw: bool = ...,
        shader: Optional[Shader] = ...,
        name: int = ...,
    ) -> Object:
        ...

    def asphere(
        self,
        curvature: float,
        semi_aperture: float,
        *,
        conic: float = ...,
        terms: Sequence[float] = ...,
        inner_radius: float = ...,
        ccw: bool = ...,
        shader: Optional[Shader] = ...,
        name: int = ...,
    ) -> Object:
        ...

    def group(self, parts: Sequence[Tuple[Object, Optional[npt.ArrayLike]]]) -> Object:
        ...

    def instance(
        self,
        object: Object,
        matrix: Optional[npt.ArrayLike] = ...,
        *,
        shader: Optional[Shader] = ...,
        name: int = ...,
        user_data: int = ...,
        dynamic: bool = ...,
    ) -> Instance:
        ...

    def move_instances(self, instances: Sequence[Instance], matrices: npt.ArrayLike) -> None:
        ...

    def shader(self, name: str, library: Optional[str] = ..., **parameters: Any) -> Shader:
        ...

    def texture(self,
                pixels: npt.ArrayLike,
                *,
                srgb: bool = ...,
                wrap: str = ...,
                filter: str = ...,
                border: Sequence[float] = ...) -> Texture:
        ...

    def light(self,
              shader: Shader,
              matrix: Optional[npt.ArrayLike] = ...,
              *,
              scope: Optional[Instance] = ...) -> Light:
        ...

    def camera(
        self,
        eye: Sequence[float],
        at: Sequence[float],
        up: Sequence[float] = ...,
        fov: float = ...,
        *,
        height: Optional[float] = ...,
    ) -> None:
        ...

    def camera_shader(self,
                      shader: Optional[Shader],
                      matrix: Optional[npt.ArrayLike] = ...) -> None:
        ...

    def environment(self, shader: Optional[Shader], matrix: Optional[npt.ArrayLike] = ...) -> None:
        ...

    def default_shader(self, shader: Optional[Shader]) -> None:
        ...

    def render(
        self,
        size: Tuple[int, int] = ...,
        spp: Optional[int] = ...,
        *,
        error: float = ...,
        time_limit: float = ...,
        depth: int = ...,
        seed: int = ...,
        transport: str = ...,
        shadows: bool = ...,
        channels: Union[None, str, Sequence[str]] = ...,
        progress: Union[None, bool, Callable[[float], Any]] = ...,
        follow_images: bool = ...,
        jitter: bool = ...,
        light_stride: int = ...,
        depth_along: str = ...,
    ) -> Picture:
        ...

    def cast_rays(self,
                  rays: npt.ArrayLike,
                  *,
                  tnear: float = ...,
                  tfar: float = ...,
                  precision: str = ...) -> _Hits:
        ...

    def test_occlusions(self,
                        rays: npt.ArrayLike,
                        *,
                        tnear: float = ...,
                        tfar: float = ...,
                        precision: str = ...) -> npt.NDArray[np.bool_]:
        ...

    def count_intersections(self,
                            rays: npt.ArrayLike,
                            *,
                            tnear: float = ...,
                            tfar: float = ...,
                            precision: str = ...) -> npt.NDArray[np.int32]:
        ...

    def list_intersections(self,
                           rays: npt.ArrayLike,
                           *,
                           tnear: float = ...,
                           tfar: float = ...,
                           precision: str = ...) -> _Hits:
        ...

    def compute_closest_points(self, query_points: npt.ArrayLike, *, radius: float = ...) -> _Hits:
        ...


class Raycaster:
    INVALID_ID: int
    meshes: List[Any]

    def __init__(self, threads: int = ...) -> None:
        ...

    def add_triangles(self,
                      vertices: npt.ArrayLike,
                      triangles: npt.ArrayLike,
                      matrix: Optional[npt.ArrayLike] = ...) -> int:
        ...

    def add_sphere(self, center: Sequence[float], radius: float) -> int:
        ...

    def add_mesh(self, mesh: Mesh) -> Optional[int]:
        ...

    def update(self,
               which: Union[None, int, npt.ArrayLike, Mesh, Sequence[Mesh]] = ...,
               *,
               matrices: Optional[npt.ArrayLike] = ...,
               vertices: Optional[npt.ArrayLike] = ...,
               triangles: Optional[npt.ArrayLike] = ...) -> None:
        ...

    def cast_rays(self,
                  rays: npt.ArrayLike,
                  nthreads: int = ...,
                  *,
                  tnear: float = ...,
                  tfar: float = ...,
                  precision: str = ...,
                  errors: bool = ...) -> _Hits:
        ...

    def test_occlusions(self,
                        rays: npt.ArrayLike,
                        tnear: float = ...,
                        tfar: float = ...,
                        nthreads: int = ...,
                        *,
                        precision: str = ...) -> npt.NDArray[np.bool_]:
        ...

    def count_intersections(self,
                            rays: npt.ArrayLike,
                            nthreads: int = ...,
                            *,
                            tnear: float = ...,
                            tfar: float = ...,
                            precision: str = ...) -> npt.NDArray[np.int32]:
        ...

    def list_intersections(self,
                           rays: npt.ArrayLike,
                           nthreads: int = ...,
                           *,
                           tnear: float = ...,
                           tfar: float = ...,
                           precision: str = ...,
                           errors: bool = ...) -> _Hits:
        ...

    def compute_closest_points(self,
                               query_points: npt.ArrayLike,
                               nthreads: int = ...,
                               *,
                               radius: float = ...) -> _Hits:
        ...

    def compute_distance(self,
                         query_points: npt.ArrayLike,
                         nthreads: int = ...) -> npt.NDArray[np.float32]:
        ...

    def compute_occupancy(self,
                          query_points: npt.ArrayLike,
                          nthreads: int = ...,
                          nsamples: int = ...,
                          *,
                          precision: str = ...) -> npt.NDArray[np.float32]:
        ...

    def compute_signed_distance(self,
                                query_points: npt.ArrayLike,
                                nthreads: int = ...,
                                nsamples: int = ...) -> npt.NDArray[np.float32]:
        ...

    @overload
    @staticmethod
    def create_rays_pinhole(fov_deg: float, center: npt.ArrayLike, eye: npt.ArrayLike,
                            up: npt.ArrayLike, width_px: int,
                            height_px: int) -> npt.NDArray[np.float32]:
        ...

    @overload
    @staticmethod
    def create_rays_pinhole(intrinsic_matrix: npt.ArrayLike, extrinsic_matrix: npt.ArrayLike,
                            width_px: int, height_px: int) -> npt.NDArray[np.float32]:
        ...


@overload
def create_rays_pinhole(fov_deg: float, center: npt.ArrayLike, eye: npt.ArrayLike,
                        up: npt.ArrayLike, width_px: int,
                        height_px: int) -> npt.NDArray[np.float32]:
    ...


@overload
def create_rays_pinhole(intrinsic_matrix: npt.ArrayLike, extrinsic_matrix: npt.ArrayLike,
                        width_px: int, height_px: int) -> npt.NDArray[np.float32]:
    ...
