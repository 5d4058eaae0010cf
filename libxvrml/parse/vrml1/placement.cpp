// placement.cpp: the order and the decomposition of transformations.
#include "parse/vrml1/placement.h"

#include <algorithm>
#include <cmath>

#include <Imath/ImathMatrixAlgo.h>
#include <Imath/ImathQuat.h>

namespace xvrml::vrml1 {
namespace {

Vec3f narrowed(const Vector& v) { return {float(v.x), float(v.y), float(v.z)}; }

// Returns the rotation of a row-vector matrix whose determinant is 1.
Rotation rotationOf(const Imath::M33d& m) {
  Matrix full;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) full[i][j] = m[i][j];
  const Imath::Quatd q = Imath::extractQuat(full).normalized();
  const Vector axis = q.v;
  const double sine = axis.length();
  if (!(sine > 1e-12)) return {};
  const double angle = 2 * std::atan2(sine, q.r);
  return {float(axis.x / sine), float(axis.y / sine), float(axis.z / sine), float(angle)};
}

Imath::M33d linearOf(const Matrix& m) {
  return {m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2], m[2][0], m[2][1], m[2][2]};
}

} // namespace

Matrix Placement::matrixOf(const Fields& fields) {
  return transformMatrix(
      {fields.center, fields.translation, fields.scale, fields.rotation, fields.scaleOrientation});
}

Matrix Placement::matrix() const { return exact_ ? matrixOf(fields_) : matrix_; }

// Returns the fields of a Transform with this matrix. The linear part is a scale along axes that
// are orthogonal to each other, and then a rotation. Two ways find them:
// - The rows of the matrix are orthogonal: they are the turned axes, and their lengths the scale.
// - Else the singular value decomposition (row vectors: L = U S V^T) gives L = (U S U^T)(U V^T):
//   scale along the axes of U, then the rotation U V^T.
Placement::Fields Placement::decompose(const Matrix& matrix) {
  Fields fields;
  fields.translation = {float(matrix[3][0]), float(matrix[3][1]), float(matrix[3][2])};
  const Imath::M33d linear = linearOf(matrix);
  Vector rows[3], lengths;
  for (int i = 0; i < 3; ++i) {
    rows[i] = {linear[i][0], linear[i][1], linear[i][2]};
    lengths[i] = rows[i].length();
  }
  constexpr double tolerance = 1e-6; // single precision, in which files are written
  const auto orthogonal = [&](int a, int b) {
    return std::abs(rows[a].dot(rows[b])) <= tolerance * lengths[a] * lengths[b];
  };
  const bool regular = lengths.x > 0 && lengths.y > 0 && lengths.z > 0;
  if (regular && orthogonal(0, 1) && orthogonal(1, 2) && orthogonal(0, 2)) {
    Vector scale = lengths;
    if (linear.determinant() < 0) scale = -scale; // a mirror image
    Imath::M33d turn;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) turn[i][j] = rows[i][j] / scale[i];
    fields.rotation = rotationOf(turn);
    fields.scale = narrowed(scale);
    return fields;
  }
  Imath::M33d u, v;
  Vector s;
  Imath::jacobiSVD(linear, u, s, v, 1e-14, true);
  fields.rotation = rotationOf(u * v.transposed());
  fields.scale = narrowed(s);
  fields.scaleOrientation = rotationOf(u.transposed());
  return fields;
}

// Adds a Transform's fields behind what there is. Returns whether fields can say it.
bool Placement::append(const Fields& added) {
  const Fields none;
  if (!exact_) return false;
  Fields before = fields_;
  if (before == none) {
    fields_ = added;
    return true;
  }
  const bool onlyMoves = [&] {
    before.translation = {};
    return before == none;
  }();
  before = fields_;
  if (onlyMoves) { // T1 and then T2 ... : the sum of both, and the rest of the second
    fields_ = added;
    fields_.translation = {before.translation.x + added.translation.x,
                           before.translation.y + added.translation.y,
                           before.translation.z + added.translation.z};
    return true;
  }
  // T R and then a scale about the origin
  Fields scale = added;
  scale.scale = none.scale;
  if (scale == none && fields_.scale == none.scale && fields_.center == none.center) {
    fields_.scale = added.scale;
    return true;
  }
  return false;
}

bool Placement::add(const TreeNode& property) {
  Fields added;
  Matrix matrix;
  bool whole = true, isMatrix = false;
  switch (property.kind) {
  case Kind::translation: added.translation = property.get<Vec3f>("translation"); break;
  case Kind::rotation: added.rotation = property.get<Rotation>("rotation"); break;
  case Kind::scale: added.scale = property.get<Vec3f>("scaleFactor"); break;
  case Kind::transform:
    added = {property.get<Vec3f>("center"), property.get<Vec3f>("translation"),
             property.get<Vec3f>("scaleFactor"), property.get<Rotation>("rotation"),
             property.get<Rotation>("scaleOrientation")};
    break;
  default: {
    const MFFloat& numbers = property.get<MFFloat>("matrix");
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = double(numbers[static_cast<size_t>(i)]);
    const double w = matrix[3][3];
    const double perspective =
        std::max({std::abs(matrix[0][3]), std::abs(matrix[1][3]), std::abs(matrix[2][3])});
    whole = w != 0 && perspective <= 1e-6 * std::abs(w); // files round zeros
    if (w != 0 && w != 1) matrix *= 1 / w; // the same points in homogeneous coordinates
    for (int i = 0; i < 4; ++i) matrix[i][3] = i == 3 ? 1 : 0;
    isMatrix = true;
  }
  }
  if (!isMatrix && append(added)) return whole;
  if (!isMatrix) matrix = matrixOf(added);
  const Matrix product = matrix * this->matrix();
  if (!finite(product)) return false;
  exact_ = false;
  matrix_ = product;
  return whole;
}

void Placement::writeTo(nodes::Transform& transform) const {
  const Fields fields = exact_ ? fields_ : decompose(matrix_);
  transform.center = fields.center;
  transform.translation = fields.translation;
  transform.scale = fields.scale;
  transform.rotation = fields.rotation;
  transform.scaleOrientation = fields.scaleOrientation;
}

bool Placement::operator==(const Placement& other) const {
  return exact_ == other.exact_ && (exact_ ? fields_ == other.fields_ : matrix_ == other.matrix_);
}

} // namespace xvrml::vrml1
