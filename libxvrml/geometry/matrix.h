// matrix.h: the transformations of VRML nodes in double precision, and those of the camera. Pure
// functions, any thread.
//
// A Matrix is Imath's row-vector matrix. Its 16 numbers in memory are also OpenRT's column-major
// matrix for column vectors. compose(a, b) follows the standard's notation "a times b" for column
// vectors: b acts first.
#pragma once

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include "xvrml/types.h"

namespace xvrml {

using Matrix = Imath::M44d;
using Vector = Imath::V3d;

inline Vector vector(const Vec3f& v) { return {v.x, v.y, v.z}; }
inline Matrix compose(const Matrix& a, const Matrix& b) { return b * a; }
inline const double* data(const Matrix& m) { return &m.x[0][0]; }
Matrix fromArray(const double m[16]);
void toArray(const Matrix& m, double out[16]);

Matrix translation(const Vector& v);
Matrix scaling(const Vector& v);
// The axis may have any length; a zero axis gives no rotation. angle: in radians.
Matrix rotation(const Vector& axis, double angle);
Matrix rotation(const Rotation& r);

struct TransformFields {
  Vec3f center, translation, scale{1, 1, 1};
  Rotation rotation, scaleOrientation;
};
// Returns the matrix of a Transform: T x C x R x SR x S x -SR x -C (clause 6.52).
Matrix transformMatrix(const TransformFields& fields);

// Returns the matrix of a TextureTransform for (s, t, 0, 1): -C x S x R x C x T (clause 6.49).
Matrix textureMatrix(Vec2f center, float rotation, Vec2f scale, Vec2f translation);

Vector transformPoint(const Matrix& m, const Vector& p);
Vector transformDirection(const Matrix& m, const Vector& v);
bool finite(const Matrix& m);
// Returns 0 if the linear part is singular or not finite.
double determinant(const Matrix& m);
// Returns the largest length of a transformed unit vector: the largest singular value of the linear
// part. Without shear it is the length of the longest axis.
double largestStretch(const Matrix& m);
// Computes the affine inverse. Returns false if there is none.
bool invert(const Matrix& m, Matrix& inverse);

// Returns rotation and translation only: the axes of m made orthonormal, z first, then y. A view is
// not distorted by scale (clause 6.53).
Matrix rigid(const Matrix& m);
// Returns the rotation only (for Background, clause 6.5).
Matrix rotationOnly(const Matrix& m);

// Returns the rotation of a Billboard (clause 6.6). viewer, up: position and up direction of the
// viewer in local coordinates.
Matrix billboardMatrix(const Vector& axisOfRotation, const Vector& viewer, const Vector& up);

// Returns the vertical angle of view of a Viewpoint. Its fieldOfView applies to the smaller side of
// the picture (clause 6.53).
double verticalFieldOfView(double fieldOfView, double aspect);

} // namespace xvrml
