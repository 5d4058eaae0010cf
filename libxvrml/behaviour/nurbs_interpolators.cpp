// nurbs_interpolators.cpp: NurbsPositionInterpolator, NurbsOrientationInterpolator and
// NurbsSurfaceInterpolator (ISO/IEC 19775-1 27.4.8, 27.4.6, 27.4.10): a fraction is a part of the
// range of a parameter. Events can change control points, so each fraction reads them again.
#include <algorithm>
#include <cmath>
#include <utility>

#include "behaviour/builtin.h"
#include "behaviour/named_fields.h"
#include "geometry/nurbs/fields.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

struct State : NodeState {
  bool warned = false; // what does not fit has been reported
};

void report(Events& events, Node& node, const Faults& faults) {
  auto* state = static_cast<State*>(events.state(node));
  if (faults.any() && state && !std::exchange(state->warned, true))
    faults.report(node, &events.diagnostics(), "");
}

double within(float fraction) { return std::clamp(double(fraction), 0.0, 1.0); }

bool isFinite(const V3d& v) {
  return std::isfinite(float(v.x)) && std::isfinite(float(v.y)) && std::isfinite(float(v.z));
}

// Returns the shortest rotation of the z axis to a unit vector.
Rotation fromZ(const V3d& to) {
  const V3d axis = unit(V3d(0, 0, 1).cross(to));
  if (axis == V3d(0, 0, 0))
    return to.z < 0 ? Rotation{1, 0, 0, float(std::acos(-1.0))} : Rotation{};
  const double angle = std::atan2(std::hypot(to.x, to.y), to.z);
  return {float(axis.x), float(axis.y), float(axis.z), float(angle)};
}

void send(Events& events, nodes::NurbsPositionInterpolator& node, const RationalCurve::Point& at) {
  if (isFinite(at.place)) sendFrom<"value_changed">(events, node, toVec3f(at.place));
}
void send(Events& events, nodes::NurbsOrientationInterpolator& node,
          const RationalCurve::Point& at) {
  const V3d tangent = unit(at.first);
  if (tangent != V3d(0, 0, 0)) sendFrom<"value_changed">(events, node, fromZ(tangent));
}

template <class Interpolator>
void receiveCurve(Events& events, Node& any, const FieldInfo& in, const Value& value) {
  if (!isField<"set_fraction">(any, in)) return;
  const float fraction = std::get<SFFloat>(value);
  if (std::isnan(fraction)) return;
  auto& node = static_cast<Interpolator&>(any);
  Faults faults;
  if (const std::optional<RationalCurve> curve = curveOf(node, faults))
    send(events, node, curve->at(curve->knots.at(within(fraction))));
  report(events, node, faults);
}

void receiveSurface(Events& events, Node& any, const FieldInfo& in, const Value& value) {
  if (!isField<"set_fraction">(any, in)) return;
  const auto fraction = std::get<SFVec2f>(value);
  if (std::isnan(fraction.x) || std::isnan(fraction.y)) return;
  auto& node = static_cast<nodes::NurbsSurfaceInterpolator&>(any);
  Faults faults;
  if (const std::optional<RationalSurface> surface = surfaceOf(node, faults)) {
    const double u = surface->u.at(within(fraction.x)), v = surface->v.at(within(fraction.y));
    const RationalSurface::Point at = surface->at(u, v);
    const double scale = at.alongU.length() * at.alongV.length();
    const V3d normal = surface->normal(at, u, v, scale);
    if (isFinite(at.place)) sendFrom<"position_changed">(events, node, toVec3f(at.place));
    if (normal != V3d(0, 0, 0)) sendFrom<"normal_changed">(events, node, toVec3f(normal));
  }
  report(events, node, faults);
}

std::unique_ptr<NodeState> begin(Events&, Node&) { return std::make_unique<State>(); }

} // namespace

void addNurbsInterpolatorBehaviours(const AddBehaviour& add) {
  add(nodes::NurbsPositionInterpolator::nodeType(),
      {.begin = begin, .receive = receiveCurve<nodes::NurbsPositionInterpolator>});
  add(nodes::NurbsOrientationInterpolator::nodeType(),
      {.begin = begin, .receive = receiveCurve<nodes::NurbsOrientationInterpolator>});
  add(nodes::NurbsSurfaceInterpolator::nodeType(), {.begin = begin, .receive = receiveSurface});
}

} // namespace xvrml
