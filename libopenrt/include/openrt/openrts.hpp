// openrts.hpp: OpenRTS for C++17: a shader as a small class that sees one hit at a time. The header
// hides the batches, builds the class table and the parameter table, and needs nothing but
// openrts.h. Where every nanosecond counts, write the batch functions of openrts.h instead.
//
//   #include <openrt/openrts.hpp>
//   struct Polished : rts::Surface<Polished> {
//     rts::Param<rts::Color> reflectance{"reflectance", {0.9f, 0.9f, 0.9f}, "fraction reflected,
//     0..1"}; void surface(const rts::Hit&, rts::Closures& out) const {
//     out.reflection(reflectance); }
//   };
//   RTS_PLUGIN(Polished)
//
// A class may say `static constexpr const char* text = "what it is";`. Its functions are const,
// must not throw and are called on many threads at once [render]. Its members are rts::Param, and,
// for what `prepare` makes of them, plain numbers and pointers, which are zero before `prepare`
// whatever their initialisers say.
//
//   Surface<T>      void surface(const Hit&, Closures&) const         a sum of lobes that the
//   engine follows
//                   Shaded shade(const Hit&) const                    instead: radiance; or beside
//                   it, for the transports that
//                                                                     follow no light between
//                                                                     surfaces
//                   Color reflect(const Hit&, const Light&) const     optional, with shade: the
//                   answer to one light; without it:
//                                                                     unlit
//                   Color transmit(const Hit&) const                  optional: what shadow rays
//                   see; without it the surface is
//                                                                     opaque
//                   bool emits() const                                optional: emission may be
//                   above 0; without it path tracing
//                                                                     meets the light by chance
//                                                                     only
//                   Medium medium() const                             optional: the inside of the
//                   body static constexpr uint32_t needs = RTS_GLOSSY;     optional, also as a
//                   const function: RTS_SPECULAR,
//                                                                     RTS_GLOSSY, RTS_GLOBAL,
//                                                                     RTS_NO_SCATTER; without it a
//                                                                     class with `surface` counts
//                                                                     as RTS_SPECULAR
//   LightSource<T>  Illumination illuminate(Vec3 point) const         point and answer in the
//   light's local space
//                   Extent extent() const                             optional: where it is and how
//                   strong static constexpr bool directional = true;         optional: toLight has
//                   no end point static constexpr bool shadows = false;            optional
//   Camera<T>       Ray generate(Vec2 pixel, Vec2 size) const         local space
//                   Projection project(Vec3 point, Vec2 lens, Vec2 size) const     optional: its
//                   inverse static constexpr bool parallel = true;            optional: all rays
//                   have one direction
//   Environment<T>  Vec4 miss(Vec3 direction) const                   radiance and opacity
//                   Fog attenuate(Vec3 fromEye) const                 optional
//   Transport<T>    Vec4 radiance(const CameraRay&) const             radiance and alpha
//   all             const char* prepare()                             optional, called once for
//   each new set of values: a message
//                                                                     if they make no sense, else
//                                                                     nullptr
//                   void release()                                    optional: undoes it
#ifndef OPENRT_OPENRTS_HPP
#define OPENRT_OPENRTS_HPP

#include <limits>
#include <type_traits>

#include "openrts.h"
#include "openrts_values.hpp"

namespace rts {

inline constexpr float infinity = std::numeric_limits<float>::infinity();

namespace detail {
// What the host has told about the hits of a batch, array by array, asked for once.
struct Asked {
  float* random[4][2] = {};
  float *local[6] = {}, *derivatives[6] = {}, *throughput[3] = {}, *error = nullptr;
  uint32_t *ids[3] = {}, *depth = nullptr;
};
} // namespace detail

// What functions see and answer
// -------------------------------------------------------------------------------------------

struct Ray {
  Vec3 origin, direction; // unit
};
// What a ray meets first.
struct Found {
  float distance = infinity; // infinite: nothing
  Vec3 position;             // render space
  Vec3 geometric, normal;    // unit, turned towards the ray's origin; as shaded
  uint32_t name = 0;         // rtLoadName
  bool any() const { return distance < infinity; }
};

// Something in a batch that can send rays, one at a time: a hit, or a camera ray of a transport.
// The batch functions of RtsHost do the same for many at once and are several times as fast. Hosts
// before 1.2 find nothing: black, clear.
class Tracer {
 public:
  const RtsHost* host = nullptr;
  RtsBatch* batch = nullptr;
  uint32_t lane = 0;
  uint32_t count = 0; // of the batch
  detail::Asked* asked = nullptr;

  // Light that comes back along a ray (unit direction) from a place, shaded by the engine. Black
  // beyond the depth limit.
  Color trace(Vec3 from, Vec3 towards, float length = infinity, float* alpha = nullptr) const {
    return traceFrom(&from, towards, length, alpha);
  }
  Found findHit(Vec3 from, Vec3 towards, float length = infinity) const {
    return findFrom(&from, towards, length);
  }
  // The colour that is let through between a ray's origin and its end: black where it is blocked.
  Color occluded(Vec3 from, Vec3 towards, float length = infinity) const {
    return occludedFrom(&from, towards, length);
  }
  // A point of the unit square, for each pair < 4 another: well spread over the samples of a pixel.
  // Using one turns the pixel's value into an estimate.
  Vec2 random(uint32_t pair) const;

 protected:
  Color traceFrom(const Vec3* origin, Vec3 direction, float length, float* alpha) const;
  Found findFrom(const Vec3* origin, Vec3 direction, float length) const;
  Color occludedFrom(const Vec3* origin, Vec3 direction, float length) const;
};

struct Hit : Tracer {
  Vec3 position;  // render space
  Vec3 direction; // unit, of the ray, towards the surface
  Vec3 geometric; // unit, turned towards the ray's origin
  Vec3 normal;    // unit, on the same side
  Vec2 uv;
  Vec4 color;         // of the geometry, 1 1 1 1 without
  float distance = 0; // along the path from the camera
  float segment = 0;  // along the ray that met the surface
  uint32_t flags = 0;

  bool back() const { return (flags & RTS_HIT_BACK) != 0; }
  bool line() const { return (flags & RTS_HIT_LINE) != 0; }
  // Of the ray that met the surface, at the shading normal: 0..1.
  float cosine() const { return std::fmin(1.0f, std::fmax(0.0f, -dot(direction, normal))); }
  // Filtered texel; white for no texture.
  Vec4 sample(Texture texture, Vec2 place) const;

  // The rest is the host's since 1.2; with older ones they answer as said.
  using Tracer::findHit;
  using Tracer::occluded;
  using Tracer::trace;
  // The same from this hit, lifted off the surface to the side of the direction (unit).
  Color trace(Vec3 towards, float length = infinity) const {
    return traceFrom(nullptr, towards, length, nullptr);
  }
  Found findHit(Vec3 towards, float length = infinity) const {
    return findFrom(nullptr, towards, length);
  }
  Color occluded(Vec3 towards, float length = infinity) const {
    return occludedFrom(nullptr, towards, length);
  }
  // Position and geometric normal (not unit) in the frame of the object: a pattern made from them
  // moves with it. Else render space.
  struct Local {
    Vec3 position, normal;
  };
  Local local() const;
  // Change of the position per unit of texture coordinate, render space; else 0.
  struct Derivatives {
    Vec3 alongS, alongT;
  };
  Derivatives derivatives() const;
  // rtLoadName, outermost instance, triangle; else 0.
  struct Ids {
    uint32_t name = 0, instance = 0, primitive = 0;
  };
  Ids ids() const;
  uint32_t depth() const;   // surfaces that the path met before; else 0
  Color throughput() const; // share of the light from here that reaches the camera; else 1
  float error() const; // bound of the position's rounding error along the geometric normal; else 0
};

// Of a transport: the ray of a sample of the picture.
struct CameraRay : Tracer {
  Vec3 origin, direction; // render space; unit
  float length = infinity;

  using Tracer::findHit;
  using Tracer::trace;
  // What the engine makes of this ray, and what it meets.
  Color trace(float* alpha = nullptr) const { return traceFrom(&origin, direction, length, alpha); }
  Found findHit() const { return findFrom(&origin, direction, length); }
};

struct Shaded {
  Color radiance;     // leaving towards the ray's origin, weighted by opacity
  Color transmission; // of what lies straight behind
  Color albedo;
};

struct Light {  // as it arrives at a hit, shadows taken off the direct part
  Vec3 toLight; // unit
  Color color, ambient;
};

struct Illumination {
  Vec3 toLight; // any length
  Color color, ambient;
};
struct Fog {
  Color color;
  float fraction = 1; // of the surface's radiance that arrives
};
// The inside of a body (RtsMedium): where bodies overlap the one of the highest priority is there.
// Faces point outwards.
struct Medium {
  Color index{1, 1, 1}; // of refraction, by colour
  Color absorption;     // per unit of length in the world
  int32_t priority = 0;
  bool present = true;
};
// Where a light is and how strong (RtsExtent), local space.
struct Extent {
  Vec3 position, direction{0, 0, -1};
  float cosine = -1; // of the half angle of the cone about the direction that gets light
  float power = 1;
  float radius = infinity; // nothing is lit beyond
  bool parallel = false, known = true;
};
// Where a point is in the picture (RtsProjection).
struct Projection {
  Vec2 pixel;
  Vec3 toEye;
  float weight = 0; // pixels covered per unit of area that faces the eye; 0: not in the picture
};

// A direction that a lobe of one's own chooses: its value divided by the density, and the density;
// 0: none.
struct Sample {
  Vec3 direction;
  Color quotient;
  float density = 0;
};

// The functions of a lobe of a plug-in's own: a trivially copyable class of floats (at most
// RTS_MAX_LOBE_FLOATS), with
//   Color evaluate(Vec3 toEye, Vec3 direction, Vec3 normal) const    response per radiance times
//   the cosine at the normal float density(Vec3 toEye, Vec3 direction, Vec3 normal) const     of
//   sample, by solid angle Sample sample(Vec3 toEye, Vec2 square, Vec3 normal) const        or the
//   direction alone (Vec3): the rest is then worked out static constexpr bool transmits = true;
//   optional: may answer light from the other side
// Directions are unit, away from the surface. A lobe must be reciprocal unless it transmits, and
// reflect at most what it gets.
template <class L> const RtsLobeFunctions* lobeFunctions();

// The lobes of one hit (RtsLobeKind). Several of a kind add up. Weights 0..1; all of a hit should
// add up to at most 1.
class Closures {
 public:
  // Lambert's law.
  void diffuse(Color albedo) { add(RTS_LOBE_DIFFUSE, albedo); }
  // Perfect mirror; Fresnel's share is part of the reflectance.
  void reflection(Color reflectance) { add(RTS_LOBE_REFLECTION, reflectance); }
  // Smooth boundary of a clear medium. eta: index of refraction on the ray's side over that behind.
  void dielectric(Color tint, float eta) { add(RTS_LOBE_DIELECTRIC, tint, eta); }
  void transparent(Color transmittance) { add(RTS_LOBE_TRANSPARENT, transmittance); }
  // Microfacets (GGX) of width alpha, 0..1. With eta Fresnel's share of a clear medium multiplies.
  void glossy(Color reflectance, float alpha, float eta = 0) {
    add(RTS_LOBE_GLOSSY, reflectance, alpha, eta);
  }
  void roughDielectric(Color tint, float eta, float alpha) {
    add(RTS_LOBE_ROUGH_DIELECTRIC, tint, eta, alpha);
  }
  // A lobe of one's own (see lobeFunctions).
  template <class L> void custom(Color weight, const L& lobe);
  // The normal of the lobes that follow for this hit; at first the hit's. Unit, on the side of the
  // geometric one.
  void normal(Vec3 unit) {
    normal_ = unit;
    bent_ = true;
  }

  void emission(Color radiance) {
    const float c[3] = {radiance.r, radiance.g, radiance.b};
    for (int k = 0; k < 3; k++) out_->emission[k][lane_] += c[k];
  }
  // For the albedo channel.
  void albedo(Color color) {
    const float c[3] = {color.r, color.g, color.b};
    for (int k = 0; out_->albedo[0] && k < 3; k++) out_->albedo[k][lane_] = c[k];
  }

  Closures(const RtsHost* host, RtsBatch* batch, RtsSurface* out)
      : host_(host), batch_(batch), out_(out) {}
  void begin(uint32_t lane) { // the next hit
    lane_ = lane;
    bent_ = false;
    for (uint32_t i = 0; i < count_; i++) free_[i] = true;
  }

 private:
  RtsLobe* add(RtsLobeKind kind, Color weight, float first = 0, float second = 0,
               const RtsLobeFunctions* functions = nullptr, uint32_t floats = 0) {
    RtsLobe* lobe = slot(kind, functions, floats);
    if (!lobe) return nullptr;
    const float c[3] = {weight.r, weight.g, weight.b}, n[3] = {normal_.x, normal_.y, normal_.z};
    for (int k = 0; k < 3; k++) lobe->weight[k][lane_] = c[k];
    for (int k = 0; bent_ && k < 3; k++) lobe->normal[k][lane_] = n[k];
    if (functions) return lobe;
    lobe->parameter[0][lane_] = first;
    lobe->parameter[1][lane_] = second;
    return lobe;
  }
  // A lobe of this kind that the hit has not used yet. Null beyond RTS_MAX_LOBES and on hosts that
  // do not know the kind.
  RtsLobe* slot(RtsLobeKind kind, const RtsLobeFunctions* functions, uint32_t floats) {
    for (uint32_t i = 0; i < count_; i++) {
      if (!free_[i] || lobes_[i]->kind != kind || functions_[i] != functions) continue;
      free_[i] = false;
      return lobes_[i];
    }
    if (count_ == RTS_MAX_LOBES) return nullptr;
    const bool own = host_->minor >= 2 && host_->customLobe;
    RtsLobe* made = !functions ? host_->lobe(batch_, kind)
                    : own      ? host_->customLobe(batch_, functions, floats)
                               : nullptr;
    if (made) {
      lobes_[count_] = made;
      functions_[count_] = functions;
      free_[count_++] = false;
    }
    return made;
  }

  const RtsHost* host_;
  RtsBatch* batch_;
  RtsSurface* out_;
  uint32_t lane_ = 0, count_ = 0;
  Vec3 normal_;
  bool bent_ = false;
  RtsLobe* lobes_[RTS_MAX_LOBES] = {};
  const RtsLobeFunctions* functions_[RTS_MAX_LOBES] = {};
  bool free_[RTS_MAX_LOBES] = {};
};

template <class T> struct Surface {};
template <class T> struct LightSource {};
template <class T> struct Camera {};
template <class T> struct Environment {};
template <class T> struct Transport {};

} // namespace rts

#include "openrts_ask.hpp"
#include "openrts_glue.hpp"

// Exports the classes, each under its own name. Once a library, outside any namespace.
#define RTS_PLUGIN(...)                                                                            \
  extern "C" {                                                                                     \
  extern RTS_EXPORT const RtsPlugin rtsPlugin;                                                     \
  const RtsPlugin rtsPlugin = rts::detail::pluginOf<__VA_ARGS__>(#__VA_ARGS__);                    \
  }

#endif
