// transform.h: elementary matrices of the API, in double. Pure functions; they throw ApiError for
// arguments without a meaning.
#pragma once

#include "scene/matrix.h"

namespace openrt {

// An affine matrix from the application: finite, bottom row 0 0 0 1; else RT_INVALID_VALUE.
Matrix4d checkedMatrix(const double* m);

Matrix4d translation(double x, double y, double z);
Matrix4d scaling(double x, double y, double z);
// Angle in degrees about an axis of any length but 0; multiples of 90 degrees are exact.
Matrix4d rotation(double degrees, double x, double y, double z);
// Camera-to-world matrix of gluLookAt's arguments.
Matrix4d lookAt(const Vec3d& eye, const Vec3d& at, const Vec3d& up);

} // namespace openrt
