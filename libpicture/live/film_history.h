// film_history.h: Rebuilds the frames of a film, each as a function of its number: whichever part
// of the film is made, and on whichever machine, a frame has the same bytes. A renderer that makes
// previews of sequences owns one. [one thread at a time; a call uses several threads]
#pragma once

#include <cstdint>
#include <optional>

#include "libpicture/live/reconstruction.h"

namespace picture::live {

// Keeps two histories at a time. A history begins with each frame whose number is a multiple of
// `period`, and lives for two periods. A picture is the mean of both: while the younger history
// grows up, its weight rises from frame to frame, and the older one fades out. So no frame shows
// that a history ends.
class FilmHistory {
 public:
  static constexpr int64_t period = 8;
  // Returns the first of the frames that a frame is made of: `period` to 2 * period - 1 before it.
  static int64_t firstFor(int64_t number);
  // Returns the weight of the younger history in a frame: above 0 and below 1.
  static float weightOfYounger(int64_t number);

  // threads: 0: as many as the process may use.
  explicit FilmHistory(int threads = 0)
      : histories_{Reconstruction(threads), Reconstruction(threads)} {}

  // Forgets what was accumulated: another world is shown.
  void reset();

  // Adds a frame and returns its picture, as Reconstruction::add() does. A number that does not
  // follow the last one begins anew. If all frames from firstFor(number) on were added in turn, the
  // bytes depend on nothing else; before, the histories that there are make the picture.
  Picture add(int64_t number, const Picture& frame, const FrameCamera& camera,
              OidnFilter* denoiser = nullptr);

  // Facts about the last add(): the seconds of both histories, the rest of the younger one.
  const Reconstruction::Facts& facts() const { return facts_; }

 private:
  Reconstruction& younger() { return histories_[younger_]; }
  Reconstruction& older() { return histories_[1 - younger_]; }

  Reconstruction histories_[2];
  int younger_ = 0;
  bool hasOlder_ = false;       // the older history has begun
  std::optional<int64_t> last_; // number of the last frame
  Reconstruction::Facts facts_;
};

} // namespace picture::live
