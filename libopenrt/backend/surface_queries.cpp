// surface_queries.cpp: forwards surface queries, or reports that nothing is hit. Called on the
// application's thread.
#include "backend/surface_queries.h"

#include <algorithm>
#include <limits>

namespace openrt {

void ForwardedQueries::countHits(std::span<const RTray> rays, std::span<uint32_t> counts) {
  if (SurfaceQueries* to = target()) return to->countHits(rays, counts);
  std::fill(counts.begin(), counts.end(), 0u);
}

void ForwardedQueries::listHits(std::span<const RTray> rays, std::span<const size_t> first,
                                std::span<RThit> hits) {
  if (SurfaceQueries* to = target()) return to->listHits(rays, first, hits);
  RThit nothing{};
  nothing.t = std::numeric_limits<float>::infinity();
  std::fill(hits.begin(), hits.end(), nothing);
}

void ForwardedQueries::closestPoints(std::span<const float> points, float radius,
                                     std::span<RTclosest> closest) {
  if (SurfaceQueries* to = target()) return to->closestPoints(points, radius, closest);
  RTclosest nothing{};
  nothing.distance = std::numeric_limits<float>::infinity();
  std::fill(closest.begin(), closest.end(), nothing);
}

namespace {

void missAll(std::span<RThitd> hits) {
  RThitd nothing{};
  nothing.t = std::numeric_limits<double>::infinity();
  std::fill(hits.begin(), hits.end(), nothing);
}

} // namespace

void ForwardedQueries::castPrecise(std::span<const RTrayd> rays, std::span<RThitd> hits) {
  if (SurfaceQueries* to = target()) return to->castPrecise(rays, hits);
  missAll(hits);
}

void ForwardedQueries::occludePrecise(std::span<const RTrayd> rays, std::span<uint8_t> occluded) {
  if (SurfaceQueries* to = target()) return to->occludePrecise(rays, occluded);
  std::fill(occluded.begin(), occluded.end(), uint8_t(0));
}

void ForwardedQueries::countPrecise(std::span<const RTrayd> rays, std::span<uint32_t> counts) {
  if (SurfaceQueries* to = target()) return to->countPrecise(rays, counts);
  std::fill(counts.begin(), counts.end(), 0u);
}

void ForwardedQueries::listPrecise(std::span<const RTrayd> rays, std::span<const size_t> first,
                                   std::span<RThitd> hits) {
  if (SurfaceQueries* to = target()) return to->listPrecise(rays, first, hits);
  missAll(hits);
}

void ForwardedQueries::closestPrecise(std::span<const double> points, double radius,
                                      std::span<RThitd> closest) {
  if (SurfaceQueries* to = target()) return to->closestPrecise(points, radius, closest);
  missAll(closest);
}

} // namespace openrt
