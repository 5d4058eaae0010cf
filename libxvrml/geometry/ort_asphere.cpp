// ort_asphere.cpp: builds an ORTAsphere: the exact surface for the ray tracer, and rings of
// triangles for pointing devices and bounds.
#include <algorithm>
#include <cmath>

#include "geometry/builders.h"
#include "geometry/round.h"
#include "geometry/vector_math.h"

namespace xvrml {
namespace {

constexpr int rings = 16;
constexpr size_t mostTerms = 8;

// Writes the sag and its slope at a distance from the axis (rtAsphere, openrt/geometry.h).
void profileAt(const nodes::ORTAsphere& node, double r, double& sag, double& slope) {
  const double c = node.radius == 0 ? 0 : 1 / double(node.radius), u = r * r;
  const double root = std::sqrt(std::max(1 - (1 + double(node.conic)) * c * c * u, 1e-12));
  sag = c * u / (1 + root);
  slope = c * r / root;
  double power = u * r; // r^3
  for (size_t i = 0; i < node.terms.size(); i++, power *= u) {
    sag += double(node.terms[i]) * power * r;
    slope += double(2 * i + 4) * double(node.terms[i]) * power;
  }
}

void addRings(const nodes::ORTAsphere& node, Mesh& mesh) {
  const double inner = node.innerRadius, outer = node.semiAperture;
  for (int ring = 0; ring <= rings; ring++) {
    const double r = inner + (outer - inner) * ring / rings;
    double sag, slope;
    profileAt(node, r, sag, slope);
    for (int i = 0; i <= roundSegments; i++) {
      const Vec2f turn = aroundAxis(i == roundSegments ? 0 : double(i) / roundSegments);
      const double x = double(turn.x), y = double(turn.y);
      const V3d normal = unit(V3d(-slope * x, -slope * y, 1));
      addVertex(mesh, {float(r * x), float(r * y), float(sag)},
                {float(normal.x), float(normal.y), float(normal.z)},
                {float(0.5 + r * x / (2 * outer)), float(0.5 + r * y / (2 * outer))});
    }
  }
  constexpr uint32_t row = roundSegments + 1;
  for (uint32_t ring = 0; ring < uint32_t(rings); ring++)
    for (uint32_t i = 0; i < uint32_t(roundSegments); i++) {
      const uint32_t a = ring * row + i, b = a + 1, c = a + row, d = c + 1;
      // aroundAxis turns clockwise seen from +z: from y = -1 to x = -1.
      addTriangle(mesh, a, d, c);
      addTriangle(mesh, a, b, d);
    }
}

} // namespace

Mesh buildORTAsphere(const nodes::ORTAsphere& node, const MeshOptions&, Faults& faults) {
  Mesh mesh;
  bool finite = std::isfinite(node.conic) && std::isfinite(node.radius);
  for (const float term : node.terms) finite = finite && std::isfinite(term);
  if (!finite || node.terms.size() > mostTerms) {
    faults.note("radius, conic and terms must be finite, and there are at most 8 terms; nothing is "
                "drawn");
    return mesh;
  }
  if (!(node.semiAperture > 0) || !std::isfinite(node.semiAperture) || !(node.innerRadius >= 0) ||
      !(node.innerRadius < node.semiAperture)) {
    faults.note("semiAperture must be positive and above innerRadius, which must not be negative; "
                "nothing is drawn");
    return mesh;
  }
  addRings(node, mesh);
  mesh = finishRound(std::move(mesh));
  mesh.kind = Mesh::Kind::triangles;
  mesh.solid = node.solid;
  mesh.ccw = node.ccw;
  ExactSurface exact{ExactSurface::Kind::asphere,
                     {node.radius == 0 ? 0 : 1 / double(node.radius), double(node.conic),
                      double(node.innerRadius), double(node.semiAperture)}};
  exact.numbers.insert(exact.numbers.end(), node.terms.begin(), node.terms.end());
  mesh.exact.push_back(std::move(exact));
  return mesh;
}

} // namespace xvrml
