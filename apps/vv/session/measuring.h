// measuring.h: Reads sensors of the world that runs, between the frames of its viewers, which wait
// meanwhile. One measurement at a time. Owned by a session. [the browser's thread]
#pragma once

#include <functional>
#include <optional>

#include "session/shared_renderer.h"

namespace vv {

class Measuring {
 public:
  // Receives the readings, or why there are none.
  using Done = std::function<void(const picture::LiveReadings& readings)>;

  // The renderer must outlive this object.
  explicit Measuring(SharedRenderer& shared) : shared_(shared) {}

  // Asks for readings of the world as it is when the renderer is free. [not while one is pending]
  void want(const picture::LiveMeasure& measure, Done done);
  // A measurement waits or is under way, so that no frame may be started.
  bool isPending() const { return done_ != nullptr; }
  bool isWaiting() const { return wanted_.has_value(); }
  // Ends what is pending: done is called with a failure.
  void giveUp();
  // Begins what waits once the renderer is free, and hands over what has ended. [not while mapping]
  void advance();

 private:
  void end(const picture::LiveReadings& readings);

  SharedRenderer& shared_;
  std::optional<picture::LiveMeasure> wanted_;
  Done done_; // null: nothing is pending
};

} // namespace vv
