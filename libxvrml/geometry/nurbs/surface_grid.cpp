// surface_grid.cpp: joins the edges of grids, cuts their quadrilaterals, and mends normals.
#include "geometry/nurbs/surface_grid.h"

#include <algorithm>
#include <string>

#include "geometry/builders.h"
#include "geometry/polygons/face_set.h"
#include "geometry/round.h"

namespace xvrml {
namespace {

// One row or column of a grid.
struct GridLine {
  std::vector<SurfaceVertex>& vertices;
  size_t first, step, count;

  V3d& at(size_t i) const { return vertices[first + i * step].place; }
};

// Joins lines whose points coincide up to the rounding of single precision.
class Joiner {
 public:
  explicit Joiner(SurfaceGrid& grid) : grid_(grid) {
    V3d low = grid.vertices[0].place, high = low;
    for (const SurfaceVertex& vertex : grid.vertices)
      for (int axis = 0; axis < 3; axis++) {
        low[axis] = std::min(low[axis], vertex.place[axis]);
        high[axis] = std::max(high[axis], vertex.place[axis]);
      }
    tolerance_ = 1e-7 * (high - low).length();
  }

  void run() {
    const size_t columns = grid_.columns, rows = grid_.rows;
    const GridLine left{grid_.vertices, 0, columns, rows},
        right{grid_.vertices, columns - 1, columns, rows}, bottom{grid_.vertices, 0, 1, columns},
        top{grid_.vertices, (rows - 1) * columns, 1, columns};
    for (const GridLine& line : {left, right, bottom, top}) shrink(line);
    join(left, right);
    join(bottom, top);
  }

 private:
  bool near(const V3d& a, const V3d& b) const { return (a - b).length() <= tolerance_; }

  void shrink(const GridLine& line) const {
    for (size_t i = 1; i < line.count; i++)
      if (!near(line.at(0), line.at(i))) return;
    for (size_t i = 1; i < line.count; i++) line.at(i) = line.at(0);
  }
  void join(const GridLine& from, const GridLine& to) const {
    for (size_t i = 0; i < from.count; i++)
      if (!near(from.at(i), to.at(i))) return;
    for (size_t i = 0; i < from.count; i++) to.at(i) = from.at(i);
  }

  SurfaceGrid& grid_;
  double tolerance_ = 0;
};

// Gives vertices without a normal the mean of the facets around them.
void mendNormals(Mesh& mesh) {
  const auto lacks = [&](uint32_t vertex) { return mesh.ownNormals[vertex] == Vec3f{0, 0, 0}; };
  std::vector<V3d> sums;
  for (size_t t = 0; t + 2 < mesh.ownIndices.size(); t += 3)
    for (size_t k = 0; k < 3; k++) {
      const uint32_t vertex = mesh.ownIndices[t + k];
      if (!lacks(vertex)) continue;
      if (sums.empty()) sums.assign(mesh.ownPoints.size(), V3d(0, 0, 0));
      const V3d a = toV3d(mesh.ownPoints[mesh.ownIndices[t]]);
      sums[vertex] += (toV3d(mesh.ownPoints[mesh.ownIndices[t + 1]]) - a)
                          .cross(toV3d(mesh.ownPoints[mesh.ownIndices[t + 2]]) - a);
    }
  for (uint32_t i = 0; i < mesh.ownNormals.size(); i++) {
    if (!lacks(i)) continue;
    const V3d mean = sums.empty() ? V3d(0, 0, 0) : unit(sums[i]);
    mesh.ownNormals[i] = mean == V3d(0, 0, 0) ? Vec3f{0, 0, 1} : toVec3f(mean);
  }
}

} // namespace

bool isGridAllowed(uint64_t uSteps, uint64_t vSteps, const MeshOptions& options, Faults& faults) {
  const uint64_t most = std::min<uint64_t>(triangleLimit(options), noValue / 4);
  if (uSteps <= most && vSteps <= most && 2 * uSteps * vSteps <= most) return true;
  faults.note("more triangles than " + std::string(triangleLimitName(options)) +
              " allows; nothing is drawn");
  return false;
}

Mesh meshOfGrid(SurfaceGrid&& grid, bool flipped, Faults& faults) {
  Joiner(grid).run();
  Mesh mesh;
  for (const SurfaceVertex& vertex : grid.vertices)
    addVertex(mesh, toVec3f(vertex.place), toVec3f(vertex.normal), vertex.texCoord);
  const uint32_t columns = uint32_t(grid.columns), rows = uint32_t(grid.rows);
  for (uint32_t j = 0; j + 1 < rows; j++)
    for (uint32_t i = 0; i + 1 < columns; i++) {
      const uint32_t a = i + j * columns;
      addTriangle(mesh, a, a + 1, a + 1 + columns);
      addTriangle(mesh, a, a + 1 + columns, a + columns);
    }
  return finishSurface(std::move(mesh), flipped, faults);
}

Mesh finishSurface(Mesh&& mesh, bool flipped, Faults& faults) {
  if (!allFinite(std::span<const Vec3f>(mesh.ownPoints)) ||
      !allFinite(std::span<const Vec2f>(mesh.ownTexCoords))) {
    faults.note("the surface is not finite; nothing is drawn");
    return {};
  }
  mendNormals(mesh);
  if (flipped) {
    for (size_t t = 0; t + 2 < mesh.ownIndices.size(); t += 3)
      std::swap(mesh.ownIndices[t + 1], mesh.ownIndices[t + 2]);
    for (Vec3f& n : mesh.ownNormals) n = {-n.x, -n.y, -n.z};
  }
  return finishRound(std::move(mesh));
}

} // namespace xvrml
