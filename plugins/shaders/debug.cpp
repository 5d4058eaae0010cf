// debug.cpp: shows what a shader sees of a hit as a colour, whatever the light. For people who look for mistakes in geometry;
// also the example of a shader written with openrts.hpp.
#include "openrt/openrts.hpp"

namespace {

struct Debug : rts::Surface<Debug> {
  static constexpr const char* text = "shows normals, texture coordinates or sides as colours";
  rts::Param<int32_t> show{"show", 0, "0: shading normal, 1: geometric normal, 2: texture coordinates, 3: front green, back red",
                           0, 3};

  rts::Shaded shade(const rts::Hit& hit) const {
    const rts::Color c = color(hit);
    return {c, {}, c};
  }

 private:
  // -1..1 becomes 0..1.
  static rts::Color ofNormal(rts::Vec3 n) { return {0.5f + 0.5f * n.x, 0.5f + 0.5f * n.y, 0.5f + 0.5f * n.z}; }
  static float fraction(float x) { return x - std::floor(x); }

  rts::Color color(const rts::Hit& hit) const {
    switch (show) {
    case 1: return ofNormal(hit.geometric);
    case 2: return {fraction(hit.uv.x), fraction(hit.uv.y), 0};
    case 3: return hit.back() ? rts::Color{1, 0, 0} : rts::Color{0, 1, 0};
    default: return ofNormal(hit.normal);
    }
  }
};

} // namespace

RTS_PLUGIN(Debug)
