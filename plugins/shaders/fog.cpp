// fog.cpp: the surface shader Fog for a body of fog, smoke or dust: a medium that scatters, without
// a surface. Its faces point outwards, so a hit on a back face is inside the body. [render]
#include "openrt/openrts.hpp"

namespace {

struct Fog : rts::Surface<Fog> {
  static constexpr const char* text =
      "fog, smoke or dust inside a closed shape that is itself invisible; lamps, camera and other "
      "shapes may be inside";
  static constexpr uint32_t needs = RTS_SPECULAR | RTS_NO_SCATTER | RTS_MEDIUM_ONLY;
  rts::Param<rts::Color> scattering{
      "scattering",
      {0.1f, 0.1f, 0.1f},
      "scattering of light inside, per unit of length in the world: 1 / its mean free path",
      0,
      1e6f};
  rts::Param<rts::Color> absorption{
      "absorption",
      {0, 0, 0},
      "absorption of light inside, per unit of length in the world (Beer-Lambert)",
      0,
      1e6f};
  rts::Param<float> anisotropy{
      "anisotropy", 0,
      "mean cosine of the scattering angle (Henyey-Greenstein): 0 all directions alike, above 0 "
      "forwards (mist .8), below 0 backwards",
      -0.99f, 0.99f};
  rts::Param<int32_t> priority{"priority", 0,
                               "where bodies overlap, the one with the highest priority counts"};

  rts::Medium medium() const {
    return {{1, 1, 1}, absorption, priority, true, scattering, anisotropy};
  }
  // Where the body touches another medium, its surface refracts.
  template <class F> void surface(const rts::HitOf<F>&, rts::ClosuresOf<F>& out) const {
    out.dielectric({1, 1, 1}, F(1));
    out.albedo({1, 1, 1});
  }
  rts::Color transmit(const rts::Hit&) const { return {1, 1, 1}; }
};

} // namespace

RTS_PLUGIN(Fog)
