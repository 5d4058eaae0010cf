// nurbs_surface.cpp: NurbsPatchSurface and NurbsTrimmedSurface (ISO/IEC 19775-1 27.4.7, 27.4.14):
// equal steps of both parameters, with exact normals at their ends.
#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "geometry/builders.h"
#include "geometry/nurbs/fields.h"
#include "geometry/nurbs/surface_grid.h"
#include "geometry/nurbs/trim.h"
#include "geometry/round.h"
#include "xvrml/world.h"

namespace xvrml {
namespace {

// A surface that is drawn, and its texture coordinates.
class Patch {
 public:
  Patch(RationalSurface&& surface, std::optional<RationalSurface>&& texture)
      : surface_(std::move(surface)), texture_(std::move(texture)) {}

  // Returns the places of both parameters at a fraction of their ranges.
  double uAt(double fraction) const { return surface_.u.at(fraction); }
  double vAt(double fraction) const { return surface_.v.at(fraction); }

  // Sets the length of a cross product of derivatives that counts as regular.
  void setScale(double scale) { scale_ = scale; }
  double crossLength(double u, double v) const {
    const RationalSurface::Point point = surface_.at(uAt(u), vAt(v));
    return point.alongU.cross(point.alongV).length();
  }

  // Returns the vertex at fractions of both ranges.
  SurfaceVertex at(double u, double v) const {
    const double atU = uAt(u), atV = vAt(v);
    const RationalSurface::Point point = surface_.at(atU, atV);
    SurfaceVertex vertex{point.place, surface_.normal(point, atU, atV, scale_), {}};
    vertex.texCoord = {float(u), float(v)};
    if (texture_) {
      const V3d place = texture_->at(texture_->u.at(u), texture_->v.at(v)).place;
      vertex.texCoord = {float(place.x), float(place.y)};
    }
    return vertex;
  }

 private:
  RationalSurface surface_;
  std::optional<RationalSurface> texture_;
  double scale_ = 0;
};

std::vector<double> fractions(uint64_t steps) {
  std::vector<double> result(steps + 1);
  for (uint64_t i = 0; i <= steps; i++) result[i] = double(i) / double(steps);
  return result;
}

// Sets the scale of a patch by its points at some of the steps.
void measure(Patch& patch, std::span<const double> u, std::span<const double> v) {
  constexpr size_t most = 16;
  double scale = 0;
  const auto step = [](size_t count) { return std::max<size_t>(1, count / most); };
  for (size_t j = 0; j < v.size(); j += step(v.size()))
    for (size_t i = 0; i < u.size(); i += step(u.size()))
      scale = std::max(scale, patch.crossLength(u[i], v[j]));
  patch.setScale(scale);
}

using Contour = std::vector<V2d>;

double areaOf(const Contour& contour) {
  double sum = 0;
  for (size_t i = 0; i < contour.size(); i++)
    sum += contour[i].cross(contour[(i + 1) % contour.size()]) / 2;
  return sum;
}

// Returns the points of one contour, in fractions of the ranges of both parameters.
Contour contourOf(const nodes::Contour2D& node, const RationalSurface& surface, Faults& faults) {
  constexpr uint64_t most = 1'000'000; // more take too long to be cut
  const V2d low(surface.u.begin(), surface.v.begin()),
      size(surface.u.end() - low.x, surface.v.end() - low.y);
  Contour points;
  for (const NodeRef& curve : node.children)
    for (const V2d& p : planeCurveOf(curve, most, faults).points)
      points.push_back((p - low) / size);
  return points;
}

// Returns the contours between which the surface stays. It stays on the left of a contour, so that
// a largest one that runs clockwise cuts a hole into the whole surface.
std::vector<Contour> contoursOf(const nodes::NurbsTrimmedSurface& node,
                                const RationalSurface& surface, Faults& faults) {
  std::vector<Contour> contours;
  double largest = 0;
  for (const NodeRef& child : node.trimmingContour) {
    auto* contour = nodeCast<nodes::Contour2D>(renderedNode(child.get()));
    if (!contour) continue;
    Contour points = contourOf(*contour, surface, faults);
    if (points.size() < 3) {
      faults.note("a contour of trimmingContour has fewer than 3 points; it is left out");
      continue;
    }
    const double area = areaOf(points);
    if (std::abs(area) > std::abs(largest)) largest = area;
    contours.push_back(std::move(points));
  }
  if (largest < 0) contours.push_back({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  return contours;
}

template <class Node> Patch patchOf(const Node& node, RationalSurface&& surface,
                                    const MeshOptions& options, Faults& faults) {
  std::optional<RationalSurface> texture;
  if (options.needTexCoords) texture = texturePatchOf(node, faults);
  return Patch(std::move(surface), std::move(texture));
}

Mesh meshOfAll(const Patch& patch, std::span<const double> u, std::span<const double> v,
               Faults& faults) {
  SurfaceGrid grid{u.size(), v.size(), {}};
  grid.vertices.reserve(u.size() * v.size());
  for (const double atV : v)
    for (const double atU : u) grid.vertices.push_back(patch.at(atU, atV));
  return meshOfGrid(std::move(grid), false, faults);
}

Mesh meshOfPart(const Patch& patch, const TrimmedCells& cells, Faults& faults) {
  Mesh mesh;
  for (const V2d& corner : cells.corners) {
    const SurfaceVertex vertex =
        patch.at(std::clamp(corner.x, 0.0, 1.0), std::clamp(corner.y, 0.0, 1.0));
    addVertex(mesh, toVec3f(vertex.place), toVec3f(vertex.normal), vertex.texCoord);
  }
  for (size_t t = 0; t + 2 < cells.triangles.size(); t += 3)
    addTriangle(mesh, cells.triangles[t], cells.triangles[t + 1], cells.triangles[t + 2]);
  return finishSurface(std::move(mesh), false, faults);
}

template <class Node>
Mesh buildSurface(const Node& node, const MeshOptions& options, Faults& faults) {
  std::optional<RationalSurface> surface = surfaceOf(node, faults);
  if (!surface) return {};
  const uint64_t uSteps = stepsOf(node.uTessellation, size_t(node.uDimension)),
                 vSteps = stepsOf(node.vTessellation, size_t(node.vDimension));
  if (!isGridAllowed(uSteps, vSteps, options, faults)) return {};
  const std::vector<double> u = fractions(uSteps), v = fractions(vSteps);
  std::vector<Contour> contours;
  if constexpr (std::is_same_v<Node, nodes::NurbsTrimmedSurface>)
    contours = contoursOf(node, *surface, faults);
  Patch patch = patchOf(node, std::move(*surface), options, faults);
  measure(patch, u, v);
  Mesh mesh;
  if (contours.empty())
    mesh = meshOfAll(patch, u, v, faults);
  else
    mesh = meshOfPart(patch, trimCells(u, v, contours, triangleLimit(options), faults), faults);
  mesh.solid = node.solid;
  return mesh;
}

} // namespace

Mesh buildNurbsPatchSurface(const nodes::NurbsPatchSurface& node, const MeshOptions& options,
                            Faults& faults) {
  return buildSurface(node, options, faults);
}

Mesh buildNurbsTrimmedSurface(const nodes::NurbsTrimmedSurface& node, const MeshOptions& options,
                              Faults& faults) {
  return buildSurface(node, options, faults);
}

} // namespace xvrml
