// openrts_glue.hpp: builds the tables of openrts.h from the classes of openrts.hpp, with the batch
// functions of openrts_loops.hpp. Part of openrts.hpp. The tables are built when the plug-in is
// loaded.
#ifndef OPENRT_OPENRTS_GLUE_HPP
#define OPENRT_OPENRTS_GLUE_HPP

#include <cstring>
#include <new>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "openrts_loops.hpp"

namespace rts {
namespace detail {

// Tables ------------------------------------------------------------------------------------------

template <class T> uint32_t surfaceTraits(const void* params) {
  uint32_t t = HasTransmit<T>::value ? uint32_t(RTS_TRANSPARENT) : 0u;
  const T* shader = static_cast<const T*>(params);
  (void)shader;
  if constexpr (HasTransmits<T>::value) t = shader->transmits() ? t : 0u;
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
    if constexpr (HasOpening<T>::value) c.opening = opening<T>;
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

template <class F> template <class L> void ClosuresOf<F>::custom(Color weight, const L& own) {
  constexpr uint32_t floats = detail::LobeLoops<L>::floats;
  const RtsLobe* lobe = add(RTS_LOBE_CUSTOM, weight, 0, 0, lobeFunctions<L>(), floats);
  if (!lobe) return;
  float data[RTS_MAX_LOBE_FLOATS] = {};
  if constexpr (floats > 0) std::memcpy(data, &own, sizeof own);
  for (uint32_t k = 0; k < floats; k++) detail::store<F>(lobe->data[k] + lane_, data[k]);
}

} // namespace rts

#endif
