// oidn_lender.h: Lends the filter of Open Image Denoise to the previews that shall have it: all of
// them, none, or those that leave time for it. A renderer that makes previews owns one. [one thread
// at a time]
#pragma once

#include <future>
#include <memory>
#include <string>
#include <vector>

#include "libpicture/live/denoise_choice.h"
#include "libpicture/live/oidn.h"
#include "libpicture/renderer.h"

namespace picture::live {

class OidnLender {
 public:
  // The library, or null. Throws OidnError.
  using Find = std::shared_ptr<const OidnLibrary> (*)();

  // wanted: own: the library is not even looked for. oidn: it filters every preview. automatic: it
  // is loaded and tried beside the previews, and filters those that it has time for.
  // threads: 0: as many as the process may use. find: where the library comes from.
  OidnLender(Denoiser wanted, int threads, Find find = OidnLibrary::find);
  ~OidnLender(); // waits for a trial
  OidnLender(const OidnLender&) = delete;
  OidnLender& operator=(const OidnLender&) = delete;

  // Returns the filter for a viewer's next preview; null: the preview is filtered without the
  // library. pixels: of the images; allowed: seconds that it may take, for `automatic`.
  OidnFilter* filterFor(DenoiseSwitch& viewer, double pixels, double allowed);
  // Tells whether the library is being tried.
  bool isTrying() const { return state_ == State::trying; }
  // Notes how long the filter took for a preview.
  void took(double pixels, double seconds) { time_.took(pixels, seconds); }
  // Notes that the library has failed. It is not used again.
  void failed(const std::string& why);
  // Returns, once, why the library is not used although it is there; "": nothing to tell.
  std::string takeProblem();

 private:
  // Holds what a trial brings.
  struct Trial {
    std::unique_ptr<OidnFilter> filter; // null: there is no library, or it cannot be used
    double secondsPerPixel = 0;
    std::string problem;
  };
  enum class State : unsigned char {
    untried,
    trying,  // the trial owns the filter
    usable,  // filter_ is there
    unusable // there is no library, or it has failed
  };

  void beginTrial();
  void endTrial();
  static Trial make(Find find, int threads, OidnQuality quality);
  static Trial tryOut(Trial made);

  const Denoiser wanted_;
  const int threads_;
  const Find find_;
  State state_ = State::untried;
  std::unique_ptr<OidnFilter> filter_;
  std::future<Trial> trial_;
  DenoiseTime time_;
  // Previews since the trial and before the next one: the first trial may have met a busy machine.
  long since_ = 0, patience_;
  std::string problem_;
};

} // namespace picture::live
