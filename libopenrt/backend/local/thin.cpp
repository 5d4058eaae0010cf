// thin.cpp: converts lines and points to spheres and round curves. Called by AccelBuilder, on the
// application thread.
#include "backend/local/thin.h"

#include <cmath>

#include "backend/local/accel/bake.h"

namespace openrt {

void addThin(Part& part, const Geometry& g, const Matrix4d& toKernel, uint32_t record,
             const PixelFootprint& footprint, float scale) {
  if (!consistent(g) || !toKernel.usable()) return;
  const std::vector<float> points = bakePoints(g, toKernel);
  const uint32_t* index = g.indices->as<uint32_t>();
  const bool lines = g.primitive == edit::Primitive::Lines;
  const auto put = [&](uint32_t i) {
    const Vec3f p = vectorOf(points.data() + 3 * size_t(i));
    const float depth = dot(p / scale - footprint.eye, footprint.axis);
    const float radius =
        0.5f * g.width * (footprint.constant + footprint.slope * std::fabs(depth)) * scale;
    part.vertices.insert(part.vertices.end(), {p.x, p.y, p.z, radius});
  };
  for (size_t i = 0; i < g.primitives(); i++) {
    if (lines) part.indices.push_back(uint32_t(part.vertices.size() / 4));
    put(index[lines ? 2 * i : i]);
    if (lines) put(index[2 * i + 1]);
  }
  part.primitives.add(record, 0, uint32_t(g.primitives()));
}

} // namespace openrt
