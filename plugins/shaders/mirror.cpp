// mirror.cpp: the surface shader Mirror, a mirror with the same reflectance at every angle.
// [render]
#include "openrt/openrts.hpp"

namespace {

struct Mirror : rts::Surface<Mirror> {
  static constexpr const char* text = "a perfect mirror of one reflectance in all directions";
  static constexpr uint32_t needs = RTS_SPECULAR | RTS_NO_SCATTER;
  rts::Param<rts::Color> reflectance{
      "reflectance", {0.9f, 0.9f, 0.9f}, "fraction reflected, 0..1", 0, 1};

  template <class F> void surface(const rts::HitOf<F>&, rts::ClosuresOf<F>& out) const {
    out.reflection(*reflectance);
    out.albedo(*reflectance);
  }
};

} // namespace

RTS_PLUGIN(Mirror)
