#include "libpicture/live/denoise.h"

#include <algorithm>
#include <cmath>

namespace picture::live {

namespace {

// From a quarter of noise on, the library counts in full.
constexpr float noiseFall = 4;
// Each filter errs in a way of its own, so their mean is nearer to the truth than either
// (docs/decisions/0053).
constexpr float share = 0.5f; // the library's part in the result

size_t firstOf(const OidnImages& images, int y) { return size_t(y) * size_t(images.width) * 3; }

} // namespace

void imageRow(const Moment& now, const Reading& reading, int y, OidnImages& images) {
  const Plane3 &light = now.accumulated.light, &albedo = reading.albedo,
               &normal = now.guides.normal;
  float *colour = images.colour.data() + firstOf(images, y),
        *surface = images.albedo.data() + firstOf(images, y),
        *direction = images.normal.data() + firstOf(images, y);
  for (size_t i = now.layout.row(y), last = i + size_t(images.width); i < last; i++) {
    const float rest = light.x[i] - light.z[i];
    const float rgb[3] = {rest + light.y[i], light.x[i] + light.z[i], rest - light.y[i]};
    const float a[3] = {albedo.x[i], albedo.y[i], albedo.z[i]};
    const float n[3] = {normal.x[i], normal.y[i], normal.z[i]};
    for (int c = 0; c < 3; c++) {
      *colour++ = std::max(0.0f, rgb[c]) * a[c];
      *surface++ = std::min(1.0f, a[c]);
      *direction++ = n[c];
    }
  }
}

void lightRow(const Moment& now, const Reading& reading, const OidnImages& images, int y,
              const Plane3& own, Plane3& to) {
  const Plane3& albedo = reading.albedo;
  const float* colour = images.colour.data() + firstOf(images, y);
  for (size_t i = now.layout.row(y), last = i + size_t(images.width); i < last; i++) {
    const float r = *colour++ / albedo.x[i], g = *colour++ / albedo.y[i],
                b = *colour++ / albedo.z[i];
    const float luma = 0.25f * r + 0.5f * g + 0.25f * b, first = 0.5f * (r - b),
                second = 0.5f * g - 0.25f * (r + b);
    const bool known = std::isfinite(luma) && std::isfinite(first) && std::isfinite(second);
    const float trust = known ? share * std::min(1.0f, noiseFall * now.accumulated.noise[i]) : 0;
    to.x[i] = own.x[i] + (known ? trust * (luma - own.x[i]) : 0);
    to.y[i] = own.y[i] + (known ? trust * (first - own.y[i]) : 0);
    to.z[i] = own.z[i] + (known ? trust * (second - own.z[i]) : 0);
  }
}

} // namespace picture::live
