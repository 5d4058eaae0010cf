// faults.h: counts what is wrong with the output of shaders and with bodies, by class; reported
// once at the end of a frame (surface/sanitize_output.h finds faulty output). [render]
#pragma once

#include <cstdint>
#include <vector>

#include "openrt/openrt.h"
#include "openrt/openrts.h"

namespace openrt {

enum class Fault : uint8_t {
  notFinite,
  undeclaredGlossy,
  undeclaredEmission,
  undeclaredTransparency,
  undeclaredScattering,
  varyingEmission,
  neverEntered // the last one
};

class ShaderFaults { // Fault counts of one thread, or of a frame.
 public:
  struct Entry {
    const RtsClass* shaderClass;
    Fault fault;
    uint64_t hits;
  };
  void add(const RtsClass& shaderClass, Fault fault, uint64_t hits);
  void add(const ShaderFaults& more);
  uint64_t count(Fault fault) const;
  // Logs one line for each class and fault, in an order that does not depend on threads.
  // cameraRays: of the frame. Bodies that fewer than one path in a thousand has left without
  // entering them are closed, but for a few paths that pass an edge within the rounding.
  void report(RTlogCallback callback, void* user, uint64_t cameraRays) const;
  const std::vector<Entry>& entries() const { return entries_; } // unordered

 private:
  std::vector<Entry> entries_;
};

} // namespace openrt
