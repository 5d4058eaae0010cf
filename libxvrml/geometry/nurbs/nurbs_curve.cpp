// nurbs_curve.cpp: NurbsCurve (ISO/IEC 19775-1 27.4.4) as a line through points at equal steps of
// its parameter, and at its bends.
#include "geometry/builders.h"
#include "geometry/nurbs/fields.h"

namespace xvrml {

Mesh buildNurbsCurve(const nodes::NurbsCurve& node, const MeshOptions& options, Faults& faults) {
  const std::optional<RationalCurve> curve = curveOf(node, faults);
  if (!curve) return {};
  const size_t points = curve->points.size();
  const uint64_t steps = stepsOf(node.tessellation, points);
  if (steps > triangleLimit(options) || steps >= UINT32_MAX) {
    faults.note("more steps than " + std::string(triangleLimitName(options)) +
                " allows; nothing is drawn");
    return {};
  }
  Mesh mesh;
  for (const ParameterStep& step : curve->knots.steps(steps)) {
    const Vec3f place = toVec3f(curve->at(curve->knots.basis(step)).place);
    if (!isFinite(place)) {
      faults.note("the curve is not finite; nothing is drawn");
      return {};
    }
    if (!mesh.ownPoints.empty() && mesh.ownPoints.back() == place) continue;
    const uint32_t vertex = uint32_t(mesh.ownPoints.size());
    mesh.ownPoints.push_back(place);
    if (vertex > 0) mesh.ownIndices.insert(mesh.ownIndices.end(), {vertex - 1, vertex});
  }
  if (mesh.ownIndices.empty()) return {};
  mesh.kind = Mesh::Kind::lines;
  mesh.solid = false;
  mesh.viewOwn();
  return mesh;
}

} // namespace xvrml
