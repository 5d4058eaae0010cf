#include "libpicture/live/film_history.h"

#include <cstddef>
#include <vector>

namespace picture::live {

namespace {

// Returns how many frames a history that began at the last multiple of the period has had before.
int64_t ageAt(int64_t number) {
  constexpr int64_t period = FilmHistory::period;
  return (number % period + period) % period;
}

// Mixes a picture into another one of its size. weight: of `other`.
void mix(const Picture& other, float weight, Picture& picture) {
  std::vector<float>& rgba = picture.planes.at(RT_RGBA);
  const std::vector<float>& from = other.planes.at(RT_RGBA);
  for (size_t i = 0; i < rgba.size(); ++i) rgba[i] += (from[i] - rgba[i]) * weight;
}

} // namespace

int64_t FilmHistory::firstFor(int64_t number) { return number - ageAt(number) - period; }

float FilmHistory::weightOfYounger(int64_t number) {
  // Smooth at both ends, where one of the histories has few frames or is about to end.
  const float t = float(ageAt(number) + 1) / float(period + 1);
  return t * t * (3 - 2 * t);
}

void FilmHistory::reset() {
  for (Reconstruction& history : histories_) history.reset();
}

Picture FilmHistory::add(int64_t number, const Picture& frame, const FrameCamera& camera,
                         OidnFilter* denoiser) {
  if (!last_ || *last_ + 1 != number) {
    reset();
    hasOlder_ = false;
  } else if (ageAt(number) == 0) {
    younger_ = 1 - younger_;
    hasOlder_ = true;
    younger().reset();
  }
  last_ = number;
  Picture picture = younger().add(frame, camera, 1, denoiser);
  facts_ = younger().facts();
  if (!hasOlder_) return picture;
  mix(older().add(frame, camera, 1, denoiser), 1 - weightOfYounger(number), picture);
  const Reconstruction::Facts& others = older().facts();
  facts_.seconds += others.seconds;
  facts_.denoising += others.denoising;
  facts_.denoised |= others.denoised;
  if (facts_.problem.empty()) facts_.problem = others.problem;
  return picture;
}

} // namespace picture::live
