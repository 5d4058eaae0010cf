// diffuse.cpp: the surface shader Diffuse, a Lambertian surface that may emit light. [render]
#include "openrt/openrts.hpp"

namespace {

struct Diffuse : rts::Surface<Diffuse> {
  static constexpr const char* text = "scatters light evenly and may emit light";
  rts::Param<rts::Color> reflectance{
      "reflectance", {0.8f, 0.8f, 0.8f}, "fraction of light scattered, 0..1", 0, 1, rts::PerVertex};
  rts::Param<rts::Color> emission{"emission", {0, 0, 0}, "emitted radiance"};
  rts::Param<rts::Texture> texture{"texture", "multiplies reflectance"};

  bool emits() const { return rts::largest(emission) > 0; }
  bool emitsUniformly() const { return true; }
  uint32_t needs() const { return rts::largest(reflectance) > 0 ? 0 : RTS_NO_SCATTER; }
  template <class F> void surface(const rts::HitOf<F>& hit, rts::ClosuresOf<F>& out) const {
    const rts::Vec4Of<F> texel = hit.sample(texture, hit.uv);
    const rts::ColorOf<F> albedo = *reflectance * rts::ColorOf<F>{texel.x, texel.y, texel.z} *
                                   rts::ColorOf<F>{hit.color.x, hit.color.y, hit.color.z};
    out.diffuse(albedo);
    out.emission(*emission);
    out.albedo(albedo);
  }
};

} // namespace

RTS_PLUGIN(Diffuse)
