// queries.h: the queries of openrt/query.h, implemented by backends that have surfaces
// (Backend::queries). Called on the application's thread, after the first commit.
#pragma once

#include <span>

#include "openrt/openrt.h"

namespace openrt {

class Queries {
 public:
  virtual ~Queries() = default;
  virtual void castRays(std::span<const RTray> rays, std::span<RThit> hits) = 0;
  virtual void occludedRays(std::span<const RTray> rays, std::span<uint8_t> occluded) = 0;
  // Writes the hit of the committed camera's ray through the picture at (x, y) (pixels), in the
  // form of castRays. Returns false if no camera or no frame is committed.
  virtual bool pick(double x, double y, RThit& hit) = 0;
  virtual void countHits(std::span<const RTray> rays, std::span<uint32_t> counts) = 0;
  // Writes the hits of ray i to hits[first[i]] .. hits[first[i + 1] - 1]. first has one number more
  // than rays and has been checked.
  virtual void listHits(std::span<const RTray> rays, std::span<const size_t> first,
                        std::span<RThit> hits) = 0;
  virtual void closestPoints(std::span<const float> points, float radius,
                             std::span<RTclosest> closest) = 0;
  // The same in double precision.
  virtual void castDouble(std::span<const RTrayd> rays, std::span<RThitd> hits) = 0;
  virtual void occludeDouble(std::span<const RTrayd> rays, std::span<uint8_t> occluded) = 0;
  virtual void countDouble(std::span<const RTrayd> rays, std::span<uint32_t> counts) = 0;
  virtual void listDouble(std::span<const RTrayd> rays, std::span<const size_t> first,
                          std::span<RThitd> hits) = 0;
  virtual void closestDouble(std::span<const double> points, double radius,
                             std::span<RThitd> closest) = 0;
};

} // namespace openrt
