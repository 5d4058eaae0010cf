// placement.h: the transformation that VRML 1.0 has accumulated, relative to a group, and the
// Transform of VRML97 that stands for it. Pure values. [any thread]
#pragma once

#include "geometry/matrix.h"
#include "parse/vrml1/tree.h"
#include "xvrml/nodes.h"

namespace xvrml::vrml1 {

class Placement {
 public:
  // Adds a property: Translation, Rotation, Scale, Transform or MatrixTransform. It acts on what
  // follows, before all that was added earlier. Returns false if something of it was dropped: the
  // perspective part of a matrix, or all of it if it is not finite.
  bool add(const TreeNode& property);
  bool isIdentity() const { return exact_ && fields_ == Fields(); }
  // Returns the matrix from the coordinates of what follows to those of the group.
  Matrix matrix() const;
  // Sets the fields of a Transform. The numbers of the file are kept where translation, rotation
  // and scale were added in an order that one Transform can say; else the matrix is decomposed.
  void writeTo(nodes::Transform& transform) const;
  bool operator==(const Placement& other) const;

 private:
  struct Fields {
    Vec3f center, translation, scale{1, 1, 1};
    Rotation rotation, scaleOrientation;
    bool operator==(const Fields&) const = default;
  };
  static Matrix matrixOf(const Fields& fields);
  static Fields decompose(const Matrix& matrix);
  bool append(const Fields& added);

  Fields fields_; // the transformation, if exact_
  bool exact_ = true;
  Matrix matrix_; // the transformation, if not exact_
};

} // namespace xvrml::vrml1
