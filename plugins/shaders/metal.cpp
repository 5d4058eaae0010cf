// metal.cpp: polished metal.
#include "openrt/openrts.hpp"

namespace {

// Fresnel's equations with a complex index n + ik (M. Born, E. Wolf, "Principles of Optics", 14.2), unpolarised.
struct Metal : rts::Surface<Metal> {
  static constexpr const char* text = "polished metal by its complex index of refraction";
  rts::Param<rts::Color> n{"n", {1.35f, 0.96f, 0.62f}, "real part of the index, by colour (default: aluminium)"};
  rts::Param<rts::Color> k{"k", {7.47f, 6.4f, 5.3f}, "imaginary part of the index, by colour"};

  void surface(const rts::Hit& hit, rts::Closures& out) const {
    const float c = std::fmin(1.0f, std::fabs(rts::dot(hit.direction, hit.normal)));
    const rts::Color f{reflectance(c, n->r, k->r), reflectance(c, n->g, k->g), reflectance(c, n->b, k->b)};
    out.reflection(f);
    out.albedo(f);
  }

  static float reflectance(double cosine, double n, double k) {
    const double c2 = cosine * cosine, s2 = 1 - c2, t = n * n - k * k - s2;
    const double ab = std::sqrt(t * t + 4 * n * n * k * k); // a^2 + b^2
    const double a = std::sqrt(std::fmax(0.0, (ab + t) / 2));
    const double s = (ab - 2 * a * cosine + c2) / (ab + 2 * a * cosine + c2);
    const double p = s * (c2 * ab - 2 * a * cosine * s2 + s2 * s2) / (c2 * ab + 2 * a * cosine * s2 + s2 * s2);
    return static_cast<float>((s + p) / 2);
  }
};

} // namespace

RTS_PLUGIN(Metal)
