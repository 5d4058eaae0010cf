// phong.cpp: the surface shader Phong, a Lambertian surface with a highlight. It looks like
// VRML97's material but conserves energy, so it suits global illumination. [render]
#include "blinn_phong.h"

namespace {

struct Phong : rts::Surface<Phong> {
  static constexpr const char* text =
      "even scattering and a Blinn-Phong highlight; reciprocal, keeps energy";
  rts::Param<rts::Color> diffuseColor{
      "diffuseColor", {0.6f, 0.6f, 0.6f}, "diffuse reflectance", 0, 1, rts::PerVertex};
  rts::Param<rts::Color> specularColor{
      "specularColor",
      {0.3f, 0.3f, 0.3f},
      "fraction of light in the highlight, 0..1; with diffuseColor it is scaled to at most 1",
      0,
      1};
  rts::Param<float> shininess{"shininess", 0.2f, "exponent of the highlight over 128, as in VRML97",
                              0, 7812.5f};
  rts::Param<rts::Texture> texture{"texture", "multiplies diffuseColor"};

  uint32_t needs() const { return rts::largest(specularColor) > 0 ? RTS_GLOSSY : 0; }
  template <class F> void surface(const rts::HitOf<F>& hit, rts::ClosuresOf<F>& out) const {
    const rts::Vec4Of<F> t = hit.sample(texture, hit.uv);
    const rts::ColorOf<F> albedo = *diffuseColor * rts::ColorOf<F>{t.x, t.y, t.z} *
                                   rts::ColorOf<F>{hit.color.x, hit.color.y, hit.color.z};
    const rts::ColorOf<F> both = albedo + *specularColor;
    const rts::ColorOf<F> scale{kept(both.r), kept(both.g), kept(both.b)};
    out.diffuse(scale * albedo);
    out.coat();
    out.custom(scale * *specularColor, blinn_phong::Lobe{128 * shininess});
    out.albedo(scale * albedo);
  }

 private:
  template <class F> static F kept(F sum) { return rts::select(sum > 1, 1 / sum, 1); }
};

} // namespace

RTS_PLUGIN(Phong)
