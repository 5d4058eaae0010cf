#include "libpicture/compare/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "libpicture/luminance.h"
#include "parallel_for.h"
#include "srgb.h"

namespace picture {

namespace {

using Colour = std::array<float, 3>;
using Kernel =
    std::vector<float>; // an odd number of weights; the middle one is for the pixel itself

// Pixels a degree of a 4K screen, .7 m wide, seen from .7 m.
constexpr double pixelsPerDegree = 67.0206;
constexpr int mostExposures = 64;

// One number for each pixel.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;
  Plane(int w, int h) : width(w), height(h), values(size_t(w) * size_t(h)) {}
  float* row(int y) { return &values[size_t(y) * size_t(width)]; }
  const float* row(int y) const { return &values[size_t(y) * size_t(width)]; }
};

struct Planes {
  std::array<Plane, 3> of;
  Planes(int w, int h) : of{Plane(w, h), Plane(w, h), Plane(w, h)} {}
  int width() const { return of[0].width; }
  int height() const { return of[0].height; }
  Colour at(size_t i) const { return {of[0].values[i], of[1].values[i], of[2].values[i]}; }
  void set(size_t i, const Colour& c) {
    for (size_t k = 0; k < 3; ++k) of[k].values[i] = c[k];
  }
};

template <class F> void forRows(int height, const F& f) {
  parallelFor(tbb::blocked_range<int>(0, height, 8), [&](const auto& rows) {
    for (int y = rows.begin(); y < rows.end(); ++y) f(y);
  });
}

// --- Colours ---

// Linear sRGB to XYZ, relative to the white of the screen.
constexpr float toXyz[3][3] = {{.41238656f, .35759149f, .18045049f},
                               {.21263682f, .71518298f, .07218020f},
                               {.01933062f, .11919716f, .95037259f}};
constexpr float fromXyz[3][3] = {{3.24100326f, -1.53739899f, -.49861587f},
                                 {-.96922425f, 1.87592999f, .04155422f},
                                 {.05563942f, -.20401120f, 1.05714897f}};
constexpr Colour white = {.95042854f, 1, 1.08890037f};

Colour times(const float (&m)[3][3], const Colour& c) {
  Colour out;
  for (size_t k = 0; k < 3; ++k) out[k] = m[k][0] * c[0] + m[k][1] * c[1] + m[k][2] * c[2];
  return out;
}

Colour relativeXyz(const Colour& linear) {
  Colour xyz = times(toXyz, linear);
  for (size_t k = 0; k < 3; ++k) xyz[k] /= white[k];
  return xyz;
}

// Returns YCxCz, the linear opponent colours in which the eye's blur is described.
Colour opponent(const Colour& linear) {
  const Colour c = relativeXyz(linear);
  return {116 * c[1] - 16, 500 * (c[0] - c[1]), 200 * (c[1] - c[2])};
}

// Returns the colour of a screen that is nearest to YCxCz.
Colour linearOf(const Colour& ycxcz) {
  const float y = (ycxcz[0] + 16) / 116;
  const Colour xyz = {(y + ycxcz[1] / 500) * white[0], y * white[1],
                      (y - ycxcz[2] / 200) * white[2]};
  Colour rgb = times(fromXyz, xyz);
  for (float& v : rgb) v = std::clamp(v, 0.0f, 1.0f);
  return rgb;
}

// Returns L*a*b* with Hunt's adjustment: dark colours differ less in their hue.
Colour huntLab(const Colour& linear) {
  constexpr float bend = 6.0f / 29;
  Colour f = relativeXyz(linear);
  for (float& t : f) t = t > bend * bend * bend ? std::cbrt(t) : t / (3 * bend * bend) + 4.0f / 29;
  const float lightness = 116 * f[1] - 16, hunt = .01f * lightness;
  return {lightness, hunt * 500 * (f[0] - f[1]), hunt * 200 * (f[1] - f[2])};
}

// Returns the distance HyAB to the power of .7.
float distance(const Colour& a, const Colour& b) {
  const float d = std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
  return std::pow(d, .7f);
}

// --- Filters ---

// Returns the plane filtered by a kernel along the rows and one along the columns, of one length;
// its edges are continued.
Plane filtered(const Plane& in, const Kernel& across, const Kernel& down) {
  const int radius = int(across.size() / 2);
  const auto width = size_t(in.width);
  Plane rows(in.width, in.height), out(in.width, in.height);
  const auto add = [width](float weight, const float* from, float* to) {
    for (size_t x = 0; x < width; ++x) to[x] += weight * from[x];
  };
  forRows(in.height, [&](int y) {
    const float* const from = in.row(y);
    std::vector<float> longer(width + 2 * size_t(radius), from[0]);
    std::copy_n(from, width, longer.begin() + radius);
    std::fill_n(longer.end() - radius, radius, from[width - 1]);
    for (size_t k = 0; k < across.size(); ++k) add(across[k], &longer[k], rows.row(y));
  });
  forRows(in.height, [&](int y) {
    for (int k = -radius; k <= radius; ++k)
      add(down[size_t(k + radius)], rows.row(std::clamp(y + k, 0, in.height - 1)), out.row(y));
  });
  return out;
}

// Divides the positive weights by their sum, and the negative ones by theirs.
Kernel normalised(Kernel kernel) {
  float more = 0, less = 0;
  for (const float v : kernel) (v > 0 ? more : less) += v;
  for (float& v : kernel)
    if (v != 0) v /= v > 0 ? more : -less;
  return kernel;
}

template <class F> Kernel kernelOf(int radius, const F& weight) {
  Kernel kernel;
  for (int x = -radius; x <= radius; ++x) kernel.push_back(float(weight(double(x))));
  return normalised(std::move(kernel));
}

// A term a sqrt(pi / b) exp(-pi^2 x^2 / b) of the eye's contrast sensitivity, x in degrees.
struct Sensitivity {
  double a, b;
};

Plane blurred(const Plane& in, std::initializer_list<Sensitivity> terms) {
  constexpr double widest = .04, pi = std::numbers::pi;
  const int radius = int(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixelsPerDegree));
  Plane out(in.width, in.height);
  double all = 0;
  std::vector<double> shares;
  for (const auto& [a, b] : terms) {
    double sum = 0;
    for (int x = -radius; x <= radius; ++x)
      sum += std::exp(-pi * pi * (x / pixelsPerDegree) * (x / pixelsPerDegree) / b);
    shares.push_back(a * std::sqrt(pi / b) * sum * sum);
    all += shares.back();
  }
  size_t term = 0;
  for (const Sensitivity& one : terms) {
    const Kernel kernel = kernelOf(radius, [&](double x) {
      return std::exp(-pi * pi * (x / pixelsPerDegree) * (x / pixelsPerDegree) / one.b);
    });
    const Plane part = filtered(in, kernel, kernel);
    const auto share = float(shares[term++] / all);
    for (size_t i = 0; i < out.values.size(); ++i) out.values[i] += share * part.values[i];
  }
  return out;
}

// --- LDR-FLIP ---

// A picture as the eye takes it in.
struct Seen {
  Planes lab;
  Plane edges, points; // how strong they are
};

Plane strengthOf(const Plane& in, const Kernel& change, const Kernel& gauss) {
  Plane x = filtered(in, change, gauss);
  const Plane y = filtered(in, gauss, change);
  for (size_t i = 0; i < x.values.size(); ++i) x.values[i] = std::hypot(x.values[i], y.values[i]);
  return x;
}

Seen seenOf(const Planes& linear) {
  const int width = linear.width(), height = linear.height();
  Planes colours(width, height), lab(width, height);
  Plane luminance(width, height);
  const auto forPixels = [&](const auto& f) {
    forRows(height, [&](int y) {
      for (size_t i = size_t(y) * size_t(width), x = 0; x < size_t(width); ++x) f(i + x);
    });
  };
  forPixels([&](size_t i) {
    colours.set(i, opponent(linear.at(i)));
    luminance.values[i] = (colours.of[0].values[i] + 16) / 116;
  });
  colours.of = {blurred(colours.of[0], {{1, .0047}}), blurred(colours.of[1], {{1, .0053}}),
                blurred(colours.of[2], {{34.1, .04}, {13.5, .025}})};
  forPixels([&](size_t i) { lab.set(i, huntLab(linearOf(colours.at(i)))); });
  constexpr double deviation = .5 * .082 * pixelsPerDegree;
  const int radius = int(std::ceil(3 * deviation));
  const auto bell = [](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
  const Kernel gauss = kernelOf(radius, bell),
               slope = kernelOf(radius, [&](double x) { return -x * bell(x); }),
               curve = kernelOf(radius, [&](double x) {
                 return (x * x / (deviation * deviation) - 1) * bell(x);
               });
  return {std::move(lab), strengthOf(luminance, slope, gauss), strengthOf(luminance, curve, gauss)};
}

// Writes the larger one of FLIP and what the map has.
void addFlip(const Planes& reference, const Planes& test, std::vector<float>& map) {
  static const float most = distance(huntLab({0, 1, 0}), huntLab({0, 0, 1}));
  constexpr float bendAt = .4f, bendTo = .95f;
  const Seen a = seenOf(reference), b = seenOf(test);
  forRows(reference.height(), [&](int y) {
    for (int x = 0; x < reference.width(); ++x) {
      const size_t i = size_t(y) * size_t(reference.width()) + size_t(x);
      float colour = distance(a.lab.at(i), b.lab.at(i)) / most;
      colour = colour < bendAt ? colour * bendTo / bendAt
                               : bendTo + (colour - bendAt) / (1 - bendAt) * (1 - bendTo);
      const float feature = std::max(std::abs(a.edges.values[i] - b.edges.values[i]),
                                     std::abs(a.points.values[i] - b.points.values[i]));
      const float shape = std::sqrt(std::clamp(feature / std::numbers::sqrt2_v<float>, 0.f, 1.f));
      map[i] = std::max(map[i], std::pow(std::clamp(colour, 0.0f, 1.0f), 1 - shape));
    }
  });
}

// --- HDR-FLIP ---

// The tone curve (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5) is K. Narkowicz's fit of ACES, with its
// exposure of .6.
constexpr double k0 = .36 * 2.51, k1 = .6 * .03, k3 = .36 * 2.43, k4 = .6 * .59, k5 = .14;

float toneMapped(double x) {
  return float(std::clamp((k0 * x * x + k1 * x) / (k3 * x * x + k4 * x + k5), 0.0, 1.0));
}

// Returns the light that the curve makes .85 of.
double nearlyWhite() {
  constexpr double t = .85, a = k0 - t * k3, b = k1 - t * k4, c = -t * k5;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

// Returns the factors that the papers' exposures multiply radiance by: from one that shows the
// brightest pixel to one that shows the median.
std::vector<double> exposuresOf(const std::vector<Colour>& radiance) {
  std::vector<float> luminances;
  for (const Colour& c : radiance)
    if (const float v = luminanceOf(c.data()); v > 0) luminances.push_back(v);
  if (luminances.empty()) return {1};
  const auto middle = luminances.begin() + std::ptrdiff_t(luminances.size() / 2);
  std::nth_element(luminances.begin(), middle, luminances.end());
  const double median = double(*middle),
               most = double(*std::max_element(luminances.begin(), luminances.end()));
  const double first = std::log2(nearlyWhite() / most), last = std::log2(nearlyWhite() / median);
  const int count = std::clamp(int(std::ceil(last - first)), 2, mostExposures);
  std::vector<double> factors;
  for (int i = 0; i < count; ++i)
    factors.push_back(std::exp2(first + (last - first) * i / (count - 1)));
  return factors;
}

std::vector<Colour> coloursOf(const Picture& picture) {
  const std::vector<float>& rgba = rgbaOf(picture);
  std::vector<Colour> out(rgba.size() / 4);
  for (size_t i = 0; i < out.size(); ++i)
    for (size_t k = 0; k < 3; ++k) {
      const float v = rgba[4 * i + k];
      out[i][k] = std::isfinite(v) ? v : 0.0f;
    }
  return out;
}

template <class F> Planes shown(const Picture& picture, const std::vector<Colour>& from, F curve) {
  Planes planes(picture.width, picture.height);
  for (size_t i = 0; i < from.size(); ++i)
    planes.set(i, {curve(from[i][0]), curve(from[i][1]), curve(from[i][2])});
  return planes;
}

} // namespace

Flip flipOf(const Picture& reference, const Picture& test) {
  const std::vector<Colour> a = coloursOf(reference), b = coloursOf(test);
  Flip flip;
  flip.map.assign(a.size(), 0);
  if (reference.linear) {
    const std::vector<double> factors = exposuresOf(a);
    flip.exposures = int(factors.size());
    for (const double factor : factors) {
      const auto curve = [factor](float v) {
        return toneMapped(std::max(0.0, double(v)) * factor);
      };
      addFlip(shown(reference, a, curve), shown(test, b, curve), flip.map);
    }
  } else {
    const auto curve = [](float v) { return decodeSrgb(std::clamp(v, 0.0f, 1.0f)); };
    addFlip(shown(reference, a, curve), shown(test, b, curve), flip.map);
  }
  flip.mean = std::accumulate(flip.map.begin(), flip.map.end(), 0.0) / double(flip.map.size());
  return flip;
}

} // namespace picture
