// rotation.h: Computes rotation matrices for both libraries: rt* calls take degrees, VRML's nodes
// radians. Pure, any thread.
#pragma once

// Rodrigues' formula, c I + s [a]x + (1 - c) a a^T, for a unit axis and the sine and cosine of the
// angle. The matrix is constructed from 16 numbers, column by column, for column vectors.
template <class Matrix, class Vector> Matrix rotationMatrix(const Vector& a, double s, double c) {
  const double d = 1 - c;
  return Matrix{a.x * a.x * d + c,
                a.y * a.x * d + a.z * s,
                a.z * a.x * d - a.y * s,
                0,
                a.x * a.y * d - a.z * s,
                a.y * a.y * d + c,
                a.z * a.y * d + a.x * s,
                0,
                a.x * a.z * d + a.y * s,
                a.y * a.z * d - a.x * s,
                a.z * a.z * d + c,
                0,
                0,
                0,
                0,
                1};
}
