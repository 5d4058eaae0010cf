"""Makes Transforms of matrices."""
import numpy as np

import xvrml


def placed(shape, matrix):
    """Returns a Transform that is equivalent to the matrix. Translation, rotation and scale come
    from its singular value decomposition."""
    if np.allclose(matrix, np.eye(4)):
        return shape
    u, s, vt = np.linalg.svd(matrix[:3, :3])
    if np.linalg.det(vt) < 0:
        vt, u = -vt, -u
    rotation = u @ vt
    return xvrml.Transform(translation=matrix[:3, 3],
                           rotation=axis_angle(rotation),
                           scale=s,
                           scaleOrientation=axis_angle(vt.T),
                           children=[shape])


def axis_angle(r):
    """Returns the axis and the angle (radians) of a rotation matrix."""
    angle = np.arccos(np.clip((np.trace(r) - 1) / 2, -1, 1))
    if angle < 1e-12:
        return (0, 0, 1, 0)
    if np.pi - angle < 1e-6:
        column = np.argmax(np.diag(r))
        axis = (r + np.eye(3))[:, column]
    else:
        axis = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    return (*(axis / np.linalg.norm(axis)), angle)
