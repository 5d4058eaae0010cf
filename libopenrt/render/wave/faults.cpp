#include "render/wave/faults.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "render/lanes/all_finite.h"
#include "shading/running.h"

namespace openrt {
namespace {

const char* textOf(Fault fault) {
  switch (fault) {
  case Fault::notFinite:
    return "returned NaN or infinity, which is replaced by 0. Look for divisions by 0 and roots of "
           "negative numbers";
  case Fault::undeclaredGlossy:
    return "has glossy lobes, but its traits lack RTS_GLOSSY: the automatic transport does not "
           "know that they scatter";
  case Fault::undeclaredEmission:
    return "has emission, but its traits lack RTS_EMISSIVE: its light is not sampled directly, so "
           "the picture is noisier than necessary";
  case Fault::undeclaredTransparency:
    return "lets light through, but its traits lack RTS_TRANSPARENT: its shadows are opaque";
  case Fault::undeclaredScattering:
    return "has lobes that scatter, but its traits have RTS_NO_SCATTER: the automatic transport "
           "may leave out light";
  case Fault::varyingEmission:
    return "has emission that varies, but its traits have RTS_UNIFORM_EMISSION: light samples take "
           "the same radiance everywhere";
  case Fault::neverEntered:
    return "bounds bodies that paths have left but never entered: a mesh of it is open, is inside "
           "out, or belongs together with one whose shader has other parameters. Such a boundary "
           "refracts nothing, or wrongly";
  }
  return "";
}

} // namespace

void ShaderFaults::add(const RtsClass& shaderClass, Fault fault, uint64_t hits) {
  for (Entry& e : entries_)
    if (e.shaderClass == &shaderClass && e.fault == fault) {
      e.hits += hits;
      return;
    }
  entries_.push_back({&shaderClass, fault, hits});
}

void ShaderFaults::add(const ShaderFaults& more) {
  for (const Entry& e : more.entries_) add(*e.shaderClass, e.fault, e.hits);
}

uint64_t ShaderFaults::count(Fault fault) const {
  uint64_t sum = 0;
  for (const Entry& e : entries_) sum += e.fault == fault ? e.hits : 0;
  return sum;
}

void ShaderFaults::report(RTlogCallback callback, void* user, uint64_t cameraRays) const {
  if (!callback || entries_.empty()) return;
  std::vector<Entry> sorted = entries_;
  std::sort(sorted.begin(), sorted.end(), [](const Entry& a, const Entry& b) {
    const int order = std::strcmp(labelOf(*a.shaderClass), labelOf(*b.shaderClass));
    return order != 0 ? order < 0 : a.fault < b.fault;
  });
  for (const Entry& e : sorted) {
    if (e.fault == Fault::neverEntered && e.hits < cameraRays / 1000 + 1) continue;
    const std::string text = "shader " + std::string(labelOf(*e.shaderClass)) + " " +
                             textOf(e.fault) + " (" + std::to_string(e.hits) +
                             (e.hits == 1 ? " point)" : " points)");
    callback(2, text.c_str(), user);
  }
}

} // namespace openrt
