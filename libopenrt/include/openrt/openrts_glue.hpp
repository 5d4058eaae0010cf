// openrts_glue.hpp: builds the tables of openrts.h from the classes of openrts.hpp, and loops over
// batches to call the functions for single hits. Part of openrts.hpp. The loops run on [render]
// threads; the tables are built when the plug-in is loaded.
#ifndef OPENRT_OPENRTS_GLUE_HPP
#define OPENRT_OPENRTS_GLUE_HPP

#include <cstring>
#include <new>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "openrts.hpp"

namespace rts {
namespace detail {

// Detects which of the optional members a class has.
#define RTS_DETECT(Name, expression)                                                               \
  template <class T, class = void> struct Name : std::false_type {};                               \
  template <class T> struct Name<T, std::void_t<decltype(expression)>> : std::true_type {}
RTS_DETECT(HasShade, std::declval<const T&>().shade(std::declval<const Hit&>()));
RTS_DETECT(HasReflect, std::declval<const T&>().reflect(std::declval<const Hit&>(),
                                                        std::declval<const Light&>()));
RTS_DETECT(HasTransmit, std::declval<const T&>().transmit(std::declval<const Hit&>()));
RTS_DETECT(HasSurface,
           std::declval<const T&>().surface(std::declval<const Hit&>(), std::declval<Closures&>()));
RTS_DETECT(HasEmits, std::declval<const T&>().emits());
RTS_DETECT(HasEmitsUniformly, std::declval<const T&>().emitsUniformly());
RTS_DETECT(HasMedium, std::declval<const T&>().medium());
RTS_DETECT(HasNeeds, T::needs);
RTS_DETECT(ComputesNeeds, std::declval<const T&>().needs());
RTS_DETECT(HasExtent, std::declval<const T&>().extent());
RTS_DETECT(HasProject, std::declval<const T&>().project(Vec3(), Vec2(), Vec2()));
RTS_DETECT(HasAttenuate, std::declval<const T&>().attenuate(Vec3()));
RTS_DETECT(HasPrepare, std::declval<T&>().prepare());
RTS_DETECT(HasRelease, std::declval<T&>().release());
RTS_DETECT(HasText, T::text);
#undef RTS_DETECT

template <class T, class = void> struct IsDirectional : std::false_type {};
template <class T> struct IsDirectional<T, std::void_t<decltype(T::directional)>>
    : std::bool_constant<T::directional> {};
template <class T, class = void> struct IsParallel : std::false_type {};
template <class T> struct IsParallel<T, std::void_t<decltype(T::parallel)>>
    : std::bool_constant<T::parallel> {};
template <class T, class = void> struct CastsShadows : std::true_type {};
template <class T> struct CastsShadows<T, std::void_t<decltype(T::shadows)>>
    : std::bool_constant<T::shadows> {};
template <class L, class = void> struct Transmits : std::false_type {};
template <class L> struct Transmits<L, std::void_t<decltype(L::transmits)>>
    : std::bool_constant<L::transmits> {};

inline Vec3 vec3(const float* const a[3], uint32_t i) { return {a[0][i], a[1][i], a[2][i]}; }
inline Color color(float* const a[3], uint32_t i) { return {a[0][i], a[1][i], a[2][i]}; }
inline void put(float* const a[3], uint32_t i, Vec3 v) {
  a[0][i] = v.x;
  a[1][i] = v.y;
  a[2][i] = v.z;
}
inline void put(float* const a[3], uint32_t i, Color c) { put(a, i, Vec3{c.r, c.g, c.b}); }
inline void add(float* const a[3], uint32_t i, Color c) { put(a, i, color(a, i) + c); }

// Surfaces ----------------------------------------------------------------------------------------

// Returns hit i of a batch. If shadowRay is true, reads only the arrays that are valid in
// `transmit` (openrts.h).
inline Hit hitAt(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, uint32_t i,
                 Asked& asked, bool shadowRay) {
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
  h.count = hits->count;
  h.host = host;
  h.batch = batch;
  h.asked = &asked;
  return h;
}

template <class T> const T& shaderAt(const RtsHits* hits, uint32_t i) {
  return *static_cast<const T*>(hits->params[i]);
}

template <class T> void addLights(const RtsHost* host, RtsBatch* batch, const RtsHits* hits,
                                  Asked& asked, RtsShading* out) {
  const uint32_t count = host->lights(batch);
  uint8_t* wanted = reinterpret_cast<uint8_t*>(host->scratch(batch, hits->count));
  std::memset(wanted, 1, hits->count);
  for (uint32_t k = 0; k < count; k++) {
    RtsIllumination light{};
    host->illuminate(batch, k, hits, &light);
    host->shadow(batch, k, hits, wanted, &light);
    for (uint32_t i = 0; i < hits->count; i++) {
      const Light at{vec3(light.toLight, i), color(light.color, i), color(light.ambient, i)};
      add(out->radiance, i,
          shaderAt<T>(hits, i).reflect(hitAt(host, batch, hits, i, asked, false), at));
    }
  }
}

template <class T>
void shade(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  Asked asked;
  for (uint32_t i = 0; i < hits->count; i++) {
    const Shaded s = shaderAt<T>(hits, i).shade(hitAt(host, batch, hits, i, asked, false));
    put(out->radiance, i, s.radiance);
    put(out->transmission, i, s.transmission);
    if (out->albedo[0]) put(out->albedo, i, s.albedo);
  }
  if constexpr (HasReflect<T>::value) addLights<T>(host, batch, hits, asked, out);
}

template <class T>
void surface(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out) {
  Asked asked;
  Closures closures(host, batch, out);
  for (uint32_t i = 0; i < hits->count; i++) {
    closures.begin(i);
    shaderAt<T>(hits, i).surface(hitAt(host, batch, hits, i, asked, false), closures);
  }
}

template <class T> void transmit(const RtsHost* host, RtsBatch* batch, const RtsHits* hits,
                                 float* const transmission[3]) {
  Asked asked;
  for (uint32_t i = 0; i < hits->count; i++)
    put(transmission, i, shaderAt<T>(hits, i).transmit(hitAt(host, batch, hits, i, asked, true)));
}

template <class T> int medium(const RtsHost*, const void* params, RtsMedium* out) {
  const Medium m = static_cast<const T*>(params)->medium();
  const float index[3] = {m.index.r, m.index.g, m.index.b},
              absorption[3] = {m.absorption.r, m.absorption.g, m.absorption.b};
  for (int k = 0; k < 3; k++) {
    out->index[k] = index[k];
    out->absorption[k] = absorption[k];
  }
  out->priority = m.priority;
  return m.present;
}

// Lobes -------------------------------------------------------------------------------------------

template <class L> struct LobeLoops {
  static_assert(std::is_trivially_copyable_v<L> && alignof(L) <= alignof(float),
                "a lobe is made of floats");
  static constexpr uint32_t floats = std::is_empty_v<L> ? 0 : sizeof(L) / sizeof(float);
  static_assert(floats <= RTS_MAX_LOBE_FLOATS &&
                    (std::is_empty_v<L> || sizeof(L) % sizeof(float) == 0),
                "too many floats");

  static L load(const RtsLobe* lobe, uint32_t i) {
    float data[RTS_MAX_LOBE_FLOATS] = {};
    for (uint32_t k = 0; k < floats; k++) data[k] = lobe->data[k][i];
    L l{};
    if constexpr (floats > 0) std::memcpy(static_cast<void*>(&l), data, sizeof l);
    return l;
  }
  static void evaluate(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
                       const float* const direction[3], float* const value[3], float* density) {
    for (uint32_t j = 0; j < n; j++) {
      const uint32_t i = hit[j];
      const L l = load(lobe, i);
      const Vec3 toEye = -vec3(hits->direction, i),
                 normal{lobe->normal[0][i], lobe->normal[1][i], lobe->normal[2][i]};
      put(value, j, l.evaluate(toEye, vec3(direction, j), normal));
      density[j] = l.density(toEye, vec3(direction, j), normal);
    }
  }
  static void sample(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
                     const float* const square[2], float* const direction[3],
                     float* const quotient[3], float* density) {
    for (uint32_t j = 0; j < n; j++) {
      const uint32_t i = hit[j];
      const L l = load(lobe, i);
      const Vec3 toEye = -vec3(hits->direction, i),
                 normal{lobe->normal[0][i], lobe->normal[1][i], lobe->normal[2][i]};
      const Sample s =
          complete(l, l.sample(toEye, Vec2{square[0][j], square[1][j]}, normal), toEye, normal);
      put(direction, j, s.direction);
      put(quotient, j, s.quotient);
      density[j] = s.density;
    }
  }

 private:
  static Sample complete(const L&, const Sample& sample, Vec3, Vec3) { return sample; }
  static Sample complete(const L& l, Vec3 direction, Vec3 toEye, Vec3 normal) {
    const float density = l.density(toEye, direction, normal);
    if (!(density > 0)) return {direction, {}, 0};
    return {direction, l.evaluate(toEye, direction, normal) / density, density};
  }
};

// Lights, cameras, environments, transports -------------------------------------------------------

template <class T> void illuminate(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                                   const float* const local[3], RtsIllumination* out) {
  for (uint32_t i = 0; i < n; i++) {
    const Illumination l = static_cast<const T*>(params)->illuminate(vec3(local, i));
    put(out->toLight, i, l.toLight);
    put(out->color, i, l.color);
    put(out->ambient, i, l.ambient);
  }
  out->directional = IsDirectional<T>::value;
}

template <class T> int extent(const RtsHost*, const void* params, RtsExtent* out) {
  const Extent e = static_cast<const T*>(params)->extent();
  const float position[3] = {e.position.x, e.position.y, e.position.z};
  const float direction[3] = {e.direction.x, e.direction.y, e.direction.z};
  for (int k = 0; k < 3; k++) {
    out->position[k] = position[k];
    out->direction[k] = direction[k];
  }
  out->parallel = e.parallel;
  out->cosine = e.cosine;
  out->power = e.power;
  out->radius = e.radius;
  return e.known;
}

template <class T> void generate(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                                 const float* const xy[2], const float size[2], RtsRays* out) {
  for (uint32_t i = 0; i < n; i++) {
    const Ray ray =
        static_cast<const T*>(params)->generate(Vec2{xy[0][i], xy[1][i]}, Vec2{size[0], size[1]});
    put(out->origin, i, ray.origin);
    put(out->direction, i, ray.direction);
  }
}

template <class T> void project(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                                const float* const local[3], const float* const lens[2],
                                const float size[2], RtsProjection* out) {
  for (uint32_t i = 0; i < n; i++) {
    const Vec2 place = lens && lens[0] ? Vec2{lens[0][i], lens[1][i]} : Vec2{0.5f, 0.5f};
    const Projection p =
        static_cast<const T*>(params)->project(vec3(local, i), place, Vec2{size[0], size[1]});
    out->xy[0][i] = p.pixel.x;
    out->xy[1][i] = p.pixel.y;
    put(out->toEye, i, p.toEye);
    out->weight[i] = p.weight;
  }
  out->parallel = IsParallel<T>::value;
}

template <class T> void miss(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                             const float* const direction[3], float* const rgba[4]) {
  for (uint32_t i = 0; i < n; i++) {
    const Vec4 c = static_cast<const T*>(params)->miss(vec3(direction, i));
    put(rgba, i, Vec3{c.x, c.y, c.z});
    rgba[3][i] = c.w;
  }
}

template <class T> void attenuate(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                                  const float* const fromEye[3], float* const color[3],
                                  float* fraction) {
  for (uint32_t i = 0; i < n; i++) {
    const Fog fog = static_cast<const T*>(params)->attenuate(vec3(fromEye, i));
    put(color, i, fog.color);
    fraction[i] = fog.fraction;
  }
}

template <class T> void radiance(const RtsHost* host, RtsBatch* batch, const void* params,
                                 const RtsRequest* rays, float* const rgba[4]) {
  Asked asked;
  CameraRay ray;
  ray.host = host;
  ray.batch = batch;
  ray.count = rays->count;
  ray.asked = &asked;
  for (uint32_t i = 0; i < rays->count; i++) {
    ray.lane = i;
    ray.origin = vec3(rays->origin, i);
    ray.direction = vec3(rays->direction, i);
    ray.length = rays->length ? rays->length[i] : infinity;
    const Vec4 c = static_cast<const T*>(params)->radiance(ray);
    put(rgba, i, Vec3{c.x, c.y, c.z});
    if (rgba[3]) rgba[3][i] = c.w;
  }
}

// Tables ------------------------------------------------------------------------------------------

template <class T> uint32_t surfaceTraits(const void* params) {
  uint32_t t = HasTransmit<T>::value ? uint32_t(RTS_TRANSPARENT) : 0u;
  const T* shader = static_cast<const T*>(params);
  (void)shader;
  if constexpr (HasEmits<T>::value) t |= shader->emits() ? uint32_t(RTS_EMISSIVE) : 0u;
  if constexpr (HasEmitsUniformly<T>::value)
    t |= (t & RTS_EMISSIVE) && shader->emitsUniformly() ? uint32_t(RTS_UNIFORM_EMISSION) : 0u;
  if constexpr (ComputesNeeds<T>::value)
    t |= shader->needs();
  else if constexpr (HasNeeds<T>::value)
    t |= T::needs;
  else if constexpr (HasSurface<T>::value)
    t |= RTS_SPECULAR;
  if (!HasReflect<T>::value && !HasSurface<T>::value) t |= RTS_UNLIT;
  return t;
}

template <class T> uint32_t traits(const RtsHost*, const void* params) {
  (void)params;
  if constexpr (std::is_base_of_v<Surface<T>, T>)
    return surfaceTraits<T>(params);
  else
    return CastsShadows<T>::value ? 0u : uint32_t(RTS_NO_SHADOW);
}

template <class T> const char* prepare(const RtsHost*, void* params) {
  return static_cast<T*>(params)->prepare();
}
template <class T> void release(const RtsHost*, void* params) {
  static_cast<T*>(params)->release();
}

template <class T> void fillSurface(RtsClass& c) {
  static_assert(HasShade<T>::value || HasSurface<T>::value,
                "a surface has `surface` or `shade`, both const");
  c.kind = RTS_SURFACE;
  c.traits = traits<T>;
  if constexpr (HasSurface<T>::value) c.surface = surface<T>;
  if constexpr (HasShade<T>::value) c.shade = shade<T>;
  if constexpr (HasTransmit<T>::value) c.transmit = transmit<T>;
  if constexpr (HasMedium<T>::value) c.medium = medium<T>;
}

template <class T> void fillFunctions(RtsClass& c) {
  if constexpr (HasPrepare<T>::value) c.prepare = prepare<T>;
  if constexpr (HasRelease<T>::value) c.release = release<T>;
  if constexpr (std::is_base_of_v<Surface<T>, T>) {
    fillSurface<T>(c);
  } else if constexpr (std::is_base_of_v<LightSource<T>, T>) {
    c.kind = RTS_LIGHT;
    c.traits = traits<T>;
    c.illuminate = illuminate<T>;
    if constexpr (HasExtent<T>::value) c.extent = extent<T>;
  } else if constexpr (std::is_base_of_v<Camera<T>, T>) {
    c.kind = RTS_CAMERA;
    c.generate = generate<T>;
    if constexpr (HasProject<T>::value) c.project = project<T>;
  } else if constexpr (std::is_base_of_v<Transport<T>, T>) {
    c.kind = RTS_TRANSPORT;
    c.radiance = radiance<T>;
  } else {
    static_assert(std::is_base_of_v<Environment<T>, T>,
                  "derive from rts::Surface, LightSource, Camera, Environment or Transport");
    c.kind = RTS_ENVIRONMENT;
    c.miss = miss<T>;
    if constexpr (HasAttenuate<T>::value) c.attenuate = attenuate<T>;
  }
}

// Builds the tables of one class; they live as long as the plug-in.
template <class T> const RtsClass* classOf(std::string name) {
  static_assert(std::is_trivially_destructible_v<T> && !std::is_polymorphic_v<T>,
                "a shader holds rts::Param and plain values");
  static Declaration params;
  static std::string ownName;
  static RtsClass table{};
  ownName = std::move(name);
  alignas(T) char prototype[sizeof(T)];
  params.start = prototype;
  declaration() = &params;
  new (prototype) T();
  declaration() = nullptr;
  params.start = nullptr; // the offsets are known; the prototype is no longer needed
  table.size = sizeof(RtsClass);
  table.name = ownName.c_str();
  if constexpr (HasText<T>::value)
    table.text = T::text;
  else
    table.text = "";
  // Never 0: member functions are called on the object at this address.
  table.paramSize = static_cast<uint32_t>(sizeof(T));
  table.paramCount = static_cast<uint32_t>(params.params.size());
  table.params = params.params.data();
  table.frequency = params.frequency.data();
  fillFunctions<T>(table);
  return &table;
}

// Removes the first entry from a list like "a::Mirror, Glass" and returns it without namespaces.
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
  // Braces evaluate from left to right, in the order of the names.
  static const RtsClass* const classes[] = {classOf<T>(nextName(names))...};
  return {RTS_MAGIC, RTS_ABI_MAJOR, RTS_ABI_MINOR, sizeof(RtsPlugin), sizeof...(T), classes};
}

} // namespace detail

template <class L> const RtsLobeFunctions* lobeFunctions() {
  using Loops = detail::LobeLoops<L>;
  static const RtsLobeFunctions table = {sizeof(RtsLobeFunctions), detail::Transmits<L>::value,
                                         Loops::evaluate, Loops::sample};
  return &table;
}

template <class L> void Closures::custom(Color weight, const L& own) {
  constexpr uint32_t floats = detail::LobeLoops<L>::floats;
  const RtsLobe* lobe = add(RTS_LOBE_CUSTOM, weight, 0, 0, lobeFunctions<L>(), floats);
  if (!lobe) return;
  float data[RTS_MAX_LOBE_FLOATS] = {};
  if constexpr (floats > 0) std::memcpy(data, &own, sizeof own);
  for (uint32_t k = 0; k < floats; k++) lobe->data[k][lane_] = data[k];
}

} // namespace rts

#endif
