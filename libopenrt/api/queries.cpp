// queries.cpp: rtCountHits, rtListHits, rtClosestPoints: arguments checked, then the backend's own.
// [app]
#include "api/guard.h"
#include "backend/surface_queries.h"

namespace openrt {
namespace {

// Of the backend, if anything was committed and it has surfaces.
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

void listHits(Context& c, size_t count, const RTray* rays, const size_t* first, RThit* hits) {
  require((rays && first) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  if (count == 0) return;
  for (size_t i = 0; i < count; i++)
    require(first[i] <= first[i + 1], RT_INVALID_VALUE, "the numbers of `first` fall");
  require(hits || first[count] == 0, RT_INVALID_VALUE, "a pointer is NULL");
  CommittedQueries(c).listHits({rays, count}, {first, count + 1}, {hits, first[count]});
}

void closestPoints(Context& c, size_t count, const float* points, float radius,
                   RTclosest* closest) {
  require((points && closest) || count == 0, RT_INVALID_VALUE, "a pointer is NULL");
  require(radius > 0, RT_INVALID_VALUE, "the radius is not above 0");
  CommittedQueries(c).closestPoints({points, 3 * count}, radius, {closest, count});
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
