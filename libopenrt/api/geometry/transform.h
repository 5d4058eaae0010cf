// transform.h: Computes elementary matrices of the API, in double precision. Pure functions; they
// throw ApiError for invalid arguments.
#pragma once

#include "scene/matrix.h"

namespace openrt {

// Returns the application's matrix. Throws RT_INVALID_VALUE if it is not finite or if its bottom
// row is not 0 0 0 1.
Matrix4d checkedMatrix(const double* m);

Matrix4d translation(double x, double y, double z);
Matrix4d scaling(double x, double y, double z);
// Rotates about an axis of any length except 0. Multiples of 90 degrees are exact.
Matrix4d rotation(double degrees, double x, double y, double z);
// Returns the camera-to-world matrix for the arguments of gluLookAt.
Matrix4d lookAt(const Vec3d& eye, const Vec3d& at, const Vec3d& up);

} // namespace openrt
