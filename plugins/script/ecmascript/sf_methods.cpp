// sf_methods.cpp: Implements the methods of colours, rotations and vectors (C.6.4, C.6.7 to C.6.9;
// X3D's types have those of VRML97's types alike, ISO/IEC 19777-1 7.6).
#include <algorithm>
#include <cmath>
#include <cstring>

#include "slots.h"

namespace ecma {
namespace {

// Returns the object that a method is called on; it stays on the stack.
SfData* receiver(duk_context* ctx, XsType type, const char* method) {
  step(Interpreter::of(ctx));
  duk_push_this(ctx);
  SfData* data = sfData(ctx, -1);
  if (!data || data->type != type)
    throwType(ctx, "%s.%s: must be called on an %s", typeName(type), method, typeName(type));
  return data;
}

void argument(duk_context* ctx, XsType type, double* out, const char* what) {
  toPlain(ctx, 0, type, out, what);
}

duk_ret_t answer(duk_context* ctx, XsType type, const double* v) {
  pushSf(ctx, Interpreter::of(ctx), type, v);
  return 1;
}

// --- Vectors: the type is the function's magic number ---

XsType vectorType(duk_context* ctx) { return XsType(duk_get_current_magic(ctx)); }

template <class Combine> duk_ret_t combine(duk_context* ctx, const char* name, Combine&& each) {
  const XsType type = vectorType(ctx);
  const SfData* a = receiver(ctx, type, name);
  double b[4] = {}, v[4] = {};
  argument(ctx, type, b, name);
  for (int i = 0; i < components(type); ++i) v[i] = each(a->v[i], b[i]);
  return answer(ctx, type, v);
}
template <class Scale> duk_ret_t scaled(duk_context* ctx, const char* name, Scale&& each) {
  const XsType type = vectorType(ctx);
  const SfData* a = receiver(ctx, type, name);
  double v[4] = {};
  for (int i = 0; i < components(type); ++i) v[i] = each(a->v[i]);
  return answer(ctx, type, v);
}

double lengthOf(const SfData* a) {
  double sum = 0;
  for (int i = 0; i < components(a->type); ++i) sum += a->v[i] * a->v[i];
  return std::sqrt(sum);
}

duk_ret_t add(duk_context* ctx) {
  return combine(ctx, "add", [](double a, double b) { return a + b; });
}
duk_ret_t subtract(duk_context* ctx) {
  return combine(ctx, "subtract", [](double a, double b) { return a - b; });
}
duk_ret_t multiply(duk_context* ctx) {
  const double n = toNumber(ctx, 0, XS_SFFLOAT, "multiply");
  return scaled(ctx, "multiply", [n](double a) { return a * n; });
}
duk_ret_t divide(duk_context* ctx) {
  const double n = toNumber(ctx, 0, XS_SFFLOAT, "divide");
  return scaled(ctx, "divide", [n](double a) { return a / n; });
}
duk_ret_t negate(duk_context* ctx) {
  return scaled(ctx, "negate", [](double a) { return a == 0 ? 0 : -a; });
}
duk_ret_t dot(duk_context* ctx) {
  const XsType type = vectorType(ctx);
  const SfData* a = receiver(ctx, type, "dot");
  double b[4], sum = 0;
  argument(ctx, type, b, "dot");
  for (int i = 0; i < components(type); ++i) sum += a->v[i] * b[i];
  duk_push_number(ctx, sum);
  return 1;
}
duk_ret_t length(duk_context* ctx) {
  duk_push_number(ctx, lengthOf(receiver(ctx, vectorType(ctx), "length")));
  return 1;
}
// Normalizing a zero vector returns a zero vector.
duk_ret_t normalize(duk_context* ctx) {
  const double n = lengthOf(receiver(ctx, vectorType(ctx), "normalize"));
  duk_pop(ctx);
  return scaled(ctx, "normalize", [n](double a) { return n > 0 ? a / n : a; });
}
duk_ret_t cross(duk_context* ctx) {
  const SfData* a = receiver(ctx, vectorType(ctx), "cross");
  double b[4];
  argument(ctx, vectorType(ctx), b, "cross");
  const double v[4] = {a->v[1] * b[2] - a->v[2] * b[1], a->v[2] * b[0] - a->v[0] * b[2],
                       a->v[0] * b[1] - a->v[1] * b[0], 0};
  return answer(ctx, vectorType(ctx), v);
}

// --- SFColor and SFColorRGBA: hue in degrees ---

duk_ret_t setHsv(duk_context* ctx) {
  SfData* c = receiver(ctx, vectorType(ctx), "setHSV");
  const double h = toNumber(ctx, 0, XS_SFFLOAT, "setHSV"),
               s = toNumber(ctx, 1, XS_SFFLOAT, "setHSV"),
               v = toNumber(ctx, 2, XS_SFFLOAT, "setHSV");
  const double turned = std::isfinite(h) ? h - 360 * std::floor(h / 360) : 0,
               sector = std::floor(turned / 60);
  const double f = turned / 60 - sector, p = v * (1 - s), q = v * (1 - s * f),
               t = v * (1 - s * (1 - f));
  const double table[6][3] = {{v, t, p}, {q, v, p}, {p, v, t}, {p, q, v}, {t, p, v}, {v, p, q}};
  std::memcpy(c->v, table[std::clamp(int(sector), 0, 5)], 3 * sizeof *c->v);
  writeBack(ctx, Interpreter::of(ctx), -1, c, 0, 3);
  return 0;
}

duk_ret_t getHsv(duk_context* ctx) {
  const double* c = receiver(ctx, vectorType(ctx), "getHSV")->v;
  const double most = std::max({c[0], c[1], c[2]}), delta = most - std::min({c[0], c[1], c[2]});
  double h = 0;
  if (delta > 0) {
    h = most == c[0]   ? (c[1] - c[2]) / delta
        : most == c[1] ? 2 + (c[2] - c[0]) / delta
                       : 4 + (c[0] - c[1]) / delta;
    h = h < 0 ? h * 60 + 360 : h * 60;
  }
  const double hsv[] = {h, most > 0 ? delta / most : 0, most};
  duk_push_array(ctx);
  for (duk_uarridx_t i = 0; i < 3; ++i) {
    duk_push_number(ctx, hsv[i]);
    duk_put_prop_index(ctx, -2, i);
  }
  return 1;
}

// --- SFRotation ---

struct Quaternion {
  double x, y, z, w;
};

Quaternion quaternionOf(const double* r) {
  const double length = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]),
               s = length > 0 ? std::sin(r[3] / 2) / length : 0;
  return {r[0] * s, r[1] * s, r[2] * s, length > 0 ? std::cos(r[3] / 2) : 1};
}

void rotationOf(Quaternion q, double* r) {
  const double s = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
  const bool none = !(s > 1e-12 * std::fabs(q.w));
  r[0] = none ? 0 : q.x / s;
  r[1] = none ? 0 : q.y / s;
  r[2] = none ? 1 : q.z / s;
  r[3] = none ? 0 : 2 * std::atan2(s, q.w);
}

duk_ret_t getAxis(duk_context* ctx) {
  const SfData* r = receiver(ctx, XS_SFROTATION, "getAxis");
  const double v[4] = {r->v[0], r->v[1], r->v[2], 0};
  return answer(ctx, XS_SFVEC3F, v);
}
duk_ret_t setAxis(duk_context* ctx) {
  SfData* r = receiver(ctx, XS_SFROTATION, "setAxis");
  double axis[4];
  argument(ctx, XS_SFVEC3F, axis, "setAxis");
  std::memcpy(r->v, axis, 3 * sizeof *axis);
  writeBack(ctx, Interpreter::of(ctx), -1, r, 0, 3);
  return 0;
}
duk_ret_t inverse(duk_context* ctx) {
  const SfData* r = receiver(ctx, XS_SFROTATION, "inverse");
  const double v[4] = {r->v[0], r->v[1], r->v[2], r->v[3] == 0 ? 0 : -r->v[3]};
  return answer(ctx, XS_SFROTATION, v);
}

// Multiplies as quaternions a b: (a.multiply(b)).multVec(v) equals a.multVec(b.multVec(v)).
duk_ret_t multiplyRotation(duk_context* ctx) {
  const Quaternion a = quaternionOf(receiver(ctx, XS_SFROTATION, "multiply")->v);
  double other[4], v[4];
  argument(ctx, XS_SFROTATION, other, "multiply");
  const Quaternion b = quaternionOf(other);
  rotationOf({a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
              a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
              a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
              a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z},
             v);
  return answer(ctx, XS_SFROTATION, v);
}

duk_ret_t multVec(duk_context* ctx) {
  const Quaternion q = quaternionOf(receiver(ctx, XS_SFROTATION, "multVec")->v);
  double p[4];
  argument(ctx, XS_SFVEC3F, p, "multVec");
  // p + 2 w (u x p) + 2 u x (u x p), u the vector part
  const double cx = q.y * p[2] - q.z * p[1], cy = q.z * p[0] - q.x * p[2],
               cz = q.x * p[1] - q.y * p[0];
  const double v[4] = {p[0] + 2 * (q.w * cx + q.y * cz - q.z * cy),
                       p[1] + 2 * (q.w * cy + q.z * cx - q.x * cz),
                       p[2] + 2 * (q.w * cz + q.x * cy - q.y * cx), 0};
  return answer(ctx, XS_SFVEC3F, v);
}

// Interpolates along the shorter path (K. Shoemake, "Animating rotation with quaternion curves",
// 1985).
duk_ret_t slerp(duk_context* ctx) {
  const SfData* from = receiver(ctx, XS_SFROTATION, "slerp");
  double to[4], v[4];
  argument(ctx, XS_SFROTATION, to, "slerp");
  const double t = toNumber(ctx, 1, XS_SFFLOAT, "slerp");
  if (t == 0 || t == 1) return answer(ctx, XS_SFROTATION, t == 0 ? from->v : to);
  const Quaternion a = quaternionOf(from->v);
  Quaternion b = quaternionOf(to);
  double cosine = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
  if (cosine < 0) {
    b = {-b.x, -b.y, -b.z, -b.w};
    cosine = -cosine;
  }
  const double angle = std::acos(std::min(cosine, 1.0)), sine = std::sin(angle);
  const bool near = sine < 1e-6;
  const double wa = near ? 1 - t : std::sin((1 - t) * angle) / sine,
               wb = near ? t : std::sin(t * angle) / sine;
  rotationOf({wa * a.x + wb * b.x, wa * a.y + wb * b.y, wa * a.z + wb * b.z, wa * a.w + wb * b.w},
             v);
  return answer(ctx, XS_SFROTATION, v);
}

constexpr Method vectorMethods[] = {
    {"add", add, 1},       {"subtract", subtract, 1},   {"multiply", multiply, 1},
    {"divide", divide, 1}, {"negate", negate, 0},       {"dot", dot, 1},
    {"length", length, 0}, {"normalize", normalize, 0}, {"toString", notationMethod, 0}};
constexpr Method vector3Methods[] = {{"cross", cross, 1}};
constexpr Method colorMethods[] = {
    {"setHSV", setHsv, 3}, {"getHSV", getHsv, 0}, {"toString", notationMethod, 0}};
constexpr Method rotationMethods[] = {
    {"getAxis", getAxis, 0},        {"setAxis", setAxis, 1}, {"inverse", inverse, 0},
    {"multVec", multVec, 1},        {"slerp", slerp, 2},     {"multiply", multiplyRotation, 1},
    {"toString", notationMethod, 0}};
constexpr Method textMethods[] = {{"toString", notationMethod, 0}};

template <size_t n>
void put(duk_context* ctx, Interpreter& self, XsType type, const Method (&methods)[n]) {
  duk_push_heapptr(ctx, self.prototypes[type]);
  putMethods(ctx, methods, n, type);
  duk_pop(ctx);
}

} // namespace

void registerSfMethods(duk_context* ctx, Interpreter& self) {
  for (const XsType type : {XS_SFVEC2F, XS_SFVEC3F, XS_SFVEC4F, XS_SFVEC2D, XS_SFVEC3D, XS_SFVEC4D})
    put(ctx, self, type, vectorMethods);
  put(ctx, self, XS_SFVEC3F, vector3Methods);
  put(ctx, self, XS_SFVEC3D, vector3Methods);
  put(ctx, self, XS_SFCOLOR, colorMethods);
  put(ctx, self, XS_SFCOLORRGBA, colorMethods);
  for (const XsType type : {XS_SFMATRIX3F, XS_SFMATRIX3D, XS_SFMATRIX4F, XS_SFMATRIX4D})
    put(ctx, self, type, textMethods);
  put(ctx, self, XS_SFROTATION, rotationMethods);
  put(ctx, self, XS_SFIMAGE, textMethods);
}

} // namespace ecma
