// glass.cpp: the surface shader Glass, a clear solid body with a smooth surface. Its faces point
// outwards, so a hit on a back face is inside the body. [render]
#include "openrt/openrts.hpp"

namespace {

struct Glass : rts::Surface<Glass> {
  static constexpr const char* text =
      "clear glass: Fresnel reflection and refraction, absorption and dispersion inside";
  static constexpr uint32_t needs = RTS_SPECULAR | RTS_NO_SCATTER;
  rts::Param<float> index{"index", 1.5f, "index of refraction (of yellow light, 587.6 nm), > 0",
                          0.1f, 10};
  rts::Param<float> abbe{
      "abbe", 0,
      "Abbe number: how little the index depends on the colour (crown 60, flint 30); 0: not at all",
      0, 1000};
  rts::Param<rts::Color> indexByColor{
      "indexByColor",
      {0, 0, 0},
      "index of refraction for red, green and blue; a value above 0 replaces index and abbe",
      0,
      10};
  rts::Param<rts::Color> absorption{
      "absorption",
      {0, 0, 0},
      "absorption of light inside, per unit of length in the world (Beer-Lambert)"};
  rts::Param<rts::Color> tint{
      "tint", {1, 1, 1}, "tint of all light that hits the surface, 0..1", 0, 1};
  rts::Param<int32_t> priority{"priority", 0,
                               "where bodies overlap, the one with the highest priority counts"};
  rts::Param<int32_t> shadow{
      "shadow", 0, "1: blocks shadow rays; 0: lets shadow rays pass straight through", 0, 1};
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
    return {{indexAt(0.6114f, indexByColor->r), indexAt(0.5491f, indexByColor->g),
             indexAt(0.4642f, indexByColor->b)},
            absorption,
            priority,
            true,
            scattering,
            anisotropy};
  }
  template <class F> void surface(const rts::HitOf<F>& hit, rts::ClosuresOf<F>& out) const {
    // An engine that knows media uses their indices instead.
    out.dielectric(*tint, rts::select(hit.back(), float(index), 1 / float(index)));
    out.albedo({1, 1, 1});
  }
  // Shadow rays pass straight through, with the transmittance of normal incidence.
  rts::Color transmit(const rts::Hit&) const {
    if (shadow) return {};
    const float r = (float(index) - 1) / (float(index) + 1);
    return *tint * (1 - r * r);
  }

 private:
  // Returns the index at a wavelength (micrometres) by Cauchy's equation n = A + B / w^2. It is
  // fitted to the index at the d line and to the Abbe number, which is defined by the F and C
  // lines. Called with the dominant wavelengths of the sRGB primaries.
  float indexAt(float wavelength, float given) const {
    if (given > 0) return given;
    if (!(abbe > 0)) return index;
    constexpr double d = 0.58756, f = 0.48613, c = 0.65627;
    const double b = (double(index) - 1) / (double(abbe) * (1 / (f * f) - 1 / (c * c)));
    return static_cast<float>(index +
                              b * (1 / (double(wavelength) * double(wavelength)) - 1 / (d * d)));
  }
};

} // namespace

RTS_PLUGIN(Glass)
