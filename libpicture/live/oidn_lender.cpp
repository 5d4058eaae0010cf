#include "libpicture/live/oidn_lender.h"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace picture {

void checkDenoiser(Denoiser wanted) {
  if (wanted != Denoiser::oidn) return;
  try {
    if (live::OidnLibrary::findTried()) return;
  } catch (const live::OidnError& error) { throw RenderError(error.what()); }
  throw RenderError(fmt::format("Open Image Denoise 2 was not found: {}", live::howToGetOidn));
}

namespace live {

namespace {

// A trial filters noise of this size, which takes a hundredth of a second on a few processors.
constexpr int trialWidth = 160, trialHeight = 120, trials = 3;
constexpr long firstPatience = 256; // previews until the next trial, the first time

// In motion there is hardly time for more; where time does not count, the best is right.
constexpr OidnQuality inTime = OidnQuality::fast, atLeisure = OidnQuality::high;

OidnImages trialImages() {
  OidnImages images;
  images.resize(trialWidth, trialHeight);
  uint32_t state = 1;
  for (float& value : images.colour) {
    state = state * 1664525u + 1013904223u; // W. H. Press et al., "Numerical Recipes", 7.1
    value = float(state >> 8) * 0x1p-24f;
  }
  std::fill(images.albedo.begin(), images.albedo.end(), 0.5f);
  for (size_t i = 2; i < images.normal.size(); i += 3) images.normal[i] = 1;
  return images;
}

} // namespace

OidnLender::OidnLender(Denoiser wanted, int threads, Find find)
    : wanted_(wanted), threads_(threads), find_(find), patience_(firstPatience) {}

OidnLender::~OidnLender() = default; // a future of std::async waits

OidnLender::Trial OidnLender::make(Find find, int threads, OidnQuality quality) {
  Trial made;
  try {
    if (const auto library = find()) {
      made.filter = std::make_unique<OidnFilter>(library, threads, quality);
    }
  } catch (const std::exception& error) { made.problem = error.what(); }
  return made;
}

// Measures the filter. The first run of a size prepares it and does not count; the shortest of the
// others is the one that was disturbed least.
OidnLender::Trial OidnLender::tryOut(Trial made) {
  using Clock = std::chrono::steady_clock;
  if (!made.filter) return made;
  double shortest = 0;
  try {
    for (int k = 0; k <= trials; ++k) {
      OidnImages images = trialImages();
      const Clock::time_point begin = Clock::now();
      made.filter->denoise(images);
      const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
      if (k == 1 || (k > 1 && seconds < shortest)) shortest = seconds;
    }
    made.secondsPerPixel = shortest / (trialWidth * trialHeight);
  } catch (const std::exception& error) {
    made.filter.reset();
    made.problem = error.what();
  }
  return made;
}

void OidnLender::beginTrial() {
  Trial known;
  known.filter = std::move(filter_);
  try {
    trial_ = std::async(
        std::launch::async, [find = find_, threads = threads_, known = std::move(known)]() mutable {
          return tryOut(known.filter ? std::move(known) : make(find, threads, inTime));
        });
    state_ = State::trying;
  } catch (const std::system_error& error) { failed(error.what()); } // no thread can be started
}

void OidnLender::endTrial() {
  Trial done = trial_.get();
  state_ = done.filter ? State::usable : State::unusable;
  filter_ = std::move(done.filter);
  problem_ = std::move(done.problem);
  time_.probed(done.secondsPerPixel);
  since_ = 0;
}

OidnFilter* OidnLender::filterFor(DenoiseSwitch& viewer, double pixels, double allowed) {
  if (wanted_ == Denoiser::own || state_ == State::unusable) return nullptr;
  if (wanted_ == Denoiser::oidn) {
    if (state_ == State::untried) {
      Trial made = make(find_, threads_, atLeisure);
      if (!made.filter && made.problem.empty()) made.problem = "Open Image Denoise 2 was not found";
      state_ = made.filter ? State::usable : State::unusable;
      filter_ = std::move(made.filter);
      problem_ = std::move(made.problem);
    }
    return filter_.get();
  }
  if (state_ == State::untried) beginTrial();
  if (state_ == State::trying) {
    if (trial_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return nullptr;
    endTrial();
    if (state_ == State::unusable) return nullptr;
  }
  if (viewer.next(time_.of(pixels), allowed)) return filter_.get();
  if (++since_ >= patience_) {
    patience_ *= 4;
    beginTrial();
  }
  return nullptr;
}

void OidnLender::failed(const std::string& why) {
  state_ = State::unusable;
  filter_.reset();
  problem_ = why;
}

std::string OidnLender::takeProblem() { return std::exchange(problem_, {}); }

} // namespace live
} // namespace picture
