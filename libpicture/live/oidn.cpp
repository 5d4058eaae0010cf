// oidn.cpp: Loads Open Image Denoise and declares what is used of its C interface, since no header
// of it is needed to build. The declarations follow the section "API" of its documentation
// (https://www.openimagedenoise.org/documentation.html), version 2.
#include "libpicture/live/oidn.h"

#include <dlfcn.h>

#include <new>
#include <utility>

#include <fmt/format.h>
#include <tbb/info.h>

#include "plugin_library.h"

namespace picture::live {

namespace {

// Numbers of the enumerations OIDNDeviceType, OIDNFormat and OIDNQuality.
constexpr int defaultDevice = 0, processorDevice = 1;
constexpr int threeFloats = 3;
constexpr int outOfMemory = 4; // OIDNError
int numberOf(OidnQuality quality) { return 4 + int(quality); }

// A better network for the albedo takes three times as long for .0002 of relMSE (decision 71).
constexpr OidnQuality albedoQuality = OidnQuality::fast;

constexpr int oldestVersion = 20000; // 2.0.0

using Device = struct OIDNDeviceImpl*;
using Buffer = struct OIDNBufferImpl*;
using Filter = struct OIDNFilterImpl*;

} // namespace

struct OidnFunctions {
  Device (*newDevice)(int type);
  void (*commitDevice)(Device);
  void (*releaseDevice)(Device);
  int (*getDeviceInt)(Device, const char* name);
  void (*setDeviceInt)(Device, const char* name, int);
  void (*setDeviceBool)(Device, const char* name, bool);
  // Returns the number of the device's first error since the last call, 0: none. Without a device:
  // that of the thread.
  int (*getDeviceError)(Device, const char** message);
  Buffer (*newBuffer)(Device, size_t bytes);
  void (*releaseBuffer)(Buffer);
  void (*writeBuffer)(Buffer, size_t offset, size_t bytes, const void* from);
  void (*readBuffer)(Buffer, size_t offset, size_t bytes, void* to);
  Filter (*newFilter)(Device, const char* type);
  void (*releaseFilter)(Filter);
  void (*setFilterImage)(Filter, const char* name, Buffer, int format, size_t width, size_t height,
                         size_t offset, size_t pixelStride, size_t rowStride);
  void (*setFilterBool)(Filter, const char* name, bool);
  void (*setFilterInt)(Filter, const char* name, int);
  void (*commitFilter)(Filter);
  void (*executeFilter)(Filter);
};

namespace {

template <class Function>
void lookUp(void* library, const std::string& file, const char* name, Function*& function) {
  function = reinterpret_cast<Function*>(dlsym(library, name));
  if (!function)
    throw OidnError(
        fmt::format("{} has no function {}: it is not Open Image Denoise 2", file, name));
}

OidnFunctions functionsOf(void* library, const std::string& file) {
  OidnFunctions f{};
  const auto find = [&](const char* name, auto*& function) {
    lookUp(library, file, name, function);
  };
  find("oidnNewDevice", f.newDevice);
  find("oidnCommitDevice", f.commitDevice);
  find("oidnReleaseDevice", f.releaseDevice);
  find("oidnGetDeviceInt", f.getDeviceInt);
  find("oidnSetDeviceInt", f.setDeviceInt);
  find("oidnSetDeviceBool", f.setDeviceBool);
  find("oidnGetDeviceError", f.getDeviceError);
  find("oidnNewBuffer", f.newBuffer);
  find("oidnReleaseBuffer", f.releaseBuffer);
  find("oidnWriteBuffer", f.writeBuffer);
  find("oidnReadBuffer", f.readBuffer);
  find("oidnNewFilter", f.newFilter);
  find("oidnReleaseFilter", f.releaseFilter);
  find("oidnSetFilterImage", f.setFilterImage);
  find("oidnSetFilterBool", f.setFilterBool);
  find("oidnSetFilterInt", f.setFilterInt);
  find("oidnCommitFilter", f.commitFilter);
  find("oidnExecuteFilter", f.executeFilter);
  return f;
}

// Throws what has gone wrong on a device since the last call.
void check(const OidnFunctions& f, Device device) {
  const char* message = nullptr;
  const int code = f.getDeviceError(device, &message);
  if (code == outOfMemory) throw std::bad_alloc();
  if (code || !device)
    throw OidnError(
        fmt::format("Open Image Denoise: {}",
                    message && *message ? message : fmt::format("error {}", code).c_str()));
}

// A device that is released with its owner.
struct OwnedDevice {
  OwnedDevice(const OidnFunctions& functions, int threads) : f(functions) {
    device = f.newDevice(defaultDevice);
    if (!device) check(f, nullptr);
    try {
      if (f.getDeviceInt(device, "type") == processorDevice) {
        f.setDeviceInt(device, "numThreads",
                       threads > 0 ? threads : tbb::info::default_concurrency());
        f.setDeviceBool(device, "setAffinity", false); // other threads use the processors, too
      }
      f.commitDevice(device);
      check(f, device);
    } catch (...) {
      f.releaseDevice(device);
      throw;
    }
  }
  ~OwnedDevice() { f.releaseDevice(device); }
  OwnedDevice(const OwnedDevice&) = delete;
  OwnedDevice& operator=(const OwnedDevice&) = delete;

  const OidnFunctions& f;
  Device device = nullptr;
};

} // namespace

// --- The library ---

namespace {

// Loads a library by its file, or by a bare name, which the system's loader looks for in its own
// folders. Returns null if there is none of that name.
void* open(const std::string& file) {
  std::string why;
  if (file.find('/') != file.npos) {
    try {
      return plugin_files::openLibrary(file, "library");
    } catch (const std::runtime_error& error) { why = error.what(); }
  } else {
    if (void* const handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) return handle;
    const char* const reason = dlerror();
    why = reason ? reason : "it cannot be loaded";
    // A library that was found is called by its whole path, one that was not by its name.
    if (why.starts_with(file + ":")) return nullptr;
  }
  throw OidnError(fmt::format("Open Image Denoise cannot be loaded: {}", why));
}

} // namespace

std::shared_ptr<const OidnLibrary> OidnLibrary::load(const std::string& file) {
  void* const handle = open(file);
  if (!handle) return nullptr;
  auto library = std::make_shared<OidnLibrary>();
  library->file_ = file;
  library->functions_ = std::make_shared<const OidnFunctions>(functionsOf(handle, file));
  Dl_info place{};
  if (dladdr(reinterpret_cast<const void*>(library->functions().newDevice), &place) &&
      place.dli_fname)
    library->file_ = place.dli_fname;
  const OwnedDevice asked(library->functions(), 1);
  const int version = library->functions().getDeviceInt(asked.device, "version");
  library->name_ = fmt::format("Open Image Denoise {}.{}.{}", version / 10000, version / 100 % 100,
                               version % 100);
  if (version < oldestVersion)
    throw OidnError(
        fmt::format("{} is {}; version 2.0.0 or newer is needed", file, library->name_));
  return library;
}

// --- The filter ---

void OidnImages::resize(int w, int h) {
  width = w;
  height = h;
  for (std::vector<float>* image : {&colour, &albedo, &normal})
    image->resize(size_t(w) * size_t(h) * 3);
}

struct OidnFilter::Impl {
  Impl(std::shared_ptr<const OidnLibrary> l, int threads, OidnQuality q, OidnGuides g)
      : library(std::move(l)), f(library->functions()), owned(f, threads), quality(q), guides(g) {}
  ~Impl() { release(); }

  void release() {
    for (const Filter filter : filters) f.releaseFilter(filter);
    filters.clear();
    if (buffer) f.releaseBuffer(std::exchange(buffer, nullptr));
    width = height = 0;
  }

  // The places of the images in the buffer.
  enum Place : uint8_t { colour, albedo, normal, output };

  void setImage(Filter filter, const char* name, Place place) {
    f.setFilterImage(filter, name, buffer, threeFloats, size_t(width), size_t(height),
                     place * imageBytes(width, height), 0, 0);
  }

  Filter addFilter(OidnQuality of) {
    const Filter filter = f.newFilter(owned.device, "RT");
    check(f, owned.device);
    filters.push_back(filter);
    f.setFilterInt(filter, "quality", numberOf(of));
    return filter;
  }

  // Makes the filters for images of another size. Buffers are the device's, since a graphics
  // processor need not reach other memory.
  void resize(int w, int h) {
    if (w == width && h == height) return;
    release();
    buffer = f.newBuffer(owned.device, 4 * imageBytes(w, h));
    check(f, owned.device);
    width = w;
    height = h;
    if (guides == OidnGuides::noisyAlbedo) {
      const Filter first = addFilter(albedoQuality);
      setImage(first, "albedo", albedo);
      setImage(first, "output", albedo);
      f.commitFilter(first);
    }
    const Filter filter = addFilter(quality);
    setImage(filter, "color", colour);
    if (guides != OidnGuides::none) {
      setImage(filter, "albedo", albedo);
      setImage(filter, "normal", normal);
    }
    setImage(filter, "output", output);
    f.setFilterBool(filter, "hdr", true);
    if (guides != OidnGuides::none) f.setFilterBool(filter, "cleanAux", true);
    f.commitFilter(filter);
    check(f, owned.device);
  }

  static size_t imageBytes(int w, int h) { return size_t(w) * size_t(h) * 3 * sizeof(float); }

  void write(Place place, const std::vector<float>& image) {
    const size_t bytes = imageBytes(width, height);
    f.writeBuffer(buffer, place * bytes, bytes, image.data());
  }

  void denoise(OidnImages& images) {
    resize(images.width, images.height);
    write(colour, images.colour);
    if (guides != OidnGuides::none) {
      write(albedo, images.albedo);
      write(normal, images.normal);
    }
    for (const Filter filter : filters) f.executeFilter(filter);
    check(f, owned.device);
    const size_t bytes = imageBytes(width, height);
    f.readBuffer(buffer, output * bytes, bytes, images.colour.data());
    check(f, owned.device);
  }

  const std::shared_ptr<const OidnLibrary> library;
  const OidnFunctions& f;
  const OwnedDevice owned;
  const OidnQuality quality;
  const OidnGuides guides;
  Buffer buffer = nullptr;
  std::vector<Filter> filters; // in the order in which they run
  int width = 0, height = 0;   // size of the images that the filters are made for
};

OidnFilter::OidnFilter(std::shared_ptr<const OidnLibrary> library, int threads, OidnQuality quality,
                       OidnGuides guides)
    : impl_(std::make_unique<Impl>(std::move(library), threads, quality, guides)) {}
OidnFilter::~OidnFilter() = default;

const std::string& OidnFilter::name() const { return impl_->library->name(); }

void OidnFilter::denoise(OidnImages& images) {
  try {
    impl_->denoise(images);
  } catch (...) {
    impl_->release();
    throw;
  }
}

} // namespace picture::live
