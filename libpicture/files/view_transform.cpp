#include "libpicture/files/view_transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

#include "libpicture/files/picture.h"
#include "libpicture/luminance.h"
#include "srgb.h"

namespace picture {

namespace {

constexpr std::string_view names[] = {"standard", "filmic", "agx"};

using Colour = std::array<double, 3>;
using Rows = double[3][3];

Colour times(const Rows& m, const Colour& c) {
  Colour out{};
  for (size_t i = 0; i < 3; ++i) out[i] = m[i][0] * c[0] + m[i][1] * c[1] + m[i][2] * c[2];
  return out;
}

// The curve of "Uncharted 2" by J. Hable, with his constants: shoulder, linear strength and angle,
// toe strength, numerator and denominator.
double hable(double x) {
  constexpr double a = .15, b = .50, c = .10, d = .20, e = .02, f = .30;
  return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
}

// The published exposure bias is 2, so that light of 5.6 becomes white.
double filmic(double v) {
  constexpr double bias = 2, white = 11.2;
  static const double scale = 1 / hable(white);
  return v > 0 ? std::min(hable(std::min(bias * v, white)) * scale, 1.0) : 0;
}

// AgX as three.js and Godot have it. The light goes to Rec. 2020, is mixed towards grey, and its
// logarithm from -12.47393 to 4.026069 goes through a sigmoid: the polynomial of B. Wrensch,
// "Minimal AgX Implementation", 2023.
Colour agx(const Colour& light) {
  constexpr Rows toWide = {{.6274, .3293, .0433}, {.0691, .9195, .0113}, {.0164, .0880, .8956}};
  constexpr Rows toNarrow = {
      {1.6605, -.5876, -.0728}, {-.1246, 1.1329, -.0083}, {-.0182, -.1006, 1.1187}};
  constexpr Rows inset = {{.856627153315983, .0951212405381588, .0482516061458583},
                          {.137318972929847, .761241990602591, .101439036467562},
                          {.11189821299995, .0767994186031903, .811302368396859}};
  constexpr Rows outset = {{1.1271005818144368, -.11060664309660323, -.016493938717834573},
                           {-.1413297634984383, 1.157823702216272, -.016493938717834257},
                           {-.14132976349843826, -.11060664309660294, 1.2519364065950405}};
  constexpr double least = -12.47393, most = 4.026069;
  Colour c = times(inset, times(toWide, light));
  for (double& v : c) {
    const double x = std::clamp((std::log2(std::max(v, 1e-10)) - least) / (most - least), 0.0, 1.0);
    v = ((((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + .4298) * x + .1191) * x) - .00232;
  }
  c = times(outset, c);
  for (double& v : c) v = std::pow(std::max(v, 0.0), 2.2);
  return times(toNarrow, c);
}

// Returns the luminances above 0, each as its logarithm to base 2.
std::vector<float> logLuminances(const Picture& picture) {
  const std::vector<float>& rgba = rgbaOf(picture);
  std::vector<float> out;
  out.reserve(rgba.size() / 4);
  for (size_t i = 0; i + 3 < rgba.size(); i += 4) {
    const float y = luminanceOf(&rgba[i]);
    if (y > 0 && std::isfinite(y)) out.push_back(std::log2(y));
  }
  return out;
}

double atShare(std::vector<float>& values, double share) {
  const auto at = values.begin() + std::ptrdiff_t(double(values.size() - 1) * share);
  std::nth_element(values.begin(), at, values.end());
  return double(*at);
}

} // namespace

std::string_view curveName(ViewCurve curve) { return names[size_t(curve)]; }

std::optional<ViewCurve> curveNamed(std::string_view name) {
  for (size_t i = 0; i < std::size(names); ++i)
    if (name == names[i]) return ViewCurve(i);
  return {};
}

float linearOf(float v) { return decodeSrgb(v); }

void toScreen(const ViewTransform& view, const float radiance[3], float screen[3]) {
  constexpr double most = 1e30; // keeps infinities out of differences
  const double scale = std::exp2(view.exposure);
  Colour c;
  for (size_t i = 0; i < 3; ++i) {
    const double v = double(radiance[i]) * scale;
    c[i] = v > 0 ? std::min(v, most) : 0; // also 0 for NaN
  }
  if (view.curve == ViewCurve::filmic)
    for (double& v : c) v = filmic(v);
  else if (view.curve == ViewCurve::agx)
    c = agx(c);
  for (size_t i = 0; i < 3; ++i) screen[i] = float(std::clamp(c[i], 0.0, 1.0));
}

double fittingExposure(const Picture& picture) {
  constexpr double grey = .18, outside = .01, steps = 64, range = 16;
  std::vector<float> all = logLuminances(picture);
  if (all.empty()) return 0;
  const double most = atShare(all, 1 - outside);
  // A value that is darker by a factor of 65536 is as good as black.
  std::erase_if(all, [&](float v) { return double(v) < most - range; });
  double sum = 0;
  for (const float v : all) sum += double(v);
  const double mean = sum / double(all.size()), least = atShare(all, outside);
  const double place =
      most > least ? std::clamp((2 * mean - least - most) / (most - least), -1.0, 1.0) : 0;
  const double stops = std::log2(grey) + 2 * place - mean; // 4 to the power of place
  return std::clamp(std::round(stops * steps) / steps, -mostExposure, mostExposure);
}

} // namespace picture
