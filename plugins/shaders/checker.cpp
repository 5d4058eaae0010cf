// checker.cpp: the surface shader Checker, a solid texture of cubes in two colours. [render]
#include "coat.h"
#include "pattern.h"

namespace {

struct Checker : rts::Surface<Checker> {
  static constexpr const char* text = "carved from cubes of two colours";
  rts::Param<rts::Color> even{"even",
                              {0.8f, 0.8f, 0.8f},
                              "fraction of light scattered by the cube at the origin, 0..1",
                              0,
                              1};
  rts::Param<rts::Color> odd{"odd",
                             {0.1f, 0.1f, 0.1f},
                             "fraction of light scattered by the neighbouring cubes, 0..1",
                             0,
                             1};
  rts::Param<rts::Vec3> size{
      "size",
      {1, 1, 1},
      "edges of the cubes, in units of the object; 0: no change along this axis"};
  rts::Param<float> coating{"coating", 1, "index of refraction of a clear coating; 1: none", 1, 3};

  uint32_t needs() const { return coating > 1.001f ? RTS_SPECULAR | RTS_GLOSSY : 0; }
  template <class F> void surface(const rts::HitOf<F>& hit, rts::ClosuresOf<F>& out) const {
    const rts::Vec3Of<F> p =
        pattern::positionBeneath(hit, std::fmax(size->x, std::fmax(size->y, size->z)));
    const auto isOdd = [&](float x, float y, float z) {
      return float((number(x, size->x) + number(y, size->y) + number(z, size->z)) & 1);
    };
    const rts::ColorOf<F> albedo =
        rts::select(rts::eachLane(isOdd, p.x, p.y, p.z) > 0, *odd, *even);
    coat::add(hit, out, albedo, coating);
  }

 private:
  static int32_t number(float x, float edge) { return edge > 0 ? pattern::cell(x / edge) : 0; }
};

} // namespace

RTS_PLUGIN(Checker)
