// carpaint.cpp: pigment and metal flakes under a clear coat. Flakes lie in cells of the object's
// space. A hash of the cell decides whether a flake is visible and how it tilts, so flakes stay in
// place while object and camera move.
#include "coat.h"
#include "microfacet.h"
#include "pattern.h"

namespace {

// The lobe of a tilted aluminium flake, whose normal is the lobe's, under a coat with normal `top`.
// The coat transmits both directions at its own normal. Their refraction is neglected: it only
// makes flakes appear less tilted. The weight is the tint.
struct Flake {
  microfacet::MicrofacetLobe<microfacet::Conductor> metal;
  float index;
  rts::Vec3 top;

  rts::Color evaluate(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    return twoWayTransmittance(toEye, direction) * metal.evaluate(toEye, direction, normal);
  }
  float density(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    return metal.density(toEye, direction, normal);
  }
  rts::Sample sample(rts::Vec3 toEye, rts::Vec2 square, rts::Vec3 normal) const {
    rts::Sample s = metal.sample(toEye, square, normal);
    s.quotient = twoWayTransmittance(toEye, s.direction) * s.quotient;
    return s;
  }

 private:
  float coatTransmittance(rts::Vec3 v) const {
    const float c = rts::dot(v, top);
    return c > 0 ? coat::transmittance(std::fmin(1.0f, c), index) : 0.0f;
  }
  float twoWayTransmittance(rts::Vec3 a, rts::Vec3 b) const {
    return coatTransmittance(a) * coatTransmittance(b);
  }
};

constexpr rts::Color aluminiumN{1.35f, 0.96f, 0.62f}, aluminiumK{7.47f, 6.4f, 5.3f};

struct CarPaint : rts::Surface<CarPaint> {
  static constexpr const char* text = "pigment and metal flakes under a clear coat";
  static constexpr uint32_t needs = RTS_SPECULAR | RTS_GLOSSY;
  rts::Param<rts::Color> color{
      "color", {0.35f, 0.02f, 0.03f}, "fraction of light that the pigment scatters, 0..1", 0, 1};
  rts::Param<rts::Color> flakeColor{
      "flakeColor", {0.9f, 0.45f, 0.4f}, "tint of the light from flakes, 0..1", 0, 1};
  rts::Param<float> flakes{"flakes", 0.35f, "fraction of the area that flakes cover", 0, 1};
  rts::Param<float> flakeSize{"flakeSize", 0.002f,
                              "mean distance of flakes, in units of the object", 1e-6f, 1e6f};
  rts::Param<float> flakeSpread{"flakeSpread", 0.25f,
                                "how far flakes lean: mean tangent of the angle", 0, 2};
  rts::Param<float> flakeRoughness{"flakeRoughness", 0.12f, "of each flake (alpha of GGX)", 0.01f,
                                   1};
  rts::Param<float> index{"index", 1.5f, "index of refraction of the clear coat; 1: none", 1, 3};

  void surface(const rts::Hit& hit, rts::Closures& out) const {
    rts::Vec3 leaning;
    const float f = 1 - coat::transmittance(hit.cosine(), index);
    out.coat();
    if (index > 1.001f) out.reflection({f, f, f});
    out.coat(false);
    if (flakeAt(hit, leaning)) {
      out.normal(leaning);
      out.custom(flakeColor, Flake{{flakeRoughness, {aluminiumN, aluminiumK}}, index, hit.normal});
      out.albedo(flakeColor);
    } else {
      out.custom(coat::colour(*color, index), coat::CoatedDiffuse::of(index));
      out.albedo(color);
    }
  }

 private:
  // Finds the nearest flake; each cell has one at a random position.
  bool flakeAt(const rts::Hit& hit, rts::Vec3& leaning) const {
    const rts::Vec3 p = hit.local().position * (1 / float(flakeSize));
    const int32_t x = pattern::cell(p.x - 0.5f), y = pattern::cell(p.y - 0.5f),
                  z = pattern::cell(p.z - 0.5f);
    float nearest = rts::infinity;
    uint32_t flake = 0;
    for (int32_t i = 0; i < 8; i++) {
      const int32_t cx = x + (i & 1), cy = y + (i >> 1 & 1), cz = z + (i >> 2);
      const uint32_t h = pattern::hash(cx, cy, cz), g = pattern::mix(h + 1),
                     e = pattern::mix(h + 2);
      const rts::Vec3 d = p - rts::Vec3{float(cx) + pattern::unit(h), float(cy) + pattern::unit(g),
                                        float(cz) + pattern::unit(e)};
      const float distance = rts::dot(d, d);
      if (distance < nearest) {
        nearest = distance;
        flake = h;
      }
    }
    if (!(pattern::unit(pattern::mix(flake + 3)) < flakes)) return false;
    // The tilt is distributed like GGX slopes: one number gives the tangent, another the direction.
    const float u = std::fmin(0.99f, pattern::unit(pattern::mix(flake + 4))),
                phi = 2 * rts::pi * pattern::unit(pattern::mix(flake + 5));
    const float slope = flakeSpread * std::sqrt(u / (1 - u));
    leaning = rts::normalize(
        rts::Frame(hit.normal).toWorld({slope * std::cos(phi), slope * std::sin(phi), 1}));
    // A flake that faces away from the eye or from the outside is not tilted.
    if (!(rts::dot(leaning, hit.geometric) > 0) || !(rts::dot(leaning, hit.direction) < 0))
      leaning = hit.normal;
    return true;
  }
};

} // namespace

RTS_PLUGIN(CarPaint)
