// round.cpp: builds the discs and the vertices of Cone and Cylinder (clauses 6.11, 6.14).
#include "geometry/round.h"

#include <numbers>

#include "geometry/vector_math.h"

namespace xvrml {

Vec2f aroundAxis(double s) {
  // Whole quarters are exact, so that seams and opposite vertices match bit for bit.
  double quarter = std::floor(s * 4), rest = (s * 4 - quarter) * std::numbers::pi / 2;
  double sine = std::sin(rest), cosine = std::cos(rest);
  switch (int(quarter) & 3) {
  case 0: return {float(-sine), float(-cosine)};
  case 1: return {float(-cosine), float(sine)};
  case 2: return {float(sine), float(cosine)};
  default: return {float(cosine), float(-sine)};
  }
}

void addVertex(Mesh& mesh, const Vec3f& point, const Vec3f& normal, const Vec2f& texCoord) {
  mesh.ownPoints.push_back(point);
  mesh.ownNormals.push_back(normal);
  mesh.ownTexCoords.push_back(texCoord);
}

void addTriangle(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c) {
  const auto& p = mesh.ownPoints;
  if (hasArea(p[a], p[b], p[c])) mesh.ownIndices.insert(mesh.ownIndices.end(), {a, b, c});
}

void addDisc(Mesh& mesh, float y, float radius, bool up) {
  // The texture is upright when the top, or the bottom, is tilted towards +z: t runs to -z on the
  // top and to +z on the bottom.
  const Vec3f normal{0, up ? 1.f : -1.f, 0};
  const uint32_t center = uint32_t(mesh.ownPoints.size());
  addVertex(mesh, {0, y, 0}, normal, {0.5f, 0.5f});
  for (int i = 0; i < roundSegments; i++) {
    Vec2f at = aroundAxis(double(i) / roundSegments);
    addVertex(mesh, {at.x * radius, y, at.y * radius}, normal,
              {0.5f + at.x / 2, 0.5f + (up ? -at.y : at.y) / 2});
  }
  for (uint32_t i = 0; i < roundSegments; i++) {
    uint32_t a = center + 1 + i, b = center + 1 + (i + 1) % roundSegments;
    addTriangle(mesh, center, up ? a : b, up ? b : a);
  }
}

// The side is where x^2 + z^2 = (at0 + slope y)^2. Its box cuts it only along the axis.
bool hasExactSize(double radius, double height) {
  constexpr double least = 1e-11, most = 9e11; // a margin to the limits of rtQuadric
  return radius >= least && radius <= most && height >= least && height <= most;
}

void addExactSide(Mesh& mesh, double lowRadius, double highRadius, double low, double high) {
  const double slope = (highRadius - lowRadius) / (high - low), at0 = lowRadius - slope * low;
  const double r = 1.001 * std::max(lowRadius, highRadius);
  mesh.exact.push_back({ExactSurface::Kind::quadric,
                        {1, -slope * slope, 1, 0, 0, 0, 0, -2 * at0 * slope, 0, -at0 * at0, -r, low,
                         -r, r, high, r}});
}

void addExactDisc(Mesh& mesh, double y, double radius, bool up) {
  mesh.exact.push_back({ExactSurface::Kind::asphere,
                        {0, 0, 0, radius},
                        up ? ExactSurface::Facing::up : ExactSurface::Facing::down,
                        y});
}

Mesh finishRound(Mesh&& mesh) {
  if (mesh.ownIndices.empty()) return {};
  mesh.kind = Mesh::Kind::triangles;
  mesh.viewOwn();
  return std::move(mesh);
}

} // namespace xvrml
