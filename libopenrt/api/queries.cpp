// queries.cpp: Implements the API functions of ray queries and rtPick. They check the arguments and
// call the backend. Runs on the application's thread.
#include <algorithm>
#include <cmath>
#include <limits>

#include "api/guard.h"
#include "backend/queries.h"

namespace openrt {
namespace {

// The queries of a scene without surfaces.
class NoSurfaces final : public Queries {
  void castRays(std::span<const RTray>, std::span<RThit> hits) override { missAll(hits); }
  void occludedRays(std::span<const RTray>, std::span<uint8_t> occluded) override {
    std::ranges::fill(occluded, uint8_t(0));
  }
  bool pick(double, double, RThit& hit) override {
    missAll(std::span(&hit, 1));
    return true;
  }
  void countHits(std::span<const RTray>, std::span<uint32_t> counts) override {
    std::ranges::fill(counts, 0u);
  }
  void listHits(std::span<const RTray>, std::span<const size_t>, std::span<RThit> hits) override {
    missAll(hits);
  }
  void closestPoints(std::span<const float>, float, std::span<RTclosest> closest) override {
    RTclosest nothing{};
    nothing.distance = std::numeric_limits<float>::infinity();
    std::ranges::fill(closest, nothing);
  }
  void castDouble(std::span<const RTrayd>, std::span<RThitd> hits) override { missAll(hits); }
  void occludeDouble(std::span<const RTrayd>, std::span<uint8_t> occluded) override {
    std::ranges::fill(occluded, uint8_t(0));
  }
  void countDouble(std::span<const RTrayd>, std::span<uint32_t> counts) override {
    std::ranges::fill(counts, 0u);
  }
  void listDouble(std::span<const RTrayd>, std::span<const size_t>,
                  std::span<RThitd> hits) override {
    missAll(hits);
  }
  void closestDouble(std::span<const double>, double, std::span<RThitd> closest) override {
    missAll(closest);
  }

  template <class Hit> static void missAll(std::span<Hit> hits) {
    Hit nothing{};
    nothing.t = std::numeric_limits<decltype(nothing.t)>::infinity();
    std::ranges::fill(hits, nothing);
  }
};

// Returns the queries of the committed scene.
Queries& queriesOf(Context& c) {
  static NoSurfaces none;
  Queries* const queries = c.everCommitted() ? c.backend().queries() : nullptr;
  return queries ? *queries : none;
}

void castRays(Context& c, size_t count, const RTray* rays, RThit* hits) {
  require((rays && hits) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  queriesOf(c).castRays({rays, count}, {hits, count});
}

void occludedRays(Context& c, size_t count, const RTray* rays, uint8_t* occluded) {
  require((rays && occluded) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  queriesOf(c).occludedRays({rays, count}, {occluded, count});
}

int pick(Context& c, double x, double y, RThit* hit) {
  require(hit != nullptr, RT_INVALID_VALUE, "the pointer is NULL");
  require(std::isfinite(x) && std::isfinite(y) && std::fabs(x) <= 1e9 && std::fabs(y) <= 1e9,
          RT_INVALID_VALUE, "x or y is not finite, or far outside any picture");
  require(c.scene.frame.width > 0, RT_INVALID_OPERATION,
          "no frame buffer: call rtFrameBuffer first");
  require(c.scene.camera.shader != 0, RT_INVALID_OPERATION,
          "no camera: call rtUseCamera, rtPerspective or rtOrtho first");
  RThit found{};
  require(c.everCommitted() && queriesOf(c).pick(x, y, found), RT_INVALID_OPERATION,
          "no frame with a camera was committed yet: call rtRender or rtSwapBuffers first");
  *hit = found;
  return std::isfinite(found.t) ? 1 : 0;
}

void countHits(Context& c, size_t count, const RTray* rays, uint32_t* counts) {
  require((rays && counts) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  queriesOf(c).countHits({rays, count}, {counts, count});
}

// Checks the arguments of rtListHits; returns false if there is nothing to do.
bool checkPlaces(size_t count, const void* rays, const size_t* first, const void* hits) {
  require((rays && first) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  if (count == 0) return false;
  for (size_t i = 0; i < count; i++)
    require(first[i] <= first[i + 1], RT_INVALID_VALUE, "the numbers of `first` fall");
  require(hits || first[count] == 0, RT_INVALID_VALUE, "a pointer is NULL");
  return true;
}

void listHits(Context& c, size_t count, const RTray* rays, const size_t* first, RThit* hits) {
  if (!checkPlaces(count, rays, first, hits)) return;
  queriesOf(c).listHits({rays, count}, {first, count + 1}, {hits, first[count]});
}

void closestPoints(Context& c, size_t count, const float* points, float radius,
                   RTclosest* closest) {
  require((points && closest) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  require(radius > 0, RT_INVALID_VALUE, "the radius is not above 0");
  queriesOf(c).closestPoints({points, 3 * count}, radius, {closest, count});
}

void castRaysd(Context& c, size_t count, const RTrayd* rays, RThitd* hits) {
  require((rays && hits) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  queriesOf(c).castDouble({rays, count}, {hits, count});
}

void occludedRaysd(Context& c, size_t count, const RTrayd* rays, uint8_t* occluded) {
  require((rays && occluded) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  queriesOf(c).occludeDouble({rays, count}, {occluded, count});
}

void countHitsd(Context& c, size_t count, const RTrayd* rays, uint32_t* counts) {
  require((rays && counts) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  queriesOf(c).countDouble({rays, count}, {counts, count});
}

void listHitsd(Context& c, size_t count, const RTrayd* rays, const size_t* first, RThitd* hits) {
  if (!checkPlaces(count, rays, first, hits)) return;
  queriesOf(c).listDouble({rays, count}, {first, count + 1}, {hits, first[count]});
}

void closestPointsd(Context& c, size_t count, const double* points, double radius,
                    RThitd* closest) {
  require((points && closest) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  require(radius > 0, RT_INVALID_VALUE, "the radius is not above 0");
  queriesOf(c).closestDouble({points, 3 * count}, radius, {closest, count});
}

} // namespace
} // namespace openrt

using namespace openrt;

void rtCastRays(size_t count, const RTray* rays, RThit* hits) {
  guarded("rtCastRays", [&](Context& c) { castRays(c, count, rays, hits); });
}

int rtPick(double x, double y, RThit* hit) {
  return guarded("rtPick", 0, [&](Context& c) { return pick(c, x, y, hit); });
}

void rtOccludedRays(size_t count, const RTray* rays, uint8_t* occluded) {
  guarded("rtOccludedRays", [&](Context& c) { occludedRays(c, count, rays, occluded); });
}

void rtCountHits(size_t count, const RTray* rays, uint32_t* counts) {
  guarded("rtCountHits", [&](Context& c) { countHits(c, count, rays, counts); });
}

void rtListHits(size_t count, const RTray* rays, const size_t* first, RThit* hits) {
  guarded("rtListHits", [&](Context& c) { listHits(c, count, rays, first, hits); });
}

void rtClosestPoints(size_t count, const float* points, float radius, RTclosest* closest) {
  guarded("rtClosestPoints", [&](Context& c) { closestPoints(c, count, points, radius, closest); });
}

void rtCastRaysd(size_t count, const RTrayd* rays, RThitd* hits) {
  guarded("rtCastRaysd", [&](Context& c) { castRaysd(c, count, rays, hits); });
}

void rtOccludedRaysd(size_t count, const RTrayd* rays, uint8_t* occluded) {
  guarded("rtOccludedRaysd", [&](Context& c) { occludedRaysd(c, count, rays, occluded); });
}

void rtCountHitsd(size_t count, const RTrayd* rays, uint32_t* counts) {
  guarded("rtCountHitsd", [&](Context& c) { countHitsd(c, count, rays, counts); });
}

void rtListHitsd(size_t count, const RTrayd* rays, const size_t* first, RThitd* hits) {
  guarded("rtListHitsd", [&](Context& c) { listHitsd(c, count, rays, first, hits); });
}

void rtClosestPointsd(size_t count, const double* points, double radius, RThitd* closest) {
  guarded("rtClosestPointsd",
          [&](Context& c) { closestPointsd(c, count, points, radius, closest); });
}
