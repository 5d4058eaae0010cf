// openrts.hpp: OpenRTS for C++17: a shader as a small class that sees one hit at a time. The header hides the batches, builds
// the class table and the parameter table, and needs nothing but openrts.h. Where every nanosecond counts, write the batch
// functions of openrts.h instead.
//
//   #include <openrt/openrts.hpp>
//   struct Flat : rts::Surface<Flat> {
//     rts::Param<rts::Color> color{"color", {0.8f, 0.8f, 0.8f}, "colour in any light"};
//     rts::Shaded shade(const rts::Hit&) const { return {color}; }
//   };
//   RTS_PLUGIN(Flat)
//
// A class may say `static constexpr const char* text = "what it is";`. Its members are rts::Param only; its functions are
// const, must not throw and are called on many threads at once [render].
//
//   Surface<T>      Shaded shade(const Hit&) const
//                   Color reflect(const Hit&, const Light&) const     optional: the answer to one light; without it: unlit
//                   void surface(const Hit&, Closures&) const         instead of shade: a sum of lobes that the engine follows
//                   bool emits() const                                optional: emission may be above 0; without it path
//                   tracing meets the light by chance only
//                   Color transmit(const Hit&) const                  optional: what shadow rays see; without it the surface is
//                   opaque
//   LightSource<T>  Illumination illuminate(Vec3 point) const         point and answer in the light's local space
//                   static constexpr bool directional = true;         optional: toLight has no end point
//                   static constexpr bool shadows = false;            optional
//   Camera<T>       Ray generate(Vec2 pixel, Vec2 size) const         local space
//   Environment<T>  Vec4 miss(Vec3 direction) const                   radiance and opacity
//                   Fog attenuate(Vec3 fromEye) const                 optional
#ifndef OPENRT_OPENRTS_HPP
#define OPENRT_OPENRTS_HPP

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "openrts.h"

namespace rts {

// Values ------------------------------------------------------------------------------------------------------------------

struct Vec2 {
  float x = 0, y = 0;
};
struct Vec3 {
  float x = 0, y = 0, z = 0;
};
struct Vec4 {
  float x = 0, y = 0, z = 0, w = 0;
};
struct Color {
  float r = 0, g = 0, b = 0;
};
struct Matrix { // column-major
  float m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};
struct Texture {
  RtsTexture id = 0;
};
using Floats = RtsFloats;
using String = const char*;

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline Vec3 operator*(float s, Vec3 a) { return a * s; }
inline float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalize(Vec3 a) { // the zero vector stays
  const float l = length(a);
  return l > 0 ? a * (1 / l) : a;
}
inline Color operator+(Color a, Color b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
inline Color operator*(Color a, Color b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
inline Color operator*(Color a, float s) { return {a.r * s, a.g * s, a.b * s}; }
inline Color operator*(float s, Color a) { return a * s; }

// Parameters -----------------------------------------------------------------------------------------------------------------

namespace detail {

template <class T> struct ParamType;
template <> struct ParamType<int32_t> { static constexpr RtsType type = RTS_INT; };
template <> struct ParamType<float> { static constexpr RtsType type = RTS_FLOAT; };
template <> struct ParamType<Vec2> { static constexpr RtsType type = RTS_VEC2; };
template <> struct ParamType<Vec3> { static constexpr RtsType type = RTS_VEC3; };
template <> struct ParamType<Vec4> { static constexpr RtsType type = RTS_VEC4; };
template <> struct ParamType<Color> { static constexpr RtsType type = RTS_COLOR; };
template <> struct ParamType<Matrix> { static constexpr RtsType type = RTS_MATRIX; };
template <> struct ParamType<Floats> { static constexpr RtsType type = RTS_FLOATS; };
template <> struct ParamType<String> { static constexpr RtsType type = RTS_STRING; };
template <> struct ParamType<Texture> { static constexpr RtsType type = RTS_TEXTURE; };

// A class's parameters as its prototype is constructed: each Param notes where it lies.
struct Declaration {
  std::vector<RtsParam> params;
  const char* start = nullptr;
};
inline Declaration*& declaration() {
  static thread_local Declaration* current = nullptr;
  return current;
}

inline void declare(const char* name, RtsType type, const void* place, const void* value, size_t bytes, const char* text,
                    float minimum, float maximum) {
  Declaration* d = declaration();
  if (!d) return;
  RtsParam p{};
  p.name = name;
  p.type = type;
  p.offset = static_cast<uint32_t>(static_cast<const char*>(place) - d->start);
  if (type == RTS_INT) {
    int32_t whole = 0;
    std::memcpy(&whole, value, sizeof whole);
    p.defaultValue[0] = static_cast<float>(whole);
  } else if (type >= RTS_FLOAT && type <= RTS_MATRIX) {
    std::memcpy(p.defaultValue, value, bytes);
  }
  p.minimum = minimum;
  p.maximum = maximum;
  p.text = text;
  d->params.push_back(p);
}

} // namespace detail

// A parameter with its name, default value, meaning and, if both are given, its range. Reads as its value. Lists, strings and
// textures start empty.
template <class T> class Param {
 public:
  Param(const char* name, T value, const char* text, float minimum = 0, float maximum = 0) : value_(value) {
    detail::declare(name, detail::ParamType<T>::type, &value_, &value_, sizeof value_, text, minimum, maximum);
  }
  Param(const char* name, const char* text) : value_() {
    detail::declare(name, detail::ParamType<T>::type, &value_, &value_, sizeof value_, text, 0, 0);
  }
  operator const T&() const { return value_; }
  const T& operator*() const { return value_; }
  const T* operator->() const { return &value_; }

 private:
  T value_; // the only member: the host writes the value here
};

// What functions see and answer -------------------------------------------------------------------------------------------

struct Hit {
  Vec3 position;  // render space
  Vec3 direction; // unit, of the ray, towards the surface
  Vec3 geometric; // unit, turned towards the ray's origin
  Vec3 normal;    // unit, on the same side
  Vec2 uv;
  Vec4 color;         // of the geometry, 1 1 1 1 without
  float distance = 0; // along the path from the camera
  float segment = 0;  // along the ray that met the surface
  uint32_t flags = 0;
  uint32_t lane = 0;
  const RtsHost* host = nullptr;
  RtsBatch* batch = nullptr;

  bool back() const { return (flags & RTS_HIT_BACK) != 0; }
  bool line() const { return (flags & RTS_HIT_LINE) != 0; }
  // Filtered texel; white for no texture.
  Vec4 sample(Texture texture, Vec2 place) const {
    alignas(64) float in[2][RTS_LANES], out[4][RTS_LANES];
    for (int i = 0; i < RTS_LANES; i++) {
      in[0][i] = place.x;
      in[1][i] = place.y;
    }
    const float* const uvs[2] = {in[0], in[1]};
    float* const rgba[4] = {out[0], out[1], out[2], out[3]};
    host->sample(batch, texture.id, 1, uvs, rgba);
    return {out[0][0], out[1][0], out[2][0], out[3][0]};
  }
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
struct Ray {
  Vec3 origin, direction; // unit
};
struct Fog {
  Color color;
  float fraction = 1; // of the surface's radiance that arrives
};

// The lobes of one hit (RtsLobeKind). Several of a kind add up.
class Closures {
 public:
  // The engine's answer to lights and to the light of other surfaces: Lambert's law.
  void diffuse(Color albedo) { add(RTS_LOBE_DIFFUSE, albedo); }
  void reflection(Color reflectance) { add(RTS_LOBE_REFLECTION, reflectance); }
  // eta: index of refraction on the ray's side over that behind.
  void dielectric(Color tint, float eta) { add(RTS_LOBE_DIELECTRIC, tint, eta); }
  void transparent(Color transmittance) { add(RTS_LOBE_TRANSPARENT, transmittance); }
  void emission(Color radiance) {
    const float c[3] = {radiance.r, radiance.g, radiance.b};
    for (int k = 0; k < 3; k++) out_->emission[k][lane_] += c[k];
  }
  // For the albedo channel.
  void albedo(Color color) {
    const float c[3] = {color.r, color.g, color.b};
    for (int k = 0; out_->albedo[0] && k < 3; k++) out_->albedo[k][lane_] = c[k];
  }

  Closures(const RtsHost* host, RtsBatch* batch, RtsSurface* out) : host_(host), batch_(batch), out_(out) {}
  void begin(uint32_t lane) { // the next hit
    lane_ = lane;
    for (uint32_t i = 0; i < count_; i++) free_[i] = true;
  }

 private:
  void add(RtsLobeKind kind, Color weight, float parameter = 0) {
    RtsLobe* lobe = slot(kind);
    if (!lobe) return;
    const float c[3] = {weight.r, weight.g, weight.b};
    for (int k = 0; k < 3; k++) lobe->weight[k][lane_] = c[k];
    lobe->parameter[0][lane_] = parameter;
  }
  // A lobe of this kind that the hit has not used yet.
  RtsLobe* slot(RtsLobeKind kind) {
    for (uint32_t i = 0; i < count_; i++) {
      if (!free_[i] || lobes_[i]->kind != kind) continue;
      free_[i] = false;
      return lobes_[i];
    }
    RtsLobe* made = count_ < RTS_MAX_LOBES ? host_->lobe(batch_, kind) : nullptr;
    if (made) lobes_[count_] = made, free_[count_++] = false;
    return made;
  }

  const RtsHost* host_;
  RtsBatch* batch_;
  RtsSurface* out_;
  uint32_t lane_ = 0, count_ = 0;
  RtsLobe* lobes_[RTS_MAX_LOBES] = {};
  bool free_[RTS_MAX_LOBES] = {};
};

template <class T> struct Surface {};
template <class T> struct LightSource {};
template <class T> struct Camera {};
template <class T> struct Environment {};

// Glue ------------------------------------------------------------------------------------------------------------------------

namespace detail {

template <class T, class = void> struct HasReflect : std::false_type {};
template <class T> struct HasReflect<
    T, std::void_t<decltype(std::declval<const T&>().reflect(std::declval<const Hit&>(), std::declval<const Light&>()))>>
    : std::true_type {};
template <class T, class = void> struct HasTransmit : std::false_type {};
template <class T> struct HasTransmit<T, std::void_t<decltype(std::declval<const T&>().transmit(std::declval<const Hit&>()))>>
    : std::true_type {};
template <class T, class = void> struct HasAttenuate : std::false_type {};
template <class T> struct HasAttenuate<T, std::void_t<decltype(std::declval<const T&>().attenuate(Vec3()))>> : std::true_type {};
template <class T, class = void> struct HasSurface : std::false_type {};
template <class T>
struct HasSurface<T,
                  std::void_t<decltype(std::declval<const T&>().surface(std::declval<const Hit&>(), std::declval<Closures&>()))>>
    : std::true_type {};
template <class T, class = void> struct HasText : std::false_type {};
template <class T> struct HasText<T, std::void_t<decltype(T::text)>> : std::true_type {};
template <class T, class = void> struct IsDirectional : std::false_type {};
template <class T> struct IsDirectional<T, std::void_t<decltype(T::directional)>> : std::bool_constant<T::directional> {};
template <class T, class = void> struct CastsShadows : std::true_type {};
template <class T> struct CastsShadows<T, std::void_t<decltype(T::shadows)>> : std::bool_constant<T::shadows> {};

inline Vec3 vec3(const float* const a[3], uint32_t i) { return {a[0][i], a[1][i], a[2][i]}; }
inline Color color(float* const a[3], uint32_t i) { return {a[0][i], a[1][i], a[2][i]}; }
inline void put(float* const a[3], uint32_t i, Vec3 v) {
  a[0][i] = v.x;
  a[1][i] = v.y;
  a[2][i] = v.z;
}
inline void put(float* const a[3], uint32_t i, Color c) { put(a, i, Vec3{c.r, c.g, c.b}); }
inline void add(float* const a[3], uint32_t i, Color c) { put(a, i, color(a, i) + c); }

// shadowRay: only what openrts.h promises to `transmit` is read.
inline Hit hitAt(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, uint32_t i, bool shadowRay) {
  Hit h;
  h.position = vec3(hits->position, i);
  h.direction = vec3(hits->direction, i);
  if (!shadowRay) {
    h.geometric = vec3(hits->geometric, i);
    h.normal = vec3(hits->normal, i);
    h.distance = hits->distance[i];
    if (host->minor >= 1) h.segment = hits->segment[i];
  }
  h.uv = {hits->uv[0][i], hits->uv[1][i]};
  h.color = {hits->color[0][i], hits->color[1][i], hits->color[2][i], hits->color[3][i]};
  h.flags = hits->flags[i];
  h.lane = i;
  h.host = host;
  h.batch = batch;
  return h;
}

template <class T> const T& shaderAt(const RtsHits* hits, uint32_t i) { return *static_cast<const T*>(hits->params[i]); }

template <class T> void addLights(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  const uint32_t count = host->lights(batch);
  uint8_t* wanted = reinterpret_cast<uint8_t*>(host->scratch(batch, hits->count));
  std::memset(wanted, 1, hits->count);
  for (uint32_t k = 0; k < count; k++) {
    RtsIllumination light{};
    host->illuminate(batch, k, hits, &light);
    host->shadow(batch, k, hits, wanted, &light);
    for (uint32_t i = 0; i < hits->count; i++) {
      const Light at{vec3(light.toLight, i), color(light.color, i), color(light.ambient, i)};
      add(out->radiance, i, shaderAt<T>(hits, i).reflect(hitAt(host, batch, hits, i, false), at));
    }
  }
}

template <class T> void shade(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  for (uint32_t i = 0; i < hits->count; i++) {
    const Shaded s = shaderAt<T>(hits, i).shade(hitAt(host, batch, hits, i, false));
    put(out->radiance, i, s.radiance);
    put(out->transmission, i, s.transmission);
    if (out->albedo[0]) put(out->albedo, i, s.albedo);
  }
  if constexpr (HasReflect<T>::value) addLights<T>(host, batch, hits, out);
}

template <class T> void surface(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out) {
  Closures closures(host, batch, out);
  for (uint32_t i = 0; i < hits->count; i++) {
    closures.begin(i);
    shaderAt<T>(hits, i).surface(hitAt(host, batch, hits, i, false), closures);
  }
}

template <class T> void transmit(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, float* const transmission[3]) {
  for (uint32_t i = 0; i < hits->count; i++)
    put(transmission, i, shaderAt<T>(hits, i).transmit(hitAt(host, batch, hits, i, true)));
}

template <class T>
void illuminate(const RtsHost*, RtsBatch*, const void* params, uint32_t n, const float* const local[3], RtsIllumination* out) {
  for (uint32_t i = 0; i < n; i++) {
    const Illumination l = static_cast<const T*>(params)->illuminate(vec3(local, i));
    put(out->toLight, i, l.toLight);
    put(out->color, i, l.color);
    put(out->ambient, i, l.ambient);
  }
  out->directional = IsDirectional<T>::value;
}

template <class T> void generate(const RtsHost*, RtsBatch*, const void* params, uint32_t n, const float* const xy[2],
                                 const float size[2], RtsRays* out) {
  for (uint32_t i = 0; i < n; i++) {
    const Ray ray = static_cast<const T*>(params)->generate(Vec2{xy[0][i], xy[1][i]}, Vec2{size[0], size[1]});
    put(out->origin, i, ray.origin);
    put(out->direction, i, ray.direction);
  }
}

template <class T>
void miss(const RtsHost*, RtsBatch*, const void* params, uint32_t n, const float* const direction[3], float* const rgba[4]) {
  for (uint32_t i = 0; i < n; i++) {
    const Vec4 c = static_cast<const T*>(params)->miss(vec3(direction, i));
    put(rgba, i, Vec3{c.x, c.y, c.z});
    rgba[3][i] = c.w;
  }
}

template <class T> void attenuate(const RtsHost*, RtsBatch*, const void* params, uint32_t n, const float* const fromEye[3],
                                  float* const color[3], float* fraction) {
  for (uint32_t i = 0; i < n; i++) {
    const Fog fog = static_cast<const T*>(params)->attenuate(vec3(fromEye, i));
    put(color, i, fog.color);
    fraction[i] = fog.fraction;
  }
}

template <class T, class = void> struct HasEmits : std::false_type {};
template <class T> struct HasEmits<T, std::void_t<decltype(std::declval<const T&>().emits())>> : std::true_type {};

template <class T> uint32_t traits(const RtsHost*, const void* params) {
  uint32_t t = 0;
  (void)params;
  if constexpr (HasEmits<T>::value) t |= static_cast<const T*>(params)->emits() ? uint32_t(RTS_EMISSIVE) : 0u;
  if constexpr (std::is_base_of_v<Surface<T>, T>) {
    if (HasTransmit<T>::value) t |= RTS_TRANSPARENT;
    if (!HasReflect<T>::value && !HasSurface<T>::value) t |= RTS_UNLIT;
  } else {
    if (!CastsShadows<T>::value) t |= RTS_NO_SHADOW;
  }
  return t;
}

template <class T> void fillFunctions(RtsClass& c) {
  if constexpr (std::is_base_of_v<Surface<T>, T>) {
    c.kind = RTS_SURFACE;
    c.traits = traits<T>;
    if constexpr (HasSurface<T>::value)
      c.surface = surface<T>;
    else
      c.shade = shade<T>;
    if constexpr (HasTransmit<T>::value) c.transmit = transmit<T>;
  } else if constexpr (std::is_base_of_v<LightSource<T>, T>) {
    c.kind = RTS_LIGHT;
    c.traits = traits<T>;
    c.illuminate = illuminate<T>;
  } else if constexpr (std::is_base_of_v<Camera<T>, T>) {
    c.kind = RTS_CAMERA;
    c.generate = generate<T>;
  } else {
    static_assert(std::is_base_of_v<Environment<T>, T>, "derive from rts::Surface, LightSource, Camera or Environment");
    c.kind = RTS_ENVIRONMENT;
    c.miss = miss<T>;
    if constexpr (HasAttenuate<T>::value) c.attenuate = attenuate<T>;
  }
}

// The tables of one class; they live as long as the plug-in.
template <class T> const RtsClass* classOf(std::string name) {
  static_assert(std::is_trivially_destructible_v<T> && !std::is_polymorphic_v<T>, "a shader holds rts::Param and nothing else");
  static Declaration params;
  static std::string ownName;
  static RtsClass table{};
  ownName = std::move(name);
  alignas(T) char prototype[sizeof(T)];
  params.start = prototype;
  declaration() = &params;
  new (prototype) T();
  declaration() = nullptr;
  table.size = sizeof(RtsClass);
  table.name = ownName.c_str();
  if constexpr (HasText<T>::value)
    table.text = T::text;
  else
    table.text = "";
  table.paramSize = static_cast<uint32_t>(sizeof(T)); // never 0: functions are called on what lies there
  table.paramCount = static_cast<uint32_t>(params.params.size());
  table.params = params.params.data();
  fillFunctions<T>(table);
  return &table;
}

// Takes the next of "a::Mirror, Glass" off the list: the class's own name.
inline std::string nextName(const char*& list) {
  const char* end = std::strchr(list, ',');
  std::string name = end ? std::string(list, end) : std::string(list);
  list = end ? end + 1 : list + name.size();
  name.erase(0, name.find_first_not_of(" \t\n"));
  name.erase(name.find_last_not_of(" \t\n") + 1);
  const size_t scope = name.rfind("::");
  return scope == std::string::npos ? name : name.substr(scope + 2);
}

template <class... T> RtsPlugin pluginOf(const char* names) {
  static const RtsClass* const classes[] = {classOf<T>(nextName(names))...}; // braces: from left to right
  return {RTS_MAGIC, RTS_ABI_MAJOR, RTS_ABI_MINOR, sizeof(RtsPlugin), sizeof...(T), classes};
}

} // namespace detail
} // namespace rts

// Exports the classes, each under its own name. Once a library, outside any namespace.
#define RTS_PLUGIN(...)                                                                                                          \
  extern "C" {                                                                                                                   \
  extern RTS_EXPORT const RtsPlugin rtsPlugin;                                                                                   \
  const RtsPlugin rtsPlugin = rts::detail::pluginOf<__VA_ARGS__>(#__VA_ARGS__);                                                  \
  }

#endif
