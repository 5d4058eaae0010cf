// surface_queries.h: the queries of openrt/queries.h, implemented by backends that have surfaces.
// On other backends the queries find no surface. Called on the application's thread, after the
// first commit.
#pragma once

#include <span>

#include "openrt/queries.h"

namespace openrt {

class SurfaceQueries {
 public:
  virtual ~SurfaceQueries() = default;
  virtual void countHits(std::span<const RTray> rays, std::span<uint32_t> counts) = 0;
  // Writes the hits of ray i to hits[first[i]] .. hits[first[i + 1] - 1]. first has one number more
  // than rays and has been checked.
  virtual void listHits(std::span<const RTray> rays, std::span<const size_t> first,
                        std::span<RThit> hits) = 0;
  virtual void closestPoints(std::span<const float> points, float radius,
                             std::span<RTclosest> closest) = 0;
  // In double precision: as castRays() of Backend and so on.
  virtual void castPrecise(std::span<const RTrayd> rays, std::span<RThitd> hits) = 0;
  virtual void occludePrecise(std::span<const RTrayd> rays, std::span<uint8_t> occluded) = 0;
  virtual void countPrecise(std::span<const RTrayd> rays, std::span<uint32_t> counts) = 0;
  virtual void listPrecise(std::span<const RTrayd> rays, std::span<const size_t> first,
                           std::span<RThitd> hits) = 0;
  virtual void closestPrecise(std::span<const double> points, double radius,
                              std::span<RThitd> closest) = 0;
};

// For backends that wrap another backend: forwards the queries to it.
class ForwardedQueries : public SurfaceQueries {
 public:
  void countHits(std::span<const RTray> rays, std::span<uint32_t> counts) override;
  void listHits(std::span<const RTray> rays, std::span<const size_t> first,
                std::span<RThit> hits) override;
  void closestPoints(std::span<const float> points, float radius,
                     std::span<RTclosest> closest) override;
  void castPrecise(std::span<const RTrayd> rays, std::span<RThitd> hits) override;
  void occludePrecise(std::span<const RTrayd> rays, std::span<uint8_t> occluded) override;
  void countPrecise(std::span<const RTrayd> rays, std::span<uint32_t> counts) override;
  void listPrecise(std::span<const RTrayd> rays, std::span<const size_t> first,
                   std::span<RThitd> hits) override;
  void closestPrecise(std::span<const double> points, double radius,
                      std::span<RThitd> closest) override;

 protected:
  virtual SurfaceQueries* target() const = 0; // null: the queries find no surface
};

} // namespace openrt
