// mesh.cpp: Divides primitives into triangles and lines (OpenGL 1.1, section 2.6.1 and table 2.12).
#include "gl/mesh.h"

#include <algorithm>

namespace rtgl {
namespace {

class Builder {
 public:
  Builder(const Part& part, Mesh& mesh)
      : part_(part), from_(part.chunk->vertices), mesh_(mesh),
        mode_(part.polygonMode[part.cull && part.cullFace == GL_FRONT ? 1 : 0]) {
    if (!part.flat) mesh.vertices = from_;
  }

  void point(size_t i) { mesh_.points.push_back(corner(i, i)); }
  void line(size_t i, size_t j) {
    mesh_.lines.push_back(corner(i, j));
    mesh_.lines.push_back(corner(j, j));
  }
  // Adds a polygon, whose corners are convex and counter-clockwise seen from the front.
  void polygon(std::initializer_list<size_t> corners, size_t provoking) {
    polygon(std::vector<size_t>(corners), provoking);
  }
  void polygon(std::vector<size_t> corners, size_t provoking) {
    if (part_.cull && part_.cullFace == GL_FRONT_AND_BACK) return;
    const bool clockwise = part_.frontFace == GL_CW;
    const bool turned =
        part_.cull ? clockwise != (part_.cullFace == GL_FRONT) : part_.lit && facesAway(corners);
    if (turned) std::reverse(corners.begin(), corners.end());
    std::vector<uint32_t> at;
    for (size_t i : corners) at.push_back(corner(i, provoking));
    const size_t n = at.size();
    if (mode_ == GL_POINT) mesh_.points.insert(mesh_.points.end(), at.begin(), at.end());
    if (mode_ == GL_LINE)
      for (size_t i = 0; i < n; i++) {
        mesh_.lines.push_back(at[i]);
        mesh_.lines.push_back(at[(i + 1) % n]);
      }
    if (mode_ == GL_FILL)
      for (size_t i = 1; i + 1 < n; i++)
        for (size_t k : {size_t(0), i, i + 1}) mesh_.triangles.push_back(at[k]);
  }

 private:
  uint32_t corner(size_t i, size_t provoking) {
    if (!part_.flat) return static_cast<uint32_t>(i);
    Vertex vertex = from_[i];
    vertex.normal = from_[provoking].normal;
    vertex.color = from_[provoking].color;
    mesh_.vertices.push_back(vertex);
    return static_cast<uint32_t>(mesh_.vertices.size() - 1);
  }
  Vector position(size_t i) const {
    const std::array<float, 3>& p = from_[i].position;
    return {p[0], p[1], p[2]};
  }
  // Returns whether the normals of the corners point away from the side on which the corners are
  // counter-clockwise.
  bool facesAway(const std::vector<size_t>& corners) const {
    Vector face = {0, 0, 0}, normal = {0, 0, 0};
    for (size_t i = 1; i + 1 < corners.size(); i++) {
      const Vector area = cross(position(corners[i]) - position(corners[0]),
                                position(corners[i + 1]) - position(corners[0]));
      for (size_t c = 0; c < 3; c++) face[c] += area[c];
    }
    for (size_t i : corners)
      for (size_t c = 0; c < 3; c++) normal[c] += static_cast<double>(from_[i].normal[c]);
    return face[0] * normal[0] + face[1] * normal[1] + face[2] * normal[2] < 0;
  }

  const Part& part_;
  const std::vector<Vertex>& from_;
  Mesh& mesh_;
  GLenum mode_;
};

} // namespace

Mesh meshOf(const Part& part) {
  Mesh mesh;
  Builder build(part, mesh);
  const size_t n = part.chunk->vertices.size();
  switch (part.chunk->mode) {
  case GL_POINTS:
    for (size_t i = 0; i < n; i++) build.point(i);
    break;
  case GL_LINES:
    for (size_t i = 0; i + 1 < n; i += 2) build.line(i, i + 1);
    break;
  case GL_LINE_STRIP:
  case GL_LINE_LOOP:
    for (size_t i = 0; i + 1 < n; i++) build.line(i, i + 1);
    if (part.chunk->mode == GL_LINE_LOOP && n > 2) build.line(n - 1, 0);
    break;
  case GL_TRIANGLES:
    for (size_t i = 0; i + 2 < n; i += 3) build.polygon({i, i + 1, i + 2}, i + 2);
    break;
  case GL_TRIANGLE_STRIP:
    for (size_t i = 0; i + 2 < n; i++) build.polygon({i + (i & 1), i + 1 - (i & 1), i + 2}, i + 2);
    break;
  case GL_TRIANGLE_FAN:
    for (size_t i = 1; i + 1 < n; i++) build.polygon({0, i, i + 1}, i + 1);
    break;
  case GL_QUADS:
    for (size_t i = 0; i + 3 < n; i += 4) build.polygon({i, i + 1, i + 2, i + 3}, i + 3);
    break;
  case GL_QUAD_STRIP:
    for (size_t i = 0; i + 3 < n; i += 2) build.polygon({i, i + 1, i + 3, i + 2}, i + 3);
    break;
  case GL_POLYGON: {
    std::vector<size_t> corners(n);
    for (size_t i = 0; i < n; i++) corners[i] = i;
    if (n > 2) build.polygon(std::move(corners), 0);
    break;
  }
  default: break;
  }
  return mesh;
}

} // namespace rtgl
