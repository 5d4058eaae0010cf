#include "render/path/first_hits.h"

#include <algorithm>
#include <cmath>

#include "render/film/error.h"
#include "render/motion.h"
#include "render/surface/sanitize_output.h"
#include "render/surface/surface_shader.h"
#include "scene/channels.h"
#include "scene/quality.h"
#include "scene/transports.h"
#include "shading/running.h"

namespace openrt {
namespace {

float mean(const Vec3f& v) { return (v.x + v.y + v.z) / 3; }

// Returns the matrix of the reflection at a plane.
Matrix4d reflectionAt(const Vec3d& point, const Vec3d& normal) {
  Matrix4d m;
  for (size_t column = 0; column < 3; column++)
    for (size_t row = 0; row < 3; row++) m.m[4 * column + row] -= 2 * normal[row] * normal[column];
  m.translate(normal * (2 * dot(normal, point)));
  return m;
}

} // namespace

// Returns whether the hits of a class are described by lobes: as where the light of a frame is
// computed (PathTracer::shadeByLobes and shadeByShade), and in frames without light wherever that
// is possible, because `shade` would ask for light.
static bool usesLobes(const RtsClass& shaderClass, const edit::FrameSettingsT& frame) {
  const bool byLobes = traitsOf(frame.transport).shading == Shading::byLobes;
  return shaderClass.surface && (!shaderClass.shade || byLobes || showsNoLight(frame));
}

FirstHits::FirstHits(const RenderScene& scene, Arena& arena, RayCounters& counters)
    : scene_(scene), arena_(arena), counters_(counters), follows_(scene.frame.followImages) {}

void FirstHits::begin(const Rays& camera) {
  for (int k = 0; k < 3; k++) {
    origin_[k] = camera.org[k];
    direction_[k] = camera.dir[k];
  }
  paths_ = camera.count;
  surface_ = 0;
  next_.clear();
  if (follows_ && images_.size() < paths_) images_.resize(paths_);
}

void FirstHits::describe(const StageContext& context, Wave& wave, PixelSamples& found) {
  intersectWave(context, WaveSource::camera, wave);
  visit(context, wave, found);
}

void FirstHits::describeBehindMedia(const StageContext& context, const Wave& wave,
                                    PixelSamples& found) {
  const uint32_t n = wave.rays.count;
  if (has(firstHitChannels)) {
    Wave seen;
    seen.rays = wave.rays;
    seen.states.allocate(arena_, n);
    for (uint32_t i = 0; i < n; i++) seen.states.set(i, wave.states[i]);
    describe(context, seen, found);
  }
  std::fill_n(found.first, n, uint8_t(0));
}

void FirstHits::finish(PixelSamples& found) {
  for (surface_ = 1; !next_.empty(); surface_++) {
    std::swap(queue_, next_);
    next_.clear();
    const uint32_t n = uint32_t(queue_.size()); // at most one for each path
    counters_.secondary += n;
    ArenaScope scope(arena_);
    Wave wave;
    wave.rays.allocate(arena_, n);
    loadWave(queue_, 0, n, wave);
    intersectWave(context_, WaveSource::surfaces, wave);
    visit(context_, wave, found);
  }
}

// Returns whether what the path hits is described, whatever it is.
bool FirstHits::isLast(PathFlags path) const {
  return surface_ >= mostSurfaces + std::min(path.passages(), mostPassages);
}

void FirstHits::visit(const StageContext& context, Wave& wave, PixelSamples& found) {
  ArenaScope scope(arena_);
  for (const uint32_t lane : wave.missed) // the sky in a mirror has the tint of the mirror
    if (has(RT_ALBEDO) && wave.states.flagsOf(lane).deflected())
      openrt::store(load(wave.states.throughput, lane), found.of(RT_ALBEDO),
                    wave.states.path[lane]);
  forEachBucket(context, wave, [&](const Points& points, const Bucket& bucket) {
    describeBucket(context, points, bucket, wave.states, found);
  });
}

void FirstHits::describeBucket(const StageContext& context, const Points& points,
                               const Bucket& bucket, const PathStates& states,
                               PixelSamples& found) {
  const RtsClass& shaderClass = *bucket.shaderClass;
  const uint32_t n = points.hits.count;
  const auto isLastAt = [&](uint32_t i) { return isLast(states.flagsOf(points.order[i])); };
  bool asks = has(RT_ALBEDO);
  for (uint32_t i = 0; i < n && follows_ && !asks; i++) asks = !isLastAt(i);
  RtsBatch batch(context, points, states);
  batch.lights.set = bucket.lightSet;
  batch.describes = true;
  float* albedo[3] = {};
  if (usesLobes(shaderClass, scene_.frame)) {
    if (asks) {
      const RtsSurface surface = runSurfaceShader(batch, shaderClass, has(RT_ALBEDO));
      sanitizeOutput(shaderClass, batch, surface);
      std::copy_n(surface.albedo, 3, albedo);
    }
    const Boundaries boundaries = crossBoundaries(batch, shaderClass);
    const ImageLead* leads = follows_ ? findImageLeads(batch, boundaries) : nullptr;
    for (uint32_t i = 0; i < n; i++) {
      const bool last = isLastAt(i);
      if (!last && !boundaries.visibleAt(i))
        queue(batch, i, {.direction = load(points.hits.direction, i), .straight = true},
              boundaries.crossing[i].behind, Step::pass);
      else if (last || !leads || !takeSurface(batch, boundaries, i, leads[i]))
        store(batch, i, albedo, found);
    }
    return;
  }
  RtsShading shaded{};
  if (asks) {
    for (int k = 0; k < 3; k++) {
      shaded.radiance[k] = arena_.takeZero<float>(padded(n));
      shaded.transmission[k] = arena_.takeZero<float>(padded(n));
      if (has(RT_ALBEDO)) shaded.albedo[k] = arena_.takeZero<float>(padded(n));
    }
    const RunningShader running(shaderClass);
    shaderClass.shade(&scene_.host, &batch, &points.hits, &shaded);
    sanitizeOutput(shaderClass, batch, shaded);
  }
  for (uint32_t i = 0; i < n; i++)
    if (isLastAt(i) || !follows_ || !takeShading(batch, i, load(shaded.transmission, i)))
      store(batch, i, shaded.albedo, found);
}

bool FirstHits::takeSurface(const RtsBatch& batch, const Boundaries& boundaries, uint32_t i,
                            const ImageLead& lead) {
  if (!lead.found) return false;
  const MediaStack& media = (*batch.states).media[batch.order[i]];
  queue(batch, i, lead, mediaTowards(*batch.points, i, lead.direction, boundaries, media),
        Step::image);
  return true;
}

bool FirstHits::takeShading(const RtsBatch& batch, uint32_t i, const Vec3f& transmission) {
  constexpr Vec3f one{1, 1, 1};
  const Vec3f tint = min(max(Vec3f(), transmission), one); // NaN: opaque
  if (!follows_ || !(mean(tint) >= ImageLead::leastTransmission)) return false;
  queue(batch, i,
        {.direction = load(batch.points->hits.direction, i), .tint = tint, .straight = true},
        (*batch.states).media[batch.order[i]], Step::image);
  return true;
}

// Queues the first-hit ray that leaves hit i.
void FirstHits::queue(const RtsBatch& batch, uint32_t i, const ImageLead& lead,
                      const MediaStack& media, Step step) {
  const RayState from = (*batch.states)[batch.order[i]];
  RayState to{.throughput = from.throughput * lead.tint,
              .travelled = batch.points->hits.distance[i],
              .path = from.path,
              .media = media,
              .flags = from.flags};
  if (surface_ == 0) to.flags.setPassages(0);
  if (lead.straight) to.flags.addPassage();
  if (step == Step::image) {
    MirrorSpace& image = images_[from.path];
    if (!from.flags.deflected()) image = MirrorSpace();
    if (lead.reflected) reflect(batch, i, lead.direction, image);
    to.flags.set(PathFlags::deflectedBit, true);
  }
  queueRay(*batch.points, i, lead.direction, to, next_);
}

// Adds the mirror at hit i, which sends the ray to `out`, to those that an image is seen in.
void FirstHits::reflect(const RtsBatch& batch, uint32_t i, const Vec3f& out,
                        MirrorSpace& image) const {
  const Points& points = *batch.points;
  Plane now{Vec3d(load(points.hits.position, i)),
            normalize(Vec3d(out) - Vec3d(load(points.hits.direction, i)))};
  Plane before = now;
  if (has(RT_MOTION)) {
    image.mirrorNew |= !findMirrorPlanes(scene_, *points.rayHits, points.order[i], now, before);
    image.mirrorMoved |= before != now;
  }
  image.now = image.now * reflectionAt(now.point, now.normal);
  image.before = image.before * reflectionAt(before.point, before.normal);
}

// Records what is seen at hit i as the first surface of its path.
void FirstHits::store(const RtsBatch& batch, uint32_t i, float* const albedo[3],
                      PixelSamples& found) const {
  const RayState ray = (*batch.states)[batch.order[i]];
  FirstHit hit{scene_, *batch.points, i, albedo};
  if (!ray.flags.deflected()) return storeFirstHit(hit, ray.path, found);
  const SeenImage image{images_[ray.path], ray.throughput, Vec3d(load(origin_, ray.path)),
                        Vec3d(load(direction_, ray.path))};
  hit.image = &image;
  storeFirstHit(hit, ray.path, found);
}

} // namespace openrt
