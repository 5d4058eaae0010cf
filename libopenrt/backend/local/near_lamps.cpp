// near_lamps.cpp: traces probe rays from emitting shapes to find surfaces that are too near. Called
// between frames.
#include "backend/local/near_lamps.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <vector>

#include "render/lights/emitters.h"
#include "render/rays.h"

namespace openrt {
namespace {

constexpr uint32_t most = 1024; // maximum number of shapes that are tested
// Required distance in multiples of the ray offset. At this distance the light of a small lamp has
// an error of about 1.5 %.
constexpr double wanted = 128;

// A ray from the centre of a shape in a direction of its light. `skip` is the distance from the
// centre to the shape's own surface.
struct Probe {
  Vec3d origin, direction;
  double skip;
  uint32_t record;
};

void addTriangle(const EmissiveShapes::Shape& shape, std::vector<Probe>& out) {
  const Vec3d a(shape.corner[0]), b(shape.corner[1]), c(shape.corner[2]);
  const Vec3d n = cross(b - a, c - a), middle = (a + b + c) * (1 / 3.0);
  const double l = length(n);
  if (!(l > 0)) return;
  for (const int side : {1, 2}) {
    const double s = (side == 1 ? 1 : -1) / l;
    if (shape.sides & side) out.push_back({middle, n * s, 0, shape.record});
  }
}

void addSphere(const EmissiveShapes::Shape& shape, const Record& r, std::vector<Probe>& out) {
  for (int axis = 0; axis < 3; axis++)
    for (const double sign : {-1.0, 1.0}) {
      const Vec3d radius = sign * Vec3d(r.frames->toRender.column(axis));
      const double l = length(radius);
      if (l > 0)
        out.push_back({Vec3d(r.frames->toRender.translation()), radius / l, l, shape.record});
    }
}

// Returns the offset of rays spawned at a hit, about as computed by render/wave/points.cpp. Sets
// `unit` to the spacing of floats there.
double stepOff(const Record& r, uint32_t primitive, const Probe& p, double t, double& unit) {
  Vec3d reach = abs(p.origin + t * p.direction);
  if (r.primitive == edit::Primitive::Triangles)
    for (const Vec3f& corner : r.cornersOf(primitive)) reach = max(reach, abs(Vec3d(corner)));
  const double along = dot(reach, abs(p.direction));
  unit = 0x1p-23 * along;
  return 7 * 0x1p-24 * std::max(along, 0x1p-6 * largest(reach));
}

} // namespace

std::string warnOfNearLamps(const RenderScene& scene) {
  const EmissiveShapes* shapes = scene.emitters->shapes();
  if (!shapes || shapes->size() == 0) return {};
  std::vector<Probe> probes;
  const auto count = uint32_t(shapes->size()), stride = std::max(1u, count / most);
  for (uint32_t i = 0; i < count; i += stride) {
    const EmissiveShapes::Shape& shape = (*shapes)[i];
    if (!(shape.power > 0) || shape.surface) continue;
    if (shape.sphere)
      addSphere(shape, scene.records[shape.record], probes);
    else
      addTriangle(shape, probes);
  }
  Arena arena;
  Rays rays;
  RayHits hits;
  rays.allocate(arena, uint32_t(probes.size()));
  hits.allocate(arena, uint32_t(probes.size()));
  auto* own = arena.take<uint32_t>(padded(uint32_t(probes.size())));
  for (uint32_t i = 0; i < probes.size(); i++) {
    store(Vec3f(probes[i].origin), rays.org, i);
    store(Vec3f(probes[i].direction), rays.dir, i);
    rays.tnear[i] = 0;
    rays.tfar[i] = std::numeric_limits<float>::infinity();
    own[i] = probes[i].record;
  }
  scene.kernel->intersectOthers(rays, own, hits);
  double worst = 1, gap = 0, step = 0;
  for (uint32_t i = 0; i < probes.size(); i++) {
    if (hits.record[i] == noHit) continue;
    const Record& r = scene.records[hits.record[i]];
    if (r.primitive != edit::Primitive::Triangles && r.primitive != edit::Primitive::Sphere)
      continue;
    double unit = 0;
    const double off = stepOff(r, hits.primitive[i], probes[i], double(hits.t[i]), unit),
                 distance = double(hits.t[i]) - probes[i].skip;
    if (!(distance > unit) || !(distance < worst * wanted * off)) continue;
    worst = distance / (wanted * off);
    gap = distance;
    step = off;
  }
  if (!(gap > 0)) return {};
  char text[320];
  std::snprintf(text, sizeof text,
                "a lamp is %.3g away from the surface that it lights, but rays start %.2g above "
                "that surface, so its light from the lamp is wrong. Keep lamps of this world %.2g "
                "away, or make the surface smaller (docs/accuracy.md)",
                gap, step, wanted * step);
  return text;
}

std::string warnOfAnalyticLamps(const RenderScene& scene) {
  for (const Record& r : scene.records)
    if (r.surface && !r.surface->samplable() && ((*scene.shaders)[r.shader].traits & RTS_EMISSIVE))
      return "a quadric emits light that is no surface of revolution about an axis of its frame: "
             "the "
             "light is found only by paths that meet it by chance; make lamps of triangles, "
             "spheres, "
             "cylinders, cones or aspheres";
  return {};
}

} // namespace openrt
