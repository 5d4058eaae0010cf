// roughglass.cpp: the surface shader RoughGlass for ground or frosted glass: a clear body with a
// rough surface, whose faces point outwards. [render]
#include "openrt/openrts.hpp"

namespace {

struct RoughGlass : rts::Surface<RoughGlass> {
  static constexpr const char* text =
      "ground glass: refraction and reflection at a rough surface, absorption inside";
  static constexpr uint32_t needs = RTS_GLOSSY;
  rts::Param<float> index{"index", 1.5f, "index of refraction, > 0", 0.1f, 10};
  rts::Param<float> roughness{"roughness", 0.2f,
                              "width of the distribution of slopes (alpha of GGX)", 0, 1};
  rts::Param<rts::Color> absorption{
      "absorption",
      {0, 0, 0},
      "absorption of light inside, per unit of length in the world (Beer-Lambert)"};
  rts::Param<rts::Color> tint{
      "tint", {1, 1, 1}, "tint of all light that hits the surface, 0..1", 0, 1};
  rts::Param<int32_t> priority{"priority", 0,
                               "where bodies overlap, the one with the highest priority counts"};
  rts::Param<rts::Color> scattering{
      "scattering",
      {0, 0, 0},
      "scattering of light inside, per unit of length in the world: milky glass, plastic, wax",
      0,
      1e6f};
  rts::Param<float> anisotropy{
      "anisotropy", 0,
      "mean cosine of the angle of that scattering (Henyey-Greenstein); 0: all directions alike",
      -0.99f, 0.99f};

  rts::Medium medium() const {
    return {{index, index, index}, absorption, priority, true, scattering, anisotropy};
  }
  template <class F> void surface(const rts::HitOf<F>& hit, rts::ClosuresOf<F>& out) const {
    out.roughDielectric(*tint, rts::select(hit.back(), float(index), 1 / float(index)),
                        float(roughness));
    out.albedo({1, 1, 1});
  }
};

} // namespace

RTS_PLUGIN(RoughGlass)
