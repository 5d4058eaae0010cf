// matrix.h: the transformations of VRML nodes in double precision, and what the camera makes of
// them. Pure functions, any thread.
//
// A Matrix is Imath's row-vector matrix; its 16 numbers in memory are at the same time OpenRT's
// column-major matrix acting on column vectors. To keep the standard's notation, compose(a, b) is
// "a times b" for column vectors: b acts first.
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
// Axis of any length; a zero axis does not turn. Angle in radians.
Matrix rotation(const Vector& axis, double angle);
Matrix rotation(const Rotation& r);

struct TransformFields {
  Vec3f center, translation, scale{1, 1, 1};
  Rotation rotation, scaleOrientation;
};
// Clause 6.52: T x C x R x SR x S x -SR x -C.
Matrix transformMatrix(const TransformFields& fields);

// Clause 6.49, acting on (s, t, 0, 1): -C x S x R x C x T.
Matrix textureMatrix(Vec2f center, float rotation, Vec2f scale, Vec2f translation);

Vector transformPoint(const Matrix& m, const Vector& p);
Vector transformDirection(const Matrix& m, const Vector& v);
bool finite(const Matrix& m);
// 0 where the linear part has no inverse or is not finite.
double determinant(const Matrix& m);
// The affine inverse; false if there is none.
bool invert(const Matrix& m, Matrix& inverse);

// Rotation and translation alone: the axes of m made orthonormal, z first, then y. Scale does not
// distort a view (clause 6.53).
Matrix rigid(const Matrix& m);
// Rotation alone (Background: clause 6.5).
Matrix rotationOnly(const Matrix& m);

// Billboard (clause 6.6): what turns the local frame for a viewer at `viewer` whose up direction is
// `up`, both local.
Matrix billboardMatrix(const Vector& axisOfRotation, const Vector& viewer, const Vector& up);

// Vertical angle of view of a Viewpoint whose fieldOfView is meant for the smaller side of the
// picture (clause 6.53).
double verticalFieldOfView(double fieldOfView, double aspect);

} // namespace xvrml
