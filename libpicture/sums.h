// sums.h: The sums of a picture as files: checkpoints of vv --resume, and the sums that --sums puts
// behind an OpenEXR file. They hold what the engine keeps (openrt/sums.h) and the few facts that
// only the renderer knows. A file may come from anywhere. [any thread]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "libpicture/background.h"
#include "libpicture/files/picture.h"
#include "libpicture/files/view_transform.h"
#include "openrt/openrt.h"
#include "openrt/sums.h"

namespace picture {

struct RenderSettings;

// Owns sums of the engine; copies share them.
class Sums {
 public:
  Sums() = default;
  explicit Sums(RTsums sums) : sums_(sums, rtDeleteSums) {}
  explicit operator bool() const { return sums_ != nullptr; }
  RTsums get() const { return sums_.get(); }
  RTsumsInfo info() const;

 private:
  std::shared_ptr<RTsumsObject> sums_;
};

// Holds what the sums of a picture do not tell.
struct SumsFacts {
  uint32_t channels = RT_RGBA; // those of the files; the sums may have more
  bool linear = true;
  bool depthAlongRay = false; // Picture::depthAlongRay
  Background background;
  std::vector<std::string> names; // the names of channel id
  bool operator==(const SumsFacts&) const = default;
};

// How a picture is shown on screens. It does not change the sums.
struct SumsView {
  ViewTransform transform;
  bool fits = false; // the exposure is chosen to fit the picture (fittingExposure)
  // Tells whether pictures are shown in the same way. An exposure that fits is that of each.
  bool operator==(const SumsView& other) const {
    return fits == other.fits && transform.curve == other.transform.curve &&
           (fits || transform.exposure == other.transform.exposure);
  }
};

struct SumsFile {
  SumsFacts facts;
  SumsView view;
  Sums done;    // the sums of all finished seeds before the current one; may be none
  Sums current; // the sums of the seed that is being made, or was the last; may be none
};

// Returns the facts of a picture.
SumsFacts factsOf(const RenderSettings& settings, uint32_t channels,
                  const std::vector<std::string>& names);
std::string encodeSums(const SumsFile& file);
// Reads a file that holds such bytes, or an OpenEXR file that ends with them. Throws InputError.
SumsFile readSums(const std::string& path);
// Puts the sums behind the bytes of an OpenEXR file. Readers of OpenEXR do not look there.
void appendSums(std::string& exr, const SumsFile& file);

// Returns the sums of both; either may be none. Throws RenderError if they do not belong together.
Sums mergeSums(const Sums& a, const Sums& b);
// Returns what is needed of finished sums to add them to others. Throws RenderError.
Sums condensed(const Sums& sums);
// Makes the picture of finished sums, with all their channels, but without a background that is a
// picture. Throws RenderError.
Picture pictureOf(const Sums& sums, const SumsFacts& facts);
RTstats statsOf(const Sums& sums); // throws RenderError

} // namespace picture
