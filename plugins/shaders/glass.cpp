// glass.cpp: a clear solid body with a smooth surface. Its faces point outwards: what is met from behind is met inside.
#include "openrt/openrts.hpp"

namespace {

struct Glass : rts::Surface<Glass> {
  static constexpr const char* text = "clear glass: Fresnel reflection and refraction, absorption inside";
  rts::Param<float> index{"index", 1.5f, "index of refraction against what is outside, > 0", 0.1f, 10};
  rts::Param<rts::Color> absorption{"absorption", {0, 0, 0}, "of light inside, per unit of length in the world (Beer-Lambert)"};
  rts::Param<rts::Color> tint{"tint", {1, 1, 1}, "of all light that meets the surface, 0..1", 0, 1};
  rts::Param<int32_t> shadow{"shadow", 0, "1: opaque to the straight rays that ask for lights; 0: lets them through unbent", 0,
                             1};

  void surface(const rts::Hit& hit, rts::Closures& out) const {
    const bool inside = hit.back();
    const rts::Color left = inside ? *tint * absorbed(hit.segment) : *tint;
    out.dielectric(left, inside ? float(index) : 1 / float(index));
    out.albedo({1, 1, 1});
  }
  // Light on the straight way through: what a surface met head on lets pass.
  rts::Color transmit(const rts::Hit&) const {
    if (shadow) return {};
    const float r = (float(index) - 1) / (float(index) + 1);
    return *tint * (1 - r * r);
  }

 private:
  rts::Color absorbed(float way) const {
    return {std::exp(-absorption->r * way), std::exp(-absorption->g * way), std::exp(-absorption->b * way)};
  }
};

} // namespace

RTS_PLUGIN(Glass)
