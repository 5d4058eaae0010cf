// first_hit.cpp: the source of every channel that tells about the first hit: a function, and a line
// of storeFirstHit().
#include "render/wave/first_hit.h"

#include <limits>

#include "render/motion.h"

namespace openrt {
namespace {

Vec3f pointOf(const FirstHit& hit) { return load(hit.points.hits.position, hit.i); }

// Returns the place of an image, in render space.
Vec3d placeOfImage(const FirstHit& hit) {
  const SeenImage& image = *hit.image;
  return image.origin + image.direction * double(hit.points.hits.distance[hit.i]);
}

uint32_t nameOf(const FirstHit& hit) { return hit.scene.records[hit.points.record[hit.i]].name; }

Vec3f normalOf(const FirstHit& hit) {
  const Vec3f normal = load(hit.points.hits.normal, hit.i);
  return hit.image ? Vec3f(hit.image->space.now.direction(Vec3d(normal))) : normal;
}

Vec3f albedoOf(const FirstHit& hit) {
  const Vec3f albedo = load(hit.albedo, hit.i);
  return hit.image ? albedo * hit.image->tint : albedo;
}

Vec3f positionOf(const FirstHit& hit) {
  return Vec3f((hit.image ? placeOfImage(hit) : Vec3d(pointOf(hit))) + vectorOf(hit.scene.origin));
}

float depthOf(const FirstHit& hit) {
  const RenderScene& scene = hit.scene;
  const bool alongRay = scene.frame.depthAlong == RT_DEPTH_ALONG_RAY;
  if (!hit.image)
    return dot(pointOf(hit) - scene.eye,
               alongRay ? load(hit.points.hits.direction, hit.i) : scene.depthAxis);
  return float(dot(placeOfImage(hit) - Vec3d(scene.eye),
                   alongRay ? hit.image->direction : Vec3d(scene.depthAxis)));
}

Vec3f motionOf(const FirstHit& hit) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const Vec3d motion =
      openrt::motionOf(hit.scene, *hit.points.rayHits, hit.points.order[hit.i], pointOf(hit));
  if (!hit.image) return Vec3f(motion);
  const MirrorSpace& space = hit.image->space;
  const Vec3d at(pointOf(hit));
  if (space.mirrorNew) return Vec3f(Vec3d(nan, nan, nan));
  if (!space.mirrorMoved) return Vec3f(space.now.direction(motion));
  return Vec3f(space.now.point(at) - space.before.point(at - motion));
}

} // namespace

void storeFirstHit(const FirstHit& hit, uint32_t path, PixelSamples& found) {
  if (found.names) found.names[path] = nameOf(hit);
  if (float* const* to = found.of(RT_NAME); to[0]) to[0][path] = float(nameOf(hit));
  if (float* const* to = found.of(RT_DEPTH); to[0]) to[0][path] = depthOf(hit);
  const auto put = [&](uint32_t channel, Vec3f (*value)(const FirstHit& hit)) {
    if (float* const* to = found.of(channel); to[0]) store(value(hit), to, path);
  };
  put(RT_NORMAL, normalOf);
  put(RT_ALBEDO, albedoOf);
  put(RT_POSITION, positionOf);
  put(RT_MOTION, motionOf);
}

} // namespace openrt
