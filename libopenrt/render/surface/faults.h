// faults.h: detects faulty shader output: numbers that are not finite and, in diagnostic mode,
// lobes that the class's traits do not declare. Bodies that are not closed are reported in the same
// way. Bad numbers are replaced at once; faults are
// counted by class and reported once at the end of a frame. [render]
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

// Replaces numbers that are not finite by 0 and counts the points concerned. arrays: n floats each;
// null arrays are skipped.
void sanitizeOutput(const RtsClass& shaderClass, RtsBatch& batch, uint32_t n,
                    std::initializer_list<float*> arrays);
// The same for the output of `surface`. A lobe with a number that is not finite gets weight 0.
void sanitizeOutput(const RtsClass& shaderClass, RtsBatch& batch, const RtsSurface& out);
// The same for the output of `shade`.
void sanitizeOutput(const RtsClass& shaderClass, RtsBatch& batch, const RtsShading& out);

} // namespace openrt
