// fields.cpp: checks knots, weights and nets, and closes what ends where it begins.
#include "geometry/nurbs/fields.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/builders.h"
#include "geometry/texture_generator.h"
#include "xvrml/deformed.h"
#include "xvrml/world.h"

namespace xvrml {
namespace {

// The fields of one parameter of a node. prefix: "u" for uOrder, uKnot and uDimension.
struct Side {
  std::string_view prefix;
  int32_t order;
  int64_t dimension;
  std::span<const Double> knot;

  std::string name(std::string_view field) const {
    if (prefix.empty()) return std::string(field);
    return fmt::format("{}{}{}", prefix, char(field[0] - 'a' + 'A'), field.substr(1));
  }
};

bool hasGoodSize(const Side& side, Faults& faults) {
  if (side.order < 2 || side.order > mostNurbsOrder) {
    faults.note(fmt::format("{} is {}, expected 2 to {}; it is left out", side.name("order"),
                            side.order, mostNurbsOrder));
    return false;
  }
  if (side.dimension < side.order) {
    faults.note(fmt::format("{} {} needs as many control points, and there are {}; it is left out",
                            side.name("order"), side.order, side.dimension));
    return false;
  }
  return true;
}

// Returns whether knots do not decrease, and none is there more than `order` times (27.2.3).
bool areKnots(std::span<const double> knots, int32_t order) {
  size_t equal = 1;
  for (size_t i = 0; i < knots.size(); i++) {
    if (!std::isfinite(knots[i])) return false;
    if (i == 0) continue;
    if (knots[i] < knots[i - 1]) return false;
    equal = knots[i] == knots[i - 1] ? equal + 1 : 1;
    if (equal > size_t(order)) return false;
  }
  const size_t degree = size_t(order) - 1;
  return knots[degree] < knots[knots.size() - 1 - degree] &&
         std::isfinite(knots.back() - knots.front());
}

// Returns uniform knots from 0 to 1. An open curve ends in its first and last point.
std::vector<double> uniformKnots(int32_t order, size_t count, bool closed) {
  std::vector<double> knots(count);
  const size_t degree = size_t(order) - 1, spans = count - 1 - 2 * degree;
  for (size_t i = 0; i < count; i++)
    knots[i] = closed ? double(i) / double(count - 1)
                      : double(std::clamp(i, degree, degree + spans) - degree) / double(spans);
  return knots;
}

// Returns the knots of a side. closed: the knots go on for the points that repeat the first ones.
KnotVector knotsOf(const Side& side, bool closed, Faults& faults) {
  const size_t count = size_t(side.dimension) + size_t(side.order);
  std::vector<double> knots(side.knot.begin(), side.knot.end());
  if (knots.size() != count || !areKnots(knots, side.order)) {
    if (!knots.empty())
      faults.note(fmt::format("{} has {} values, expected {} that do not decrease, none more than "
                              "{} times: uniform knots are used",
                              side.name("knot"), knots.size(), count, side.order));
    knots = uniformKnots(side.order, count, closed);
  }
  for (size_t i = 1; closed && i + 1 < size_t(side.order); i++)
    knots.push_back(knots.back() + (knots[i] - knots[i - 1]));
  return KnotVector(side.order, std::move(knots));
}

// Sets the weights of points, which are 1. Weights that do not fit are ignored (27.4.7).
void setWeights(std::vector<V4d>& points, std::span<const Double> weights, Faults& faults) {
  if (weights.empty()) return;
  if (weights.size() != points.size()) {
    faults.note(fmt::format("weight has {} values for {} control points: all weights are 1",
                            weights.size(), points.size()));
    return;
  }
  const auto bad = std::find_if(weights.begin(), weights.end(),
                                [](double w) { return !(w > 0) || !std::isfinite(w); });
  if (bad != weights.end()) {
    faults.note(fmt::format("weight[{}] is {}, expected a number above 0: all weights are 1",
                            bad - weights.begin(), double(*bad)));
    return;
  }
  for (size_t i = 0; i < points.size(); i++) points[i].w = weights[i];
}

template <class Points> std::vector<V4d> inSpace(const Points& points) {
  std::vector<V4d> result;
  result.reserve(points.size());
  for (const auto& p : points) {
    if constexpr (requires { p.z; })
      result.emplace_back(p.x, p.y, p.z, 1);
    else
      result.emplace_back(p.x, p.y, 0, 1);
  }
  return result;
}

// Returns the points of a Coordinate or CoordinateDouble.
std::vector<V4d> controlPointsOf(const NodeRef& node) {
  Node* rendered = renderedNode(node.get());
  if (auto* single = nodeCast<nodes::Coordinate>(rendered)) return inSpace(drawnPoints(*single));
  if (auto* exact = nodeCast<nodes::CoordinateDouble>(rendered))
    return inSpace(drawnPoints(*exact));
  return {};
}
std::vector<V4d> controlPointsOf(const MFVec2d& points) { return inSpace(points); }
std::vector<V4d> controlPointsOf(const MFVec2f& points) { return inSpace(points); }

bool areFinite(std::span<const V4d> points, Faults& faults) {
  for (size_t i = 0; i < points.size(); i++)
    if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y) || !std::isfinite(points[i].z)) {
      faults.note(fmt::format("controlPoint[{}] is not finite; it is left out", i));
      return false;
    }
  return true;
}

template <class Node>
std::optional<RationalCurve> makeCurve(const Node& node, bool closed, Faults& faults) {
  std::vector<V4d> points = controlPointsOf(node.controlPoint);
  if (points.empty()) return {};
  const Side side{"", node.order, int64_t(points.size()), node.knot};
  if (!hasGoodSize(side, faults) || !areFinite(points, faults)) return {};
  setWeights(points, node.weight, faults);
  closed = closed && points.front() == points.back();
  for (int32_t i = 1; closed && i + 1 < node.order; i++) points.push_back(points[size_t(i)]);
  return RationalCurve{knotsOf(side, closed, faults), std::move(points)};
}

// A net of control points with the fields of its sides.
struct Net {
  Side u, v;
  std::vector<V4d> points;
  std::span<const Double> weights;
};

// Repeats the first columns of a net behind its last one.
void repeatColumns(std::vector<V4d>& net, size_t columns, size_t repeated) {
  std::vector<V4d> wider;
  wider.reserve(net.size() / columns * (columns + repeated));
  for (auto row = net.begin(); row != net.end(); row += ptrdiff_t(columns)) {
    wider.insert(wider.end(), row, row + ptrdiff_t(columns));
    wider.insert(wider.end(), row + 1, row + 1 + ptrdiff_t(repeated));
  }
  net = std::move(wider);
}

std::optional<RationalSurface> makeSurface(Net&& net, bool uClosed, bool vClosed, Faults& faults) {
  if (net.points.empty()) return {};
  if (!hasGoodSize(net.u, faults) || !hasGoodSize(net.v, faults)) return {};
  const int64_t wanted = net.u.dimension * net.v.dimension; // each is below 2^31
  if (int64_t(net.points.size()) < wanted) {
    faults.note(fmt::format("there are {} control points where uDimension and vDimension ask for "
                            "{}; it is left out",
                            net.points.size(), wanted));
    return {};
  }
  net.points.resize(size_t(wanted));
  if (!areFinite(net.points, faults)) return {};
  setWeights(net.points, net.weights, faults);
  const size_t columns = size_t(net.u.dimension);
  auto& points = net.points;
  for (size_t i = 0; uClosed && i < points.size(); i += columns)
    uClosed = points[i] == points[i + columns - 1];
  vClosed = vClosed && std::equal(points.begin(), points.begin() + ptrdiff_t(columns),
                                  points.end() - ptrdiff_t(columns));
  if (vClosed) { // columns rows behind the last row
    const size_t repeated = columns * (size_t(net.v.order) - 2);
    for (size_t i = 0; i < repeated; i++) points.push_back(points[columns + i]);
  }
  if (uClosed) repeatColumns(points, columns, size_t(net.u.order) - 2);
  return RationalSurface{knotsOf(net.u, uClosed, faults), knotsOf(net.v, vClosed, faults),
                         std::move(points)};
}

template <class Node> Net netOf(const Node& node) {
  return {{"u", node.uOrder, node.uDimension, node.uKnot},
          {"v", node.vOrder, node.vDimension, node.vKnot},
          controlPointsOf(node.controlPoint),
          node.weight};
}

template <class Node>
std::optional<RationalSurface> makeTexturePatch(const Node& node, Faults& faults) {
  const auto* patch =
      nodeCast<nodes::NurbsTextureCoordinate>(firstTextureCoordinate(node.texCoord));
  if (patch) return makeSurface(netOf(*patch), false, false, faults);
  const TexCoordValues values = textureCoordinates(node.texCoord);
  const std::span<const Vec2f> given = values.points;
  if (given.empty()) return {};
  Net net = netOf(node);
  net.weights = {};
  net.points = inSpace(given);
  Faults again; // the knots have been complained about
  if (int64_t(given.size()) < net.u.dimension * net.v.dimension) {
    faults.note("texCoord has fewer points than there are control points: the whole texture is "
                "used");
    return {};
  }
  return makeSurface(std::move(net), node.uClosed, node.vClosed, again);
}

} // namespace

std::optional<RationalCurve> curveOf(const nodes::NurbsCurve& node, Faults& faults) {
  return makeCurve(node, node.closed, faults);
}
std::optional<RationalCurve> curveOf(const nodes::NurbsCurve2D& node, Faults& faults) {
  return makeCurve(node, node.closed, faults);
}
std::optional<RationalCurve> curveOf(const nodes::NurbsPositionInterpolator& node, Faults& faults) {
  return makeCurve(node, false, faults);
}
std::optional<RationalCurve> curveOf(const nodes::NurbsOrientationInterpolator& node,
                                     Faults& faults) {
  return makeCurve(node, false, faults);
}

std::optional<RationalSurface> surfaceOf(const nodes::NurbsPatchSurface& node, Faults& faults) {
  return makeSurface(netOf(node), node.uClosed, node.vClosed, faults);
}
std::optional<RationalSurface> surfaceOf(const nodes::NurbsTrimmedSurface& node, Faults& faults) {
  return makeSurface(netOf(node), node.uClosed, node.vClosed, faults);
}
std::optional<RationalSurface> surfaceOf(const nodes::NurbsSurfaceInterpolator& node,
                                         Faults& faults) {
  return makeSurface(netOf(node), false, false, faults);
}

std::optional<RationalSurface> texturePatchOf(const nodes::NurbsPatchSurface& node,
                                              Faults& faults) {
  return makeTexturePatch(node, faults);
}
std::optional<RationalSurface> texturePatchOf(const nodes::NurbsTrimmedSurface& node,
                                              Faults& faults) {
  return makeTexturePatch(node, faults);
}

uint64_t stepsOf(int32_t tessellation, size_t controlPoints) {
  if (tessellation > 0) return uint64_t(tessellation);
  return (tessellation == 0 ? 2 : uint64_t(-int64_t(tessellation))) * controlPoints;
}

PlaneCurve planeCurveOf(const NodeRef& node, uint64_t most, Faults& faults) {
  PlaneCurve result;
  Node* rendered = renderedNode(node.get());
  const auto tooMany = [&](uint64_t steps) {
    if (steps > most) faults.note("a curve has more points than can be drawn; it is left out");
    return steps > most;
  };
  if (auto* line = nodeCast<nodes::ContourPolyline2D>(rendered)) {
    const std::vector<V4d> points = controlPointsOf(line->controlPoint);
    if (tooMany(points.size()) || !areFinite(points, faults)) return result;
    for (const V4d& p : points) {
      result.fractions.push_back(double(result.points.size()) / double(points.size() - 1));
      result.points.emplace_back(p.x, p.y);
    }
  } else if (auto* curve = nodeCast<nodes::NurbsCurve2D>(rendered)) {
    const std::optional<RationalCurve> spline = curveOf(*curve, faults);
    const uint64_t steps = stepsOf(curve->tessellation, curve->controlPoint.size());
    if (!spline || tooMany(steps)) return result;
    for (const ParameterStep& step : spline->knots.steps(steps)) {
      const RationalCurve::Point point = spline->at(spline->knots.basis(step));
      result.points.emplace_back(point.place.x, point.place.y);
      result.tangents.emplace_back(point.first.x, point.first.y);
      result.fractions.push_back(step.fraction);
    }
  }
  for (const V2d& p : result.points)
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return {};
  return result;
}

} // namespace xvrml
