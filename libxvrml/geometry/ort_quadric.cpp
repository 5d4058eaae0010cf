// ort_quadric.cpp: builds an ORTQuadric: the exact surface for the ray tracer, and triangles for
// pointing devices and bounds by marching tetrahedra (A. Gueziec, R. Hummel, IEEE Transactions on
// Visualization and Computer Graphics 1(4), 1995).
#include <array>

#include "geometry/builders.h"
#include "geometry/round.h"
#include "geometry/vector_math.h"

namespace xvrml {
namespace {

constexpr int cells = 20; // along each edge of the box

class Polygonizer {
 public:
  Polygonizer(const nodes::ORTQuadric& node, Mesh& mesh, uint64_t most)
      : node_(node), mesh_(mesh), most_(most) {}

  // Returns false if the limit on triangles ends it.
  bool run() {
    for (int i = 0; i < cells; i++)
      for (int j = 0; j < cells; j++)
        for (int k = 0; k < cells; k++)
          if (!cell(i, j, k)) return false;
    return true;
  }

 private:
  double q(size_t i) const { return double(node_.coefficients[i]); }
  double valueAt(const V3d& p) const {
    return p.x * (q(0) * p.x + q(3) * p.y + q(5) * p.z + q(6)) +
           p.y * (q(1) * p.y + q(4) * p.z + q(7)) + p.z * (q(2) * p.z + q(8)) + q(9);
  }
  V3d gradientAt(const V3d& p) const {
    return {2 * q(0) * p.x + q(3) * p.y + q(5) * p.z + q(6),
            2 * q(1) * p.y + q(3) * p.x + q(4) * p.z + q(7),
            2 * q(2) * p.z + q(4) * p.y + q(5) * p.x + q(8)};
  }
  V3d corner(int i, int j, int k) const {
    const auto at = [](float low, float high, int n) {
      return double(low) + (double(high) - double(low)) * n / cells;
    };
    return {at(node_.low.x, node_.high.x, i), at(node_.low.y, node_.high.y, j),
            at(node_.low.z, node_.high.z, k)};
  }

  // A cube is six tetrahedra about the diagonal from corner 0 to corner 7 (bits: x, y, z).
  bool cell(int i, int j, int k) {
    std::array<V3d, 8> p;
    std::array<double, 8> value{};
    for (int c = 0; c < 8; c++) {
      p[size_t(c)] = corner(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1));
      value[size_t(c)] = valueAt(p[size_t(c)]);
    }
    static constexpr int between[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
    for (const auto& b : between)
      if (!tetrahedron(p, value, {0, size_t(b[0]), size_t(b[1]), 7})) return false;
    return true;
  }

  bool tetrahedron(const std::array<V3d, 8>& p, const std::array<double, 8>& value,
                   std::array<size_t, 4> corners) {
    std::array<size_t, 4> in{}, out{};
    size_t ins = 0, outs = 0;
    for (const size_t c : corners) (value[c] < 0 ? in[ins++] : out[outs++]) = c;
    if (ins == 0 || outs == 0) return true;
    const auto cut = [&](size_t a, size_t b) {
      return p[a] + (p[b] - p[a]) * (value[a] / (value[a] - value[b]));
    };
    if (ins == 1) return triangle(cut(in[0], out[0]), cut(in[0], out[1]), cut(in[0], out[2]));
    if (outs == 1) return triangle(cut(in[0], out[0]), cut(in[1], out[0]), cut(in[2], out[0]));
    const V3d a = cut(in[0], out[0]), b = cut(in[0], out[1]), c = cut(in[1], out[1]),
              d = cut(in[1], out[0]);
    return triangle(a, b, c) && triangle(a, c, d);
  }

  // The vertices run counter-clockwise seen from the front, where the gradient points to.
  bool triangle(const V3d& a, V3d b, V3d c) {
    if (mesh_.ownIndices.size() / 3 >= most_) return false;
    if ((b - a).cross(c - a).dot(gradientAt(a)) < 0) std::swap(b, c);
    const auto first = uint32_t(mesh_.ownPoints.size());
    for (const V3d& p : {a, b, c})
      addVertex(mesh_, toVec3f(p), toVec3f(unit(gradientAt(p))), {0, 0});
    addTriangle(mesh_, first, first + 1, first + 2);
    return true;
  }

  const nodes::ORTQuadric& node_;
  Mesh& mesh_;
  uint64_t most_;
};

} // namespace

Mesh buildORTQuadric(const nodes::ORTQuadric& node, const MeshOptions& options, Faults& faults) {
  Mesh mesh;
  const Vec3f &low = node.low, &high = node.high;
  if (node.coefficients.size() != 10 || !allFinite(std::span<const float>(node.coefficients))) {
    faults.note("coefficients must be ten finite numbers; nothing is drawn");
    return mesh;
  }
  if (!isFinite(low) || !isFinite(high) || !(low.x < high.x && low.y < high.y && low.z < high.z)) {
    faults.note("low must be below high on every axis, and both finite; nothing is drawn");
    return mesh;
  }
  if (!Polygonizer(node, mesh, triangleLimit(options)).run()) {
    faults.add(Fault::overLimit, 0);
    return Mesh();
  }
  mesh.kind = Mesh::Kind::triangles;
  mesh.solid = node.solid;
  mesh.ccw = node.ccw;
  mesh.viewOwn();
  ExactSurface exact{ExactSurface::Kind::quadric, {}};
  exact.numbers.assign(node.coefficients.begin(), node.coefficients.end());
  for (const float x : {low.x, low.y, low.z, high.x, high.y, high.z}) exact.numbers.push_back(x);
  mesh.exact.push_back(std::move(exact));
  return mesh;
}

} // namespace xvrml
