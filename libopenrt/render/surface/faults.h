// faults.h: answers of shaders that cannot be right: numbers that are not finite, and, where
// somebody asks for a diagnosis, lobes that the class's traits do not announce. They are made
// harmless at once and counted by class; a frame says it once, at its end. [render]
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "openrt/openrt.h"
#include "openrt/openrts.h"

namespace openrt {

enum class Fault : uint8_t {
  notFinite,
  undeclaredGlossy,
  undeclaredEmission,
  undeclaredTransparency,
  undeclaredScattering
};

class ShaderFaults { // of one thread, or of a frame
 public:
  struct Entry {
    const RtsClass* shaderClass;
    Fault fault;
    uint64_t hits;
  };
  void add(const RtsClass& shaderClass, Fault fault, uint64_t hits);
  void add(const ShaderFaults& more);
  uint64_t count(Fault fault) const;
  // A line for each class and fault, in an order that does not depend on threads.
  void report(RTlogCallback callback, void* user) const;
  const std::vector<Entry>& entries() const { return entries_; } // in no order

 private:
  std::vector<Entry> entries_;
};

// Replaces numbers of an answer that are not finite by 0. arrays: of n floats; null ones are left
// out.
void checkAnswer(const RtsClass& shaderClass, RtsBatch& batch, uint32_t n,
                 std::initializer_list<float*> arrays);
// The same of a surface that answers in lobes: one that is not finite has no weight.
void checkAnswer(const RtsClass& shaderClass, RtsBatch& batch, const RtsSurface& out);
// The same of a surface that shades by itself.
void checkAnswer(const RtsClass& shaderClass, RtsBatch& batch, const RtsShading& out);

} // namespace openrt
