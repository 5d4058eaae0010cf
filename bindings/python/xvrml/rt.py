"""The renderer without VRML: OpenRT contexts, and ray queries on meshes under the names of Open3D's
RaycastingScene.

>>> from xvrml import rt
>>> with rt.Context() as context:
...     red = context.shader("VRML97", diffuseColor=(1, 0, 0))
...     context.instance(context.mesh(vertices, faces, shader=red))
...     context.light(context.shader("VRML97DirectionalLight", direction=(0, 0, -1)))
...     context.camera(eye=(0, 0, 5), at=(0, 0, 0))
...     context.render(size=(640, 480)).save("red.png")

>>> caster = rt.Raycaster()
>>> caster.add_triangles(vertices, triangles)
0
>>> caster.cast_rays(rays)["t_hit"]
"""
import functools
import threading

import numpy as np

from . import _arguments
from ._camera import Pinhole, _matrix, _rigid
from ._xvrml import rt as _rt
from ._xvrml.rt import Context, Error, Instance, Light, Object, Shader, Texture

__all__ = [
    "Context", "Error", "Instance", "Light", "Object", "Raycaster", "Shader", "Texture",
    "create_rays_pinhole"
]

for _class in (Context, Instance, Light, Object, Shader, Texture):
    _arguments.explain_class(_class)

_FIVE = ("t_hit", "geometry_ids", "primitive_ids", "primitive_uvs", "primitive_normals")
_ERRORS = ("t_errors", "uv_errors", "point_errors")


def _corners(vertices, triangles, method="add_triangles"):
    """Checks the triangles and returns them as vertex indices."""
    count = len(_arguments.array(f"{method}(): vertices", vertices, (None, 3)))
    corners = _arguments.array(f"{method}(): triangles", triangles, (None, 3))
    if corners.dtype.kind not in "iu":
        for odd in corners[corners != np.floor(corners)][:1]:  # also catches NaN
            raise ValueError(f"{method}(): triangles: whole numbers expected, not {odd:g}")
    for none in corners[(corners < 0) | (corners >= count)][:1]:
        raise ValueError(f"{method}(): triangles: {none:.0f} is no vertex: there are {count}")
    return np.ascontiguousarray(corners, np.uint32)


def _check_finite(vertices, corners):
    """Checks the vertices that triangles use before anything is changed."""
    good = np.abs(np.asarray(vertices, np.float64)).max(1, initial=0) <= 1e38  # false for NaN
    for i in corners[~good[corners]][:1]:
        raise ValueError(f"update(): vertices: numbers within 1e38 expected, not {vertices[i]}")


def _check_precision(precision, errors):
    if precision not in ("single", "double"):
        raise ValueError(f"precision: 'single' or 'double' expected, not {precision!r}")
    if errors and precision == "single":
        raise ValueError("errors: bounds of errors are known with precision='double' only")


def _alone(method):
    """Lets calls of several threads run one after the other: the numbers of a query's hits belong
    to the bodies that the query has met."""

    @functools.wraps(method)
    def call(self, *args, **options):
        with self._lock:
            return method(self, *args, **options)

    return call


def _is_mesh(thing):
    return hasattr(thing, "kind") and hasattr(thing, "node")


class Raycaster:
    """Ray queries on triangle meshes, with arrays as input and dicts of arrays as output. A query
    uses all threads, and other Python threads continue meanwhile. Calls of several threads run one
    after the other, so that a query sees the bodies before an update or after it.

    Rays have shape (..., 6): origin and direction. The direction may have any length, which is the
    unit of t_hit. Results have the leading shape of the rays. geometry_ids are the numbers that
    add_triangles returned, primitive_ids are rows of its triangles. A ray that hits nothing has
    INVALID_ID and t_hit = inf.

    precision="single": rays and results are float32, as in the ray kernels. precision="double":
    rays are taken as float64 and decided exactly, and results are float64.
    """

    INVALID_ID = 0xFFFFFFFF

    def __init__(self, threads=0):
        self._lock = threading.RLock()
        self._context = Context(_arguments.whole("Raycaster(): threads", threads, 0, 1024))
        self._kept = {}
        self._instances, self._objects = [], []  # by number
        self.meshes = []

    def _place(self, thing, matrix, kept):
        number = len(self.meshes)
        self._instances.append(self._context.instance(thing, matrix, user_data=number))
        self._objects.append(thing)
        if kept is not None:
            self._kept[number] = kept
        return number

    @_alone
    def add_triangles(self, vertices, triangles, matrix=None):
        """Adds a mesh with vertices (n, 3) and triangles (m, 3), placed by a matrix (4, 4) for
        column vectors. Returns its number."""
        triangles = _corners(vertices, triangles)
        thing = self._context.mesh(vertices, triangles)
        number = self._place(thing, matrix, _rt._kept_triangles(vertices, triangles))
        self.meshes.append((vertices, triangles))
        return number

    @_alone
    def add_sphere(self, center, radius):
        """Adds an exact sphere; its primitive id is 0. Returns its number."""
        matrix = np.eye(4)
        matrix[:3, 3] = _arguments.numbers("add_sphere(): center", center, (3,))
        radius = _arguments.number("add_sphere(): radius", radius, above=0)
        number = self._place(self._context.sphere(radius), matrix, None)
        self.meshes.append((center, radius))
        return number

    @_alone
    def add_mesh(self, mesh):
        """Adds an xvrml.Mesh at its place. Returns its number, or None for lines and points."""
        if not hasattr(mesh, "kind"):
            raise TypeError(
                f"add_mesh(): mesh: a Mesh of World.meshes() expected, not {_arguments._short(mesh)}"
            )
        if mesh.kind == "sphere":
            thing, kept = self._context.sphere(mesh.radius), None
        elif mesh.kind == "triangles":
            thing = self._context.mesh(mesh.vertices, mesh.faces)
            kept = _rt._kept_triangles(mesh.vertices, mesh.faces)
        else:
            return None
        number = self._place(thing, mesh.matrix, kept)
        self.meshes.append(mesh)
        return number

    @_alone
    def update(self, which=None, *, matrices=None, vertices=None, triangles=None):
        """Moves or reshapes bodies in place. The next query sees them at their new places, at a
        cost in proportion to what changed.

        which: numbers of bodies; None: all. Or a Mesh of World.meshes(), or the list of all, after
        the world has changed; then nothing else is given.
        matrices: (n, 4, 4), or (4, 4) for one body: the new places, for column vectors.
        vertices: (n, 3), the new shape of one body of triangles. triangles: (m, 3); None: those
        that it has.
        """
        if _is_mesh(which) or (isinstance(which, (list, tuple)) and which and
                               all(_is_mesh(each) for each in which)):
            if matrices is not None or vertices is not None or triangles is not None:
                raise TypeError(
                    "update(): a Mesh brings its own matrix and vertices: give nothing else")
            self._update_meshes([which] if _is_mesh(which) else which, _is_mesh(which))
            return
        numbers = self._bodies(which)
        if matrices is None and vertices is None:
            raise TypeError("update(): matrices or vertices must be given")
        if matrices is not None:
            matrices = self._places(numbers, matrices)
        if vertices is not None:
            self._reshape(numbers, vertices, triangles)
        elif triangles is not None:
            raise TypeError("update(): triangles: vertices must be given, too")
        if matrices is not None:
            self._context.move_instances([self._instances[i] for i in numbers], matrices)

    def _bodies(self, which):
        """Checks numbers of bodies and returns them as a list."""
        if which is None:
            return list(range(len(self.meshes)))
        numbers = _arguments.array("update(): which", np.atleast_1d(np.asarray(which)), (None,))
        if numbers.size and numbers.dtype.kind not in "iu":
            raise TypeError(
                f"update(): which: numbers of bodies expected, not {_arguments._short(which)}")
        for none in numbers[(numbers < 0) | (numbers >= len(self.meshes))][:1]:
            raise ValueError(
                f"update(): which: {none} is no body: there are {len(self.meshes)}, from 0 on")
        return numbers.tolist()

    @staticmethod
    def _places(numbers, matrices):
        """Checks matrices and returns them as float64 of shape (n, 4, 4)."""
        if np.ndim(matrices) == 2 and len(numbers) == 1:
            matrices = np.asarray(matrices)[None]
        given = _arguments.numbers("update(): matrices", matrices, (len(numbers), 4, 4))
        odd = np.flatnonzero((given[:, 3] != (0, 0, 0, 1)).any(1))
        for i in odd[:1]:
            raise ValueError(
                f"update(): matrices: a last row of 0 0 0 1 expected, not {given[i, 3]} (matrix {i}); "
                "translations are in the last column")
        return np.ascontiguousarray(given)

    def _reshape(self, numbers, vertices, triangles):
        """Gives a body of triangles another shape."""
        if len(numbers) != 1:
            raise ValueError(
                f"update(): vertices: are those of one body: give its number, not {len(numbers)}")
        number, = numbers
        former = self.meshes[number]
        if _is_mesh(former) or len(np.shape(former[1])) != 2:
            raise ValueError(
                f"update(): vertices: body {number} was not made by add_triangles(); give a Mesh")
        vertices = _arguments.array("update(): vertices", vertices, (None, 3))
        triangles = _corners(vertices, former[1] if triangles is None else triangles, "update")
        _check_finite(vertices, triangles)
        self._redefine(number, vertices, triangles)
        self.meshes[number] = (vertices, triangles)

    def _redefine(self, number, vertices, triangles):
        self._context.mesh(vertices, triangles, replaces=self._objects[number])
        kept = _rt._kept_triangles(vertices, triangles)
        self._kept.pop(number, None)
        if kept is not None:
            self._kept[number] = kept

    def _update_meshes(self, meshes, single):
        """Brings bodies that add_mesh() made to the shapes and places of meshes."""
        meshes = [mesh for mesh in meshes if mesh.kind in ("triangles", "sphere")]
        if single:
            numbers = [
                i for i, mesh in enumerate(self.meshes)
                if meshes and _is_mesh(mesh) and mesh.node == meshes[0].node
            ]
            if len(numbers) != 1:
                raise ValueError(
                    f"update(): {len(numbers)} bodies come from the Shape of this Mesh: give the "
                    "list of all meshes")
        else:
            numbers = list(range(len(self.meshes)))
        if len(numbers) != len(meshes) or any(
                not _is_mesh(self.meshes[i]) or self.meshes[i].node != mesh.node or
                self.meshes[i].kind != mesh.kind or
            (mesh.kind == "sphere" and self.meshes[i].radius != mesh.radius)
                for i, mesh in zip(numbers, meshes)):
            raise ValueError("update(): other shapes are drawn now: make a new raycaster")
        for i, mesh in zip(numbers, meshes):
            former = self.meshes[i]
            if mesh.kind == "triangles" and not (np.array_equal(mesh.vertices, former.vertices) and
                                                 np.array_equal(mesh.faces, former.faces)):
                self._redefine(i, mesh.vertices, mesh.faces)
            self.meshes[i] = mesh
        if numbers:
            self._context.move_instances([self._instances[i] for i in numbers],
                                         np.stack([mesh.matrix for mesh in meshes]))

    def _numbered(self, hits, keys):
        """Renumbers primitives to the rows of the given triangles; triangles without area are not
        in the scene."""
        ids, primitives = hits["geometry_ids"], hits["primitive_ids"]
        for number, kept in self._kept.items():
            here = ids == number
            primitives[here] = kept[primitives[here]]
        return {key: hits[key] for key in keys}

    @staticmethod
    def _keys(precision, errors):
        points = ("points",) if precision == "double" else ()
        return (*_FIVE, *points, *(_ERRORS if errors else ()))

    @_alone
    def cast_rays(self,
                  rays,
                  nthreads=0,
                  *,
                  tnear=0.0,
                  tfar=np.inf,
                  precision="single",
                  errors=False):
        """Returns the nearest hits as a dict of t_hit, geometry_ids, primitive_ids, primitive_uvs
        and primitive_normals. nthreads: accepted for Open3D; the constructor's threads are used.

        precision="double" adds points (..., 3); errors adds t_errors, uv_errors and point_errors:
        no t_hit, no barycentric coordinate and no component of a point is farther from the truth.
        """
        _check_precision(precision, errors)
        found = self._context.cast_rays(rays, tnear=tnear, tfar=tfar, precision=precision)
        return self._numbered(found, self._keys(precision, errors))

    def test_occlusions(self, rays, tnear=0.0, tfar=np.inf, nthreads=0, *, precision="single"):
        """Returns whether anything lies on each ray between tnear and tfar."""
        _check_precision(precision, False)
        return self._context.test_occlusions(rays, tnear=tnear, tfar=tfar, precision=precision)

    def count_intersections(self, rays, nthreads=0, *, tnear=0.0, tfar=np.inf, precision="single"):
        """Returns the number of crossings of surfaces on each ray. Every crossing counts once."""
        _check_precision(precision, False)
        return self._context.count_intersections(rays, tnear=tnear, tfar=tfar, precision=precision)

    @_alone
    def list_intersections(self,
                           rays,
                           nthreads=0,
                           *,
                           tnear=0.0,
                           tfar=np.inf,
                           precision="single",
                           errors=False):
        """Returns all hits, nearest first: the arrays of cast_rays, of shape (n,), and ray_ids and
        ray_splits. The hits of ray i are ray_splits[i] to ray_splits[i + 1]."""
        _check_precision(precision, errors)
        found = self._context.list_intersections(rays, tnear=tnear, tfar=tfar, precision=precision)
        return self._numbered(found, (*self._keys(precision, errors), "ray_ids", "ray_splits"))

    @_alone
    def compute_closest_points(self,
                               query_points,
                               nthreads=0,
                               *,
                               radius=np.inf,
                               precision="single",
                               errors=False):
        """Returns the surface points nearest to points (..., 3), as a dict of points, distances,
        geometry_ids, primitive_ids, primitive_uvs and primitive_normals. radius: maximum distance;
        NaN and INVALID_ID if no surface is that near.

        precision="double" takes and gives float64; errors adds distance_errors, uv_errors and
        point_errors. No distance is farther from the truth than its error. The others are those of
        the given place as the nearest one of its triangle or sphere."""
        _check_precision(precision, errors)
        found = self._context.compute_closest_points(query_points,
                                                     radius=radius,
                                                     precision=precision)
        bounds = ("distance_errors", *_ERRORS[1:]) if errors else ()
        return self._numbered(found, ("points", "distances", *_FIVE[1:], *bounds))

    def compute_distance(self, query_points, nthreads=0, *, precision="single"):
        """Returns the distances from points (..., 3) to the nearest surface."""
        return self.compute_closest_points(query_points, precision=precision)["distances"]

    @_alone
    def compute_occupancy(self, query_points, nthreads=0, nsamples=1, *, precision="single"):
        """Returns 1 for points (..., 3) inside closed surfaces, otherwise 0. A point is inside if a
        ray from it crosses an odd number of surfaces. nsamples: rays per point, an odd number; the
        majority decides."""
        _check_precision(precision, False)
        number = np.float32 if precision == "single" else np.float64
        points = _arguments.numbers("query_points", query_points, (..., 3),
                                    finite=False).astype(number)
        nsamples = _arguments.whole("nsamples", nsamples, 1, 65535)
        votes = np.zeros(points.shape[:-1], np.int32)
        directions = np.random.default_rng(0).normal(size=(nsamples, 3)).astype(np.float32)
        for direction in directions.astype(number):
            rays = np.concatenate([points, np.broadcast_to(direction, points.shape)], -1)
            votes += self.count_intersections(rays, precision=precision) % 2
        return (votes * 2 > nsamples).astype(np.float32)

    @_alone
    def compute_signed_distance(self, query_points, nthreads=0, nsamples=1, *, precision="single"):
        """Returns the distances to the nearest surface, negative inside closed surfaces."""
        inside = self.compute_occupancy(query_points, nsamples=nsamples, precision=precision) > 0
        distance = self.compute_distance(query_points, precision=precision)
        return np.where(inside, -distance, distance)

    create_rays_pinhole = staticmethod(
        lambda *args, **options: create_rays_pinhole(*args, **options))


def create_rays_pinhole(*args, **options):
    """Returns rays (height, width, 6) of a pinhole camera, as in Open3D. Directions have length 1
    along the view axis.

    create_rays_pinhole(fov_deg, center, eye, up, width_px, height_px): the camera is at eye and
    looks at center; fov_deg is the horizontal angle of view. As in Open3D, up is the direction in
    which rows follow each other: the first row is the lowest, and columns go from right to left.
    rays[::-1, ::-1], or the opposite of up, gives an upright picture.

    create_rays_pinhole(intrinsic_matrix, extrinsic_matrix, width_px, height_px): K (3x3) and world
    to camera (4x4); camera x points to the right, y down, z forward. The middle of a picture is at
    (width_px / 2, height_px / 2), as in Open3D.
    """
    by_matrices = any(name in options for name in _BY_MATRICES[:2]) or (len(args) > 0 and hasattr(
        args[0], "__len__") and not isinstance(args[0], (str, bytes)))
    if not args and not options:
        raise TypeError(
            f"create_rays_pinhole(): {', '.join(_BY_VIEW)} must be given, or {', '.join(_BY_MATRICES)}"
        )
    names = _BY_MATRICES if by_matrices else _BY_VIEW
    given = dict(zip(names, args))
    for name in options:
        if name not in names or name in given:
            wrong = "is given twice" if name in given else f"is no argument; there are: {', '.join(names)}"
            raise TypeError(f"create_rays_pinhole(): {name} {wrong}")
    given.update(options)
    if len(args) > len(names):
        raise TypeError(
            f"create_rays_pinhole(): {len(args)} arguments were given, at most {len(names)} can be: {', '.join(names)}"
        )
    missing = [name for name in names if name not in given]
    if missing:
        raise TypeError(f"create_rays_pinhole(): {', '.join(missing)} must be given")
    for name in names[-2:]:
        given[name] = _arguments.whole(f"create_rays_pinhole(): {name}", given[name], 1, 65536)
    return (_rays_of_matrices if by_matrices else _rays_of_view)(**given)


_BY_VIEW = ("fov_deg", "center", "eye", "up", "width_px", "height_px")
_BY_MATRICES = ("intrinsic_matrix", "extrinsic_matrix", "width_px", "height_px")


def _rays_of_matrices(intrinsic_matrix, extrinsic_matrix, width_px, height_px):
    K = _matrix("create_rays_pinhole(): intrinsic_matrix", intrinsic_matrix, 3, 3)
    T = _rigid("create_rays_pinhole(): extrinsic_matrix", extrinsic_matrix)
    return Pinhole(K, T, center=0.5).rays(width_px, height_px)


def _rays_of_view(fov_deg, center, eye, up, width_px, height_px):
    fov_deg = _arguments.number("create_rays_pinhole(): fov_deg", fov_deg, above=0)
    if fov_deg >= 180:
        raise ValueError(
            f"create_rays_pinhole(): fov_deg: an angle between 0 and 180 degrees expected, not {fov_deg:g}"
        )
    eye, center, up = (_arguments.numbers(f"create_rays_pinhole(): {name}", value, (3,))
                       for name, value in (("eye", eye), ("center", center), ("up", up)))
    distance = np.linalg.norm(center - eye)
    if not distance > 0:
        raise ValueError(
            "create_rays_pinhole(): eye and center are the same point: a direction of view expected"
        )
    ahead = (center - eye) / distance
    across = np.cross(up, ahead)  # columns go this way, to the left of somebody whose head is up
    if not np.linalg.norm(across) > 1e-9 * np.linalg.norm(up):
        raise ValueError(
            "create_rays_pinhole(): up: a direction across the view expected, not one along it, nor 0 0 0"
        )
    across /= np.linalg.norm(across)
    onward = np.cross(ahead, across)
    size = 2 * np.tan(np.radians(fov_deg) / 2) / width_px
    x = (np.arange(width_px) + 0.5 - width_px / 2) * size
    y = (np.arange(height_px) + 0.5 - height_px / 2) * size
    rays = np.empty((height_px, width_px, 6), np.float32)
    rays[..., :3] = eye
    rays[..., 3:] = ahead + x[None, :, None] * across + y[:, None, None] * onward
    return rays
