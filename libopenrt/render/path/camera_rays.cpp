#include "render/path/camera_rays.h"

#include <algorithm>
#include <limits>

#include "shading/running.h"

namespace openrt {

void startSamples(const FilmSamples& film, PathSamples& samples) {
  uint32_t path = 0;
  for (uint32_t pixel : film.pixels)
    for (uint32_t s = 0; s < film.perPixel; s++, path++)
      samples.set(path, pixel, film.replicates.seedOf(film.first + s),
                  film.replicates.indexOf(film.first + s));
}

void sampleFilm(const FilmSamples& film, const PathSamples& samples, Arena& arena, float* xy[2]) {
  const uint32_t n = film.count();
  if (film.centred)
    for (int k = 0; k < 2; k++) std::fill_n(xy[k] = arena.take<float>(padded(n)), n, 0.5f);
  else
    randomNumbersAtStart(samples, n, arena).drawPair(0, arena, xy);
  uint32_t path = 0;
  for (uint32_t pixel : film.pixels)
    for (uint32_t s = 0; s < film.perPixel; s++, path++) {
      xy[0][path] += float(pixel % film.width);
      xy[1][path] += float(pixel / film.width);
    }
  for (int k = 0; k < 2; k++) std::fill(xy[k] + n, xy[k] + padded(n), xy[k][n - 1]);
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
  RtsBatch batch = makeBatch(context);
  batch.rays = n;
  const ShaderSlot& camera = scene.camera.shader;
  {
    const RunningShader running(*camera.shaderClass);
    camera.shaderClass->generate(&scene.host, &batch, camera.params, n, xy, extent, &local);
  }
  const Affine& toRender = scene.camera.fromLocal;
  for (uint32_t i = 0; i < size; i++) {
    const Vec3f direction = toRender.direction(load(local.direction, i));
    store(toRender.point(load(local.origin, i)), rays.org, i);
    store(direction * (1 / length(direction)), rays.dir, i);
  }
  std::fill_n(rays.tnear, size, 0.0f);
  std::fill_n(rays.tfar, size, std::numeric_limits<float>::infinity());
}

} // namespace openrt
