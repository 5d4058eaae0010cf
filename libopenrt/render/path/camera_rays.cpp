#include "render/path/camera_rays.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/path/camera_rays.cpp"
#include <hwy/foreach_target.h>

#include "render/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {

// Maps rays from the camera's local space to render space, with directions of length 1. The padding
// of the arrays holds rays, too.
void mapRays(const Affine& map, const RtsRays& local, const Rays& rays) {
  const Rows<Lanes> linear{vectorOf(map.r[0]), vectorOf(map.r[1]), vectorOf(map.r[2])};
  const LaneVec translation{lanesOf(map.r[0][3]), lanesOf(map.r[1][3]), lanesOf(map.r[2][3])};
  for (uint32_t i = 0; i < padded(rays.count); i += width()) {
    const LaneVec direction = linear * load(local.direction, i);
    store(linear * load(local.origin, i) + translation, rays.org, i);
    store(direction * (lanesOf(1) / sqrt(dot(direction, direction))), rays.dir, i);
  }
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>
#include <limits>

#include "shading/running.h"

namespace openrt {
HWY_EXPORT(mapRays);

void startSamples(const FilmSamples& film, PathSamples& samples) {
  for (uint32_t s = 0; s < film.perPixel; s++) {
    const uint32_t seed = film.replicates.seedOf(film.first + s),
                   point = film.replicates.indexOf(film.first + s);
    uint32_t path = s;
    for (uint32_t pixel : film.pixels) {
      samples.set(path, pixel, seed, point);
      path += film.perPixel;
    }
  }
}

namespace {

// Draws the places of first samples in their pixels, where the seed counts the points of one
// sequence.
void drawInTurn(const FilmSamples& film, Arena& arena, float* const xy[2]) {
  constexpr uint32_t sequence = 0x706c6163;
  const auto n = uint32_t(film.pixels.size());
  PathSamples places;
  places.allocate(arena, n);
  for (uint32_t i = 0; i < n; i++) places.set(i, film.pixels[i], sequence, film.replicates.seed);
  float* drawn[2];
  randomNumbersAtStart(places, n, arena).drawPair(0, arena, drawn);
  for (int k = 0; k < 2; k++)
    for (uint32_t i = 0; i < n; i++) xy[k][i * film.perPixel] = drawn[k][i];
}

} // namespace

void sampleFilm(const FilmSamples& film, const PathSamples& samples, Arena& arena, float* xy[2]) {
  const uint32_t n = film.count();
  if (film.centred)
    for (int k = 0; k < 2; k++) std::fill_n(xy[k] = arena.take<float>(padded(n)), n, 0.5f);
  else
    randomNumbersAtStart(samples, n, arena).drawPair(0, arena, xy);
  if (!film.centred && film.inTurn && film.first == 0) drawInTurn(film, arena, xy);
  uint32_t path = 0;
  for (uint32_t pixel : film.pixels) {
    const auto x = float(pixel % film.width), y = float(pixel / film.width);
    for (uint32_t s = 0; s < film.perPixel; s++, path++) {
      xy[0][path] += x;
      xy[1][path] += y;
    }
  }
  for (int k = 0; k < 2; k++) std::fill(xy[k] + n, xy[k] + padded(n), xy[k][n - 1]);
}

void recordPlaces(const FilmSamples& film, const float* const xy[2], const PixelSamples& found) {
  float* const* const place = found.of(RT_PLACE);
  if (!place[0]) return;
  uint32_t path = 0;
  for (const uint32_t pixel : film.pixels) {
    const float corner[2] = {float(pixel % film.width), float(pixel / film.width)};
    for (uint32_t s = 0; s < film.perPixel; s++, path++)
      for (int k = 0; k < 2; k++) place[k][path] = xy[k][path] - corner[k];
  }
}

void makeCameraRays(const StageContext& context, const float* const xy[2], Rays& rays) {
  const RenderScene& scene = context.scene;
  const uint32_t n = rays.count, size = padded(n);
  ArenaScope scope(context.arena);
  RtsRays local;
  for (int k = 0; k < 3; k++) {
    local.origin[k] = context.arena.takeZero<float>(size);
    local.direction[k] = context.arena.takeZero<float>(size);
  }
  const float extent[2] = {float(scene.frame.width), float(scene.frame.height)};
  RtsBatch batch(context);
  batch.lanes = {.count = n, .cameraRays = true};
  const ShaderSlot& camera = scene.camera.shader;
  {
    const RunningShader running(*camera.shaderClass);
    camera.shaderClass->generate(&scene.host, &batch, camera.params, n, xy, extent, &local);
  }
  HWY_DYNAMIC_DISPATCH(mapRays)(scene.camera.fromLocal, local, rays);
  std::fill_n(rays.tnear, size, 0.0f);
  std::fill_n(rays.tfar, size, std::numeric_limits<float>::infinity());
}

} // namespace openrt
#endif
