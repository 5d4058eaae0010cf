// reflector.cpp: the surface shader Reflector for the inside of headlamps: almost polished metal
// under a thin clear lacquer, with dust. [render]
#include "microfacet.h"

namespace {

// Fresnel term of metal below a lossless clear layer. All inter-reflections are summed, without
// interference.
struct Lacquered {
  rts::Color n, k;
  float index; // index of the layer; up to 1: no layer

  rts::Color operator()(float cosine) const {
    if (!(index > 1)) return microfacet::Conductor{n, k}(cosine);
    double below = 1;
    const double top = rts::fresnel(cosine, 1 / double(index), &below);
    return {sum(top, below, n.r, k.r), sum(top, below, n.g, k.g), sum(top, below, n.b, k.b)};
  }

 private:
  float sum(double top, double below, float re, float im) const {
    const double metal = microfacet::conductor(below, re / double(index), im / double(index));
    return static_cast<float>(top + (1 - top) * (1 - top) * metal / (1 - top * metal));
  }
};

struct Reflector : rts::Surface<Reflector> {
  static constexpr const char* text =
      "headlamp reflector: metal under clear lacquer, nearly polished, with dust on it";
  rts::Param<rts::Color> n{"n",
                           {1.35f, 0.96f, 0.62f},
                           "real part of the metal's index, by colour (default: aluminium)",
                           0,
                           20};
  rts::Param<rts::Color> k{
      "k", {7.47f, 6.4f, 5.3f}, "imaginary part of the metal's index, by colour", 0, 20};
  rts::Param<float> lacquer{"lacquer", 1.5f, "index of refraction of the lacquer; 1: none", 1, 3};
  rts::Param<float> roughness{
      "roughness", 0, "width of the distribution of slopes (alpha of GGX); 0: polished", 0, 1};
  rts::Param<float> dust{"dust", 0, "fraction of the surface that is covered", 0, 1};
  rts::Param<rts::Color> dustColor{
      "dustColor", {0.3f, 0.27f, 0.22f}, "fraction of light that dust scatters, 0..1", 0, 1};

  uint32_t needs() const {
    if (roughness > microfacet::minAlpha) return RTS_GLOSSY;
    return dust > 0 ? RTS_SPECULAR : RTS_SPECULAR | RTS_NO_SCATTER;
  }
  void surface(const rts::Hit& hit, rts::Closures& out) const {
    const Lacquered metal{n, k, lacquer};
    const rts::Color clean = metal(hit.cosine());
    const float bare = 1 - dust;
    out.coat(dust > 0);
    if (roughness > microfacet::minAlpha)
      out.custom({bare, bare, bare}, microfacet::MicrofacetLobe<Lacquered>{roughness, metal});
    else
      out.reflection(bare * clean);
    out.coat(false);
    if (dust > 0) out.diffuse(float(dust) * *dustColor);
    out.albedo(bare * clean + float(dust) * *dustColor);
  }
};

} // namespace

RTS_PLUGIN(Reflector)
