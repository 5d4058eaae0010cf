// openrts_loops.hpp: the batch functions of openrts.h for the classes of openrts.hpp: loops that
// call the functions of a class for one hit or for several (Lanes). Part of openrts.hpp. [render]
#include "openrts.hpp" // before the guard: it includes this file in the right place

#ifndef OPENRT_OPENRTS_LOOPS_HPP
#define OPENRT_OPENRTS_LOOPS_HPP

#include <cstring>
#include <type_traits>
#include <utility>

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
RTS_DETECT(HasTransmits, std::declval<const T&>().transmits());
RTS_DETECT(HasSurface,
           std::declval<const T&>().surface(std::declval<const Hit&>(), std::declval<Closures&>()));
// The same functions for several hits at once.
RTS_DETECT(ShadesLanes, std::declval<const T&>().shade(std::declval<const HitOf<Lanes>&>()));
RTS_DETECT(ReflectsLanes, std::declval<const T&>().reflect(std::declval<const HitOf<Lanes>&>(),
                                                           std::declval<const LightOf<Lanes>&>()));
RTS_DETECT(TransmitsLanes, std::declval<const T&>().transmit(std::declval<const HitOf<Lanes>&>()));
RTS_DETECT(SurfacesLanes, std::declval<const T&>().surface(std::declval<const HitOf<Lanes>&>(),
                                                           std::declval<ClosuresOf<Lanes>&>()));
RTS_DETECT(IlluminatesLanes, std::declval<const T&>().illuminate(Vec3Of<Lanes>()));
RTS_DETECT(GeneratesLanes, std::declval<const T&>().generate(Vec2Of<Lanes>(), Vec2()));
RTS_DETECT(MissesLanes, std::declval<const T&>().miss(Vec3Of<Lanes>()));
RTS_DETECT(AttenuatesLanes, std::declval<const T&>().attenuate(Vec3Of<Lanes>()));
RTS_DETECT(HasEmits, std::declval<const T&>().emits());
RTS_DETECT(HasEmitsUniformly, std::declval<const T&>().emitsUniformly());
RTS_DETECT(HasMedium, std::declval<const T&>().medium());
RTS_DETECT(HasNeeds, T::needs);
RTS_DETECT(ComputesNeeds, std::declval<const T&>().needs());
RTS_DETECT(HasExtent, std::declval<const T&>().extent());
RTS_DETECT(HasOpening, std::declval<const T&>().opening(Vec3(), Vec3()));
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

// Load and store the values of hit i, or of the group of hits that begins at i (F = Lanes).
template <class F> Vec3Of<F> vec3(const float* const a[3], uint32_t i) {
  return {load<F>(a[0] + i), load<F>(a[1] + i), load<F>(a[2] + i)};
}
template <class F> ColorOf<F> color(float* const a[3], uint32_t i) {
  return {load<F>(a[0] + i), load<F>(a[1] + i), load<F>(a[2] + i)};
}
template <class F> void put(float* const a[3], uint32_t i, Vec3Of<F> v) {
  store<F>(a[0] + i, v.x);
  store<F>(a[1] + i, v.y);
  store<F>(a[2] + i, v.z);
}
template <class F> void put(float* const a[3], uint32_t i, ColorOf<F> c) {
  put(a, i, Vec3Of<F>{c.r, c.g, c.b});
}

// Lanes where a class's function takes them, else float.
template <bool inLanes> using NumberFor = std::conditional_t<inLanes, Lanes, float>;
template <class F> inline constexpr uint32_t widthOf = sizeof(F) / sizeof(float);

// Surfaces ----------------------------------------------------------------------------------------

// Reads the numbers of hit i, or of the group that begins at i. If shadowRay is true, reads only
// the arrays that are valid in `transmit` (openrts.h).
template <class F>
void readNumbers(const RtsHits* hits, uint32_t i, bool shadowRay, HitNumbers<F>& h) {
  h.position = vec3<F>(hits->position, i);
  h.direction = vec3<F>(hits->direction, i);
  if (!shadowRay) {
    h.geometric = vec3<F>(hits->geometric, i);
    h.normal = vec3<F>(hits->normal, i);
    h.distance = load<F>(hits->distance + i);
    h.segment = load<F>(hits->segment + i);
  }
  h.uv = {load<F>(hits->uv[0] + i), load<F>(hits->uv[1] + i)};
  h.color = {load<F>(hits->color[0] + i), load<F>(hits->color[1] + i), load<F>(hits->color[2] + i),
             load<F>(hits->color[3] + i)};
}

// A batch of hits, and what the shader has asked the host about it.
struct HitBatch {
  const RtsHost* host;
  RtsBatch* batch;
  const RtsHits* hits;
  bool shadowRays = false;
  Asked asked{};

  template <class F> HitOf<F> at(uint32_t i) {
    HitOf<F> h;
    readNumbers<F>(hits, i, shadowRays, h);
    if constexpr (std::is_same_v<F, float>) {
      h.flags = hits->flags[i];
      setTracer(h, i);
    } else {
      h.flags = hits->flags + i;
      setTracer(h.first, i);
    }
    return h;
  }
  template <class T> const T& shader(uint32_t i) const {
    return *static_cast<const T*>(hits->params[i]);
  }

 private:
  void setTracer(Tracer& t, uint32_t i) {
    t.lane = i;
    t.count = hits->count;
    t.host = host;
    t.batch = batch;
    t.asked = &asked;
  }
};

// Calls visit(F, i) for every hit i (F = float), or for every group of hits that begins at i
// (F = Lanes). Hits whose neighbours have other parameters are visited one by one.
template <bool inLanes, class Visit> void eachHit(const RtsHits* hits, const Visit& visit) {
  constexpr uint32_t width = widthOf<NumberFor<inLanes>>;
  for (uint32_t first = 0; first < hits->count; first += width) {
    const uint32_t end = first + width < hits->count ? first + width : hits->count;
    if constexpr (inLanes) {
      bool same = true;
      for (uint32_t i = first + 1; i < end; i++) same &= hits->params[i] == hits->params[first];
      if (same) {
        visit(Lanes(), first);
        continue;
      }
    }
    for (uint32_t i = first; i < end; i++) visit(0.0f, i);
  }
}

template <class T> void addLights(HitBatch& b, RtsShading* out) {
  const RtsHits* hits = b.hits;
  const uint32_t count = b.host->lights(b.batch);
  uint8_t* wanted = reinterpret_cast<uint8_t*>(b.host->scratch(b.batch, hits->count));
  std::memset(wanted, 1, hits->count);
  for (uint32_t k = 0; k < count; k++) {
    RtsIllumination light{};
    b.host->illuminate(b.batch, k, hits, &light);
    b.host->shadow(b.batch, k, hits, wanted, &light);
    eachHit<ReflectsLanes<T>::value>(hits, [&](auto number, uint32_t i) {
      using F = decltype(number);
      const LightOf<F> at{vec3<F>(light.toLight, i), color<F>(light.color, i),
                          color<F>(light.ambient, i)};
      const ColorOf<F> reflected = b.shader<T>(i).reflect(b.at<F>(i), at);
      put(out->radiance, i, color<F>(out->radiance, i) + reflected);
    });
  }
}

template <class T>
void shade(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  HitBatch b{host, batch, hits};
  eachHit<ShadesLanes<T>::value>(hits, [&](auto number, uint32_t i) {
    using F = decltype(number);
    const ShadedOf<F> s = b.shader<T>(i).shade(b.at<F>(i));
    put(out->radiance, i, s.radiance);
    put(out->transmission, i, s.transmission);
    if (out->albedo[0]) put(out->albedo, i, s.albedo);
  });
  if constexpr (HasReflect<T>::value) addLights<T>(b, out);
}

template <class T>
void surface(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out) {
  HitBatch b{host, batch, hits};
  LobeList lobes(host, batch);
  eachHit<SurfacesLanes<T>::value>(hits, [&](auto number, uint32_t i) {
    using F = decltype(number);
    ClosuresOf<F> closures(lobes, out, i);
    b.shader<T>(i).surface(b.at<F>(i), closures);
  });
}

template <class T> void transmit(const RtsHost* host, RtsBatch* batch, const RtsHits* hits,
                                 float* const transmission[3]) {
  HitBatch b{host, batch, hits, true};
  eachHit<TransmitsLanes<T>::value>(hits, [&](auto number, uint32_t i) {
    using F = decltype(number);
    const ColorOf<F> through = b.shader<T>(i).transmit(b.at<F>(i));
    put(transmission, i, through);
  });
}

template <class T> int medium(const RtsHost*, const void* params, RtsMedium* out) {
  const Medium m = static_cast<const T*>(params)->medium();
  const float index[3] = {m.index.r, m.index.g, m.index.b},
              absorption[3] = {m.absorption.r, m.absorption.g, m.absorption.b},
              scattering[3] = {m.scattering.r, m.scattering.g, m.scattering.b};
  for (int k = 0; k < 3; k++) {
    out->index[k] = index[k];
    out->absorption[k] = absorption[k];
    out->scattering[k] = scattering[k];
  }
  out->anisotropy = m.anisotropy;
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
      const Vec3 toEye = -vec3<float>(hits->direction, i),
                 normal{lobe->normal[0][i], lobe->normal[1][i], lobe->normal[2][i]};
      put(value, j, l.evaluate(toEye, vec3<float>(direction, j), normal));
      density[j] = l.density(toEye, vec3<float>(direction, j), normal);
    }
  }
  static void sample(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
                     const float* const square[2], float* const direction[3],
                     float* const quotient[3], float* density) {
    for (uint32_t j = 0; j < n; j++) {
      const uint32_t i = hit[j];
      const L l = load(lobe, i);
      const Vec3 toEye = -vec3<float>(hits->direction, i),
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
  using F = NumberFor<IlluminatesLanes<T>::value>;
  for (uint32_t i = 0; i < n; i += widthOf<F>) {
    const IlluminationOf<F> l = static_cast<const T*>(params)->illuminate(vec3<F>(local, i));
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

template <class T> void opening(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                                const float* const origin[3], const float* const direction[3],
                                float* distance, float* const radiance[3]) {
  for (uint32_t i = 0; i < n; i++) {
    const Opening seen =
        static_cast<const T*>(params)->opening(vec3<float>(origin, i), vec3<float>(direction, i));
    distance[i] = seen.distance;
    put(radiance, i, seen.radiance);
  }
}

template <class T> void generate(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                                 const float* const xy[2], const float size[2], RtsRays* out) {
  using F = NumberFor<GeneratesLanes<T>::value>;
  for (uint32_t i = 0; i < n; i += widthOf<F>) {
    const Vec2Of<F> pixel{load<F>(xy[0] + i), load<F>(xy[1] + i)};
    const RayOf<F> ray = static_cast<const T*>(params)->generate(pixel, Vec2{size[0], size[1]});
    put(out->origin, i, ray.origin);
    put(out->direction, i, ray.direction);
  }
}

template <class T> void project(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                                const float* const local[3], const float* const lens[2],
                                const float size[2], RtsProjection* out) {
  for (uint32_t i = 0; i < n; i++) {
    const Vec2 place = lens && lens[0] ? Vec2{lens[0][i], lens[1][i]} : Vec2{0.5f, 0.5f};
    const Projection p = static_cast<const T*>(params)->project(vec3<float>(local, i), place,
                                                                Vec2{size[0], size[1]});
    out->xy[0][i] = p.pixel.x;
    out->xy[1][i] = p.pixel.y;
    put(out->toEye, i, p.toEye);
    out->weight[i] = p.weight;
  }
  out->parallel = IsParallel<T>::value;
}

template <class T> void miss(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                             const float* const direction[3], float* const rgba[4]) {
  using F = NumberFor<MissesLanes<T>::value>;
  for (uint32_t i = 0; i < n; i += widthOf<F>) {
    const Vec4Of<F> c = static_cast<const T*>(params)->miss(vec3<F>(direction, i));
    put(rgba, i, Vec3Of<F>{c.x, c.y, c.z});
    store<F>(rgba[3] + i, c.w);
  }
}

template <class T> void attenuate(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                                  const float* const fromEye[3], float* const color[3],
                                  float* fraction) {
  using F = NumberFor<AttenuatesLanes<T>::value>;
  for (uint32_t i = 0; i < n; i += widthOf<F>) {
    const FogOf<F> fog = static_cast<const T*>(params)->attenuate(vec3<F>(fromEye, i));
    put(color, i, fog.color);
    store<F>(fraction + i, fog.fraction);
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
    ray.origin = vec3<float>(rays->origin, i);
    ray.direction = vec3<float>(rays->direction, i);
    ray.length = rays->length ? rays->length[i] : infinity;
    const Vec4 c = static_cast<const T*>(params)->radiance(ray);
    put(rgba, i, Vec3{c.x, c.y, c.z});
    if (rgba[3]) rgba[3][i] = c.w;
  }
}

} // namespace detail
} // namespace rts

#endif
