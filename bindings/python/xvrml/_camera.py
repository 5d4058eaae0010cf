"""Defines Pinhole, a camera given by matrices, in the conventions of OpenCV."""

from . import _arguments


def _matrix(name, value, rows, columns):
    import numpy as np
    try:
        matrix = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        matrix = None
    if matrix is None or matrix.shape != (rows, columns) or not np.isfinite(matrix).all():
        raise ValueError(f"{name}: a {rows}x{columns} matrix of finite numbers expected")
    return matrix


def _rigid(name, value):
    """Checks and returns a 4x4 matrix of a rotation and a translation; its last row may be
    missing."""
    import numpy as np
    try:
        rows = 3 if np.shape(value) == (3, 4) else 4
    except ValueError:  # rows of different lengths
        rows = 4
    matrix = _matrix(name, value, rows, 4)
    if rows == 3:
        matrix = np.vstack([matrix, [0, 0, 0, 1]])
    turn = matrix[:3, :3]
    if not np.allclose(turn @ turn.T, np.eye(3), atol=1e-4) or np.linalg.det(turn) < 0:
        raise ValueError(f"{name}: its 3x3 part is no rotation")
    if not np.array_equal(matrix[3], [0, 0, 0, 1]):
        raise ValueError(f"{name}: its last row must be 0 0 0 1")
    u, _, v = np.linalg.svd(turn)  # measured poses are rounded
    matrix[:3, :3] = u @ v
    return matrix


class Pinhole:
    """A pinhole camera as OpenCV describes it, for render(camera=...).

    K is the intrinsic matrix (3x3), [[fx, s, cx], [0, fy, cy], [0, 0, 1]], in pixels of the
    rendered picture. T is the extrinsic matrix (4x4 or 3x4), world to camera, for column vectors.
    The camera's x points to the right, y down, z forward. A point X appears at K (T X) / z.

    center is the coordinate of the first pixel's centre. With 0, as in OpenCV, the centre of pixel
    (column, row) has exactly these coordinates, and the middle of a picture is at (width - 1) / 2.
    With 0.5, as in Open3D and most renderers, the middle is at width / 2.
    """

    def __init__(self, K, T=None, *, center=0.0):
        import numpy as np
        self._K = _matrix("K", K, 3, 3)
        k = self._K
        if not (k[0, 0] > 0 and k[1, 1] > 0) or k[1, 0] != 0 or not np.array_equal(k[2], [0, 0, 1]):
            raise ValueError(
                "K: [[fx, s, cx], [0, fy, cy], [0, 0, 1]] with fx and fy above 0 expected")
        self._T = np.eye(4) if T is None else _rigid("T", T)
        self._center = _arguments.number("center", center)
        for matrix in (self._K, self._T):
            matrix.setflags(write=False)

    @classmethod
    def from_pose(cls, K, pose, *, center=0.0):
        """Creates a camera from its pose (4x4 or 3x4): camera to world, the inverse of T."""
        import numpy as np
        return cls(K, np.linalg.inv(_rigid("pose", pose)), center=center)

    @property
    def K(self):
        """The intrinsic matrix: float64 of shape (3, 3), read-only."""
        return self._K

    @property
    def T(self):
        """The extrinsic matrix, world to camera: float64 of shape (4, 4), read-only."""
        return self._T

    @property
    def pose(self):
        """Camera to world, float64 of shape (4, 4); x points to the right, y down, z forward."""
        import numpy as np
        return np.linalg.inv(self._T)

    @property
    def center(self):
        """The coordinate of the first pixel's centre."""
        return self._center

    def cropped(self, x, y):
        """Returns the camera of a part of its picture: the one whose first pixel is (x, y)."""
        k = self._K.copy()
        k[0, 2] -= _arguments.whole("x", x, 0)
        k[1, 2] -= _arguments.whole("y", y, 0)
        return type(self)(k, self._T, center=self._center)

    def project(self, points):
        """Projects points (..., 3) of the world. Returns (..., 3): column, row, and distance along
        the view axis, which is negative behind the camera."""
        import numpy as np
        try:
            points = np.asarray(points, np.float64)
        except (TypeError, ValueError):
            points = None
        if points is None or points.ndim < 1 or points.shape[-1] != 3:
            raise ValueError("points: numbers of shape (..., 3) expected")
        seen = points @ self._T[:3, :3].T + self._T[:3, 3]
        z = seen[..., 2:]
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.concatenate([(seen @ self._K.T)[..., :2] / z, z], -1)

    def rays(self, width, height):
        """Returns rays (height, width, 6) through the pixel centres: origin and direction. A
        direction has length 1 along the view axis, so t_hit of a Raycaster is the distance along
        that axis."""
        import numpy as np
        width, height = _arguments.whole("width", width), _arguments.whole("height", height)
        column, row = np.meshgrid(np.arange(width) + self._center, np.arange(height) + self._center)
        pose = self.pose
        directions = np.stack([column, row, np.ones_like(column)],
                              -1) @ (pose[:3, :3] @ np.linalg.inv(self._K)).T
        rays = np.empty((height, width, 6), np.float32)
        rays[..., :3] = pose[:3, 3]
        rays[..., 3:] = directions
        return rays

    def __repr__(self):
        return f"Pinhole(K={self._K.tolist()}, T={self._T.tolist()}, center={self._center})"

    def __reduce__(self):
        return _again, (self._K, self._T, self._center)

    def _numbers(self):
        """Returns [fx, fy, cx, cy, s] and the pose row by row. cx and cy are measured from the
        picture's left and upper edges."""
        k, edge = self._K, 0.5 - self._center
        return [k[0, 0], k[1, 1], k[0, 2] + edge, k[1, 2] + edge, k[0,
                                                                    1]], self.pose.ravel().tolist()


def _again(K, T, center):
    return Pinhole(K, T, center=center)


def _of(columns, fovy, width, height):
    """Returns the Pinhole of a picture, from a camera-to-world matrix by columns that looks along
    -z, and its vertical angle of view."""
    import numpy as np
    pose = np.array(columns, np.float64).reshape(4, 4).T
    pose[:3, 1:3] *= -1
    focal = height / 2 / np.tan(fovy / 2)
    return Pinhole.from_pose([[focal, 0, (width - 1) / 2], [0, focal, (height - 1) / 2], [0, 0, 1]],
                             pose)
