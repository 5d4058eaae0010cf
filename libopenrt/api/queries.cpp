// queries.cpp: Implements the API functions rtCountHits, rtListHits, rtClosestPoints, and those in
// double precision. They check the arguments and call the backend. Runs on the application's
// thread.
#include "api/guard.h"
#include "backend/surface_queries.h"

namespace openrt {
namespace {

// Forwards queries to the backend, if it has surfaces and anything was committed.
class CommittedQueries final : public ForwardedQueries {
 public:
  explicit CommittedQueries(Context& c)
      : target_(c.everCommitted() ? dynamic_cast<SurfaceQueries*>(&c.backend()) : nullptr) {}

 private:
  SurfaceQueries* target() const override { return target_; }
  SurfaceQueries* target_;
};

void countHits(Context& c, size_t count, const RTray* rays, uint32_t* counts) {
  require((rays && counts) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  CommittedQueries(c).countHits({rays, count}, {counts, count});
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
  CommittedQueries(c).listHits({rays, count}, {first, count + 1}, {hits, first[count]});
}

void closestPoints(Context& c, size_t count, const float* points, float radius,
                   RTclosest* closest) {
  require((points && closest) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  require(radius > 0, RT_INVALID_VALUE, "the radius is not above 0");
  CommittedQueries(c).closestPoints({points, 3 * count}, radius, {closest, count});
}

void castRaysd(Context& c, size_t count, const RTrayd* rays, RThitd* hits) {
  require((rays && hits) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  CommittedQueries(c).castPrecise({rays, count}, {hits, count});
}

void occludedRaysd(Context& c, size_t count, const RTrayd* rays, uint8_t* occluded) {
  require((rays && occluded) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  CommittedQueries(c).occludePrecise({rays, count}, {occluded, count});
}

void countHitsd(Context& c, size_t count, const RTrayd* rays, uint32_t* counts) {
  require((rays && counts) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  CommittedQueries(c).countPrecise({rays, count}, {counts, count});
}

void listHitsd(Context& c, size_t count, const RTrayd* rays, const size_t* first, RThitd* hits) {
  if (!checkPlaces(count, rays, first, hits)) return;
  CommittedQueries(c).listPrecise({rays, count}, {first, count + 1}, {hits, first[count]});
}

void closestPointsd(Context& c, size_t count, const double* points, double radius,
                    RThitd* closest) {
  require((points && closest) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  require(radius > 0, RT_INVALID_VALUE, "the radius is not above 0");
  CommittedQueries(c).closestPrecise({points, 3 * count}, radius, {closest, count});
}

} // namespace
} // namespace openrt

using namespace openrt;

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
