// immediate.cpp: Implements rtBegin, rtEnd and the API functions that set the current attributes
// and state. Runs on the application's thread.
#include <cmath>

#include "api/guard.h"

using namespace openrt;

namespace {

template <class... Values> bool finite(Values... values) { return (std::isfinite(values) && ...); }

void setNormal(Context& c, float x, float y, float z) {
  require(finite(x, y, z), RT_INVALID_VALUE, "a component is not finite");
  VertexState& v = c.currentAttributes();
  v.normal[0] = x;
  v.normal[1] = y;
  v.normal[2] = z;
  v.present |= HasNormal;
}

void setTexCoord(Context& c, float s, float t) {
  require(finite(s, t), RT_INVALID_VALUE, "a coordinate is not finite");
  VertexState& v = c.currentAttributes();
  v.texCoord[0] = s;
  v.texCoord[1] = t;
  v.present |= HasTexCoord;
}

void setColor(Context& c, float r, float g, float b, float a) {
  require(finite(r, g, b, a), RT_INVALID_VALUE, "a component is not finite");
  VertexState& v = c.currentAttributes();
  v.color[0] = r;
  v.color[1] = g;
  v.color[2] = b;
  v.color[3] = a;
  v.present |= HasColor;
}

void setFogCoord(Context& c, float share) {
  require(finite(share), RT_INVALID_VALUE, "the coordinate is not finite");
  VertexState& v = c.currentAttributes();
  v.fogCoord = share;
  v.present |= HasFogCoord;
}

void requirePointer(const void* pointer) {
  require(pointer != nullptr, RT_INVALID_VALUE, "the pointer is NULL");
}

ObjectBuilder& builder(Context& c) {
  if (!c.definition) [[unlikely]]
    c.openDefinition(); // this call throws
  return c.definition->builder;
}

void setCapability(Context& c, RTenum capability, bool on) {
  switch (capability) {
  case RT_CULL_FACE: c.cull = on; break;
  case RT_CW_FRONT: c.clockwise = on; break;
  default: fail(RT_INVALID_ENUM, "unknown capability " + std::to_string(capability));
  }
}

void setPixels(float& target, float pixels) {
  require(finite(pixels) && pixels > 0, RT_INVALID_VALUE, "the size must be positive and finite");
  target = pixels;
}

} // namespace

void rtBegin(RTenum mode) {
  guarded("rtBegin", [&](Context& c) {
    ObjectBuilder& b = builder(c);
    b.begin(mode, c.latch(primitiveOf(mode)));
  });
}

void rtEnd(void) {
  guarded("rtEnd", [](Context& c) { builder(c).end(); });
}

void rtVertex2f(float x, float y) {
  guarded("rtVertex2f", [&](Context& c) { builder(c).vertex(x, y, 0.0f); });
}

void rtVertex3f(float x, float y, float z) {
  guarded("rtVertex3f", [&](Context& c) { builder(c).vertex(x, y, z); });
}

void rtVertex3fv(const float* v) {
  guarded("rtVertex3fv", [&](Context& c) {
    requirePointer(v);
    builder(c).vertex(v[0], v[1], v[2]);
  });
}

void rtVertex3d(double x, double y, double z) {
  guarded("rtVertex3d", [&](Context& c) { builder(c).vertex(x, y, z); });
}

void rtVertex3dv(const double* v) {
  guarded("rtVertex3dv", [&](Context& c) {
    requirePointer(v);
    builder(c).vertex(v[0], v[1], v[2]);
  });
}

void rtNormal3f(float x, float y, float z) {
  guarded("rtNormal3f", [&](Context& c) { setNormal(c, x, y, z); });
}

void rtNormal3fv(const float* v) {
  guarded("rtNormal3fv", [&](Context& c) {
    requirePointer(v);
    setNormal(c, v[0], v[1], v[2]);
  });
}

void rtTexCoord2f(float s, float t) {
  guarded("rtTexCoord2f", [&](Context& c) { setTexCoord(c, s, t); });
}

void rtTexCoord2fv(const float* v) {
  guarded("rtTexCoord2fv", [&](Context& c) {
    requirePointer(v);
    setTexCoord(c, v[0], v[1]);
  });
}

void rtColor3f(float r, float g, float b) {
  guarded("rtColor3f", [&](Context& c) { setColor(c, r, g, b, 1); });
}

void rtColor3fv(const float* v) {
  guarded("rtColor3fv", [&](Context& c) {
    requirePointer(v);
    setColor(c, v[0], v[1], v[2], 1);
  });
}

void rtColor4f(float r, float g, float b, float a) {
  guarded("rtColor4f", [&](Context& c) { setColor(c, r, g, b, a); });
}

void rtColor4fv(const float* v) {
  guarded("rtColor4fv", [&](Context& c) {
    requirePointer(v);
    setColor(c, v[0], v[1], v[2], v[3]);
  });
}

void rtFogCoordf(float share) {
  guarded("rtFogCoordf", [&](Context& c) { setFogCoord(c, share); });
}

void rtTexGen(RTenum mode) {
  guarded("rtTexGen", [&](Context& c) {
    require(mode <= RT_TEX_GEN_SPHERE_REFLECTION, RT_INVALID_ENUM,
            "the mode must be one of RT_TEX_GEN_*");
    c.texGen = edit::TexGen(mode);
  });
}

void rtLineWidth(float pixels) {
  guarded("rtLineWidth", [&](Context& c) { setPixels(c.lineWidth, pixels); });
}

void rtPointSize(float pixels) {
  guarded("rtPointSize", [&](Context& c) { setPixels(c.pointSize, pixels); });
}

void rtLineStipple(int factor, uint16_t pattern) {
  guarded("rtLineStipple", [&](Context& c) {
    require(factor >= 1 && factor <= Stipple::largestFactor, RT_INVALID_VALUE,
            "the factor must be 1 to 256");
    c.stipple = {uint16_t(factor), pattern};
  });
}

void rtEnable(RTenum capability) {
  guarded("rtEnable", [&](Context& c) { setCapability(c, capability, true); });
}

void rtDisable(RTenum capability) {
  guarded("rtDisable", [&](Context& c) { setCapability(c, capability, false); });
}

void rtLoadName(uint32_t name) {
  guarded("rtLoadName", [&](Context& c) { c.name = name; });
}

void rtSphere(float radius) {
  guarded("rtSphere", [&](Context& c) {
    ObjectBuilder& b = builder(c);
    b.sphere(radius, c.latch(edit::Primitive::Sphere));
  });
}
