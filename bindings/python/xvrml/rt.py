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


def _corners(vertices, triangles):
    """Checks the triangles and returns them as vertex indices."""
    count = len(_arguments.array("add_triangles(): vertices", vertices, (None, 3)))
    corners = _arguments.array("add_triangles(): triangles", triangles, (None, 3))
    if corners.dtype.kind not in "iu":
        for odd in corners[corners != np.floor(corners)][:1]:  # also catches NaN
            raise ValueError(f"add_triangles(): triangles: whole numbers expected, not {odd:g}")
    for none in corners[(corners < 0) | (corners >= count)][:1]:
        raise ValueError(f"add_triangles(): triangles: {none:.0f} is no vertex: there are {count}")
    return np.ascontiguousarray(corners, np.uint32)


class Raycaster:
    """Ray queries on triangle meshes, with arrays as input and dicts of arrays as output. A query
    uses all threads, and other Python threads continue meanwhile.

    Rays have shape (..., 6): origin and direction. The direction may have any length, which is the
    unit of t_hit. Results have the leading shape of the rays. geometry_ids are the numbers that
    add_triangles returned, primitive_ids are rows of its triangles. A ray that hits nothing has
    INVALID_ID and t_hit = inf. Numbers are float32, like in the ray kernels.
    """

    INVALID_ID = 0xFFFFFFFF

    def __init__(self, threads=0):
        self._context = Context(_arguments.whole("Raycaster(): threads", threads, 0, 1024))
        self._kept = {}
        self.meshes = []

    def _place(self, thing, matrix, kept):
        number = len(self.meshes)
        self._context.instance(thing, matrix, user_data=number)
        if kept is not None:
            self._kept[number] = kept
        return number

    def add_triangles(self, vertices, triangles, matrix=None):
        """Adds a mesh with vertices (n, 3) and triangles (m, 3), placed by a matrix (4, 4) for
        column vectors. Returns its number."""
        triangles = _corners(vertices, triangles)
        thing = self._context.mesh(vertices, triangles)
        number = self._place(thing, matrix, _rt._kept_triangles(vertices, triangles))
        self.meshes.append((vertices, triangles))
        return number

    def add_sphere(self, center, radius):
        """Adds an exact sphere; its primitive id is 0. Returns its number."""
        matrix = np.eye(4)
        matrix[:3, 3] = _arguments.numbers("add_sphere(): center", center, (3,))
        radius = _arguments.number("add_sphere(): radius", radius, above=0)
        number = self._place(self._context.sphere(radius), matrix, None)
        self.meshes.append((center, radius))
        return number

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

    def _numbered(self, hits, keys):
        """Renumbers primitives to the rows of the given triangles; triangles without area are not
        in the scene."""
        ids, primitives = hits["geometry_ids"], hits["primitive_ids"]
        for number, kept in self._kept.items():
            here = ids == number
            primitives[here] = kept[primitives[here]]
        return {key: hits[key] for key in keys}

    def cast_rays(self, rays, nthreads=0, *, tnear=0.0, tfar=np.inf):
        """Returns the nearest hits as a dict of t_hit, geometry_ids, primitive_ids, primitive_uvs
        and primitive_normals. nthreads: accepted for Open3D; the constructor's threads are used."""
        return self._numbered(self._context.cast_rays(rays, tnear=tnear, tfar=tfar), _FIVE)

    def test_occlusions(self, rays, tnear=0.0, tfar=np.inf, nthreads=0):
        """Returns whether anything lies on each ray between tnear and tfar."""
        return self._context.test_occlusions(rays, tnear=tnear, tfar=tfar)

    def count_intersections(self, rays, nthreads=0, *, tnear=0.0, tfar=np.inf):
        """Returns the number of crossings of surfaces on each ray. Every crossing counts once."""
        return self._context.count_intersections(rays, tnear=tnear, tfar=tfar)

    def list_intersections(self, rays, nthreads=0, *, tnear=0.0, tfar=np.inf):
        """Returns all hits, nearest first: the arrays of cast_rays, of shape (n,), and ray_ids and
        ray_splits. The hits of ray i are ray_splits[i] to ray_splits[i + 1]."""
        return self._numbered(self._context.list_intersections(rays, tnear=tnear, tfar=tfar),
                              (*_FIVE[:4], "primitive_normals", "ray_ids", "ray_splits"))

    def compute_closest_points(self, query_points, nthreads=0, *, radius=np.inf):
        """Returns the surface points nearest to points (..., 3), as a dict of points, distances,
        geometry_ids, primitive_ids, primitive_uvs and primitive_normals. radius: maximum distance;
        NaN and INVALID_ID if no surface is that near."""
        return self._numbered(self._context.compute_closest_points(query_points, radius=radius),
                              ("points", "distances", *_FIVE[1:]))

    def compute_distance(self, query_points, nthreads=0):
        """Returns the distances from points (..., 3) to the nearest surface."""
        return self.compute_closest_points(query_points)["distances"]

    def compute_occupancy(self, query_points, nthreads=0, nsamples=1):
        """Returns 1 for points (..., 3) inside closed surfaces, otherwise 0. A point is inside if a
        ray from it crosses an odd number of surfaces. nsamples: rays per point, an odd number; the
        majority decides."""
        points = _arguments.numbers("query_points", query_points, (..., 3),
                                    finite=False).astype(np.float32)
        nsamples = _arguments.whole("nsamples", nsamples, 1, 65535)
        votes = np.zeros(points.shape[:-1], np.int32)
        directions = np.random.default_rng(0).normal(size=(nsamples, 3)).astype(np.float32)
        for direction in directions:
            rays = np.concatenate([points, np.broadcast_to(direction, points.shape)], -1)
            votes += self.count_intersections(rays) % 2
        return (votes * 2 > nsamples).astype(np.float32)

    def compute_signed_distance(self, query_points, nthreads=0, nsamples=1):
        """Returns the distances to the nearest surface, negative inside closed surfaces."""
        inside = self.compute_occupancy(query_points, nsamples=nsamples) > 0
        return np.where(inside, -1, 1).astype(np.float32) * self.compute_distance(query_points)

    create_rays_pinhole = staticmethod(
        lambda *args, **options: create_rays_pinhole(*args, **options))


def create_rays_pinhole(*args, **options):
    """Returns rays (height, width, 6) of a pinhole camera, as in Open3D. Directions have length 1
    along the view axis.

    create_rays_pinhole(fov_deg, center, eye, up, width_px, height_px): the camera is at eye and
    looks at center; fov_deg is the horizontal angle of view.

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
    right = np.cross(ahead, up)
    if not np.linalg.norm(right) > 1e-9 * np.linalg.norm(up):
        raise ValueError(
            "create_rays_pinhole(): up: a direction across the view expected, not one along it, nor 0 0 0"
        )
    right /= np.linalg.norm(right)
    down = np.cross(ahead, right)
    size = 2 * np.tan(np.radians(fov_deg) / 2) / width_px
    x = (np.arange(width_px) + 0.5 - width_px / 2) * size
    y = (np.arange(height_px) + 0.5 - height_px / 2) * size
    rays = np.empty((height_px, width_px, 6), np.float32)
    rays[..., :3] = eye
    rays[..., 3:] = ahead + x[None, :, None] * right + y[:, None, None] * down
    return rays
