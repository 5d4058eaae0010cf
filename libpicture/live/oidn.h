// oidn.h: Calls Open Image Denoise 2, a library that removes noise from pictures by a neural
// network (https://www.openimagedenoise.org). It is looked for when vv runs and needed neither to
// build nor to run: OidnLibrary loads it, and OidnFilter denoises images with it. Previews
// (oidn_lender.h) and finished pictures (libpicture/denoiser.h) use both.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace picture::live {

struct OidnFunctions;

// Says what somebody without the library should do, for messages.
inline constexpr const char* howToGetOidn =
    "pip install pyoidn (or xvrml[denoise]) brings it; OPENRT_OIDN_LIBRARY=FILE names a "
    "libOpenImageDenoise.so.2 that is elsewhere";

// Why the library, which is there, cannot be used, or what it failed at. If it had no memory,
// std::bad_alloc is thrown instead.
struct OidnError : std::runtime_error {
  using runtime_error::runtime_error;
};

// The loaded library. It stays loaded until the process ends, because its threads do. [any thread]
class OidnLibrary {
 public:
  // Returns the library of this process; null: it is not installed. The first call looks for the
  // file that the environment variable OPENRT_OIDN_LIBRARY names, otherwise for
  // libOpenImageDenoise.so.2 and libOpenImageDenoise.so where the dynamic linker looks for
  // libraries, then in the Python package pyoidn, where pip puts it (oidn_find.cpp). The name
  // "none" means that there is none. Throws OidnError if there is a file that cannot be used; so do
  // all later calls.
  static std::shared_ptr<const OidnLibrary> find();
  // The same, but tries the library in a child process before the first call loads it: a file that
  // ends the process that uses it is an OidnError, too. For callers that can wait a moment.
  static std::shared_ptr<const OidnLibrary> findTried();
  // Adds the folder of a Python package pyoidn to the places where find() looks, before its first
  // call. The one beside the package of this program (a wheel's) is known already.
  static void lookIn(const std::string& packageFolder);
  // Loads a file. Returns null if `file` is a name without a folder and no such library is
  // installed; throws OidnError if it cannot be used.
  static std::shared_ptr<const OidnLibrary> load(const std::string& file);

  const OidnFunctions& functions() const { return *functions_; }
  // Name and version, for people: "Open Image Denoise 2.5.1".
  const std::string& name() const { return name_; }
  // The file that it was loaded from.
  const std::string& file() const { return file_; }

 private:
  std::string name_, file_;
  std::shared_ptr<const OidnFunctions> functions_;
};

// A network costs more time the better it is. On a processor `fast` takes half the time of
// `balanced` and `high` (docs/decisions/0053).
enum class OidnQuality : uint8_t { fast, balanced, high };

// Says what the filter knows about the pixels besides their colours (OidnImages::albedo, normal).
enum class OidnGuides : uint8_t {
  clean,       // both, without noise
  noisyAlbedo, // both; the albedo has noise, and is denoised first
  none         // nothing; the images of the guides are not read
};

// Three floats for each pixel, rows one after the other.
struct OidnImages {
  int width = 0, height = 0;
  std::vector<float> colour; // from 0 on, in any unit; replaced by the result
  // Hold what the pixels show: reflectances from 0 to 1, and normals of length 0 to 1.
  std::vector<float> albedo, normal;

  void resize(int w, int h);
};

// Denoises one image after the other, with a device of its own: a graphics processor if the library
// has one, otherwise the processor. [one thread at a time]
class OidnFilter {
 public:
  // threads: at most that many of the processor's; 0: as many as the process may use. Throws
  // OidnError.
  OidnFilter(std::shared_ptr<const OidnLibrary> library, int threads, OidnQuality quality,
             OidnGuides guides = OidnGuides::clean);
  ~OidnFilter();
  OidnFilter(const OidnFilter&) = delete;
  OidnFilter& operator=(const OidnFilter&) = delete;

  // Replaces images.colour. The same images give the same result on the same machine with the same
  // library. Waits until it is done. Throws OidnError; the images are as they were then.
  void denoise(OidnImages& images);
  const std::string& name() const; // the library's name

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace picture::live
