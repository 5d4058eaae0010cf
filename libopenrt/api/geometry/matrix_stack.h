// matrix_stack.h: Holds the stack of the current matrix. The definition of an object uses a stack
// of its own. Used on the application's thread.
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
  // These throw RT_INVALID_VALUE if the result is not finite.
  void load(const Matrix4d& matrix);
  void multiply(const Matrix4d& matrix) { load(top() * matrix); }

  // openDefinition() starts a new stack with the identity. checkBalanced() throws if a push since
  // then has no pop.
  void openDefinition();
  void checkBalanced() const;
  void closeDefinition();

 private:
  std::vector<Matrix4d> entries_ = std::vector<Matrix4d>(1);
  size_t floor_ = 0; // index of the bottom entry of the open stack
};

} // namespace openrt
