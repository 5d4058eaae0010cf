// metal.cpp: the surface shader Metal, a conductor with a complex index of refraction, polished or
// rough. [render]
#include "microfacet.h"

namespace {

struct Metal : rts::Surface<Metal> {
  static constexpr const char* text = "metal by its complex index of refraction, polished or rough";
  rts::Param<rts::Color> n{
      "n", {1.35f, 0.96f, 0.62f}, "real part of the index, by colour (default: aluminium)", 0, 20};
  rts::Param<rts::Color> k{
      "k", {7.47f, 6.4f, 5.3f}, "imaginary part of the index, by colour", 0, 20};
  rts::Param<float> roughness{
      "roughness", 0, "width of the distribution of slopes (alpha of GGX); 0: polished", 0, 1};

  uint32_t needs() const {
    return roughness > microfacet::minAlpha ? RTS_GLOSSY : RTS_SPECULAR | RTS_NO_SCATTER;
  }
  void surface(const rts::Hit& hit, rts::Closures& out) const {
    const microfacet::Conductor metal{n, k};
    const rts::Color f = metal(hit.cosine());
    if (roughness > microfacet::minAlpha)
      out.custom({1, 1, 1}, microfacet::MicrofacetLobe<microfacet::Conductor>{roughness, metal});
    else
      out.reflection(f);
    out.albedo(f);
  }
};

} // namespace

RTS_PLUGIN(Metal)
