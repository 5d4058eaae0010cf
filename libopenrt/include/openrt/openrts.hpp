// openrts.hpp: OpenRTS for C++17. A shader is a small class whose functions see one hit at a time;
// the header adds the loops over batches, the class table and the parameter table. It needs only
// openrts.h and the headers beside it. Units and spaces are those of openrts.h.
//
//   #include <openrt/openrts.hpp>
//   struct Polished : rts::Surface<Polished> {
//     rts::Param<rts::Color> reflectance{"reflectance", {0.9f, 0.9f, 0.9f},
//                                        "fraction reflected, 0..1"};
//     void surface(const rts::Hit&, rts::Closures& out) const { out.reflection(reflectance); }
//   };
//   RTS_PLUGIN(Polished)
//
// A function that is a template over its numbers computes several hits at once, with vector
// instructions (openrts_lanes.hpp). These functions may be such templates: `surface`, `shade`,
// `reflect`, `transmit`, `illuminate`, `generate`, `miss` and `attenuate`. The types below are then
// HitOf<F>, ClosuresOf<F>, Vec3Of<F> and so on; Hit is HitOf<float>.
//
// A class derives from one of the templates below and defines these functions. Except for `prepare`
// and `release`, they are const. None may throw. They are called on many threads at once [render];
// `emits`, `emitsUniformly`, `medium`, `needs`, `extent` and `prepare` are called on the committing
// thread.
//
//   Surface<T>
//     void surface(const Hit&, Closures&) const      adds the BSDF's lobes and emission
//     Shaded shade(const Hit&) const                 instead: returns radiance. A class may have
//                                                    both; then path tracing calls `surface` and
//                                                    the other transports call `shade`
//     Color reflect(const Hit&, const Light&) const  optional, with `shade`: radiance reflected
//                                                    from one light; without it the surface is
//                                                    unlit
//     Color transmit(const Hit&) const               optional: transmittance (0..1) for shadow
//                                                    rays; without it the surface is opaque
//     bool transmits() const                         optional, with `transmit`: it may be above 0;
//                                                    without it shadow rays always call `transmit`
//     bool emits() const                             optional: emission may be above 0; without it
//                                                    no light samples are taken on the surface, and
//                                                    path tracing finds its light only by chance
//     bool emitsUniformly() const                    optional, with `emits`: a side emits the same
//                                                    radiance at all points, in all directions
//     Medium medium() const                          optional: the interior of the body
//     static constexpr uint32_t needs = RTS_GLOSSY;  optional, also as a const function:
//                                                    RTS_SPECULAR, RTS_GLOSSY, RTS_GLOBAL,
//                                                    RTS_NO_SCATTER; the default with `surface` is
//                                                    RTS_SPECULAR
//   LightSource<T>
//     Illumination illuminate(Vec3 point) const      illumination of a point, both in the light's
//                                                    local space
//     Extent extent() const                          optional: position and strength
//     Opening opening(Vec3 origin, Vec3 direction) const
//                                                    optional: where a ray of the local space
//                                                    meets the luminous opening, and its radiance
//     static constexpr bool directional = true;      optional: toLight has no end point
//     static constexpr bool shadows = false;         optional: the light casts no shadows
//   Camera<T>
//     Ray generate(Vec2 pixel, Vec2 size) const      camera ray in local space; pixel from the top
//                                                    left corner, size of the picture in pixels
//     Projection project(Vec3 point, Vec2 lens, Vec2 size) const
//                                                    optional: the inverse of `generate`
//     static constexpr bool parallel = true;         optional: all rays have one direction
//   Environment<T>
//     Vec4 miss(Vec3 direction) const                radiance and opacity, in local space
//     Fog attenuate(Vec3 fromEye) const              optional: fog between the eye and a hit, in
//                                                    local space
//   Transport<T>
//     Vec4 radiance(const CameraRay&) const          radiance and alpha of a camera ray
//   all
//     const char* prepare()                          optional, called once for each new set of
//                                                    values: returns nullptr, or a message if the
//                                                    values make no sense
//     void release()                                 optional: frees what `prepare` allocated
//     static constexpr const char* text = "...";     optional: one line that says what the class is
//
// The members of a class are rts::Param, and plain numbers and pointers that `prepare` computes.
// The latter are zero before `prepare`: their initialisers have no effect.
#ifndef OPENRT_OPENRTS_HPP
#define OPENRT_OPENRTS_HPP

#include <limits>
#include <type_traits>

#include "openrts.h"
#include "openrts_lanes.hpp"
#include "openrts_values.hpp"

namespace rts {

inline constexpr float infinity = std::numeric_limits<float>::infinity();

namespace detail {
// Cache of the host's answers for the hits of a batch: each array is requested once.
struct Asked {
  float* random[4][2] = {};
  float *local[6] = {}, *derivatives[6] = {}, *throughput[3] = {}, *error = nullptr;
  uint32_t *ids[3] = {}, *depth = nullptr;
};
} // namespace detail

// Arguments and results ---------------------------------------------------------------------------

template <class F> struct RayOf {
  Vec3Of<F> origin, direction; // the direction is unit
};
using Ray = RayOf<float>;
// The first hit of a ray.
struct Found {
  float distance = infinity; // infinite: nothing is hit
  Vec3 position;             // render space
  // Unit: the geometric normal, turned towards the ray's origin, and the shading normal.
  Vec3 geometric, normal;
  uint32_t name = 0; // rtLoadName
  bool any() const { return distance < infinity; }
};

// A hit, or a camera ray of a transport: it can trace rays, one at a time. The batch functions of
// RtsHost trace many at once and are several times as fast. Rays are in render space, directions
// are unit, lengths in world units. On hosts before 1.2 the rays hit nothing: `trace` returns black
// and `occluded` white. Valid only during the call that received it, on its thread. [render]
class Tracer {
 public:
  const RtsHost* host = nullptr;
  RtsBatch* batch = nullptr;
  uint32_t lane = 0;
  uint32_t count = 0; // lanes of the batch
  detail::Asked* asked = nullptr;

  // Returns the radiance that arrives along a ray, shaded by the engine; black beyond the depth
  // limit. Writes the ray's alpha where `alpha` is not null.
  Color trace(Vec3 from, Vec3 towards, float length = infinity, float* alpha = nullptr) const {
    return traceFrom(&from, towards, length, alpha);
  }
  // Returns the first hit of a ray.
  Found findHit(Vec3 from, Vec3 towards, float length = infinity) const {
    return findFrom(&from, towards, length);
  }
  // Returns the transmittance (0..1, by colour) between a ray's origin and its end: black where it
  // is blocked.
  Color occluded(Vec3 from, Vec3 towards, float length = infinity) const {
    return occludedFrom(&from, towards, length);
  }
  // Returns a point of the unit square. Each pair (0..3) is a sequence of its own, well distributed
  // over the samples of a pixel. A call makes the pixel's value a Monte Carlo estimate.
  Vec2 random(uint32_t pair) const;

 protected:
  Color traceFrom(const Vec3* origin, Vec3 direction, float length, float* alpha) const;
  Found findFrom(const Vec3* origin, Vec3 direction, float length) const;
  Color occludedFrom(const Vec3* origin, Vec3 direction, float length) const;
};

// The numbers of a hit. In `transmit` only position, direction, uv, color and flags are set.
template <class F> struct HitNumbers {
  Vec3Of<F> position;  // render space
  Vec3Of<F> direction; // unit direction of the ray, towards the surface
  Vec3Of<F> geometric; // unit geometric normal, turned towards the ray's origin
  Vec3Of<F> normal;    // unit shading normal, on the same side
  Vec2Of<F> uv;        // texture coordinates, 0 if the geometry has none
  Vec4Of<F> color;     // rgba of the geometry, 1 1 1 1 if it has none
  F distance = 0;      // path length from the camera
  F segment = 0;       // length of the last ray of the path
};

// A position and a geometric normal (not unit) in the frame of the object.
template <class F> struct LocalOf { Vec3Of<F> position, normal; };

template <class F> struct HitOf; // F: float for one hit, Lanes for several
using Hit = HitOf<float>;
template <> struct HitOf<float> : Tracer, HitNumbers<float> {
  uint32_t flags = 0; // RTS_HIT_*

  bool back() const { return (flags & RTS_HIT_BACK) != 0; }
  bool line() const { return (flags & RTS_HIT_LINE) != 0; }
  bool oneSided() const { return (flags & RTS_HIT_ONE_SIDED) != 0; }
  // Returns the cosine between the reversed ray and the shading normal, 0..1.
  float cosine() const { return std::fmin(1.0f, std::fmax(0.0f, -dot(direction, normal))); }
  // Returns the filtered texel (linear rgba) at texture coordinates; white if there is no texture.
  Vec4 sample(Texture texture, Vec2 place) const;
  // The same for a texture that may be a volume (rtTexImage3D), at (s, t, r).
  Vec4 sampleVolume(Texture texture, Vec3 place) const;
  // Writes where the camera sees the hit's position, or would if nothing hid it, in pixels from the
  // top left corner of the picture (RtsHost.pixels). Returns false if the camera does not tell.
  bool pixel(Vec2& place) const;

  using Tracer::findHit;
  using Tracer::occluded;
  using Tracer::trace;
  // The same with rays that start at this hit, offset from the surface to the side of the
  // direction.
  Color trace(Vec3 towards, float length = infinity) const {
    return traceFrom(nullptr, towards, length, nullptr);
  }
  Found findHit(Vec3 towards, float length = infinity) const {
    return findFrom(nullptr, towards, length);
  }
  Color occluded(Vec3 towards, float length = infinity) const {
    return occludedFrom(nullptr, towards, length);
  }
  // Returns position and geometric normal (not unit) in the frame of the object, so that a solid
  // texture moves with the object.
  using Local = LocalOf<float>;
  Local local() const;
  // Returns the derivatives of the position with respect to the texture coordinates, in render
  // space; 0 without texture coordinates.
  struct Derivatives {
    Vec3 alongS, alongT;
  };
  Derivatives derivatives() const;
  // Returns rtLoadName, outermost instance and triangle.
  struct Ids {
    uint32_t name = 0, instance = 0, primitive = 0;
  };
  Ids ids() const;
  // Returns the number of surfaces that the path hit before this one.
  uint32_t depth() const;
  // Returns the path throughput: the fraction of radiance from here that reaches the camera.
  Color throughput() const;
  // Returns a bound of the position's rounding error along the geometric normal, in world units.
  float error() const;
};

// Neighbouring hits with the same parameters, one for each lane of Lanes. At the end of a batch the
// spare lanes hold copies of its last hit, and their results are ignored. Only these functions of
// Hit exist for several hits.
template <> struct HitOf<Lanes> : HitNumbers<Lanes> {
  Tracer first;                    // identifies the first of the hits
  const uint32_t* flags = nullptr; // RTS_HIT_*, by lane

  Mask back() const { return has(RTS_HIT_BACK); }
  Mask line() const { return has(RTS_HIT_LINE); }
  Mask oneSided() const { return has(RTS_HIT_ONE_SIDED); }
  Lanes cosine() const { return smaller(1, larger(0, -dot(direction, normal))); }
  Vec4Of<Lanes> sample(Texture texture, Vec2Of<Lanes> place) const;
  LocalOf<Lanes> local() const;

 private:
  Mask has(uint32_t flag) const {
    float at[Lanes::size];
    for (uint32_t i = 0; i < Lanes::size; i++) at[i] = (flags[i] & flag) ? 1.0f : 0.0f;
    return Lanes::load(at) > 0;
  }
};

// The argument of a transport: the ray of one sample of a pixel.
struct CameraRay : Tracer {
  Vec3 origin, direction; // render space; the direction is unit
  float length = infinity;

  using Tracer::findHit;
  using Tracer::trace;
  // Returns the radiance along this ray as the engine computes it, and the ray's first hit.
  Color trace(float* alpha = nullptr) const { return traceFrom(&origin, direction, length, alpha); }
  Found findHit() const { return findFrom(&origin, direction, length); }
};

// The result of Surface::shade.
template <class F> struct ShadedOf {
  ColorOf<F> radiance;     // leaving towards the ray's origin, multiplied by opacity
  ColorOf<F> transmission; // 0..1, fraction let through of the radiance straight behind the hit
  ColorOf<F> albedo;       // surface colour for the albedo channel
};
using Shaded = ShadedOf<float>;

// Light from one light that arrives at a hit (RtsIllumination), in render space.
template <class F> struct LightOf {
  Vec3Of<F> toLight;         // unit
  ColorOf<F> color, ambient; // direct part, multiplied by the shadow; ambient part
};
using Light = LightOf<float>;

// The result of LightSource::illuminate (RtsIllumination), in the light's local space.
template <class F> struct IlluminationOf {
  Vec3Of<F> toLight;         // any length
  ColorOf<F> color, ambient; // direct and ambient part
};
using Illumination = IlluminationOf<float>;
// The result of Environment::attenuate.
template <class F> struct FogOf {
  ColorOf<F> color;
  F fraction = 1; // fraction (0..1) of the surface's radiance that arrives
};
using Fog = FogOf<float>;
// The interior of a body (RtsMedium). Where bodies overlap, the one with the highest priority
// counts. Faces point outwards.
struct Medium {
  Color index{1, 1, 1}; // index of refraction, > 0, by colour
  Color absorption;     // per world unit of length: transmittance is exp(-absorption x length)
  int32_t priority = 0;
  bool present = true;  // false: the body has no interior
  Color scattering;     // per world unit of length, >= 0
  float anisotropy = 0; // mean cosine of the angle of scattering, between -1 and 1
};
// The position and strength of a light (RtsExtent), in its local space.
struct Extent {
  Vec3 position, direction{0, 0, -1};
  float cosine = -1;       // cosine of the lit cone's half angle; -1: all directions
  float power = 1;         // estimate of the flux (parallel: of the irradiance), mean over colours
  float radius = infinity; // nothing beyond this distance is lit
  // parallel: light falls along `direction` everywhere. known: false if the rest is unknown.
  bool parallel = false, known = true;
};
// The place where a ray meets a light's luminous opening (RtsClass.opening).
struct Opening {
  float distance = infinity; // in lengths of the ray's direction; infinite: nothing is seen
  Color radiance;
};
// Where a point appears in the picture (RtsProjection).
struct Projection {
  Vec2 pixel;       // from the top left corner
  Vec3 toEye;       // to the point on the lens; parallel views: unit, towards the eye
  float weight = 0; // pixels per unit of area that faces the eye; 0: not in the picture
};

// A direction sampled from a custom lobe, with the BSDF times cosine divided by the pdf, and the
// pdf (with respect to solid angle; 0: no direction was sampled).
struct Sample {
  Vec3 direction;
  Color quotient;
  float density = 0;
};

// Returns the function table of a custom lobe L: a trivially copyable class of at most
// RTS_MAX_LOBE_FLOATS floats, with
//   Color evaluate(Vec3 toEye, Vec3 direction, Vec3 normal) const  BSDF times the cosine at normal
//   float density(Vec3 toEye, Vec3 direction, Vec3 normal) const   pdf of `sample`, solid angle
//   Sample sample(Vec3 toEye, Vec2 square, Vec3 normal) const      or returning only the direction
//                                                                  (Vec3): the rest is computed
//   static constexpr bool transmits = true;                        optional: BTDF, may be above 0
//                                                                  on the other side of the surface
// `square` is a point of the unit square. Directions are unit, in render space, and point away from
// the surface. A lobe must be reciprocal unless it transmits, and must conserve energy.
template <class L> const RtsLobeFunctions* lobeFunctions();

namespace detail {
// The lobes that a batch has so far. Each hit, or group of hits, takes them in the order of its
// calls, so that hits with the same lobes share them.
class LobeList {
 public:
  LobeList(const RtsHost* host, RtsBatch* batch) : host_(host), batch_(batch) {}
  void begin() { // starts the next hit
    for (uint32_t i = 0; i < count_; i++) free_[i] = true;
  }
  // Returns a lobe of this kind that the hit has not used yet, or null after RTS_MAX_LOBES lobes.
  RtsLobe* take(RtsLobeKind kind, bool coat, const RtsLobeFunctions* functions, uint32_t floats) {
    for (uint32_t i = 0; i < count_; i++) {
      if (!free_[i] || lobes_[i]->kind != kind || functions_[i] != functions) continue;
      if (coats_[i] != coat) continue;
      free_[i] = false;
      return lobes_[i];
    }
    if (count_ == RTS_MAX_LOBES) return nullptr;
    RtsLobe* made =
        functions ? host_->customLobe(batch_, functions, floats) : host_->lobe(batch_, kind);
    if (made) {
      lobes_[count_] = made;
      functions_[count_] = functions;
      coats_[count_] = coat;
      made->coat = coat;
      free_[count_++] = false;
    }
    return made;
  }

 private:
  const RtsHost* host_;
  RtsBatch* batch_;
  uint32_t count_ = 0;
  RtsLobe* lobes_[RTS_MAX_LOBES] = {};
  const RtsLobeFunctions* functions_[RTS_MAX_LOBES] = {};
  bool coats_[RTS_MAX_LOBES] = {};
  bool free_[RTS_MAX_LOBES] = {};
};
} // namespace detail

// Collects the lobes of one hit, or of the hits of Lanes (RtsLobeKind). Lobes of the same kind add
// up. Weights are 0..1; all weights of a hit should add up to at most 1. A hit may have
// RTS_MAX_LOBES lobes; further ones are dropped. Valid only during the call of `surface`. [render]
template <class F> class ClosuresOf {
 public:
  using Color = ColorOf<F>;
  // Adds a Lambertian lobe.
  void diffuse(Color albedo) { add(RTS_LOBE_DIFFUSE, albedo); }
  // Adds a perfect mirror. The reflectance includes the Fresnel factor.
  void reflection(Color reflectance) { add(RTS_LOBE_REFLECTION, reflectance); }
  // Adds a smooth boundary of a clear medium. eta: index of refraction on the ray's side over that
  // on the far side.
  void dielectric(Color tint, F eta) { add(RTS_LOBE_DIELECTRIC, tint, eta); }
  // Lets light pass straight through.
  void transparent(Color transmittance) { add(RTS_LOBE_TRANSPARENT, transmittance); }
  // Adds a microfacet reflection (GGX) of width alpha, 0..1. If eta is not 0, the Fresnel
  // reflectance of a clear medium multiplies the weight.
  void glossy(Color reflectance, F alpha, F eta = 0) {
    add(RTS_LOBE_GLOSSY, reflectance, alpha, eta);
  }
  // Adds a rough boundary of a clear medium (GGX).
  void roughDielectric(Color tint, F eta, F alpha) {
    add(RTS_LOBE_ROUGH_DIELECTRIC, tint, eta, alpha);
  }
  // Adds a custom lobe (lobeFunctions), the same for all lanes.
  template <class L> void custom(Color weight, const L& lobe);
  // Sets the normal of the lobes that are added after it; the default is the hit's shading normal.
  // It must be on the side of the geometric normal.
  void normal(Vec3Of<F> unit) {
    normal_ = unit;
    bent_ = true;
  }
  // Tells whether the lobes that are added after it are coats over the others, such as varnish or a
  // highlight, whose light does not have the colour of the surface (RtsLobe.coat); the default is
  // no.
  void coat(bool is = true) { coat_ = is; }

  // Adds emitted radiance towards the ray's origin.
  void emission(Color radiance) {
    const F c[3] = {radiance.r, radiance.g, radiance.b};
    for (int k = 0; k < 3; k++) {
      float* to = out_->emission[k] + lane_;
      detail::store<F>(to, detail::load<F>(to) + c[k]);
    }
  }
  // Sets the surface colour for the albedo channel.
  void albedo(Color color) {
    if (out_->albedo[0]) put(out_->albedo, color.r, color.g, color.b);
  }

  // For the hit `lane`, or the group of hits that begins there.
  ClosuresOf(detail::LobeList& lobes, RtsSurface* out, uint32_t lane)
      : lobes_(lobes), out_(out), lane_(lane) {
    lobes_.begin();
  }

 private:
  void put(float* const to[3], F x, F y, F z) {
    detail::store<F>(to[0] + lane_, x);
    detail::store<F>(to[1] + lane_, y);
    detail::store<F>(to[2] + lane_, z);
  }
  RtsLobe* add(RtsLobeKind kind, Color weight, F first = 0, F second = 0,
               const RtsLobeFunctions* functions = nullptr, uint32_t floats = 0) {
    RtsLobe* lobe = lobes_.take(kind, coat_, functions, floats);
    if (!lobe) return nullptr;
    put(lobe->weight, weight.r, weight.g, weight.b);
    if (bent_) put(lobe->normal, normal_.x, normal_.y, normal_.z);
    if (functions) return lobe;
    detail::store<F>(lobe->parameter[0] + lane_, first);
    detail::store<F>(lobe->parameter[1] + lane_, second);
    return lobe;
  }

  detail::LobeList& lobes_;
  RtsSurface* out_;
  uint32_t lane_;
  Vec3Of<F> normal_;
  bool bent_ = false;
  bool coat_ = false;
};
using Closures = ClosuresOf<float>;

template <class T> struct Surface {};
template <class T> struct LightSource {};
template <class T> struct Camera {};
template <class T> struct Environment {};
template <class T> struct Transport {};

} // namespace rts

#include "openrts_ask.hpp"
#include "openrts_glue.hpp"

// Exports the classes, each under its own name. Use it once in a library, outside any namespace.
#define RTS_PLUGIN(...)                                                                            \
  extern "C" {                                                                                     \
  extern RTS_EXPORT const RtsPlugin rtsPlugin;                                                     \
  const RtsPlugin rtsPlugin = rts::detail::pluginOf<__VA_ARGS__>(#__VA_ARGS__);                    \
  }

#endif
