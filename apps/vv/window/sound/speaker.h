// speaker.h: Owns the audio device, which plays the samples of a Mixer. [main thread; the device's
// own thread calls the mixer]
#pragma once

#include <memory>
#include <string>

#include "window/sound/mixer.h"

namespace vv {

class Speaker {
 public:
  explicit Speaker(Mixer& mixer) : mixer_(mixer) {}
  ~Speaker();
  Speaker(const Speaker&) = delete;
  Speaker& operator=(const Speaker&) = delete;
  // Opens the device; call it once. Returns why there is none, or "".
  std::string open();
  bool tried() const { return tried_; }

 private:
  Mixer& mixer_;
  bool tried_ = false;
  unsigned device_ = 0;
};

} // namespace vv
