// debug.cpp: the surface shader Debug, which shows an attribute of the hit as a colour, independent
// of lights. It helps to find errors in geometry, and is an example of a shader with openrts.hpp.
#include "openrt/openrts.hpp"
#include "pattern.h"

namespace {

struct Debug : rts::Surface<Debug> {
  static constexpr const char* text =
      "shows normals, texture coordinates, sides, ids, distances as colours";
  rts::Param<int32_t> show{
      "show", 0,
      "0: shading normal, 1: geometric normal, 2: texture coordinates, 3: front green, back red, "
      "4: name, 5: instance, 6: triangle, 7: distance, 8: number of surfaces hit before, 9, 10: "
      "direction of growing s, t, 11: place in the object, 12: colour of the geometry",
      0, 12};
  rts::Param<float> scale{"scale", 1,
                          "distance, depth or length of the object that is shown as white, or as "
                          "one turn of the colours",
                          1e-30f, 1e30f};

  rts::Shaded shade(const rts::Hit& hit) const {
    const rts::Color c = color(hit);
    return {c, {}, c};
  }

 private:
  // Maps components from -1..1 to 0..1.
  static rts::Color ofNormal(rts::Vec3 n) {
    return {0.5f + 0.5f * n.x, 0.5f + 0.5f * n.y, 0.5f + 0.5f * n.z};
  }
  static float fraction(float x) { return x - std::floor(x); }
  // Returns a different colour for every number; 0 is black.
  static rts::Color ofId(uint32_t id) {
    const uint32_t h = pattern::mix(id);
    return id == 0 ? rts::Color{}
                   : rts::Color{0.2f + 0.8f * pattern::unit(h), 0.2f + 0.8f * pattern::unit(h << 8),
                                0.2f + 0.8f * pattern::unit(h << 16)};
  }
  static rts::Color grey(float x) { return {x, x, x}; }

  rts::Color color(const rts::Hit& hit) const {
    switch (show) {
    case 1: return ofNormal(hit.geometric);
    case 2: return {fraction(hit.uv.x), fraction(hit.uv.y), 0};
    case 3: return hit.back() ? rts::Color{1, 0, 0} : rts::Color{0, 1, 0};
    case 4: return ofId(hit.ids().name);
    case 5: return ofId(hit.ids().instance);
    case 6: return ofId(hit.ids().primitive + 1);
    case 7: return grey(hit.distance / scale);
    case 8: return grey(float(hit.depth()) / scale);
    case 9: return ofNormal(rts::normalize(hit.derivatives().alongS));
    case 10: return ofNormal(rts::normalize(hit.derivatives().alongT));
    case 11: {
      const rts::Vec3 p = hit.local().position * (1 / float(scale));
      return {fraction(p.x), fraction(p.y), fraction(p.z)};
    }
    case 12: return {hit.color.x, hit.color.y, hit.color.z};
    default: return ofNormal(hit.normal);
    }
  }
};

} // namespace

RTS_PLUGIN(Debug)
