#include "geometry/thick.h"

#include <numbers>

#include "geometry/builders.h"
#include "geometry/sphere_facets.h"
#include "geometry/vector_math.h"

namespace xvrml {
namespace {

// Returns the rows of facets of each ball: fewer where there are many, which are small in pictures.
uint32_t rowsOf(size_t balls) { return balls <= 1000 ? 12 : balls <= 20'000 ? 6 : 3; }

class Thickener {
 public:
  Thickener(const Mesh& thin, double radius, size_t balls)
      : thin_(thin), radius_(radius), rows_(rowsOf(balls)), ball_(sphereFacets(1, rows_)) {
    const bool lines = thin.kind == Mesh::Kind::lines;
    const size_t segments = lines ? thin.indices.size() / 2 : 0;
    triangles_ = balls * (ball_.indices.size() / 3) + segments * 2 * sides();
    vertices_ = balls * ball_.points.size() + segments * 2 * sides();
  }

  uint64_t triangles() const { return triangles_; }
  uint64_t vertices() const { return vertices_; }

  Mesh run(const std::vector<uint32_t>& places) {
    made_.ownPoints.reserve(vertices_);
    made_.ownNormals.reserve(vertices_);
    made_.ownIndices.reserve(3 * triangles_);
    for (const uint32_t place : places) addBall(place);
    if (thin_.kind == Mesh::Kind::lines)
      for (size_t i = 0; i + 1 < thin_.indices.size(); i += 2)
        addRod(thin_.indices[i], thin_.indices[i + 1]);
    made_.kind = Mesh::Kind::triangles;
    made_.viewOwn();
    return std::move(made_);
  }

 private:
  uint32_t sides() const { return 2 * rows_; }

  // Adds a vertex on the surface around a point of the thin mesh, in that point's colour.
  void addVertex(uint32_t place, const V3d& normal) {
    made_.ownPoints.push_back(toVec3f(toV3d(thin_.points[place]) + radius_ * normal));
    made_.ownNormals.push_back(toVec3f(normal));
    if (!thin_.colors.empty()) made_.ownColors.push_back(thin_.colors[place]);
    if (!thin_.alphas.empty()) made_.ownAlphas.push_back(thin_.alphas[place]);
    if (!thin_.fogCoords.empty()) made_.ownFogCoords.push_back(thin_.fogCoords[place]);
  }

  void addBall(uint32_t place) {
    const uint32_t first = uint32_t(made_.ownPoints.size());
    for (const Vec3f& normal : ball_.points) addVertex(place, unit(toV3d(normal)));
    for (const uint32_t index : ball_.indices) made_.ownIndices.push_back(first + index);
  }

  void addRod(uint32_t from, uint32_t to) {
    const V3d along = unit(toV3d(thin_.points[to]) - toV3d(thin_.points[from]));
    const V3d other = std::abs(along.x) < 0.5 ? V3d(1, 0, 0) : V3d(0, 1, 0);
    const V3d x = unit(along.cross(other)), y = along.cross(x);
    const uint32_t first = uint32_t(made_.ownPoints.size()), count = sides();
    for (uint32_t side = 0; side < count; side++) {
      const double angle = 2 * std::numbers::pi * side / count;
      const V3d normal = std::cos(angle) * x + std::sin(angle) * y;
      addVertex(from, normal);
      addVertex(to, normal);
    }
    for (uint32_t side = 0; side < count; side++) {
      const uint32_t a = first + 2 * side, b = first + 2 * ((side + 1) % count);
      made_.ownIndices.insert(made_.ownIndices.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  }

  const Mesh& thin_;
  const double radius_;
  const uint32_t rows_;
  const Mesh ball_; // its radius is 1
  uint64_t triangles_ = 0, vertices_ = 0;
  Mesh made_;
};

} // namespace

void thicken(Mesh& mesh, const MeshOptions& options, Faults& faults) {
  const float size = mesh.kind == Mesh::Kind::points  ? options.pointSize
                     : mesh.kind == Mesh::Kind::lines ? options.lineWidth
                                                      : 0;
  if (!(size > 0)) return;
  std::vector<bool> used(mesh.points.size(), false);
  for (const uint32_t index : mesh.indices) used[index] = true;
  std::vector<uint32_t> places;
  for (uint32_t i = 0; i < used.size(); i++)
    if (used[i]) places.push_back(i);
  Thickener thickener(mesh, 0.5 * double(size), places.size());
  if (thickener.triangles() > triangleLimit(options) || thickener.vertices() >= UINT32_MAX)
    return faults.note("points or lines stay thin: with a size they would have " +
                       std::to_string(thickener.triangles()) + " triangles, more than " +
                       std::string(triangleLimitName(options)));
  Mesh made = thickener.run(places);
  mesh = std::move(made);
}

} // namespace xvrml
