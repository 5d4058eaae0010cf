// embree_device.h: the Embree device of a backend, with the instruction set of its kernels. Made
// and destroyed between frames.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "backend/local/accel/embree.h"

namespace openrt {

struct EmbreeDevice {
  // wanted: an instruction set (backend/instruction_sets.h), or "auto" for the best one. Throws
  // OptionError if this machine does not have it.
  EmbreeDevice(uint32_t threads, const std::string& wanted);
  ~EmbreeDevice() { rtcReleaseDevice(device); }
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;
  // Commits a scene. Throws if it, or something attached to it on this thread, is not whole because
  // memory is short. Embree itself only notes that, and rays then pass what is missing.
  void commit(RTCScene scene) const;
  // Forgets what has failed before on this thread.
  void forgetErrors() const { rtcGetDeviceError(device); }
  RTCDevice device = nullptr;
  std::string isa; // the instruction set of the kernels
  // Embree traces packets of 16 rays natively with this instruction set
  bool hasNativePackets16 = true;
  std::atomic<int64_t> bytes{0}; // memory of all acceleration structures
  // hits on slivers that single precision reports and double precision rejects
  mutable std::atomic<uint64_t> wrongHits{0};
};

} // namespace openrt
