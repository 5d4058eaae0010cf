// plastic.cpp: a coloured body under a clear boundary, smooth or rough.
#include "coat.h"
#include "microfacet.h"

namespace {

constexpr int knots = 12; // of the table of what a rough boundary lets through, evenly over the cosine

struct Boundary { // one facet of it
  float index;
  rts::Color operator()(float cosine) const {
    const float f = 1 - coat::through(cosine, index);
    return {f, f, f};
  }
};

// The body under a rough boundary, with T from a table: f = T(in) T(out) / (pi mean T), white. The same rule for both directions.
struct RoughMatt {
  float mean, table[knots];

  float through(float cosine) const {
    const float x = std::fmin(1.0f, std::fmax(0.0f, cosine)) * (knots - 1);
    const int i = std::fmin(knots - 2.0f, x) < 0 ? 0 : static_cast<int>(std::fmin(knots - 2.0f, x));
    return table[i] + (table[i + 1] - table[i]) * (x - float(i));
  }
  rts::Color evaluate(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    const float in = rts::dot(direction, normal);
    if (!(in > 0)) return {};
    const float value = through(in) * through(rts::dot(toEye, normal)) * in / (rts::pi * mean);
    return {value, value, value};
  }
  float density(rts::Vec3, rts::Vec3 direction, rts::Vec3 normal) const { return coat::cosineDensity(direction, normal); }
  rts::Vec3 sample(rts::Vec3, rts::Vec2 square, rts::Vec3 normal) const { return coat::cosineDirection(square, normal); }
};

struct Plastic : rts::Surface<Plastic> {
  static constexpr const char* text = "coloured body under a clear boundary, smooth or rough; keeps energy";
  rts::Param<rts::Color> color{"color", {0.6f, 0.1f, 0.1f}, "fraction of light that the body scatters, 0..1", 0,
                               1,       rts::PerVertex};
  rts::Param<float> index{"index", 1.5f, "index of refraction of the clear part; 1: no boundary", 1, 3};
  rts::Param<float> roughness{"roughness", 0, "width of the distribution of slopes (alpha of GGX); 0: smooth", 0, 1};
  rts::Param<rts::Texture> texture{"texture", "multiplies color"};

  uint32_t needs() const {
    if (!(index > 1.001f)) return 0;
    return rough() ? RTS_GLOSSY : RTS_SPECULAR | RTS_GLOSSY;
  }
  // What the rough boundary reflects towards each cosine, by the rule that its own samples follow: a bound from above, so that
  // boundary and body never reflect more than they get.
  const char* prepare() {
    if (!rough()) return nullptr;
    const microfacet::Rough<Boundary> boundary{roughness, {index}};
    double mean = 0;
    for (int j = 0; j < knots; j++) {
      const float z = std::fmax(1e-3f, float(j) / (knots - 1));
      body_.table[j] = std::fmax(0.0f, 1 - margin - reflected(boundary, {std::sqrt(std::fmax(0.0f, 1 - z * z)), 0, z}));
    }
    const auto moment = [](double a, double b, double fa, double fb) { // of 2 x f(x) over a..b, f straight
      const double slope = (fb - fa) / (b - a), start = fa - slope * a;
      return start * (b * b - a * a) + slope * 2 / 3 * (b * b * b - a * a * a);
    };
    for (int j = 0; j + 1 < knots; j++)
      mean += moment(double(j) / (knots - 1), double(j + 1) / (knots - 1), body_.table[j], body_.table[j + 1]);
    body_.mean = static_cast<float>(mean);
    return nullptr;
  }
  void surface(const rts::Hit& hit, rts::Closures& out) const {
    const rts::Vec4 t = hit.sample(texture, hit.uv);
    const rts::Color albedo = *color * rts::Color{t.x, t.y, t.z} * rts::Color{hit.color.x, hit.color.y, hit.color.z};
    if (!rough() || !(body_.mean > 0)) return coat::add(hit, out, albedo, index);
    out.albedo(albedo);
    out.custom({1, 1, 1}, microfacet::Rough<Boundary>{roughness, {index}});
    out.custom(coat::colour(albedo, index), body_);
  }

 private:
  static constexpr float margin = 2e-3f; // of the quadrature and of the straight lines between knots
  bool rough() const { return roughness > microfacet::smoothest && index > 1.001f; }
  static float reflected(const microfacet::Rough<Boundary>& boundary, rts::Vec3 o) {
    constexpr int side = 48;
    double sum = 0;
    for (int a = 0; a < side; a++)
      for (int b = 0; b < side; b++) {
        const rts::Sample s = boundary.sample(o, {(float(a) + 0.5f) / side, (float(b) + 0.5f) / side}, {0, 0, 1});
        if (s.density > 0) sum += s.quotient.r;
      }
    return static_cast<float>(sum / (side * side));
  }
  RoughMatt body_; // made by prepare
};

} // namespace

RTS_PLUGIN(Plastic)
