// embree_device.cpp: creates the Embree device with kernels of one instruction set. Called between
// frames.
#include "backend/local/accel/embree_device.h"

#include <new>
#include <stdexcept>
#include <string_view>

#include "backend/backend.h"
#include "backend/instruction_sets.h"

namespace openrt {
namespace {

// Returns whether the library has kernels of this instruction set: a build of Embree may lack the
// wider ones, and its device then uses narrower ones.
bool hasKernels(RTCDevice device, std::string_view isa) {
  if (isa == "avx512")
    return rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED);
  if (isa == "avx2" || isa == "avx")
    return rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED);
  return true;
}

// Returns a device whose kernels use this instruction set, or null if Embree cannot.
//
// The instruction set alone does not decide the bytes. By default Embree also looks at the model of
// the processor (frequency_level): a model with 128 bit gets trees of 4 children where others get
// 8, and then rays meet surfaces in another order. So the level is fixed, to Embree's default for
// models that it does not know.
RTCDevice newDevice(uint32_t threads, std::string_view isa) {
  std::string config = "threads=" + std::to_string(threads) + ",frequency_level=simd256";
  if (isa != "neon") config += ",isa=" + std::string(isa);
  RTCDevice device = rtcNewDevice(config.c_str());
  if (!device || hasKernels(device, isa)) return device;
  rtcReleaseDevice(device);
  return nullptr;
}

[[noreturn]] void refuse(const std::string& wanted) {
  const std::string best = EmbreeDevice(1, std::string(automaticIsa)).isa;
  throw OptionError("isa=" + wanted +
                    ": expected auto, or one that this machine has: " + instructionSetsFrom(best));
}

} // namespace

EmbreeDevice::EmbreeDevice(uint32_t threads, const std::string& wanted) {
  RTCError error = RTC_ERROR_NONE;
  for (const std::string_view name : instructionSets) {
    if (wanted != automaticIsa && wanted != name) continue;
    device = newDevice(threads, name);
    isa = name;
    if (device) break;
    error = rtcGetDeviceError(nullptr);
    if (error != RTC_ERROR_NONE && error != RTC_ERROR_UNSUPPORTED_CPU) break;
  }
  const bool lacksIsa = error == RTC_ERROR_NONE || error == RTC_ERROR_UNSUPPORTED_CPU;
  if (!device && wanted != automaticIsa && lacksIsa) refuse(wanted);
  if (!device && error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (!device)
    throw std::runtime_error("the ray kernels (Embree) do not start: error " +
                             std::to_string(error));
  rtcSetDeviceMemoryMonitorFunction(
      device,
      [](void* counter, ssize_t change, bool) {
        *static_cast<std::atomic<int64_t>*>(counter) += change;
        return true;
      },
      &bytes);
  hasNativePackets16 = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED);
}

// Embree keeps the first error of each thread.
void EmbreeDevice::commit(RTCScene scene) const {
  rtcCommitScene(scene);
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (error == RTC_ERROR_UNKNOWN)
    throw std::runtime_error("the ray kernels (Embree) could not build a structure");
}

} // namespace openrt
