// nurbs_surface.cpp: NurbsPatchSurface and NurbsTrimmedSurface (ISO/IEC 19775-1 27.4.7, 27.4.14):
// equal steps of both parameters, with exact normals at their ends, and lines where it may bend.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
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

  // Sets the length of a cross product of derivatives that counts as regular.
  void setScale(double scale) { scale_ = scale; }
  double crossLength(const ParameterStep& u, const ParameterStep& v) const {
    const RationalSurface::Point point = surface_.at(u.t, v.t);
    return point.alongU.cross(point.alongV).length();
  }

  const KnotVector& u() const { return surface_.u; }
  const KnotVector& v() const { return surface_.v; }
  SurfaceVertex at(const ParameterStep& u, const ParameterStep& v) const {
    const RationalSurface::Point point = surface_.at(surface_.u.basis(u), surface_.v.basis(v));
    SurfaceVertex vertex{point.place, surface_.normal(point, u.t, v.t, scale_), {}};
    vertex.texCoord = {float(u.fraction), float(v.fraction)};
    if (texture_) {
      const V3d place = texture_->at(texture_->u.at(u.fraction), texture_->v.at(v.fraction)).place;
      vertex.texCoord = {float(place.x), float(place.y)};
    }
    return vertex;
  }

 private:
  RationalSurface surface_;
  std::optional<RationalSurface> texture_;
  double scale_ = 0;
};

using Steps = std::vector<ParameterStep>;

// Sets the scale of a patch by its points at some of the steps.
void measure(Patch& patch, const Steps& u, const Steps& v) {
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
  if (largest < -1e-9) contours.push_back({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  return contours;
}

template <class Node> Patch patchOf(const Node& node, RationalSurface&& surface,
                                    const MeshOptions& options, Faults& faults) {
  std::optional<RationalSurface> texture;
  if (options.needTexCoords) texture = texturePatchOf(node, faults);
  return Patch(std::move(surface), std::move(texture));
}

Mesh meshOfAll(const Patch& patch, const Steps& u, const Steps& v, Faults& faults) {
  SurfaceGrid grid{u.size(), v.size(), {}};
  grid.vertices.reserve(u.size() * v.size());
  for (const ParameterStep& atV : v)
    for (const ParameterStep& atU : u) grid.vertices.push_back(patch.at(atU, atV));
  return meshOfGrid(std::move(grid), false, faults);
}

// Returns the lines of a grid, of which two at a bend are one.
std::vector<double> linesOf(const Steps& steps) {
  std::vector<double> lines;
  for (const ParameterStep& step : steps)
    if (step.side != ParameterStep::Side::before) lines.push_back(step.fraction);
  return lines;
}

// Makes the vertices of triangles between two lines of one parameter. Where the surface may bend,
// or has a gap, a corner has a vertex for each side.
class SidesOfBends {
 public:
  SidesOfBends(const KnotVector& knots, const Steps& steps) : knots_(knots) {
    for (const ParameterStep& step : steps)
      if (step.side == ParameterStep::Side::before) bends_[step.fraction] = step.t;
  }
  // Returns the step of a corner of a triangle. middle: of the triangle.
  ParameterStep at(double corner, double middle) const {
    using Side = ParameterStep::Side;
    if (const auto bend = bends_.find(corner); bend != bends_.end())
      return {bend->second, corner, middle < corner ? Side::before : Side::after};
    const double fraction = std::clamp(corner, 0.0, 1.0);
    return {knots_.at(fraction), fraction};
  }

 private:
  const KnotVector& knots_;
  std::map<double, double> bends_; // the knots of fractions
};

Mesh meshOfPart(const Patch& patch, const Steps& uSteps, const Steps& vSteps,
                const TrimmedCells& cells, Faults& faults) {
  using Side = ParameterStep::Side;
  const SidesOfBends alongU(patch.u(), uSteps), alongV(patch.v(), vSteps);
  std::map<std::tuple<uint32_t, Side, Side>, uint32_t> vertices;
  Mesh mesh;
  for (size_t t = 0; t + 2 < cells.triangles.size(); t += 3) {
    V2d middle(0.0);
    for (size_t k = 0; k < 3; ++k) middle += cells.corners[cells.triangles[t + k]] / 3;
    std::array<uint32_t, 3> numbers;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t corner = cells.triangles[t + k];
      const ParameterStep u = alongU.at(cells.corners[corner].x, middle.x),
                          v = alongV.at(cells.corners[corner].y, middle.y);
      const auto [known, isNew] =
          vertices.try_emplace({corner, u.side, v.side}, uint32_t(vertices.size()));
      numbers[k] = known->second;
      if (!isNew) continue;
      const SurfaceVertex vertex = patch.at(u, v);
      addVertex(mesh, toVec3f(vertex.place), toVec3f(vertex.normal), vertex.texCoord);
    }
    addTriangle(mesh, numbers[0], numbers[1], numbers[2]);
  }
  return finishSurface(std::move(mesh), false, faults);
}

template <class Node>
Mesh buildSurface(const Node& node, const MeshOptions& options, Faults& faults) {
  std::optional<RationalSurface> surface = surfaceOf(node, faults);
  if (!surface) return {};
  const uint64_t uSteps = stepsOf(node.uTessellation, size_t(node.uDimension)),
                 vSteps = stepsOf(node.vTessellation, size_t(node.vDimension));
  if (!isGridAllowed(uSteps, vSteps, options, faults)) return {};
  const Steps u = surface->u.steps(uSteps), v = surface->v.steps(vSteps);
  if (!isGridAllowed(u.size() - 1, v.size() - 1, options, faults)) return {};
  std::vector<Contour> contours;
  if constexpr (std::is_same_v<Node, nodes::NurbsTrimmedSurface>)
    contours = contoursOf(node, *surface, faults);
  Patch patch = patchOf(node, std::move(*surface), options, faults);
  measure(patch, u, v);
  Mesh mesh;
  if (contours.empty())
    mesh = meshOfAll(patch, u, v, faults);
  else
    mesh = meshOfPart(patch, u, v,
                      trimCells(linesOf(u), linesOf(v), contours, triangleLimit(options), faults),
                      faults);
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
