// surface_queries.h: what a backend that has surfaces answers beside Backend's own queries
// (openrt/queries.h). A backend that is none of these meets nothing. Called on the application's
// thread, after the first commit.
#pragma once

#include <span>

#include "openrt/queries.h"

namespace openrt {

class SurfaceQueries {
 public:
  virtual ~SurfaceQueries() = default;
  virtual void countHits(std::span<const RTray> rays, std::span<uint32_t> counts) = 0;
  // first: one number more than rays, checked.
  virtual void listHits(std::span<const RTray> rays, std::span<const size_t> first,
                        std::span<RThit> hits) = 0;
  virtual void closestPoints(std::span<const float> points, float radius,
                             std::span<RTclosest> closest) = 0;
};

// For backends that pass everything on to another: that one's, if it has some.
class ForwardedQueries : public SurfaceQueries {
 public:
  void countHits(std::span<const RTray> rays, std::span<uint32_t> counts) override;
  void listHits(std::span<const RTray> rays, std::span<const size_t> first,
                std::span<RThit> hits) override;
  void closestPoints(std::span<const float> points, float radius,
                     std::span<RTclosest> closest) override;

 protected:
  virtual SurfaceQueries* target() const = 0; // null: nothing is met
};

} // namespace openrt
