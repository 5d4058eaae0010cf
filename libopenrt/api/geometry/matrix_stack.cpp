// matrix_stack.cpp: Implements the matrix stack and its limits. Runs on the application's thread.
#include "api/geometry/matrix_stack.h"

namespace openrt {

void MatrixStack::push() {
  require(entries_.size() - floor_ < maxStackDepth, RT_STACK_OVERFLOW,
          "the matrix stack is full (4096 matrices)");
  entries_.push_back(Matrix4d(entries_.back()));
}

void MatrixStack::pop() {
  require(entries_.size() - floor_ > 1, RT_STACK_UNDERFLOW, "no matrix was pushed");
  entries_.pop_back();
}

void MatrixStack::load(const Matrix4d& matrix) {
  require(matrix.finite(), RT_INVALID_VALUE, "the matrix is not finite");
  entries_.back() = matrix;
}

void MatrixStack::openDefinition() {
  entries_.emplace_back();
  floor_ = entries_.size() - 1;
}

void MatrixStack::checkBalanced() const {
  require(entries_.size() - floor_ == 1, RT_INVALID_OPERATION,
          "rtPushMatrix without rtPopMatrix in this definition");
}

void MatrixStack::closeDefinition() {
  entries_.resize(floor_);
  floor_ = 0;
}

} // namespace openrt
