// denoiser.h: Removes the noise of finished pictures by Open Image Denoise 2 (live/oidn.h). Such
// pictures are biased and have no error bars, and they say so: Picture::denoisedBy and
// Picture::note. Decision 71 has the reasons. [one thread at a time for each PictureDenoiser]
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "libpicture/files/picture.h"
#include "libpicture/renderer.h"

namespace picture {

namespace live {
class OidnLibrary;
}

// Channels that the filter reads beside rgba. Without them it sees colours alone and blurs what it
// takes for noise.
inline constexpr uint32_t denoiserGuides = RT_ALBEDO | RT_NORMAL;
// Channels that say how far rgba may be from the truth. A denoised picture lacks them, because they
// belong to the picture before.
inline constexpr uint32_t errorChannels = RT_VARIANCE | RT_ERROR | RT_TRUST;

class PictureDenoiser {
 public:
  // threads: at most that many; 0: as many as the process may use. The result does not depend on
  // it. Throws RenderError: there is no library, or it cannot be used; the message says how to get
  // one.
  explicit PictureDenoiser(int threads);
  // With a library that is loaded; not null.
  PictureDenoiser(std::shared_ptr<const live::OidnLibrary> library, int threads);
  ~PictureDenoiser();
  PictureDenoiser(const PictureDenoiser&) = delete;
  PictureDenoiser& operator=(const PictureDenoiser&) = delete;

  // Returns the picture with rgba denoised, without errorChannels; other channels are as they were.
  // The guides are used if the picture has both. Every colour is finite afterwards; one that was
  // not counts as 0. The same picture gives the same result on the same machine with the same
  // library. Throws RenderError, std::bad_alloc, and std::runtime_error if there is no rgba.
  Picture denoised(const Picture& noisy);
  const std::string& name() const; // the library: "Open Image Denoise 2.5.1"

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace picture
