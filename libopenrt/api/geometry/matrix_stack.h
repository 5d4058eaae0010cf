// matrix_stack.h: the current matrix and those below it. An object's definition has a stack of its
// own. Application thread.
#pragma once

#include <vector>

#include "api/errors.h"
#include "scene/matrix.h"

namespace openrt {

inline constexpr size_t maxStackDepth = 4096;

class MatrixStack {
 public:
  const Matrix4d& top() const { return entries_.back(); }
  void push();
  void pop();
  // Throw RT_INVALID_VALUE where the result would not be finite.
  void load(const Matrix4d& matrix);
  void multiply(const Matrix4d& matrix) { load(top() * matrix); }

  // Opens a stack of its own that starts at the identity; close throws if a push in it lacks its
  // pop.
  void openDefinition();
  void checkBalanced() const;
  void closeDefinition();

 private:
  std::vector<Matrix4d> entries_ = std::vector<Matrix4d>(1);
  size_t floor_ = 0; // the entry at the bottom of the open stack
};

} // namespace openrt
