// plastic.cpp: the surface shader Plastic, a coloured diffuse base under a clear boundary, smooth
// or rough. With `transparency` the base is a layer of lacquer that shows what is below. [render]
#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <utility>

#include "coat.h"
#include "lacquer.h"
#include "microfacet.h"

namespace {

// Entries of the table of a rough boundary's transmittance, evenly spaced in the root of the
// cosine.
constexpr int tableSize = 14;

// Fresnel term of a clear boundary.
struct Boundary {
  float index;
  rts::Color operator()(float cosine) const {
    const float f = 1 - coat::transmittance(cosine, index);
    return {f, f, f};
  }
};

struct Node { // a node of a Gauss-Legendre quadrature over 0..1
  double place, weight;
};
template <int n> std::array<Node, n> gauss() {
  std::array<Node, n> nodes;
  for (int i = 0; i < n; i++) {
    double z = std::cos(3.14159265358979324 * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int step = 0; step < 8; step++) { // Newton's method on the Legendre polynomial of degree n
      double p = 1, before = 0;
      for (int k = 0; k < n; k++) {
        const double next = ((2 * k + 1) * z * p - k * before) / (k + 1);
        before = p;
        p = next;
      }
      slope = n * (z * p - before) / (z * z - 1);
      z -= p / slope;
    }
    nodes[size_t(i)] = {(1 - z) / 2, 1 / ((1 - z * z) * slope * slope)};
  }
  return nodes;
}

// The lobe of a white base under a rough boundary: f = T(in) T(out) / (pi mean T), with the
// transmittance T from a table. It is symmetric in both directions.
struct RoughCoatedDiffuse {
  float mean, table[tableSize];

  // Returns T by cubic interpolation of the four table entries around the root of the cosine.
  static float at(const float (&table)[tableSize], float root) {
    const float x = std::fmin(1.0f, std::fmax(0.0f, root)) * (tableSize - 1);
    const int i = std::min(std::max(static_cast<int>(x) - 1, 0), tableSize - 4);
    const float a = x - float(i), b = a - 1, c = a - 2, d = a - 3;
    const float* t = table + i;
    return (d * (b * c * t[0] * -1 + 3 * a * c * t[1]) + a * b * (c * t[3] - 3 * d * t[2])) / 6;
  }
  float transmittance(float cosine) const { return at(table, std::sqrt(std::fmax(0.0f, cosine))); }
  rts::Color evaluate(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    const float in = rts::dot(direction, normal);
    if (!(in > 0)) return {};
    const float value =
        transmittance(in) * transmittance(rts::dot(toEye, normal)) * in / (rts::pi * mean);
    return {value, value, value};
  }
  float density(rts::Vec3, rts::Vec3 direction, rts::Vec3 normal) const {
    return coat::cosinePdf(direction, normal);
  }
  rts::Vec3 sample(rts::Vec3, rts::Vec2 square, rts::Vec3 normal) const {
    return coat::sampleCosine(square, normal);
  }
};

// Keeps what prepare() has computed, by roughness and index. It takes milliseconds, and the parts
// of a board have thousands of plastics that differ in their colours alone. [any thread]
class PreparedBodies {
 public:
  template <class Make> RoughCoatedDiffuse get(float roughness, float index, const Make& make) {
    const std::scoped_lock lock(mutex_);
    if (bodies_.size() >= most) bodies_.clear();
    const auto [at, fresh] = bodies_.try_emplace({roughness, index});
    if (fresh) at->second = make();
    return at->second;
  }

 private:
  static constexpr size_t most = 256;
  std::mutex mutex_;
  std::map<std::pair<float, float>, RoughCoatedDiffuse> bodies_;
};
PreparedBodies preparedBodies;

struct Plastic : rts::Surface<Plastic> {
  static constexpr const char* text =
      "coloured body under a clear boundary, smooth or rough; keeps energy";
  rts::Param<rts::Color> color{
      "color", {0.6f, 0.1f, 0.1f}, "fraction of light that the body scatters, 0..1", 0,
      1,       rts::PerVertex};
  rts::Param<float> index{"index", 1.5f, "index of refraction of the clear part; 1: no boundary", 1,
                          3};
  rts::Param<float> roughness{
      "roughness", 0, "width of the distribution of slopes (alpha of GGX); 0: smooth", 0, 1};
  rts::Param<float> transparency{"transparency", 0,
                                 "share of what is behind that shows through the body, in the "
                                 "brightest channel of color",
                                 0, 1};
  rts::Param<rts::Texture> texture{"texture", "multiplies color"};

  bool transmits() const { return transparency > 0; }
  uint32_t needs() const {
    if (!(index > 1.001f)) return 0;
    return rough() ? RTS_GLOSSY : RTS_SPECULAR | RTS_GLOSSY;
  }
  const char* prepare() {
    if (rough()) body_ = preparedBodies.get(roughness, index, [this] { return body(); });
    return nullptr;
  }
  // Tabulates 1 - albedo of the rough boundary. The base gets all light that the boundary does not
  // reflect, including light reflected between facets. So a white base reflects all light, with an
  // error of about 3e-4.
  RoughCoatedDiffuse body() const {
    RoughCoatedDiffuse made{};
    const microfacet::MicrofacetLobe<Boundary> boundary{roughness, {index}};
    for (int j = 0; j < tableSize; j++) {
      const float root = std::fmax(1e-2f, float(j) / (tableSize - 1)), z = root * root;
      const float reflectance = albedoOf(boundary, {std::sqrt(std::fmax(0.0f, 1 - z * z)), 0, z});
      made.table[j] = std::fmin(1.0f, std::fmax(0.0f, 1 - reflectance));
    }
    // The integral of 2 c T(c) dc = 4 r^3 T dr, with r the root of c: a polynomial of degree 6
    // between two table entries.
    double mean = 0;
    for (int j = 0; j + 1 < tableSize; j++)
      for (const Node& node : gauss<4>()) {
        const double r = (j + node.place) / (tableSize - 1);
        mean += node.weight / (tableSize - 1) * 4 * r * r * r *
                double(RoughCoatedDiffuse::at(made.table, float(r)));
      }
    made.mean = static_cast<float>(mean);
    return made;
  }
  template <class F> void surface(const rts::HitOf<F>& hit, rts::ClosuresOf<F>& out) const {
    const rts::ColorOf<F> albedo = colourAt(hit);
    if (!(transparency > 0)) {
      if (!rough() || !(body_.mean > 0)) return coat::add(hit, out, albedo, index);
      return addRough(out, albedo, rts::ColorOf<F>{1, 1, 1});
    }
    const rts::ColorOf<F> passes = lacquer::passing<F>(hit, albedo, transparency);
    const rts::ColorOf<F> shown{1 - passes.r, 1 - passes.g, 1 - passes.b};
    out.transparent(passes);
    if (rough() && body_.mean > 0) return addRough(out, albedo, shown);
    coat::add(hit, out, albedo, index, shown);
  }
  template <class F> rts::ColorOf<F> transmit(const rts::HitOf<F>& hit) const {
    return lacquer::passing<F>(hit, colourAt(hit), transparency);
  }

 private:
  template <class F> rts::ColorOf<F> colourAt(const rts::HitOf<F>& hit) const {
    const rts::Vec4Of<F> t = hit.sample(texture, hit.uv);
    return *color * rts::ColorOf<F>{t.x, t.y, t.z} *
           rts::ColorOf<F>{hit.color.x, hit.color.y, hit.color.z};
  }
  template <class F>
  void addRough(rts::ClosuresOf<F>& out, rts::ColorOf<F> albedo, rts::ColorOf<F> shown) const {
    out.albedo(albedo);
    out.coat();
    out.custom(shown, microfacet::MicrofacetLobe<Boundary>{roughness, {index}});
    out.coat(false);
    out.custom(shown * coat::colour(albedo, index), body_);
  }
  bool rough() const { return roughness > microfacet::minAlpha && index > 1.001f; }
  static float albedoOf(const microfacet::MicrofacetLobe<Boundary>& boundary, rts::Vec3 o) {
    constexpr int around = 40; // samples of half of the circle; the other half is symmetric
    double sum = 0;
    for (const Node& node : gauss<40>())
      for (int a = 0; a < around; a++) {
        const rts::Sample s =
            boundary.sample(o, {(float(a) + 0.5f) / (2 * around), float(node.place)}, {0, 0, 1});
        if (s.density > 0) sum += node.weight / around * double(s.quotient.r);
      }
    return static_cast<float>(sum);
  }
  RoughCoatedDiffuse body_; // computed by prepare
};

} // namespace

RTS_PLUGIN(Plastic)
