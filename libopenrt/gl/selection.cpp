// selection.cpp: Clips primitives against the view, and writes hit records.
#include "gl/selection.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gl/failure.h"
#include "gl/mesh.h"

namespace rtgl {
namespace {

using Corner = std::array<double, 4>;

// Returns the part of a point, a line or a convex polygon that lies in the view.
std::vector<Corner> clipped(std::vector<Corner> corners) {
  for (size_t plane = 0; plane < 6 && !corners.empty(); plane++) {
    const double side = plane % 2 == 0 ? 1 : -1;
    const auto inside = [&](const Corner& c) { return c[3] + side * c[plane / 2]; };
    std::vector<Corner> kept;
    for (size_t i = 0; i < corners.size(); i++) {
      const Corner &from = corners[i], &to = corners[(i + 1) % corners.size()];
      const double a = inside(from), b = inside(to);
      if (a >= 0) kept.push_back(from);
      if ((a >= 0) == (b >= 0)) continue;
      Corner crossing;
      for (size_t k = 0; k < 4; k++) crossing[k] = from[k] + a / (a - b) * (to[k] - from[k]);
      kept.push_back(crossing);
    }
    corners = std::move(kept);
  }
  return corners;
}

// Returns twice the area of a polygon in the picture, positive if it is counter-clockwise.
double areaOf(const std::vector<Corner>& corners) {
  double area = 0;
  for (size_t i = 0; i < corners.size(); i++) {
    const Corner &a = corners[i], &b = corners[(i + 1) % corners.size()];
    area += (a[0] * b[1] - a[1] * b[0]) / (a[3] * b[3]);
  }
  return area;
}

} // namespace

GLint Selection::setMode(GLenum mode) {
  if (mode == GL_SELECT && !buffer_) fail(GL_INVALID_OPERATION, "glSelectBuffer is missing");
  endRecord();
  const GLint answer = mode_ != GL_SELECT ? 0 : overflow_ ? -1 : records_;
  mode_ = mode;
  names_.clear();
  used_ = 0;
  records_ = 0;
  overflow_ = false;
  return answer;
}

void Selection::setBuffer(GLuint* buffer, GLsizei size) {
  if (size < 0) fail(GL_INVALID_VALUE, "the size is below 0");
  if (mode_ == GL_SELECT) fail(GL_INVALID_OPERATION, "the buffer is in use");
  buffer_ = buffer;
  size_ = static_cast<size_t>(size);
}

void Selection::initNames() {
  if (mode_ != GL_SELECT) return;
  endRecord();
  names_.clear();
}

void Selection::loadName(GLuint name) {
  if (mode_ != GL_SELECT) return;
  if (names_.empty()) fail(GL_INVALID_OPERATION, "glPushName is missing");
  endRecord();
  names_.back() = name;
}

void Selection::pushName(GLuint name) {
  if (mode_ != GL_SELECT) return;
  if (names_.size() == maxNameDepth) fail(GL_STACK_OVERFLOW, "the stack is full");
  endRecord();
  names_.push_back(name);
}

void Selection::popName() {
  if (mode_ != GL_SELECT) return;
  if (names_.empty()) fail(GL_STACK_UNDERFLOW, "glPushName is missing");
  endRecord();
  names_.pop_back();
}

void Selection::draw(const ChunkPtr& chunk, const Matrix& toClip, const Polygon& polygon) {
  if (mode_ != GL_SELECT) return;
  Part part; // polygons keep their corners' order and count as filled
  part.chunk = chunk;
  const Mesh mesh = meshOf(part);
  std::vector<Corner> corners;
  for (const Vertex& v : mesh.vertices)
    corners.push_back(transform(toClip, {v.position[0], v.position[1], v.position[2], 1}));
  const auto note = [&](const std::vector<Corner>& visible) {
    for (const Corner& c : visible) {
      if (!(c[3] > 0)) continue; // a point of the eye itself
      const double depth = std::clamp((c[2] / c[3] + 1) / 2, 0.0, 1.0);
      if (std::isnan(depth)) continue;
      nearest_ = hit_ ? std::min(nearest_, depth) : depth;
      farthest_ = hit_ ? std::max(farthest_, depth) : depth;
      hit_ = true;
    }
  };
  for (size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    const std::vector<Corner> visible =
        clipped({corners[mesh.triangles[i]], corners[mesh.triangles[i + 1]],
                 corners[mesh.triangles[i + 2]]});
    if (!polygon.culls(areaOf(visible))) note(visible);
  }
  for (size_t i = 0; i + 1 < mesh.lines.size(); i += 2)
    note(clipped({corners[mesh.lines[i]], corners[mesh.lines[i + 1]]}));
  for (const uint32_t point : mesh.points) note(clipped({corners[point]}));
}

// Writes the hit record of the names so far, if there was a hit.
void Selection::endRecord() {
  if (!std::exchange(hit_, false)) return;
  const auto whole = [](double depth) { return static_cast<GLuint>(depth * 4294967295.0); };
  records_++;
  put(static_cast<GLuint>(names_.size()));
  put(whole(nearest_));
  put(whole(farthest_));
  for (const GLuint name : names_) put(name);
}

void Selection::put(GLuint value) {
  if (used_ < size_)
    buffer_[used_++] = value;
  else
    overflow_ = true;
}

} // namespace rtgl
