// openrt_analytic.cpp: makes a quadric or an asphere from any numbers, as a recording, a message
// of the cluster or a program brings them. Numbers that are accepted must give finite bounds, and
// finite crossings in their order, points, areas and tangents. The input is the kind, the numbers,
// then rays. libFuzzer calls this on one thread.
#include <cmath>

#include "fuzz_input.h"
#include "scene/analytic.h"

namespace {

using namespace openrt;

void demand(bool condition) {
  if (!condition) __builtin_trap();
}

// Returns a number of a surface: a usual one, an odd one, or any.
double numberOf(FuzzInput& in) {
  const uint8_t b = in.byte();
  if (b < 200) return (int(b % 41) - 20) * 0.1;
  return b < 225 ? std::pow(10.0, b - 212) : in.real();
}

// Returns a coordinate of a ray, which Embree gets as a float.
double coordinateOf(FuzzInput& in) {
  const auto v = float(numberOf(in));
  return std::isfinite(v) ? double(v) : 0;
}
Vec3d vectorOf(FuzzInput& in) {
  const double x = coordinateOf(in), y = coordinateOf(in);
  return {x, y, coordinateOf(in)};
}

void checkPoint(const AnalyticSurface& surface, const Vec3d& p) {
  Vec3d gradient;
  demand(std::isfinite(surface.valueAt(p, gradient)) && isFinite(gradient));
  const auto texCoord = surface.texCoordAt(p);
  demand(std::isfinite(texCoord[0]) && std::isfinite(texCoord[1]));
  const AnalyticSurface::Tangents tangents = surface.tangentsAt(p);
  demand(isFinite(tangents.alongS) && isFinite(tangents.alongT));
  if (!surface.samplable()) return;
  const double area = surface.areaAt(p);
  demand(std::isfinite(area) && area >= 0);
}

void checkRay(const AnalyticSurface& surface, const Vec3d& origin, const Vec3d& direction) {
  const AnalyticSurface::Crossings found = surface.intersect(origin, direction);
  demand(found.count >= 0 && found.count <= AnalyticSurface::Crossings::most);
  for (int i = 0; i < found.count; i++) {
    const double t = found.t[size_t(i)];
    demand(std::isfinite(t) && (i == 0 || t >= found.t[size_t(i) - 1]));
    const Vec3d p = surface.settle(origin + direction * t, direction);
    demand(isFinite(p));
    checkPoint(surface, p);
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  FuzzInput in(std::as_bytes(std::span(data, size)));
  const auto kind = in.flip() ? edit::Primitive::Quadric : edit::Primitive::Asphere;
  std::vector<double> numbers(kind == edit::Primitive::Quadric ? 16 : 4 + in.below(10));
  for (double& number : numbers) number = numberOf(in);
  const auto surface = AnalyticSurface::make(kind, numbers);
  if (!surface) return 0;
  const Vec3d low = surface->low(), high = surface->high();
  demand(isFinite(low) && isFinite(high) && low.x <= high.x && low.y <= high.y && low.z <= high.z);
  for (const double u : {0.0, 0.3, 1.0}) {
    if (!surface->samplable()) break;
    const Vec3d p = surface->pointAt(u, 0.2);
    demand(isFinite(p));
    checkPoint(*surface, p);
  }
  const Vec3d middle = (low + high) * 0.5;
  checkRay(*surface, middle + Vec3d{0, 0, high.z - low.z}, {0, 0, -1});
  for (int i = 0; i < 8 && !in.empty(); i++) {
    const Vec3d origin = vectorOf(in), direction = vectorOf(in);
    checkRay(*surface, origin, direction);
    checkRay(*surface, origin, middle - origin);
  }
  return 0;
}
