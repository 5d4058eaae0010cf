// denoise.cpp: The spatial filter by Open Image Denoise, instead of the à-trous filter: from planes
// to images and back.
#include "libpicture/live/denoise.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace picture::live {

namespace {
const int mode = std::getenv("MOT_MODE") ? std::atoi(std::getenv("MOT_MODE")) : 0;
} // namespace

void imageRow(const Moment& now, const Reading& reading, int y, OidnImages& images) {
  const Plane3 &light = now.accumulated.light, &albedo = reading.albedo,
               &normal = now.guides.normal;
  const size_t row = now.layout.row(y);
  float* colour = images.colour.data() + size_t(y) * size_t(images.width) * 3;
  float* surface = images.albedo.data() + size_t(y) * size_t(images.width) * 3;
  float* direction = images.normal.data() + size_t(y) * size_t(images.width) * 3;
  for (int x = 0; x < images.width; x++) {
    const size_t i = row + size_t(x);
    const float rest = light.x[i] - light.z[i];
    const float rgb[3] = {rest + light.y[i], light.x[i] + light.z[i], rest - light.y[i]};
    const float a[3] = {albedo.x[i], albedo.y[i], albedo.z[i]};
    const float n[3] = {normal.x[i], normal.y[i], normal.z[i]};
    for (int c = 0; c < 3; c++) {
      colour[3 * x + c] = std::max(0.0f, rgb[c]) * (mode == 1 ? a[c] : 1);
      surface[3 * x + c] = mode == 2 ? 1 : std::min(1.0f, a[c]);
      direction[3 * x + c] = n[c];
    }
  }
}

void lightRow(const Moment& now, const Reading& reading, const OidnImages& images, int y,
              Plane3& to) {
  const Plane3 &light = now.accumulated.light, &albedo = reading.albedo;
  const size_t row = now.layout.row(y);
  const float* colour = images.colour.data() + size_t(y) * size_t(images.width) * 3;
  for (int x = 0; x < images.width; x++) {
    const size_t i = row + size_t(x);
    float r = colour[3 * x], g = colour[3 * x + 1], b = colour[3 * x + 2];
    if (mode == 1) {
      r /= albedo.x[i];
      g /= albedo.y[i];
      b /= albedo.z[i];
    }
    const float luma = 0.25f * r + 0.5f * g + 0.25f * b, first = 0.5f * (r - b),
                second = 0.5f * g - 0.25f * (r + b);
    const bool known = std::isfinite(luma) && std::isfinite(first) && std::isfinite(second);
    const float noise = known ? std::min(1.0f, 4 * now.accumulated.noise[i]) : 0;
    to.x[i] = light.x[i] + (known ? noise * (luma - light.x[i]) : 0);
    to.y[i] = light.y[i] + (known ? noise * (first - light.y[i]) : 0);
    to.z[i] = light.z[i] + (known ? noise * (second - light.z[i]) : 0);
  }
}

} // namespace picture::live
