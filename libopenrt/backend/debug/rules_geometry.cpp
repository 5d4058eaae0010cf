// rules_geometry.cpp: rules about the vertices of one object. Application thread.

#include "backend/debug/rules.h"

namespace openrt::debug {
namespace {

Vec3d at(const ArrayPtr& array, size_t i) { return Vec3d(vectorOf(array->as<float>() + 3 * i)); }

// Reports float coordinates whose precision is coarse compared to the object's size. Positions
// given in double never have this problem, because they get an origin of their own.
void farFromOrigin(uint32_t id, const Object& object, const RuleContext&, const Report& report) {
  constexpr double steps = 1 << 14; // smallest number of float steps across a geometry
  for (const Geometry& g : object.geometries) {
    if (!g.points || g.points->count<float>() < 6) continue;
    Vec3d low{1e300, 1e300, 1e300}, high = -low;
    for (size_t i = 0; i < g.points->count<float>() / 3; i++) {
      low = min(low, at(g.points, i));
      high = max(high, at(g.points, i));
    }
    const double extent = largest(high - low), reach = largest(max(abs(low), abs(high)));
    if (extent > 0 && reach * 0x1p-23 * steps > extent)
      report(id, nameOf("object", id) + " is " + std::to_string(extent) + " large and " +
                     std::to_string(reach) +
                     " away from the origin, where coordinates in float are too coarse: give them "
                     "in double (rtVertex3d, RT_DOUBLE), or relative to the object's centre and "
                     "place it with rtTranslated");
  }
}

struct Orientation {
  size_t triangles = 0, opposite = 0; // triangles whose normals oppose their winding
  // Sum of the area vectors; 0 for a closed surface.
  Vec3d area;
  double total = 0, volume = 0;
};

Orientation orientationOf(const Geometry& g) {
  Orientation s;
  const uint32_t* index = g.indices->as<uint32_t>();
  const double turn = g.clockwise ? -1 : 1;
  const Vec3d middle = at(g.points, index[0]);
  for (size_t t = 0; t < g.primitives(); t++, index += 3) {
    const Vec3d a = at(g.points, index[0]), b = at(g.points, index[1]), c = at(g.points, index[2]);
    const Vec3d n = cross(b - a, c - a) * (0.5 * turn);
    s.triangles++;
    s.area = s.area + n;
    s.total += length(n);
    s.volume += dot(a - middle, n) / 3;
    if (!g.normals) continue;
    bool opposite = true;
    for (int k = 0; k < 3; k++) opposite = opposite && dot(at(g.normals, index[k]), n) < 0;
    s.opposite += opposite;
  }
  return s;
}

void wrongSides(uint32_t id, const Object& object, const RuleContext&, const Report& report) {
  for (const Geometry& g : object.geometries) {
    if (g.primitive != edit::Primitive::Triangles || !g.points || !g.indices || g.primitives() == 0)
      continue;
    const Orientation s = orientationOf(g);
    if (2 * s.opposite > s.triangles)
      report(id, std::to_string(s.opposite) + " of " + std::to_string(s.triangles) +
                     " triangles of " + nameOf("object", id) +
                     " have normals that disagree with the order of their corners: reverse the "
                     "normals or the order, or call rtEnable(RT_CW_FRONT)");
    const bool closed = s.triangles >= 4 && length(s.area) < 1e-3 * s.total;
    if (g.cull && closed && s.volume < 0)
      report(id, nameOf("object", id) +
                     " is closed, its faces look inwards and RT_CULL_FACE is on, so its near side "
                     "is invisible from outside: reverse the order of the corners, or RT_CW_FRONT "
                     "(mirrored matrices are compensated)");
  }
}

constexpr ObjectRule table[] = {{"far-from-origin", farFromOrigin}, {"wrong-side", wrongSides}};

} // namespace

std::span<const ObjectRule> objectRules() { return table; }

} // namespace openrt::debug
