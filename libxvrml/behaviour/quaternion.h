// quaternion.h: rotations as unit quaternions, for the interpolators and followers of rotations.
// Pure functions, in double. [any thread]
#pragma once

#include <utility>

#include "geometry/vector_math.h"

namespace xvrml {

struct Quaternion {
  V3d v{0, 0, 0};
  double w = 1;
};

// Returns the quaternion of a rotation. A rotation without an axis, or by an angle that is not
// finite, is none.
Quaternion toQuaternion(const Rotation& r);
// Returns the rotation of a unit quaternion, with an angle in [0,pi]. axis: the axis of the result
// if it is no rotation at all; 0 0 0 stands for the z axis.
Rotation toRotation(const Quaternion& q, const V3d& axis = V3d(0));

Quaternion operator*(const Quaternion& a, const Quaternion& b);
inline Quaternion operator-(const Quaternion& q) { return {-q.v, -q.w}; }
inline Quaternion inverse(const Quaternion& q) { return {-q.v, q.w}; }
inline double dot(const Quaternion& a, const Quaternion& b) { return a.v.dot(b.v) + a.w * b.w; }

// Returns half the rotation vector (axis times half the angle) of a unit quaternion.
V3d logarithm(const Quaternion& q);
// Returns the unit quaternion whose logarithm is v.
Quaternion exponential(const V3d& v);
// Returns the weights of the ends of an arc with the given angle in [0,pi). Near 0 they are those
// of the chord.
std::pair<double, double> arcWeights(double angle, double t);
// Interpolates along the great circle, on the side on which the quaternions stand.
Quaternion slerp(const Quaternion& a, const Quaternion& b, double t);

} // namespace xvrml
