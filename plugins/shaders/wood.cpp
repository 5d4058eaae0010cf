// wood.cpp: the surface shader Wood, a solid texture of rings about an axis, with grain. [render]
#include "coat.h"
#include "pattern.h"

namespace {

struct Wood : rts::Surface<Wood> {
  static constexpr const char* text =
      "carved from wood: rings about an axis, grain along it, varnish";
  rts::Param<rts::Color> light{
      "light", {0.62f, 0.38f, 0.18f}, "fraction of light that early wood scatters, 0..1", 0, 1};
  rts::Param<rts::Color> dark{
      "dark", {0.3f, 0.14f, 0.05f}, "fraction of light that late wood scatters, 0..1", 0, 1};
  rts::Param<rts::Vec3> axis{"axis", {0, 1, 0}, "direction of the trunk, in the object's space"};
  rts::Param<rts::Vec3> pith{"pith", {0, 0, 0}, "a point on the axis of the trunk"};
  rts::Param<float> rings{"rings", 8, "rings per unit of length", 0, 1e6f};
  rts::Param<float> wobble{"wobble", 0.4f, "how uneven the rings are, in rings", 0, 10};
  rts::Param<float> grain{"grain", 0.3f, "how strong the fine grain is", 0, 1};
  rts::Param<float> varnish{"varnish", 1, "index of refraction of the varnish; 1: none", 1, 3};

  uint32_t needs() const { return varnish > 1.001f ? RTS_SPECULAR | RTS_GLOSSY : 0; }
  void surface(const rts::Hit& hit, rts::Closures& out) const {
    coat::add(hit, out, colour(pattern::positionBeneath(hit, rings > 0 ? 1 / float(rings) : 1)),
              varnish);
  }

 private:
  rts::Color colour(rts::Vec3 place) const {
    const rts::Vec3 a = rts::length(axis) > 0 ? rts::normalize(axis) : rts::Vec3{0, 1, 0};
    const rts::Vec3 p = float(rings) * (place - *pith);
    const rts::Vec3 local = rts::Frame(a).toLocal(p);
    const float across = std::sqrt(local.x * local.x + local.y * local.y);
    // The pattern changes slowly along the trunk, as fibres run along it.
    const float ring =
        across + wobble * pattern::turbulence({0.3f * local.x, 0.3f * local.y, 0.05f * local.z}, 3);
    const float phase = ring - std::floor(ring);
    // Early wood changes gradually to late wood; the ring then ends abruptly.
    const float late =
        std::fabs(phase) < 2 ? phase * phase * (phase < 0.9f ? 1 : 10 * (1 - phase)) : 0;
    const float fine = 0.5f + 0.5f * pattern::noise({12 * local.x, 12 * local.y, 0.6f * local.z});
    const rts::Color plain = pattern::lerp(light, dark, late);
    return plain * (1 - 0.5f * grain * fine);
  }
};

} // namespace

RTS_PLUGIN(Wood)
